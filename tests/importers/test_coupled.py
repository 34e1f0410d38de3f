"""Two gear trains of ours in one .ssp file, in every master that reads one, against a loop that does what the master does.

Masters differ in what they pass on before the first step, and in whether outputs that feed through are read with the inputs
of the step's end. Beyond that, 1e-9: they add up their communication points differently.
"""

import numpy as np
import pair
import pytest
import ssp
from fmpy.ssp.simulation import simulate_ssp
from masters import ecos, libcosim


@pytest.fixture
def trains(fmus):
    return pair.fmus_of(fmus)


@pytest.fixture
def system(trains, tmp_path):
    return ssp.write(tmp_path / "trains.ssp", trains, pair.CONNECTIONS)


def agree(found, expected):
    assert np.allclose(found, expected, rtol=1e-9), (found, expected)


def test_the_trains_feel_each_other(trains, tmp_path):
    """Otherwise the tests below would show nothing."""
    together = pair.run(trains, tmp_path, pair.Trains.exchange)
    apart = pair.run(trains, tmp_path / "apart", lambda both: setattr(both, "exchange", lambda: None))
    assert all(abs(one / other - 1) > 1e-2 for one, other in zip(together, apart)), (together, apart)


def test_libcosim_reads_the_ssp_and_passes_outputs_on_twice_in_initialization_mode(trains, system, tmp_path):
    def twice(both):
        both.exchange()
        both.exchange()

    script = """
execution = CosimExecution.from_ssp_file(ssp_path=SYSTEM, step_size=10_000)
observer = CosimObserver.create_last_value()
execution.add_observer(observer=observer)
assert execution.simulate_until(target_time=STEPS * 10_000)
for name in WATCHED:
    component, variable = name.split(".", 1)
    index = execution.slave_index_from_instance_name(component)
    reference = next(v.reference for v in execution.slave_variables(slave_index=index) if v.name.decode() == variable)
    print("value", *observer.last_real_values(slave_index=index, variable_references=[reference]))
"""
    found = libcosim(script, SYSTEM=system, STEPS=pair.STEPS, WATCHED=pair.WATCHED)
    agree(found, pair.run(trains, tmp_path, twice))


def test_ecos_reads_the_ssp_and_reads_outputs_with_new_inputs(trains, system, tmp_path):
    script = """
with EcosSimulation(step_size=1e-5, ssp_path=SYSTEM) as simulation:
    simulation.init()
    simulation.step(STEPS)
    for name in WATCHED:
        print("value", simulation.get_real(name.replace(".", "::", 1)))
    simulation.terminate()
"""
    expected = pair.run(trains, tmp_path, pair.Trains.exchange, at_the_end=True)
    agree(ecos(script, SYSTEM=system, STEPS=pair.STEPS, WATCHED=pair.WATCHED), expected)


def test_fmpy_reads_the_ssp_and_begins_with_zeros(trains, system, tmp_path):
    def zeros(both):
        # In step mode: the trains start from the equilibrium under the torques of their files.
        both.initialize()
        for _, sink in pair.CONNECTIONS:
            both.set(sink, 0.0)

    result = simulate_ssp(system, stop_time=pair.STEPS * pair.STEP, step_size=pair.STEP)
    found = [result[name][pair.STEPS - 1] for name in pair.WATCHED]
    agree(found, pair.run(trains, tmp_path, zeros, before_the_first=False))
