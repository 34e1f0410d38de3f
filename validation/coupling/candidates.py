"""What a slave could do by itself when its master only sets values and steps: prototypes that play the slaves' part here.

A slave sees its own inputs at communication points, its own state, and the length of the last step. Courses of inputs within a step
that are no straight lines are followed in PIECES straight pieces.
"""

from collections import deque

import numpy as np
from slaves import Pair, Slave

PIECES = 8


def follow(slave: Slave, course, h: float, pieces: int = PIECES) -> None:
    """One step of `slave` with the inputs course(t), 0 <= t <= h."""
    piece = h / pieces
    now = course(0.0)
    for index in range(pieces):
        then = course((index + 1) * piece)
        slave.set(now)
        slave.set_rates((then - now) / piece)
        slave.step(piece)
        now = then


def straight(value, rate):
    return lambda t: value + rate * t


class Estimate:
    """One slave's inputs with derivatives estimated from past communication points."""

    def __init__(self, order: int):
        self.order, self.past = order, deque(maxlen=order)

    def course(self, values: np.ndarray, h: float):
        """The polynomial of the given order through the values now and at past points; held in the first step."""
        known = [values, *self.past]
        self.past.appendleft(values)
        if len(known) == 1:
            return straight(values, 0.0)
        if len(known) == 2:
            return straight(values, (values - known[1]) / h)
        first, second = (1.5 * values - 2 * known[1] + 0.5 * known[2]) / h, (values - 2 * known[1] + known[2]) / (h * h)
        return lambda t: values + first * t + 0.5 * second * t * t


class MeanOfParabola:
    """The straight line from the value now with the mean that the parabola through three points has over the step."""

    def __init__(self):
        self.past = deque(maxlen=2)

    def course(self, values: np.ndarray, h: float):
        known = [values, *self.past]
        self.past.appendleft(values)
        if len(known) < 3:
            return straight(values, (values - known[-1]) / h)
        return straight(values, (11 * values - 16 * known[1] + 5 * known[2]) / (6 * h))


class Motion:
    """The train's inputs: displacements go on with the velocity inputs, velocities with their backward difference."""

    def __init__(self, curved: bool):
        self.curved, self.past = curved, None

    def course(self, values: np.ndarray, h: float):
        half = len(values) // 2
        acceleration = 0.0 if self.past is None else (values[half:] - self.past) / h
        self.past = values[half:]
        rate = np.concatenate([values[half:], np.broadcast_to(acceleration, half)])
        if not self.curved:
            return straight(values, rate)
        bend = np.concatenate([np.broadcast_to(acceleration, half), np.zeros(half)])
        return lambda t: values + rate * t + 0.5 * bend * t * t


class Estimated:
    """A parallel step; what is None holds its inputs. Straight courses cost nothing, bent ones are followed in pieces."""

    def __init__(self, train=None, housing=None, bent=False):
        self.train, self.housing, self.bent = train, housing, bent

    def step(self, pair: Pair, h: float) -> None:
        motion, forces = pair.exchange()
        for slave, values, estimate in ((pair.train, motion, self.train), (pair.housing, forces, self.housing)):
            if estimate is None:
                slave.step(h)
            else:
                follow(slave, estimate.course(values, h), h, PIECES if self.bent else 1)


class Averaged:
    """Forces are reported as their average over the last step."""

    def __init__(self, predict: bool):
        self.average, self.before, self.predict = None, None, predict

    def step(self, pair: Pair, h: float) -> None:
        motion, forces = pair.housing.get(), self.average
        pair.train.set(motion)
        start = pair.train.get()
        if forces is None:
            forces = start
        elif self.predict and self.before is not None:
            forces = 2 * forces - self.before  # goes on to the average over the coming step
        pair.housing.set(forces)
        pair.housing.step(h)
        samples = [start]
        for _ in range(PIECES):
            pair.train.step(h / PIECES)
            samples.append(pair.train.get())
        self.before = self.average
        self.average = (sum(samples) - 0.5 * (samples[0] + samples[-1])) / PIECES


class Predicted:
    """Outputs are reported as they will be in the middle of the coming step, by their own derivatives."""

    def __init__(self):
        self.past = None

    def step(self, pair: Pair, h: float) -> None:
        motion = pair.housing.get() + 0.5 * h * pair.housing.rates()
        pair.train.set(motion)
        half = pair.displacements
        # Displacement inputs move with the velocity inputs; the change of those is not known to the train.
        pair.train.set_rates(np.concatenate([motion[half:], np.zeros(half)]))
        forces = pair.train.get() + 0.5 * h * pair.train.rates()
        pair.train.set_rates(np.zeros(2 * half))
        pair.housing.set(forces)
        pair.step(h)


class TransmissionLine:
    """Between every bearing and its point runs a line of impedance z, as long as a step: both ends know only what the other sent
    a step ago."""

    def __init__(self, impedance: float):
        self.z, self.sent = impedance, None

    def step(self, pair: Pair, h: float) -> None:
        half, z = pair.displacements, self.z
        if self.sent is None:
            motion, forces = pair.exchange()
            self.base = motion
            self.sent = [forces - z * motion[half:], forces + z * motion[half:]]
        to_train, to_housing = self.sent
        pieces = max(PIECES, int(np.ceil(h / 2e-6)))
        piece = h / pieces
        for _ in range(pieces):
            velocity = pair.housing.get()[half:]
            pair.housing.set(to_housing - z * velocity)
            pair.housing.step(piece)
            # The base gives way until the bearing carries what the line does: F(v) = to_train + z v, F falls with v by damping.
            x = self.base[:half]
            pair.train.set(np.concatenate([x, np.zeros(half)]))
            still = pair.train.get()
            v = (still - to_train) / (z + 2e3)
            pair.train.set(np.concatenate([x, v]))
            pair.train.set_rates(np.concatenate([v, np.zeros(half)]))
            pair.train.step(piece)
            self.base = np.concatenate([x + piece * v, v])
        pair.train.set(self.base)
        force_train, velocity = pair.train.get(), pair.housing.get()[half:]
        force_housing = to_housing - z * velocity
        self.sent = [force_housing - z * velocity, force_train + z * self.base[half:]]
