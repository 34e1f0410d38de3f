"""The packed FMUs against an independent implementation of the same equations (reference/)."""

from pathlib import Path

import numpy as np
import pytest
import reference
from conftest import ROOT, simulate

EXAMPLE = ROOT / "examples/three_stage.toml"


def model_file(name: str) -> Path:
    return EXAMPLE if name == "three_stage" else ROOT / f"tests/models/{name}.toml"


def flat(rotor):
    """Uncoupled frequencies with the names of the FMU's variables."""
    for kind in ("lateral", "torsional"):
        for index, value in enumerate(rotor[kind]):
            yield f"{rotor['name']}.{kind}_frequency[{index + 1}]", value


@pytest.mark.parametrize("name", ["three_stage", "reducer", "compound"])
def test_uncoupled_frequencies(fmus, name):
    expected = dict(pair for rotor in reference_frequencies(name) for pair in flat(rotor))
    result = simulate(fmus / f"{name}.fmu", stop_time=1e-5, output=list(expected))
    for variable, value in expected.items():
        # 1e-8: two eigenvalue solvers on the same matrices; the issue asks for 1e-5.
        assert abs(result[variable][0] / value - 1) < 1e-8, variable


def reference_frequencies(name):
    frequencies = reference.frequencies(reference.load(model_file(name)))
    return [{"name": rotor, **values} for rotor, values in frequencies.items()]


CASES = {
    "three_stage": {},
    "three_stage, case 4": {
        "gearbox_vibration.amplitude_x": 25e-6,
        "gearbox_vibration.amplitude_y": 25e-6,
        "stage1.gear_unbalance.moment": 1.5e-4,
        "stage2.gear_unbalance.moment": 1.5e-4,
        "stage3.gear_unbalance.moment": 1.5e-4,
    },
    "reducer": {},
    "compound": {},
}


def apply(model, parameters):
    for path, value in parameters.items():
        owner, *rest = path.split(".")
        if owner == "gearbox_vibration":
            model[owner][rest[0]] = value
        else:
            rotor = next(rotor for rotor in model["rotor"] if rotor["name"] == owner)
            next(u for u in rotor["unbalance"] if u["name"] == rest[0])[rest[1]] = value
    return model


@pytest.mark.parametrize("case", CASES)
def test_transient(fmus, case):
    """Every output, at every communication point: RMS error relative to the alternating part."""
    name, parameters = case.split(",")[0], CASES[case]
    stop, step = 0.02, 2e-5
    model = apply(reference.load(model_file(name)), parameters)
    times = np.arange(round(stop / step) + 1) * step
    expected = reference.simulate(model, stop, times)
    outputs = [key for key in expected if "." in key and not key.endswith((".speed", ".angle"))]
    found = simulate(fmus / f"{name}.fmu", stop_time=stop, output_interval=step, output=outputs,
                     start_values={"simulation.tolerance": 1e-5, **parameters})
    scale = {}
    for key in outputs:
        family = key.rsplit(".", 1)[-1].rstrip("xy")
        scale[family] = max(scale.get(family, 0.0), np.std(expected[key]))
    errors = {}
    for key in outputs:
        exact, family = expected[key], key.rsplit(".", 1)[-1].rstrip("xy")
        # What should not move at all (the symmetric directions) is measured against what does.
        alternating = max(np.std(exact), 1e-6 * scale[family])
        errors[key] = np.sqrt(np.mean((found[key] - exact) ** 2)) / alternating
    worst = max(errors, key=errors.get)
    # 1e-3: the bound for mesh and bearing forces, here for every output.
    assert errors[worst] < 1e-3, f"{worst}: {errors[worst]:.2e}"
