"""Couple a gear train with its gearbox, FMU by FMU, in four ways with FMPy, and compare each with both in one FMU.

    cargo xtask couple examples/three_stage.toml examples/gearbox_housing.toml
    python examples/couple.py target/couple/three_stage_in_gearbox_housing

The folder holds the FMUs of the train, of the housing and of the train in the housing, connections.csv (what is connected with
what), and a copy of this script, which needs no argument there. Which way stands which step, and how exact each is: docs/coupling.md.
"""

import argparse
import csv
import tempfile
from pathlib import Path

import fmpy
import matplotlib
import numpy as np
from fmpy.fmi2 import FMU2Slave

matplotlib.use("Agg")  # draws into files, needs no screen
import matplotlib.pyplot as plt  # noqa: E402


class Component:
    """An FMU in initialization mode; variables by name."""

    def __init__(self, fmu: Path):
        description = fmpy.read_model_description(fmu)
        self.references = {variable.name: variable.valueReference for variable in description.modelVariables}
        self.outputs = [variable.name for variable in description.modelVariables if variable.causality == "output"]
        self.slave = FMU2Slave(guid=description.guid, unzipDirectory=fmpy.extract(fmu, tempfile.mkdtemp()),
                               modelIdentifier=description.coSimulation.modelIdentifier, instanceName=description.modelName)
        self.slave.instantiate()
        self.slave.setupExperiment(startTime=0.0)
        self.slave.enterInitializationMode()

    def set_parameters(self, values: dict[str, float]) -> None:
        """Those that it has: only a housing knows bearings."""
        own = [name for name in values if name in self.references]
        self.slave.setReal(self.find(own), [values[name] for name in own])

    def find(self, names: list[str]) -> list[int]:
        return [self.references[name] for name in names]

    def close(self) -> None:
        self.slave.terminate()
        self.slave.freeInstance()


class Connections:
    """What is connected with what: variables of the train and of the housing, one by one."""

    def __init__(self, folder: Path):
        with open(folder / "connections.csv", newline="") as file:
            links = [(line["from"].split(".", 1), line["to"].split(".", 1)) for line in csv.DictReader(file)]
        motion = [link for link in links if ".housing." in link[1][1]]
        forces = [link for link in links if link not in motion]
        self.train, self.housing = motion[0][1][0], motion[0][0][0]
        self.moving, self.moved = ([end[1] for end in ends] for ends in zip(*motion))
        self.pushing, self.pushed = ([end[1] for end in ends] for ends in zip(*forces))


class Coupling:
    """Train and housing, started together from the equilibrium of both."""

    def __init__(self, folder: Path, parameters: dict[str, float]):
        links = Connections(folder)
        self.train, self.housing = Component(folder / f"{links.train}.fmu"), Component(folder / f"{links.housing}.fmu")
        self.train.set_parameters(parameters)
        self.housing.set_parameters(parameters)
        self.moved, self.pushing = self.train.find(links.moved), self.train.find(links.pushing)
        self.moving, self.pushed = self.housing.find(links.moving), self.housing.find(links.pushed)
        self.find_equilibrium()
        self.train.slave.exitInitializationMode()
        self.housing.slave.exitInitializationMode()

    def find_equilibrium(self) -> None:
        """In initialization mode both answer with their static solution, which is linear in the forces."""
        def answer(forces: np.ndarray) -> np.ndarray:
            self.housing.slave.setReal(self.pushed, forces)
            return self.exchange()[1]

        unloaded = answer(np.zeros(len(self.pushed)))
        response = np.array([answer(unit) - unloaded for unit in np.eye(len(self.pushed))]).T
        answer(np.linalg.solve(np.eye(len(self.pushed)) - response, unloaded))

    def exchange(self) -> tuple[np.ndarray, np.ndarray]:
        """Motion first: the bearing forces react to it at once, the motion to forces only in the next step."""
        motion = self.housing.slave.getReal(self.moving)
        self.train.slave.setReal(self.moved, motion)
        forces = self.train.slave.getReal(self.pushing)
        self.housing.slave.setReal(self.pushed, forces)
        return np.array(motion), np.array(forces)

    def slopes(self) -> tuple[np.ndarray, np.ndarray]:
        """How motion and forces change per second now, exactly. The forces' change follows from that of the motion."""
        motion = self.housing.slave.getRealOutputDerivatives(self.moving, [1] * len(self.moving))
        self.train.slave.setRealInputDerivatives(self.moved, [1] * len(self.moved), motion)
        forces = self.train.slave.getRealOutputDerivatives(self.pushing, [1] * len(self.pushing))
        return np.array(motion), np.array(forces)

    def change(self, motion: np.ndarray, forces: np.ndarray) -> None:
        """Inputs change by so much per second in the next step."""
        self.train.slave.setRealInputDerivatives(self.moved, [1] * len(self.moved), list(motion))
        self.housing.slave.setRealInputDerivatives(self.pushed, [1] * len(self.pushed), list(forces))

    def step(self, time: float, step: float) -> None:
        self.train.slave.doStep(time, step)
        self.housing.slave.doStep(time, step)


def held(pair: Coupling, time: float, step: float) -> None:
    """What most masters do: inputs are held over the step."""
    pair.exchange()
    pair.step(time, step)


def with_derivatives(pair: Coupling, time: float, step: float) -> None:
    """Inputs go on in a straight line over the step, with the slope that the partner states."""
    pair.exchange()
    pair.change(*pair.slopes())
    pair.step(time, step)


def iterated(pair: Coupling, time: float, step: float) -> None:
    """A first try shows where the step leads; then both go back and take it again, with inputs that lead there."""
    motion, forces = pair.exchange()
    before = [component.slave.getFMUstate() for component in (pair.train, pair.housing)]
    pair.change(*pair.slopes())
    pair.step(time, step)
    motion_then, forces_then = pair.exchange()
    for component, state in zip((pair.train, pair.housing), before):
        component.slave.setFMUstate(state)
        component.slave.freeFMUstate(state)
    pair.change((motion_then - motion) / step, (forces_then - forces) / step)
    pair.step(time, step)


# The same as held inputs for the master; the FMUs continue them through the step, and the housing stands on its bearings.
CONTINUED = {"simulation.input_extrapolation": 1.0, "simulation.known_bearings": 1.0}

WAYS = {"held inputs": (held, {}), "input derivatives": (with_derivatives, {}), "two iterations": (iterated, {}),
        "held, continued": (held, CONTINUED)}


def simulate(folder: Path, name: str, step: float, steps: int) -> dict[str, np.ndarray]:
    """Outputs of train and housing by name, at all communication points."""
    way, parameters = WAYS[name]
    pair = Coupling(folder, parameters)
    rows = []
    for index in range(steps + 1):
        pair.exchange()
        rows.append([value for one in (pair.train, pair.housing) for value in one.slave.getReal(one.find(one.outputs))])
        if index < steps:
            way(pair, index * step, step)
        if index % (steps // 4) == 0:
            print(f"    {1e3 * index * step:.1f} ms", flush=True)
    pair.train.close()
    pair.housing.close()
    return dict(zip(pair.train.outputs + pair.housing.outputs, np.array(rows).T))


def embedded(folder: Path, step: float, steps: int) -> dict[str, np.ndarray]:
    """The same from the train in the housing: one system, nothing to couple."""
    links = Connections(folder)
    whole = Component(folder / f"{links.train}_in_{links.housing}.fmu")
    whole.slave.exitInitializationMode()
    rows = [whole.slave.getReal(whole.find(whole.outputs))]
    for index in range(steps):
        whole.slave.doStep(index * step, step)
        rows.append(whole.slave.getReal(whole.find(whole.outputs)))
    whole.close()
    return dict(zip(whole.outputs, np.array(rows).T))


def main() -> None:
    parser = argparse.ArgumentParser(description="Couple a gear train with its gearbox in four ways.")
    parser.add_argument("folder", type=Path, nargs="?", default=Path(__file__).parent, help="what cargo xtask couple wrote")
    parser.add_argument("--step", type=float, default=2e-5, help="communication step [s]")
    parser.add_argument("--stop", type=float, default=0.02, help="end of the simulation [s]")
    parser.add_argument("--output", type=Path, default=Path("target/examples"), help="folder for the picture")
    arguments = parser.parse_args()
    steps = round(arguments.stop / arguments.step)

    print("train in the housing, one FMU")
    exact = embedded(arguments.folder, arguments.step, steps)
    found = {}
    for name in WAYS:
        print(f"two FMUs, {name}")
        found[name] = simulate(arguments.folder, name, arguments.step, steps)

    both = [name for name in exact if name in found["held inputs"]]
    shown = {"bearing force": Connections(arguments.folder).pushing,
             "mesh force": [name for name in both if name.endswith(".force")],
             "acceleration": [name for name in both if name.endswith((".ax", ".ay"))]}
    print(f"\nRMS error in % of the RMS of what alternates, communication step {1e6 * arguments.step:g} us")
    for name, result in found.items():
        errors = []
        for kind, variables in shown.items():
            difference = np.concatenate([result[variable] - exact[variable] for variable in variables])
            swing = np.concatenate([exact[variable] - exact[variable].mean() for variable in variables])
            errors.append(f"{kind} {100 * np.sqrt(np.mean(difference**2) / np.mean(swing**2)):.4f}")
        print(f"{name:18}: " + ", ".join(errors))

    figure, axes = plt.subplots(2, 3, figsize=(15, 7.5), sharex=True, layout="constrained")
    time = 1e3 * arguments.step * np.arange(steps + 1)
    for (above, below), (kind, variables) in zip(axes.T, shown.items()):
        variable = max(variables, key=lambda name: exact[name].std())
        above.plot(time, exact[variable], color="black", linewidth=2.5, alpha=0.35, label="one FMU")
        for name, result in found.items():
            above.plot(time, result[variable], linewidth=0.9, label=name)
            below.semilogy(time[1:], np.abs(result[variable] - exact[variable])[1:], linewidth=0.8, label=name)
        unit = "m/s²" if kind == "acceleration" else "N"
        above.set(title=f"{kind}: {variable}", ylabel=unit)
        below.set(xlabel="time, ms", ylabel=f"difference to one FMU, {unit}")
        for ax in (above, below):
            ax.grid(alpha=0.25)
    figure.legend(*axes[0, 0].get_legend_handles_labels(), loc="outside lower center", ncols=5, frameon=False)
    arguments.output.mkdir(parents=True, exist_ok=True)
    picture = arguments.output / "couple.png"
    figure.savefig(picture, dpi=110)
    print(f"written: {picture}")


if __name__ == "__main__":
    main()
