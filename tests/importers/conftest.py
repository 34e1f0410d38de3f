"""Where the packed FMUs are, and how the tests run them through FMPy."""

import os
import subprocess
from pathlib import Path

import fmpy
import pytest

ROOT = Path(__file__).resolve().parents[2]


@pytest.fixture(scope="session")
def fmus() -> Path:
    """The folder with the packed FMUs."""
    folder = os.environ.get("GEARTRAIN_FMUS")
    if not folder:
        pytest.exit("GEARTRAIN_FMUS is not set: run these tests with `cargo xtask test`")
    return Path(folder)


@pytest.fixture(scope="session")
def three_stage(fmus) -> str:
    return str(fmus / "three_stage.fmu")


def couple(train, housing, folder, links=None) -> Path:
    """What `cargo xtask couple` writes of two model files; `links` names points for bearings."""
    command = [os.environ.get("CARGO", "cargo"), "run", "--quiet", "--package", "xtask", "--", "couple", train, housing]
    for bearing, point in (links or {}).items():
        command += ["--connect", f"{bearing}={point}"]
    done = subprocess.run([*command, "--out", str(folder)], cwd=ROOT, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    return Path(folder)


@pytest.fixture(scope="session")
def three_stage_pair(tmp_path_factory) -> Path:
    """The folder of the three-stage train and its housing, ready to be coupled."""
    return couple("examples/three_stage.toml", "examples/gearbox_housing.toml", tmp_path_factory.mktemp("pair"))


def simulate(fmu, **options):
    """FMPy's simulation with the file's communication step and every logger message as a failure."""
    messages = []

    def logger(environment, instance, status, category, message):
        if status != 0:
            messages.append(message.decode())

    result = fmpy.simulate_fmu(str(fmu), logger=logger, **options)
    assert not messages, messages
    return result
