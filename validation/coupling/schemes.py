"""Ways to couple two slaves. Each class takes one communication step; what it remembers of past steps is its own."""

import numpy as np
from slaves import Pair


class HeldOldOutputs:
    """parallel, inputs held, outputs as of the end of the last step"""

    def __init__(self):
        self.forces = None

    def step(self, pair: Pair, h: float) -> None:
        _, forces = pair.exchange()
        pair.housing.set(forces if self.forces is None else self.forces)
        pair.step(h)
        self.forces = pair.train.get()


class HeldOldOutputsAndContinued(HeldOldOutputs):
    """the same with slaves that continue their inputs"""

    parameters = {"simulation.input_extrapolation": 1.0}


class Held:
    """parallel, inputs held, outputs re-evaluated with the inputs just set"""

    def step(self, pair: Pair, h: float) -> None:
        pair.exchange()
        pair.step(h)


class HeldAndContinued(Held):
    """the same with slaves that continue their inputs"""

    parameters = {"simulation.input_extrapolation": 1.0}


class HeldOnKnownBearings(Held):
    """the same with a housing that knows its bearings"""

    parameters = {"simulation.known_bearings": 1.0}


class HeldAndContinuedOnKnownBearings(Held):
    """the same with slaves that continue their inputs and a housing that knows its bearings"""

    def __init__(self, share: float = 1.0):
        self.parameters = {"simulation.input_extrapolation": 1.0, "simulation.known_bearings": share}


class HeldWithoutVelocity:
    """the same with velocity inputs left at 0"""

    def step(self, pair: Pair, h: float) -> None:
        motion = pair.housing.get()
        motion[pair.displacements:] = 0.0
        pair.train.set(motion)
        pair.housing.set(pair.train.get())
        pair.step(h)


class Derivatives:
    """parallel, input derivatives from the partner"""

    def step(self, pair: Pair, h: float) -> None:
        pair.exchange()
        pair.train.set_rates(pair.housing.rates())
        pair.housing.set_rates(pair.train.rates())
        pair.step(h)


class DerivativesOnKnownBearings(Derivatives):
    """the same with a housing that knows its bearings"""

    parameters = {"simulation.known_bearings": 1.0}


class Sequential:
    """sequential (Gauss-Seidel): the housing first with held forces, the train with the motion found"""

    def step(self, pair: Pair, h: float) -> None:
        before, _ = pair.exchange()
        pair.housing.step(h)
        pair.train.set_rates((pair.housing.get() - before) / h)
        pair.train.step(h)


class SequentialExtrapolated:
    """sequential (Gauss-Seidel), forces extrapolated"""

    def step(self, pair: Pair, h: float) -> None:
        before, _ = pair.exchange()
        pair.train.set_rates(pair.housing.rates())
        pair.housing.set_rates(pair.train.rates())
        pair.housing.step(h)
        pair.train.set_rates((pair.housing.get() - before) / h)
        pair.train.step(h)


class Rollback:
    """iterations with state rollback: each repeats the step with what the one before found at its end"""

    def __init__(self, iterations: int = 2):
        self.iterations = iterations

    def step(self, pair: Pair, h: float) -> None:
        motion, forces = pair.exchange()
        for slave in pair.slaves:
            slave.save()
        pair.train.set_rates(pair.housing.rates())
        pair.housing.set_rates(pair.train.rates())
        pair.step(h)
        for _ in range(self.iterations - 1):
            motion_rates, force_rates = ((now - before) / h for now, before in zip(pair.exchange(), (motion, forces)))
            for slave in pair.slaves:
                slave.restore()
            pair.train.set_rates(motion_rates)
            pair.housing.set_rates(force_rates)
            pair.step(h)


class RollbackOnKnownBearings(Rollback):
    """the same with a housing that knows its bearings"""

    parameters = {"simulation.known_bearings": 1.0}
