"""The packed FMUs in FMPy, as a user runs them."""

import os
import shutil
import subprocess
import sys
import zipfile
from pathlib import Path

import fmpy
import numpy as np
import pytest
import reference
from conftest import ROOT, simulate
from fmpy.fmi2 import FMU2Slave
from fmpy.validation import validate_fmu


def test_validation_is_silent(fmus):
    packed = sorted(fmus.glob("*.fmu"))
    assert len(packed) > 10
    assert {fmu.name: validate_fmu(str(fmu)) for fmu in packed} == {fmu.name: [] for fmu in packed}


def test_command_line_runs_it_as_a_user_would(three_stage, tmp_path):
    output = tmp_path / "out.csv"
    command = [sys.executable, "-m", "fmpy", "simulate", three_stage, "--stop-time", "0.01", "--output-file", str(output)]
    done = subprocess.run(command, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    header = output.read_text().splitlines()[0]
    assert "mesh12.force" in header


def test_the_documents_a_person_looks_for_are_inside(three_stage):
    with zipfile.ZipFile(three_stage) as archive:
        names = set(archive.namelist())
        page = archive.read("documentation/index.html").decode()
        source = archive.read("documentation/model.toml").decode()
    assert {"modelDescription.xml", "binaries/linux64/three_stage.so", "documentation/licenses/license.txt"} <= names
    assert source == (ROOT / "examples/three_stage.toml").read_text()
    for variable in fmpy.read_model_description(three_stage).modelVariables:
        assert f"<td>{variable.name}</td>" in page, variable.name


def test_the_icon_is_a_picture_and_numbers_come_with_their_size(three_stage):
    with zipfile.ZipFile(three_stage) as archive:
        icon = archive.read("model.png")
    assert icon.startswith(b"\x89PNG\r\n\x1a\n") and len(icon) < 8000
    variables = {variable.name: variable for variable in fmpy.read_model_description(three_stage).modelVariables}
    assert float(variables["mesh12.force"].nominal) == 1e4
    assert float(variables["stage1.b1.stiffness.xx"].min) == 0.0
    # An input is of the size that it is described with.
    assert float(variables["stage1.drive.torque"].nominal) == 2e3


def test_the_reader_of_model_files_stays_out_of_the_library(three_stage):
    with zipfile.ZipFile(three_stage) as archive:
        library = archive.read("binaries/linux64/three_stage.so")
    for words in [b"unknown key; known here", b"the parentheses do not match", b"exchange rates are not available", b"not valid TOML"]:
        assert words not in library


def test_the_file_says_nothing_about_where_and_when_it_was_packed(three_stage):
    with zipfile.ZipFile(three_stage) as packed:
        dates = {entry.date_time for entry in packed.infolist()}
        library = packed.read("binaries/linux64/three_stage.so")
    assert dates == {(1980, 1, 1, 0, 0, 0)}
    # Places in source files stand in the library for panics: they begin at the package or the registry.
    crates = os.environ.get("CARGO_HOME", Path.home() / ".cargo")
    for folder in ROOT, crates:
        assert str(folder).encode() not in library
    assert b"/crates/nalgebra-" in library


def test_committed_model_description_is_up_to_date(three_stage):
    with zipfile.ZipFile(three_stage) as archive:
        inside = archive.read("modelDescription.xml").decode()
    committed = (ROOT / "modelDescription/modelDescription.xml").read_text()
    assert inside == committed, "run `cargo xtask golden`, review the diff and commit it"


def test_every_variable_has_a_description_and_a_defined_unit(three_stage):
    description = fmpy.read_model_description(three_stage)
    units = {unit.name for unit in description.unitDefinitions}
    for variable in description.modelVariables:
        assert variable.description, variable.name
        assert variable.unit is None or variable.unit in units, variable.name


def test_two_runs_give_the_same_bits(three_stage):
    one, two = (simulate(three_stage, stop_time=0.01) for _ in range(2))
    assert one.tobytes() == two.tobytes()


def test_static_mesh_force_is_the_torque_over_the_base_radius(three_stage):
    """10 474 N: with the mean stiffness, that is, before the teeth begin to pass."""
    result = simulate(three_stage, stop_time=2e-5, output=["mesh12.deflection", "mesh13.deflection"])
    mean_stiffness = 661941964.2857143
    for mesh in ["mesh12", "mesh13"]:
        force = result[f"{mesh}.deflection"][0] * mean_stiffness
        assert abs(force / (1125.0 / 0.1074069) - 1) < 1e-9


def housing_motion(frequency=1200.0, amplitude=25e-6, rate=50e3, stop=0.02):
    """A gearbox vibration at every bearing as FMPy's input array."""
    bearings = [f"stage{s}.b{b}" for s, count in [(1, 3), (2, 3), (3, 2)] for b in range(1, count + 1)]
    time = np.arange(0.0, stop + 0.5 / rate, 1 / rate)
    omega = 2 * np.pi * frequency
    columns = {"time": time}
    for bearing in bearings:
        columns[f"{bearing}.housing.x"] = amplitude * np.sin(omega * time)
        columns[f"{bearing}.housing.y"] = amplitude * np.sin(omega * time + np.pi / 2)
        columns[f"{bearing}.housing.vx"] = amplitude * omega * np.cos(omega * time)
        columns[f"{bearing}.housing.vy"] = amplitude * omega * np.cos(omega * time + np.pi / 2)
    return np.rec.fromarrays(list(columns.values()), names=list(columns))


def alternating_error(found, exact):
    """RMS of the difference relative to the RMS of the alternating part."""
    return np.sqrt(np.mean((found - exact) ** 2)) / np.std(exact)


@pytest.mark.parametrize("step, rows_per_step", [(2e-5, 1), (5e-6, 1), (5e-6, 0.25)])
def test_gearbox_vibration_from_a_csv_file_is_seen_with_the_delay_of_held_inputs(
        three_stage, tmp_path, step, rows_per_step):
    """1200 Hz against the reference with continuous motion. FMPy sets the inputs of a step's start and reads
    the outputs at its end: the bearing force, K u_b for the most part, lags by a step, 2 pi 1200 h; the mesh
    force follows the motion itself, which lags by half a step. Between the rows of a coarser table FMPy
    interpolates linearly: at 20 us that adds (w dt)^2 / 8 = 0.3 %."""
    table = housing_motion(rate=rows_per_step / step)
    file = tmp_path / "gearbox motion.csv"
    names = table.dtype.names
    header = ",".join(f'"{name}"' for name in names)
    np.savetxt(file, np.column_stack([table[name] for name in names]), delimiter=",", comments="", header=header)
    signals = fmpy.util.read_csv(str(file))
    driven = simulate(three_stage, input=signals, stop_time=0.02, output_interval=step,
                      output=["mesh12.force", "stage1.b1.force_x"])

    def motion(time):
        angle = 2 * np.pi * 1200.0 * time
        speed = 25e-6 * 2 * np.pi * 1200.0
        return 25e-6 * np.sin(angle), 25e-6 * np.cos(angle), speed * np.cos(angle), -speed * np.sin(angle)

    model = reference.load(ROOT / "examples/three_stage.toml")
    bearings = {name.removesuffix(".housing.x") for name in names if name.endswith(".housing.x")}
    base_motion = dict.fromkeys(bearings, motion)
    exact = reference.simulate(model, 0.02, np.arange(len(driven)) * step, base_motion=base_motion)
    lag = 2 * np.pi * 1200.0 * step
    for name, bound in [("stage1.b1.force_x", 1.2 * lag), ("mesh12.force", 0.6 * lag)]:
        error = alternating_error(driven[name], exact[name])
        assert 0.0 < error < bound, f"{name}: {error:.2e}, lag {lag:.2e}"


def test_parameters_set_by_the_master_act(three_stage):
    names = ["mesh12.stiffness", "stage1.speed", "stage2.speed", "stage1.lateral_frequency[1]"]
    changed = {"mesh12.stiffness_factor": 2.0, "stage1.mean_speed": 100.0, "stage1.b3.stiffness.xx": 4e7}
    plain = simulate(three_stage, stop_time=1e-4, output=names)
    result = simulate(three_stage, stop_time=1e-4, output=names, start_values=changed)
    assert result["mesh12.stiffness"][0] == 2 * plain["mesh12.stiffness"][0]
    assert (result["stage1.speed"][0], result["stage2.speed"][0]) == (100.0, -100.0)
    assert result["stage1.lateral_frequency[1]"][0] > plain["stage1.lateral_frequency[1]"][0]


def slave(fmu, folder, name="one"):
    """An instance in initialization mode, with its variables by name."""
    description = fmpy.read_model_description(fmu)
    # Unpacking over a library that is loaded would pull the rug from under it.
    directory = str(folder) if folder.exists() else fmpy.extract(fmu, unzipdir=str(folder))
    fmu_slave = FMU2Slave(guid=description.guid, unzipDirectory=directory, instanceName=name,
                          modelIdentifier=description.coSimulation.modelIdentifier)
    fmu_slave.instantiate()
    fmu_slave.setupExperiment(startTime=0.0)
    fmu_slave.enterInitializationMode()
    return fmu_slave, {variable.name: variable.valueReference for variable in description.modelVariables}


def test_two_instances_do_not_see_each_other(three_stage, tmp_path):
    def forces(instances):
        """Mesh force of the first instance while all of them step in turn."""
        for instance, _ in instances:
            instance.exitInitializationMode()
        series = []
        for index in range(50):
            for instance, _ in instances:
                instance.doStep(index * 2e-5, 2e-5)
            first, names = instances[0]
            series.append(first.getReal([names["mesh12.force"]])[0])
        for instance, _ in instances:
            instance.terminate()
            instance.freeInstance()
        return series

    alone = forces([slave(three_stage, tmp_path / "fmu")])
    one, two = slave(three_stage, tmp_path / "fmu"), slave(three_stage, tmp_path / "fmu", "two")
    two[0].setReal([two[1]["stage1.drive.torque"]], [0.0])
    assert forces([one, two]) == alone


def test_a_path_with_spaces_and_letters_of_other_alphabets_works(three_stage, tmp_path):
    folder = tmp_path / "ein Ordner mit Umlauten äöü und шестерня"
    folder.mkdir()
    copy = folder / "drei Stufen.fmu"
    shutil.copy(three_stage, copy)
    simulate(copy, stop_time=1e-3)
    instance, names = slave(str(copy), folder / "entpackt hier")
    instance.exitInitializationMode()
    instance.doStep(0.0, 1e-5)
    assert instance.getReal([names["stage1.angle"]]) == [314.1592653589793 * 1e-5]
    instance.freeInstance()


def test_outputs_react_to_inputs_without_a_step(three_stage, tmp_path):
    instance, names = slave(three_stage, tmp_path / "fmu")
    instance.exitInitializationMode()
    force, motion, velocity = (names[f"stage1.b1.{end}"] for end in ("force_x", "housing.x", "housing.vx"))
    before = instance.getReal([force])[0]
    instance.setReal([motion, velocity], [1e-6, 1e-3])
    # Force on the gearbox = K (u - u_b) + C (u' - u_b') with 1e8 N/m and 2000 N s/m.
    change = instance.getReal([force])[0] - before
    assert abs(change + 1e8 * 1e-6 + 2000.0 * 1e-3) < 1e-9
    instance.freeInstance()


def test_input_derivatives_take_the_delay_away(three_stage, tmp_path):
    """The same vibration in x from inputs with derivatives and from the parameters of the FMU, which the solver
    takes exactly: a chord misses a sine by (w h)^2 / 12 = 1.9e-3 at 1200 Hz and 20 us, of which the bearing force
    is the difference to the shaft's motion: three times as much; held inputs lag by 0.15.
    (FMPy's own set_input_derivatives has room for exactly nine inputs.)"""
    step, outputs = 2e-5, ["mesh12.force", "stage1.b1.force_x"]
    exact = simulate(three_stage, start_values={"gearbox_vibration.amplitude_x": 25e-6}, stop_time=0.02,
                     output_interval=step, output=outputs)
    table = housing_motion(rate=1 / step)
    inputs = [name for name in table.dtype.names if name.endswith((".x", ".vx"))]
    motion = np.column_stack([table[name] for name in inputs])
    instance, names = slave(three_stage, tmp_path / "fmu")
    instance.exitInitializationMode()
    references = [names[name] for name in inputs]
    driven = [instance.getReal([names[name] for name in outputs])]
    for index, (now, then) in enumerate(zip(motion[:-1], motion[1:])):
        instance.setReal(references, list(now))
        instance.setRealInputDerivatives(references, [1] * len(references), list((then - now) / step))
        instance.doStep(index * step, step)
        driven.append(instance.getReal([names[name] for name in outputs]))
    instance.freeInstance()
    for name, found, bound in zip(outputs, np.transpose(driven), [3e-3, 1e-2]):
        error = alternating_error(found, exact[name])
        assert error < bound, f"{name}: {error:.2e}"


def test_reset_is_as_if_new(three_stage, tmp_path):
    instance, names = slave(three_stage, tmp_path / "fmu")
    forces = [names["mesh12.force"], names["stage3.b1.force_y"]]

    def run():
        instance.exitInitializationMode()
        for index in range(20):
            instance.doStep(index * 2e-5, 2e-5)
        return instance.getReal(forces)

    first = run()
    instance.reset()
    instance.setReal([names["stage1.gear_unbalance.moment"]], [1.0])
    instance.reset()
    instance.setupExperiment(startTime=0.0)
    instance.enterInitializationMode()
    assert run() == first
    instance.freeInstance()


GO_ON = """
import sys
from pathlib import Path
from test_fmpy import forces_from, slave

fmu, folder, state = sys.argv[1:]
instance, names = slave(fmu, Path(folder))
instance.setFMUstate(instance.deSerializeFMUstate(Path(state).read_bytes()))
print(*map(float.hex, forces_from(instance, names, 20)))
"""


def forces_from(instance, names, first):
    """Forces after ten more steps."""
    for index in range(first, first + 10):
        instance.doStep(index * 2e-5, 2e-5)
    return instance.getReal([names["mesh12.force"], names["stage3.b1.force_y"]])


def test_a_state_goes_on_in_another_process(three_stage, tmp_path):
    instance, names = slave(three_stage, tmp_path / "fmu")
    instance.exitInitializationMode()
    for index in range(20):
        instance.doStep(index * 2e-5, 2e-5)
    state = tmp_path / "state"
    state.write_bytes(instance.serializeFMUstate(instance.getFMUstate()))
    forces = forces_from(instance, names, 20)
    instance.freeInstance()
    done = subprocess.run([sys.executable, "-c", GO_ON, three_stage, str(tmp_path / "other"), str(state)],
                          cwd=ROOT / "tests/importers", capture_output=True, text=True)
    assert done.stdout.split() == [force.hex() for force in forces], done.stderr


def test_many_simulations_in_one_process(three_stage):
    """FMPy unpacks and loads anew each time."""
    results = {simulate(three_stage, stop_time=1e-4).tobytes() for _ in range(100)}
    assert len(results) == 1
