"""What c/run.c does, by FMPy from the packed file: run.py FMU GUID NANOSECONDS STEPS INPUTS READS OUT."""

import shutil
import sys
from array import array

import fmpy
from fmpy.fmi2 import FMU2Slave
from fmpy.validation import validate_fmu

EVERY, TWICE = 16, 20

path, guid, nanoseconds, steps, inputs, reads, out = sys.argv[1:]
step, steps = int(nanoseconds) / 1e9, int(steps)
inputs = [int(reference) for reference in inputs.split(",") if reference]
reads = [int(reference) for reference in reads.split(",")]

assert validate_fmu(path) == [], "FMPy finds problems"
folder = fmpy.extract(path)
description = fmpy.read_model_description(folder)
assert description.guid == guid
slave = FMU2Slave(
    guid=guid,
    unzipDirectory=folder,
    modelIdentifier=description.coSimulation.modelIdentifier,
    instanceName="run",
)


def do_step(number):
    values = [(number * (place + 1) % 64 - 32) / 32.0 / 1e6 for place in range(len(inputs))]
    slave.setReal(inputs, values)
    slave.doStep(number * step, step)


def repeat_from_saved_state(number, results):
    saved = slave.getFMUstate()
    state = slave.serializeFMUstate(saved)
    results.write(state)
    ends = []
    for _ in range(2):
        restored = slave.deSerializeFMUstate(state)
        slave.setFMUstate(restored)
        for following in range(number, number + TWICE):
            do_step(following)
        ends.append(slave.getReal(reads))
        slave.setFMUstate(restored)
        slave.freeFMUstate(restored)
    assert ends[0] == ends[1], "a restored state does not continue as the slave did"
    slave.freeFMUstate(saved)


slave.instantiate()
slave.setupExperiment()
slave.enterInitializationMode()
slave.exitInitializationMode()
with open(out, "wb") as results:
    for number in range(steps):
        if number == steps // 2:
            repeat_from_saved_state(number, results)
        do_step(number)
        if number % EVERY == 0 or number == steps - 1:
            array("d", slave.getReal(reads)).tofile(results)
slave.terminate()
slave.freeInstance()
shutil.rmtree(folder)
