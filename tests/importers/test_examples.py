"""The scripts in examples/ run, and say what they should."""

import csv
import math
import os
import re
import subprocess
import sys

import pytest
from conftest import ROOT


def run(script, *arguments):
    command = [sys.executable, "-W", "error", str(ROOT / "examples" / script), *map(str, arguments)]
    done = subprocess.run(command, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    return done.stdout


def test_a_train_and_its_gearbox_close_the_loop_in_four_ways(three_stage_pair, tmp_path):
    pytest.importorskip("matplotlib")
    said = run("couple.py", three_stage_pair, "--stop", 0.004, "--output", tmp_path)
    found = {name: [float(word) for word in re.findall(r"(\d+\.\d+)", line)]
             for name, line in re.findall(r"^(held inputs|input derivatives|two iterations|held, continued) *: (.*)$", said, re.MULTILINE)}
    # Bearing force, mesh force, acceleration in %: held inputs are the worst, derivatives the second worst.
    assert len(found) == 4, said
    for worse, better in (("held inputs", "input derivatives"), ("input derivatives", "two iterations"),
                          ("input derivatives", "held, continued")):
        assert all(small < large for small, large in zip(found[better], found[worse])), said
    assert (tmp_path / "couple.png").exists()


@pytest.fixture(scope="session")
def inspection(tmp_path_factory):
    """What inspect says of the example, as JSON."""
    model = ROOT / "examples/three_stage.toml"
    command = [os.environ.get("CARGO", "cargo"), "run", "--quiet", "--package", "xtask", "--", "inspect", model]
    done = subprocess.run([*command, "--format", "json"], cwd=ROOT, capture_output=True, text=True, check=True)
    file = tmp_path_factory.mktemp("inspection") / "inspection.json"
    file.write_text(done.stdout)
    return file


def test_the_demonstration_writes_the_papers_table_and_figures(three_stage, inspection, tmp_path):
    pytest.importorskip("matplotlib")
    said = run("paper_cases.py", three_stage, inspection, tmp_path)
    assert len(list(tmp_path.glob("case_?.csv"))) == 4
    figures = sorted(int(path.name[7:9]) for path in tmp_path.glob("figure_*.png"))
    assert figures == list(range(3, 17)), figures
    with open(tmp_path / "table_1.csv", newline="") as file:
        deviations = [abs(float(row["deviation_percent"])) for row in csv.DictReader(file)]
    # 0.5 %: the table is rounded to 1 Hz; the model is fitted to 0.3 %.
    assert len(deviations) == 12 and max(deviations) < 0.5
    # The paper: "the major component is the dc component ... the other sizable one is at 1800 Hz".
    line = next(line for line in said.splitlines() if line.startswith("mesh12.force"))
    mean, amplitude, frequency = re.match(r"mesh12.force\s+([\d.]+)\s+([\d.]+) @ (\d+)", line).groups()
    assert (float(mean), int(frequency)) == (10.5, 1800) and 1.0 < float(amplitude) < 4.0


def test_any_fmu_is_simulated_and_drawn(three_stage, tmp_path):
    said = run("simulate_and_plot.py", three_stage, "--set", "gearbox_vibration.amplitude_x=25e-6", "--stop", 0.05, "--output", tmp_path)
    mean = float(re.search(r"mesh12.force: mean (\d+) N", said).group(1))
    # Two meshes share 2250 N m at a base radius of 0.1074069 m. 1 %: the start rings.
    assert abs(mean / (2250 / (2 * 0.1074069)) - 1) < 0.01, said
    assert (tmp_path / "three_stage.png").exists()


def test_a_measured_vibration_shakes_the_bearings(three_stage, tmp_path):
    csv_file = ROOT / "examples/gearbox_vibration.csv"
    assert run("make_vibration.py").splitlines() == csv_file.read_text().splitlines(), "its origin is this script"
    said = run("measured_vibration.py", three_stage, csv_file, "--output", tmp_path)
    still, shaken = map(float, re.search(r"(\d+) N peak to peak at rest, (\d+) N shaken", said).groups())
    assert shaken > 10 * still, said
    assert (tmp_path / "measured_vibration.png").exists()


def test_a_run_up_follows_the_torque(fmus, tmp_path):
    stop = 0.4
    said = run("run_up.py", fmus / "electric_drive.fmu", "--stop", stop, "--output", tmp_path)
    found = float(re.search(r"(\d+) rpm", said).group(1))
    # Seen from the motor: 60 N m against 0.6 N m s/rad and 0.606 kg m2 at the wheel, 0.00608 kg m2 at the motor itself.
    ratio = (23 / 67) ** 2
    slope, inertia = 0.6 * ratio, 0.606 * ratio + 0.00608
    expected = 60 / slope * (1 - math.exp(-slope / inertia * stop)) * 30 / math.pi
    # 1 %: the inertia of the shafts is left out.
    assert abs(found / expected - 1) < 0.01, (found, expected)
    assert (tmp_path / "run_up.png").exists()


def test_a_sweep_runs_on_workers(three_stage, tmp_path):
    said = run("sweep.py", three_stage, "--points", 2, "--stop", 0.1, "--output", tmp_path)
    assert "4 of 4 simulations" in said
    with open(tmp_path / "sweep.csv", newline="") as file:
        sizes = [float(row["peak_to_peak_m"]) for row in csv.DictReader(file)]
    # Soft bearings first, small imbalance first: ten times the imbalance is seen, and stiff bearings hold better.
    assert sizes[1] > 5 * sizes[0] and sizes[3] < sizes[1], sizes
    assert (tmp_path / "sweep.png").exists()
