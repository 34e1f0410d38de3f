"""The packed FMUs in Ecos, alone and two instances of one FMU."""

import numpy as np
from conftest import simulate
from masters import ecos


def test_ecos_runs_it_without_a_complaint_and_with_the_same_result(three_stage):
    script = """
with EcosSimulationStructure() as structure:
    structure.add_model("one", FMU)
    structure.add_model("other", FMU)
    structure.add_parameter_set("soft", {"other::mesh12.stiffness_factor": 0.5})
    with EcosSimulation(structure=structure, step_size=2e-5) as simulation:
        simulation.init(parameter_set="soft")
        simulation.step(500)
        for variable in ("one::mesh12.force", "one::stage1.b1.force_x", "other::mesh12.force"):
            print("value", simulation.get_real(variable))
        simulation.terminate()
"""
    forces = ecos(script, FMU=three_stage)
    outputs = ["mesh12.force", "stage1.b1.force_x"]
    one = simulate(three_stage, stop_time=0.01, output_interval=2e-5, output=outputs)[-1]
    other = simulate(three_stage, stop_time=0.01, output_interval=2e-5, output=outputs,
                     start_values={"mesh12.stiffness_factor": 0.5})[-1]
    # 1e-6: Ecos adds up its communication points, FMPy multiplies; steps that differ by rounding may be divided differently
    # inside, which the tolerance of 1e-4 allows.
    assert np.allclose(forces, [one["mesh12.force"], one["stage1.b1.force_x"], other["mesh12.force"]], rtol=1e-6)
    assert one["mesh12.force"] != other["mesh12.force"]


def test_what_a_slave_complains_about_is_in_the_log_of_ecos(three_stage):
    """Ecos ignores the status of every call: without this the test above would prove nothing."""
    script = """
with EcosSimulationStructure() as structure:
    structure.add_model("one", FMU)
    structure.add_parameter_set("wrong", {"one::simulation.tolerance": -1.0})
    with EcosSimulation(structure=structure, step_size=2e-5) as simulation:
        simulation.init(parameter_set="wrong")
        simulation.step(1)
"""
    try:
        ecos(script, FMU=three_stage)
    except AssertionError as complaint:
        assert "tolerance" in str(complaint), complaint
    else:
        raise AssertionError("nobody complained")
