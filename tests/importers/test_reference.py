"""The packed FMUs against an independent implementation of the same equations (reference/): the machines of
examples/ and tests/models/, and random trains."""

import functools
import json
import os
import subprocess
import tomllib
from pathlib import Path

import fmpy
import numpy as np
import pytest
import random_trains
import reference
from conftest import ROOT, simulate
from fmpy.fmi2 import FMU2Slave

# Trains that between them have every feature of random_trains.py, and some more.
SEEDS = [0, 1, 3, 17, 18, 21, 29, 33, 35, 40, 42, 61, 77, 87, 111, 113, 116, 119, 123, 138, 143, 150, 160]


def model_files():
    """Every train that the reference can read: it has no tooth geometry and knows plain numbers only."""
    for file in sorted([*ROOT.glob("examples/*.toml"), *ROOT.glob("tests/models/*.toml")]):
        model = tomllib.loads(file.read_text())
        laws = {mesh["stiffness"]["law"] for mesh in model.get("mesh", [])}
        if model["kind"] == "gear_train" and "tooth_geometry" not in laws:
            yield file.stem, file


MODELS = dict(model_files())

# name: model file, end of the run [s], parameters
CASES = {name: (name, 0.02, {}) for name in MODELS} | {
    "three_stage, case 4": ("three_stage", 0.02, {
        "gearbox_vibration.amplitude_x": 25e-6,
        "gearbox_vibration.amplitude_y": 25e-6,
        "stage1.gear_unbalance.moment": 1.5e-4,
        "stage2.gear_unbalance.moment": 1.5e-4,
        "stage3.gear_unbalance.moment": 1.5e-4,
    }),
} | {f"train{seed}": (f"train{seed}", 0.006, {}) for seed in SEEDS}

STEP = 2e-5


@pytest.fixture(scope="session")
def packed(fmus, tmp_path_factory):
    """name -> FMU of every case."""
    folder = tmp_path_factory.mktemp("trains")
    files = []
    for seed in SEEDS:
        files.append(folder / f"train{seed}.toml")
        files[-1].write_text(random_trains.toml_text(random_trains.train(seed)))
    cargo = os.environ.get("CARGO", "cargo")
    command = [cargo, "run", "--quiet", "--package", "xtask", "--", "fmu", *map(str, files), "--out", str(folder)]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    return lambda name: (fmus if name in MODELS else folder) / f"{name}.fmu"


@functools.cache
def expected(case):
    """The system and all outputs by the reference."""
    name, stop, parameters = CASES[case]
    source = MODELS[name] if name in MODELS else random_trains.train(int(name.removeprefix("train")))
    system = reference.System(apply(reference.load(source), parameters))
    # 1e-9: the reference agrees with itself at 1e-11 to better than 1e-5 of the alternating part.
    return system, reference.simulate(system, stop, np.arange(round(stop / STEP) + 1) * STEP, rtol=1e-9)


def apply(model, parameters):
    for path, value in parameters.items():
        owner, *rest = path.split(".")
        if owner == "gearbox_vibration":
            model[owner][rest[0]] = value
        else:
            rotor = next(rotor for rotor in model["rotor"] if rotor["name"] == owner)
            next(u for u in rotor["unbalance"] if u["name"] == rest[0])[rest[1]] = value
    return model


def is_output(key):
    return "." in key


@functools.cache
def found(fmu, case):
    """The same outputs, and the frequencies, by the FMU."""
    system, exact = expected(case)
    _, stop, parameters = CASES[case]
    names = [*filter(is_output, exact), *listed_frequencies(system)]
    return simulate(fmu, stop_time=stop, output_interval=STEP, output=names, start_values={"simulation.tolerance": 1e-5, **parameters})


def listed_frequencies(system):
    """Uncoupled frequencies with the names of the FMU's variables."""
    return {f"{rotor}.{kind}_frequency[{index + 1}]": value for rotor, kinds in reference.frequencies(system).items()
            for kind, values in kinds.items() for index, value in enumerate(values)}


@pytest.mark.parametrize("case", CASES)
def test_uncoupled_frequencies(packed, case):
    result = found(packed(CASES[case][0]), case)
    for variable, value in listed_frequencies(expected(case)[0]).items():
        # 1e-7: the reference's eigenvalue solver loses digits of soft modes among stiff ones; the issue asks for 1e-5.
        assert abs(result[variable][0] / value - 1) < 1e-7, variable


# Scales below these are rounding: of what no force reaches, or does not turn against its rotor [N, N m, m, m/s, m/s^2, rad]; and of
# the speed of a rotor that nothing drives, for the reference's own tolerance [rad/s].
ROUNDING = dict(force=1e-3, mesh_torque=1e-3, displacement=1e-10, velocity=1e-7, acceleration=1e-3, deflection=1e-10, theta=1e-7, angle=1e-7, speed=1e-2, stiffness=1.0)


def family(key):
    """Outputs of one kind are measured by a common scale."""
    motions = {end: name for name, ends in dict(displacement="x y", velocity="vx vy", acceleration="ax ay").items() for end in ends.split()}
    return motions.get(last := key.rsplit(".", 1)[-1], last.removesuffix("_x").removesuffix("_y"))


def scales(exact, size):
    scale = dict(ROUNDING)
    for key in filter(is_output, exact):
        scale[family(key)] = max(scale[family(key)], size(exact[key]))
    return scale


@pytest.mark.parametrize("case", CASES)
def test_start(packed, case):
    """Every output at time 0: static forces and deflections, speeds."""
    exact, result = expected(case)[1], found(packed(CASES[case][0]), case)
    scale = scales(exact, lambda series: abs(series[0]))
    for key in filter(is_output, exact):
        # 1e-7: linear algebra with a condition number of some 1e7; the issue asks for 1e-6.
        assert abs(result[key][0] - exact[key][0]) < 1e-7 * scale[family(key)], key


def alternating_errors(exact, result):
    """RMS error of every output relative to its own alternating part; of what hardly moves, to 1 % of what moves most."""
    scale = scales(exact, np.std)
    return {key: np.sqrt(np.mean((result[key] - exact[key]) ** 2)) / max(np.std(exact[key]), 1e-2 * scale[family(key)])
            for key in filter(is_output, exact) if family(key) != "stiffness"}


@pytest.mark.parametrize("case", CASES)
def test_transient(packed, case):
    """Every output, at every communication point."""
    errors = alternating_errors(expected(case)[1], found(packed(CASES[case][0]), case))
    worst = max(errors, key=errors.get)
    # 1e-3: the bound for mesh and bearing forces, here for every output.
    assert errors[worst] < 1e-3, f"{worst}: {errors[worst]:.2e}"


@pytest.mark.parametrize("name, drive, values", [
    ("coast_down", "input.drag", (60.0, -40.0)),
    ("rattle", "pinion.drive", (-60.0, 60.0)),
])
def test_torque_reversal(packed, tmp_path, name, drive, values):
    """The torque of the drive turns round in the middle of the run: the teeth change flanks."""
    stop, count = 0.01, 500
    times = np.arange(count + 1) * stop / count
    torque = {drive: lambda t: values[int(t >= stop / 2)]}
    exact = reference.simulate(MODELS[name], stop, times, rtol=1e-9, torques=torque, knots=[stop / 2])
    keys = list(filter(is_output, exact))
    rows = driven(packed(name), tmp_path, keys, times, f"{drive}.torque", torque[drive])
    errors = alternating_errors(exact, dict(zip(keys, np.array(rows).T)))
    worst = max(errors, key=errors.get)
    assert errors[worst] < 1e-3, f"{worst}: {errors[worst]:.2e}"
    force = exact["mesh.force"]
    assert force.max() > 0.0 > force.min()


def driven(fmu, folder, keys, times, variable, value):
    """Outputs of the FMU at `times` with one input set at the beginning of every step."""
    description = fmpy.read_model_description(str(fmu))
    reference_of = {v.name: v.valueReference for v in description.modelVariables}
    slave = FMU2Slave(guid=description.guid, unzipDirectory=fmpy.extract(str(fmu), unzipdir=str(folder)), instanceName="one",
                      modelIdentifier=description.coSimulation.modelIdentifier)
    slave.instantiate()
    slave.setupExperiment(startTime=0.0, tolerance=1e-5)
    slave.enterInitializationMode()
    slave.setReal([reference_of[variable]], [value(0.0)])
    slave.exitInitializationMode()
    outputs = [reference_of[key] for key in keys]
    rows = [slave.getReal(outputs)]
    for begin, end in zip(times, times[1:]):
        slave.setReal([reference_of[variable]], [value(begin)])
        slave.doStep(begin, end - begin)
        rows.append(slave.getReal(outputs))
    slave.terminate()
    slave.freeInstance()
    return rows


@pytest.mark.parametrize("name", MODELS)
def test_coupled_frequencies(name):
    """Those that `inspect` prints, damping ratios included, from the eigenvalues of the same matrices."""
    cargo = os.environ.get("CARGO", "cargo")
    command = [cargo, "run", "--quiet", "--package", "xtask", "--", "inspect", str(MODELS[name]), "--format", "json"]
    printed = json.loads(subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=True).stdout)
    listed = sorted((mode["frequency_hz"], mode["damping_ratio"]) for mode in printed["coupled"] if mode["damping_ratio"] < 0.999)
    exact = sorted((mode["frequency_hz"], mode["damping_ratio"]) for mode in reference.coupled(MODELS[name]))
    assert len(listed) > 0
    for frequency, damping in listed:
        # 1e-6: eigenvalues of unsymmetric matrices; the issue asks for 1e-5.
        assert any(abs(f / frequency - 1) < 1e-6 and abs(z - damping) < 1e-6 for f, z in exact), (frequency, damping)


def test_the_random_trains_are_what_they_are():
    """The same seed gives the same file, on every machine and in every process; and TOML is what was written."""
    for seed in SEEDS:
        model = random_trains.train(seed)
        text = random_trains.toml_text(model)
        assert text == random_trains.toml_text(random_trains.train(seed))
        assert reference.load(tomllib.loads(text)) == reference.load(model)


def test_the_features_of_the_random_trains():
    """One of each at least: a list to read, and a guard against seeds that lose them."""
    trains = [random_trains.train(seed) for seed in SEEDS]
    meshes = [mesh for model in trains for mesh in model["mesh"]]
    bearings = [b for model in trains for rotor in model["rotor"] for b in rotor["bearing"]]
    assert {mesh["stiffness"]["law"] for mesh in meshes} == {"constant", "rectangular", "tooth_pair", "fourier", "table"}
    assert {b["nonlinear"]["law"] for b in bearings if "nonlinear" in b} == {"clearance", "cubic", "hertz"}
    assert {(model["simulation"]["speed"], model["simulation"]["start"]) for model in trains} == {
        (speed, start) for speed in ("prescribed", "free") for start in ("equilibrium", "rest")}
    for feature in ("internal", "backlash", "transmission_error", "torque_coupling", "damping"):
        assert any(mesh.get(feature) for mesh in meshes), feature
    for feature in ("bow", "basis_support", "probe", "disk", "unbalance", "angle"):
        assert any(feature in rotor for model in trains for rotor in model["rotor"]), feature
    assert any("at_speed" in b for b in bearings)
