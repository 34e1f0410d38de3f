"""Two gear trains of ours on one shaft, and what a master that exchanges all values between steps finds."""

import fmpy
from fmpy.fmi2 import FMU2Slave

STEP = 1e-5
STEPS = 500

# The torque of each mesh is passed on to the other train; the follower's shaft runs in a pilot bearing inside the reducer's.
CONNECTIONS = [
    ("reducer.wheel_shaft.wheel.mesh_torque", "follower.input.coupling.torque"),
    ("follower.input.pinion.mesh_torque", "reducer.wheel_shaft.load.torque"),
    ("reducer.wheel_shaft.right.x", "follower.input.pilot.housing.x"),
    ("reducer.wheel_shaft.right.y", "follower.input.pilot.housing.y"),
]
WATCHED = ["reducer.mesh.force", "follower.mesh.force", "follower.input.pilot.force_x"]


def fmus_of(folder):
    return {name: str(folder / f"{name}.fmu") for name in ("reducer", "follower")}


class Trains:
    """Both trains in initialization mode, values by "component.variable"."""

    def __init__(self, fmus, folder):
        self.slaves, self.references = {}, {}
        for name, fmu in fmus.items():
            description = fmpy.read_model_description(fmu)
            self.references |= {f"{name}.{v.name}": v.valueReference for v in description.modelVariables}
            slave = FMU2Slave(guid=description.guid, unzipDirectory=fmpy.extract(fmu, unzipdir=str(folder / name)),
                              modelIdentifier=description.coSimulation.modelIdentifier, instanceName=name)
            slave.instantiate()
            slave.setupExperiment(startTime=0.0)
            slave.enterInitializationMode()
            self.slaves[name] = slave
        self.running = False

    def initialize(self):
        """Leaves initialization mode, once."""
        if not self.running:
            for slave in self.slaves.values():
                slave.exitInitializationMode()
        self.running = True

    def get(self, name):
        return self.slaves[name.split(".", 1)[0]].getReal([self.references[name]])[0]

    def set(self, name, value):
        self.slaves[name.split(".", 1)[0]].setReal([self.references[name]], [value])

    def exchange(self):
        values = [self.get(source) for source, _ in CONNECTIONS]
        for (_, sink), value in zip(CONNECTIONS, values):
            self.set(sink, value)

    def step(self, index):
        for slave in self.slaves.values():
            slave.doStep(index * STEP, STEP)

    def close(self):
        for slave in self.slaves.values():
            slave.terminate()
            slave.freeInstance()


def run(fmus, folder, initialize, before_the_first=True, at_the_end=False):
    """Watched values after all steps, with outputs passed on before each of them; not `before_the_first` where a master sets
    other values there, and once more `at_the_end` where it reads outputs with the new inputs."""
    trains = Trains(fmus, folder)
    initialize(trains)
    trains.initialize()
    for index in range(STEPS):
        if index or before_the_first:
            trains.exchange()
        trains.step(index)
    if at_the_end:
        trains.exchange()
    values = [trains.get(name) for name in WATCHED]
    trains.close()
    return values
