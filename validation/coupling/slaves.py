"""A gear train and a housing as two FMUs, and as one FMU that holds both: fast access through FMPy.

A folder holds what `cargo xtask couple` writes: TRAIN.fmu, HOUSING.fmu, TRAIN_in_HOUSING.fmu and connections.csv.
"""

import csv
import ctypes
import tempfile
from pathlib import Path

import fmpy
import numpy as np
from fmpy.fmi2 import FMU2Slave


class Block:
    """Some variables of a slave, read or written in one call, in arrays that are made once."""

    def __init__(self, references: list[int]):
        size = len(references)
        self.size = size
        self.references = (ctypes.c_uint * size)(*references)
        self.orders = (ctypes.c_int * size)(*[1] * size)
        self.buffer = (ctypes.c_double * size)()
        self.values = np.frombuffer(self.buffer)


class Slave:
    """An FMU in initialization mode: what it is given (`inputs`), what it answers (`outputs`), in the order of the names."""

    def __init__(self, fmu: Path, inputs: list[str], outputs: list[str], parameters: dict[str, float], tolerance: float):
        description = fmpy.read_model_description(fmu)
        self.references = {variable.name: variable.valueReference for variable in description.modelVariables}
        self.folder = tempfile.TemporaryDirectory()
        self.fmu = FMU2Slave(guid=description.guid, unzipDirectory=fmpy.extract(fmu, self.folder.name),
                             modelIdentifier=description.coSimulation.modelIdentifier, instanceName=description.modelName)
        self.fmu.instantiate()
        self.fmu.setupExperiment(startTime=0.0, tolerance=tolerance)
        # A vibration comes after the equilibrium: it must not push the housing aside beforehand.
        shaking = {variable.name: float(variable.start) for variable in description.modelVariables
                   if variable.name.startswith("gearbox_vibration.amplitude")}
        self.fmu.setReal([self.references[name] for name in shaking], [0.0] * len(shaking))
        self.parameters = {self.references[name]: value for name, value in (shaking | parameters).items()
                           if name in self.references}
        self.fmu.enterInitializationMode()
        self.inputs, self.outputs = self.block(inputs), self.block(outputs)
        self.time, self.state = 0.0, None

    def start(self) -> None:
        """Sets the parameters and leaves initialization mode."""
        self.fmu.setReal(list(self.parameters), list(self.parameters.values()))
        self.fmu.exitInitializationMode()

    def set(self, values: np.ndarray) -> None:
        block = self.inputs
        block.values[:] = values
        self.fmu.fmi2SetReal(self.fmu.component, block.references, block.size, block.buffer)

    def set_rates(self, values: np.ndarray) -> None:
        """How the inputs change per second in the next step."""
        block = self.inputs
        block.values[:] = values
        self.fmu.fmi2SetRealInputDerivatives(self.fmu.component, block.references, block.size, block.orders, block.buffer)

    def block(self, names: list[str]) -> Block:
        return Block([self.references[name] for name in names])

    def get(self, block: Block | None = None) -> np.ndarray:
        """The outputs, or another block of variables."""
        block = block or self.outputs
        self.fmu.fmi2GetReal(self.fmu.component, block.references, block.size, block.buffer)
        return block.values.copy()

    def rates(self, block: Block | None = None) -> np.ndarray:
        """How the outputs, or others, change per second now, with the inputs and their rates as set."""
        block = block or self.outputs
        self.fmu.fmi2GetRealOutputDerivatives(self.fmu.component, block.references, block.size, block.orders, block.buffer)
        return block.values.copy()

    def directional_derivatives(self) -> np.ndarray:
        """How the outputs, by row, react at once to the inputs, by column."""
        outputs, inputs = list(self.outputs.references), list(self.inputs.references)
        return np.array([self.fmu.getDirectionalDerivative(outputs, [one], [1.0]) for one in inputs]).T

    def step(self, length: float) -> None:
        self.fmu.fmi2DoStep(self.fmu.component, self.time, length, 1)
        self.time += length

    def save(self) -> None:
        if self.state is None:
            self.state = self.fmu.getFMUstate()
        else:
            self.fmu.fmi2GetFMUstate(self.fmu.component, ctypes.byref(self.state))
        self.saved_time = self.time

    def restore(self) -> None:
        self.fmu.setFMUstate(self.state)
        self.time = self.saved_time

    def close(self) -> None:
        if self.state is not None:
            self.fmu.freeFMUstate(self.state)
        self.fmu.terminate()
        self.fmu.freeInstance()
        self.folder.cleanup()


class Connections:
    """Who is connected with whom: motion of the housing with the train, forces of the train with the housing."""

    def __init__(self, folder: Path):
        with open(folder / "connections.csv", newline="") as file:
            lines = list(csv.DictReader(file))
        apart = [(line["from"].split(".", 1), line["to"].split(".", 1)) for line in lines]
        motion = [pair for pair in apart if ".housing." in pair[1][1]]
        forces = [pair for pair in apart if ".housing." not in pair[1][1]]
        self.train, self.housing = motion[0][1][0], motion[0][0][0]
        # All displacements before all velocities.
        motion.sort(key=lambda pair: pair[1][1].rsplit(".", 1)[1].startswith("v"))
        self.motion_from, self.motion_to = ([end[1] for end in ends] for ends in zip(*motion))
        self.forces_from, self.forces_to = ([end[1] for end in ends] for ends in zip(*forces))
        self.displacements = len(motion) // 2
        outputs = {name: [variable.name for variable in fmpy.read_model_description(folder / f"{name}.fmu").modelVariables
                          if variable.causality == "output"] for name in (self.train, self.housing)}
        self.meshes = [name for name in outputs[self.train] if name.endswith(".force")]
        points = {name.rsplit(".", 1)[0] for name in self.motion_from}
        self.sensors = [name for name in outputs[self.housing] if name.endswith((".ax", ".ay")) and name[:-3] not in points]


class Pair:
    """Train and housing in step mode, at an equilibrium of both."""

    def __init__(self, folder: Path, parameters: dict[str, float], tolerance: float = 1e-7):
        links = Connections(folder)
        self.train = Slave(folder / f"{links.train}.fmu", links.motion_to, links.forces_from, parameters, tolerance)
        self.housing = Slave(folder / f"{links.housing}.fmu", links.forces_to, links.motion_from, parameters, tolerance)
        self.slaves = (self.train, self.housing)
        self.displacements = links.displacements
        self._find_equilibrium()
        for slave in self.slaves:
            slave.start()
        self.meshes, self.sensors = self.train.block(links.meshes), self.housing.block(links.sensors)

    def _find_equilibrium(self) -> None:
        """Newton's method on the forces: passing values on until they settle diverges where bearings are stiffer than the housing."""
        def answer(forces):
            self.housing.set(forces)
            self.train.set(self.housing.get())
            return self.train.get()

        forces = np.zeros(self.train.outputs.size)
        for _ in range(20):
            found = answer(forces)
            if np.abs(found - forces).max() <= 1e-10 * (1.0 + np.abs(found).max()):
                return
            push = 1e-3 * (1.0 + np.abs(found).max())
            slopes = np.array([answer(forces + push * one) - found for one in np.eye(len(forces))]).T / push
            forces = forces + np.linalg.solve(np.eye(len(forces)) - slopes, found - forces)
        raise RuntimeError("no equilibrium of train and housing found")

    def exchange(self) -> tuple[np.ndarray, np.ndarray]:
        """Motion to the train; then its forces, which react to that motion, to the housing."""
        motion = self.housing.get()
        self.train.set(motion)
        forces = self.train.get()
        self.housing.set(forces)
        return motion, forces

    def step(self, length: float) -> None:
        for slave in self.slaves:
            slave.step(length)

    def mesh_forces(self) -> np.ndarray:
        return self.train.get(self.meshes)

    def accelerations(self) -> np.ndarray:
        return self.housing.get(self.sensors)

    def close(self) -> None:
        for slave in self.slaves:
            slave.close()
