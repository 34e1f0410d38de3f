"""Couple the gear train to a gearbox structure of your own, step by step, with FMPy.

    python examples/couple_gearbox.py target/fmu/three_stage.fmu

Here the gearbox is as simple as can be: 10 kg on a spring (400 Hz, 2 % damping) at every bearing, in x and y. Replace
`Gearbox` by your structure or another FMU: it takes bearing forces and gives displacement and velocity.
"""

import sys
import tempfile

import fmpy
import numpy as np
from fmpy.fmi2 import FMU2Slave

STEP, STOP = 1e-5, 0.05


class Gearbox:
    """Independent masses on springs, one per direction of each bearing; integrated exactly for held forces."""

    def __init__(self, directions: int, mass=10.0, frequency=400.0, damping=0.02):
        omega = 2 * np.pi * frequency
        self.mass, self.omega, self.decay = mass, omega, damping * omega
        self.damped = omega * np.sqrt(1 - damping**2)
        self.displacement, self.velocity = np.zeros(directions), np.zeros(directions)

    def step(self, forces, h):
        static = np.asarray(forces) / (self.mass * self.omega**2)
        offset, decay, damped = self.displacement - static, self.decay, self.damped
        sine, cosine, fade = np.sin(damped * h), np.cos(damped * h), np.exp(-decay * h)
        swing = (self.velocity + decay * offset) / damped
        self.displacement = static + fade * (offset * cosine + swing * sine)
        self.velocity = fade * (self.velocity * cosine - (decay * swing + damped * offset) * sine)


def main(fmu: str) -> float:
    description = fmpy.read_model_description(fmu)
    variables = {variable.name: variable.valueReference for variable in description.modelVariables}
    bearings = [name.removesuffix(".housing.x") for name in variables if name.endswith(".housing.x")]
    inputs = [variables[f"{bearing}.housing.{end}"] for end in ("x", "y", "vx", "vy") for bearing in bearings]
    forces = [variables[f"{bearing}.{end}"] for end in ("force_x", "force_y") for bearing in bearings]

    train = FMU2Slave(guid=description.guid, unzipDirectory=fmpy.extract(fmu, tempfile.mkdtemp()),
                      modelIdentifier=description.coSimulation.modelIdentifier, instanceName="train")
    train.instantiate()
    train.setupExperiment(startTime=0.0)
    train.enterInitializationMode()
    train.exitInitializationMode()

    gearbox = Gearbox(directions=2 * len(bearings))
    largest = 0.0
    for index in range(round(STOP / STEP)):
        # Forces react to the gearbox motion just set; no step is needed in between.
        train.setReal(inputs, [*gearbox.displacement, *gearbox.velocity])
        gearbox.step(train.getReal(forces), STEP)
        train.doStep(currentCommunicationPoint=index * STEP, communicationStepSize=STEP)
        largest = max(largest, np.abs(gearbox.displacement).max())
    train.terminate()
    train.freeInstance()
    print(f"largest gearbox displacement in {STOP} s: {1e6 * largest:.1f} um")
    return largest


if __name__ == "__main__":
    main(sys.argv[1])
