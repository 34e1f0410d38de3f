"""The packed FMUs in libcosim, alone and two of them in one execution."""

import re
import subprocess
import sys

import numpy as np
from conftest import simulate

SCRIPT = """
import sys
from libcosimpy.CosimExecution import CosimExecution
from libcosimpy.CosimObserver import CosimObserver
from libcosimpy.CosimSlave import CosimLocalSlave

execution = CosimExecution.from_step_size(step_size=20_000)
observer = CosimObserver.create_last_value()
execution.add_observer(observer=observer)
slaves = [execution.add_local_slave(local_slave=CosimLocalSlave(fmu_path=path, instance_name=f"fmu{index}"))
          for index, path in enumerate(sys.argv[1:])]
assert execution.simulate_until(target_time=10_000_000)
variables = {variable.name.decode(): variable.reference for variable in execution.slave_variables(slave_index=slaves[0])}
references = [variables[name] for name in ("mesh12.force", "stage1.b1.force_x")]
print("forces", *observer.last_real_values(slave_index=slaves[0], variable_references=references))
"""


def test_libcosim_runs_it_without_a_complaint_and_with_the_same_result(fmus, three_stage):
    # A process of its own: libcosim logs to its stderr.
    command = [sys.executable, "-c", SCRIPT, three_stage, str(fmus / "reducer.fmu")]
    done = subprocess.run(command, capture_output=True, text=True)
    said = done.stdout + done.stderr
    assert done.returncode == 0, said
    complaints = [line for line in said.splitlines() if re.search(r"\[(warning|error|fatal)", line)]
    assert not complaints, complaints
    forces = [float(word) for word in re.search(r"^forces (.*)$", said, re.MULTILINE).group(1).split()]
    alone = simulate(three_stage, stop_time=0.01, output_interval=2e-5, output=["mesh12.force", "stage1.b1.force_x"])
    # 1e-9: the two masters add up their communication points differently.
    assert np.allclose(forces, [alone["mesh12.force"][-1], alone["stage1.b1.force_x"][-1]], rtol=1e-9)
