"""The scripts in examples/ run, and say what they should."""

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


def test_a_gearbox_closes_the_loop(three_stage):
    """10 kg on a 400 Hz spring carries static bearing forces of some 10 kN: F / (m w^2) is 0.1 to 1 mm."""
    said = run("couple_gearbox.py", three_stage)
    largest = float(re.search(r"([\d.]+) um", said).group(1))
    assert 1e2 < largest < 2e3, said


def test_the_demonstration_writes_its_tables_and_pictures(three_stage, tmp_path):
    pytest.importorskip("matplotlib")
    said = run("paper_cases.py", three_stage, tmp_path)
    assert len(list(tmp_path.glob("case_?.csv"))) == 4
    pictures = sorted(path.name for path in tmp_path.glob("*.png"))
    assert len(pictures) == 5, pictures
    # The paper: "the major component is the dc component ... the other sizable one is at 1800 Hz".
    line = next(line for line in said.splitlines() if line.startswith("mesh12.force"))
    mean, amplitude, frequency = re.match(r"mesh12.force\s+([\d.]+)\s+([\d.]+) @ (\d+)", line).groups()
    assert (float(mean), int(frequency)) == (10.5, 1800) and 1.0 < float(amplitude) < 4.0
