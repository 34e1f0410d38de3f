"""Energy of train and housing without damping, meshes and torques: whatever it gains or loses comes from the coupling."""

from pathlib import Path

import numpy as np
from slaves import Pair

STAGES = {"stage1": ("b1", "b2", "b3"), "stage2": ("b1", "b2", "b3"), "stage3": ("b1", "b2")}
HOUSING_MODES = range(1, 10)
BASIS_SUPPORT = 2e5  # of examples/three_stage.toml, at every gear [N/m]

UNDAMPED = {f"{stage}.{kind}_damping_ratio": 0.0 for stage in STAGES for kind in ("lateral", "torsional")}
UNDAMPED |= {f"{stage}.{bearing}.damping.{axis}": 0.0 for stage, bearings in STAGES.items() for bearing in bearings
             for axis in ("xx", "yy")}
UNDAMPED |= {f"{stage}_{bearing}.damping.{axis}": 0.0 for stage, bearings in STAGES.items() for bearing in bearings for axis in ("xx", "yy")}
UNDAMPED |= {f"housing.damping_ratio[{mode}]": 0.0 for mode in HOUSING_MODES}
# Meshes must not work: next to no stiffness, and torques are taken off. The pair starts from the equilibrium under torque: what
# the housing bent under the load swings.
UNDAMPED |= {f"mesh{pair}.stiffness_factor": 1e-12 for pair in ("12", "13")}
UNDAMPED |= {"stage1.drive.torque": 0.0, "stage2.load.torque": 0.0, "stage3.load.torque": 0.0}
UNDAMPED |= {f"{stage}.gear_unbalance.moment": 0.0 for stage in STAGES}


class Energy:
    """Of both, from modal coordinates and forces."""

    def __init__(self, pair: Pair):
        self.pair, train, housing = pair, pair.train, pair.housing
        modes = [(stage, axis, mode) for stage in STAGES for axis in "xy" for mode in (1, 2, 3)]
        self.rotors = train.block([f"{stage}.modal.{axis}[{mode}]" for stage, axis, mode in modes])
        self.box = housing.block([f"housing.modal[{mode}]" for mode in HOUSING_MODES])
        self.rotor_stiffness = (2 * np.pi * train.get(train.block([f"{stage}.lateral_frequency[{mode}]" for stage, _, mode in modes]))) ** 2
        self.box_stiffness = (2 * np.pi * housing.get(housing.block([f"housing.frequency[{mode}]" for mode in HOUSING_MODES]))) ** 2
        bearings = [(f"{stage}.{bearing}", axis) for stage, some in STAGES.items() for bearing in some for axis in "xy"]
        self.journals = train.block([f"{bearing}.{axis}" for bearing, axis in bearings])
        self.gears = train.block([f"{stage}.gear.{axis}" for stage in STAGES for axis in "xy"])
        self.forces = train.block([f"{bearing}.force_{axis}" for bearing, axis in bearings])
        self.springs = train.get(train.block([f"{bearing}.stiffness.{axis}{axis}" for bearing, axis in bearings]))

    def now(self) -> float:
        """Energy [J] after passing on motion and forces."""
        train, housing = self.pair.train, self.pair.housing
        self.pair.exchange()
        double = sum(np.sum(slave.rates(block) ** 2) for slave, block in ((train, self.rotors), (housing, self.box)))
        double += self.rotor_stiffness @ train.get(self.rotors) ** 2 + self.box_stiffness @ housing.get(self.box) ** 2
        # Modes of the rotors include springs from the bearings to the ground and the support of the basis: in their place come
        # the springs between rotor and housing, by their forces.
        double -= self.springs @ train.get(self.journals) ** 2 + BASIS_SUPPORT * np.sum(train.get(self.gears) ** 2)
        double += np.sum(train.get(self.forces) ** 2 / self.springs)
        return 0.5 * double


def energies(folder: Path, scheme, h: float, stop: float) -> np.ndarray:
    """Energy at all communication points [J]."""
    pair = Pair(folder, UNDAMPED | getattr(scheme, "parameters", {}), tolerance=1e-8)
    energy = Energy(pair)
    found = [energy.now()]
    for _ in range(round(stop / h)):
        scheme.step(pair, h)
        found.append(energy.now())
    pair.close()
    return np.array(found)
