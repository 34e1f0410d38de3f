"""Errors and stability of a coupling scheme against the embedded housing."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from slaves import Connections, Pair, Slave

GRID = 1e-6  # of the reference [s]; communication steps are multiples of it


@dataclass(frozen=True)
class Course:
    """What was found over time: a row per communication point, a column per direction of bearings and sensors, and per mesh."""
    bearings: np.ndarray
    meshes: np.ndarray
    sensors: np.ndarray

    def every(self, stride: int) -> "Course":
        return Course(self.bearings[::stride], self.meshes[::stride], self.sensors[::stride])

    def errors(self, exact: "Course") -> list[float]:
        """Of bearing forces, mesh forces and accelerations."""
        kinds = ("bearings", "meshes", "sensors")
        return [error(getattr(self, kind), getattr(exact, kind)) for kind in kinds]


def reference(folder: Path, parameters: dict[str, float], stop: float, tolerance: float = 1e-8) -> Course:
    """Train and housing as one system, at every microsecond."""
    links = Connections(folder)
    kinds = (links.forces_from, links.meshes, links.sensors)
    slave = Slave(folder / f"{links.train}_in_{links.housing}.fmu", [], sum(kinds, []), parameters, tolerance)
    slave.start()
    rows = [slave.get()]
    for _ in range(round(stop / GRID)):
        slave.step(GRID)
        rows.append(slave.get())
    slave.close()
    return Course(*np.split(np.array(rows), np.cumsum([len(names) for names in kinds])[:-1], axis=1))


def coupled(folder: Path, parameters: dict[str, float], scheme, h: float, stop: float, limit: float = np.inf) -> Course:
    """The pair under a scheme, read after passing on motion and forces; ends early where a bearing force exceeds `limit`."""
    pair = Pair(folder, parameters | getattr(scheme, "parameters", {}))
    rows = []
    try:
        for index in range(round(stop / h) + 1):
            rows.append((pair.exchange()[1], pair.mesh_forces(), pair.accelerations()))
            if not np.abs(rows[-1][0]).max() < limit:
                break
            if index < round(stop / h):
                scheme.step(pair, h)
    finally:
        pair.close()
    return Course(*(np.array(column) for column in zip(*rows)))


def error(found: np.ndarray, exact: np.ndarray) -> float:
    """RMS of the difference over all columns, relative to the RMS of what alternates in the exact ones."""
    if len(found) != len(exact):
        return np.inf
    return np.sqrt(np.mean((found - exact) ** 2) / np.mean((exact - exact.mean(axis=0)) ** 2))


def stable(folder: Path, parameters: dict[str, float], scheme, h: float, peak: float) -> bool:
    """Whether bearing forces stay within twice the reference's `peak` for 0.05 s, or 300 steps where that is longer."""
    steps = max(300, round(0.05 / h))
    course = coupled(folder, parameters, scheme, h, steps * h, limit=2 * peak)
    return len(course.bearings) == steps + 1


def largest_stable_step(folder: Path, parameters: dict[str, float], scheme, peak: float, low=1e-5, high=8e-4) -> float:
    """By bisection, within 3 % [s]; `scheme` makes a new one each time. Takes stability to end once and for all."""
    while high / low > 1.03:
        middle = np.sqrt(low * high)
        if stable(folder, parameters, scheme(), middle, peak):
            low = middle
        else:
            high = middle
    return low


def step_for(target: float, steps: list[float], errors: list[float]) -> float:
    """The step at which an error reaches a target, between the measured ones on a log-log line; nan beyond them."""
    for (h, e), (h_next, e_next) in zip(zip(steps, errors), zip(steps[1:], errors[1:])):
        if e <= target < e_next and np.isfinite(e_next):
            return h * (h_next / h) ** (np.log(target / e) / np.log(e_next / e))
    return np.nan
