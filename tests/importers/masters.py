"""Masters that run in a process of their own: they log to its output, where their complaints are found."""

import re
import subprocess
import sys
from pathlib import Path

LIBCOSIM = """
from libcosimpy.CosimExecution import CosimExecution
from libcosimpy.CosimObserver import CosimObserver
from libcosimpy.CosimSlave import CosimLocalSlave
"""
ECOS = """
from ecospy import EcosLib, EcosSimulation, EcosSimulationStructure
EcosLib.set_log_level("debug")
"""


def libcosim(script, **names):
    """What a script prints behind the word "value"."""
    return _values(LIBCOSIM, script, names)


def ecos(script, **names):
    """As `libcosim`. Ecos returns success whatever a slave answers: only its log tells."""
    import importlib.util
    package = Path(importlib.util.find_spec("ecospy").origin).parent
    for program in ("ecos", "proxyfmu"):                   # the wheel brings them without the permission to run
        (package / "binaries" / program).chmod(0o755)
    return _values(ECOS, script, names)


def _values(imports, script, names):
    setting = "".join(f"{name} = {value!r}\n" for name, value in names.items())
    done = subprocess.run([sys.executable, "-c", imports + setting + script], capture_output=True, text=True)
    said = done.stdout + done.stderr
    assert done.returncode == 0, said
    complaints = [line for line in said.splitlines() if re.search(r"\[(warn|err|crit|fatal)|fmi2(Warning|Discard|Error|Fatal)", line)]
    assert not complaints, complaints
    return [float(word) for word in re.findall(r"^value (.*)$", said, re.MULTILINE)]
