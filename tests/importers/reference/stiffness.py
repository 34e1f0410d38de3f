"""Mesh stiffness over the phase p in tooth pitches, period 1 (eq 3, design 8.7).

A law is smooth between its breakpoints b_0 < b_1 < ... in [0, 1).  The pieces between them are numbered through all
pitches: piece n B + i (B breakpoints) begins at phase n + b_i.  Each piece is a formula that continues beyond its
ends, so that an integrator may look a little too far.
"""
import bisect
import math

import numpy as np

TWO_PI = 2 * math.pi


class Law:
    def __init__(self, breaks, formulas, mean=None):
        """formulas[i](x): k at phase x, b_i <= x <= b_(i+1); the last one reaches to b_0 + 1.  Without breakpoints: one for all."""
        self.breaks, self.formulas = breaks, formulas
        self.mean = self._mean() if mean is None else mean

    def piece(self, p):
        """The piece in which p lies; at a breakpoint the new one."""
        if not self.breaks:
            return 0
        n = math.floor(p)
        return n * len(self.breaks) + bisect.bisect_right(self.breaks, p - n) - 1

    def start(self, piece):
        """The phase at which a piece begins; it ends where the next one begins."""
        n, i = divmod(piece, len(self.breaks))
        return n + self.breaks[i]

    def value(self, p, piece=None):
        if not self.breaks:
            return self.formulas[0](p)
        n, i = divmod(self.piece(p) if piece is None else piece, len(self.breaks))
        return self.formulas[i](p - n)

    def _mean(self):
        points, weights = np.polynomial.legendre.leggauss(10)              # exact to degree 19; tooth_pair has 9
        total = 0.0
        for a, b, k in zip(self.breaks, self.breaks[1:] + [self.breaks[0] + 1], self.formulas):
            total += (b - a) / 2 * sum(q * k((a + b) / 2 + (b - a) / 2 * x) for x, q in zip(points, weights))
        return float(total)


def law(data):
    kinds = dict(constant=constant, fourier=fourier, rectangular=rectangular, tooth_pair=tooth_pair, table=table)
    return kinds[data["law"]](data)


def constant(data):
    return Law([], [lambda p: data["mean"]], data["mean"])


def fourier(data):
    cosine, sine = ([(TWO_PI * (i + 1), c) for i, c in enumerate(data.get(key, []))] for key in ("cosine", "sine"))

    def k(p):
        return data["mean"] * (1 + sum(c * math.cos(i * p) for i, c in cosine) + sum(s * math.sin(i * p) for i, s in sine))
    return Law([], [k], data["mean"])


def rectangular(data):
    """floor(eps) + 1 pairs for frac(p) < frac(eps), else floor(eps)."""
    few, part = divmod(data["contact_ratio"], 1.0)
    low, high = (data["pair"] * few, data["pair"] * (few + 1)) if "pair" in data else (data["single"], data["double"])
    return Law([0.0, part], [lambda x: high, lambda x: low]) if part else Law([0.0], [lambda x: low])


def tooth_pair(data):
    eps, ramp = data["contact_ratio"], data.get("ramp", 0.0)
    quadratic, quartic = data.get("quadratic", 0.0), data.get("quartic", 0.0)
    breaks = [0.0, eps % 1.0, ramp % 1.0, (eps - ramp) % 1.0] + ([eps / 2 % 1.0] if 2 * ramp > eps else [])
    breaks = distinct(breaks)

    def formula(middle):
        # The engaged pairs x = p + j, and on which side of its path each is, are the same in the whole piece.
        pairs = [j for j in range(math.ceil(eps) + 1) if middle + j < eps]
        ramps = []
        for j in pairs:
            x = middle + j
            ramps.append(0 if ramp == 0 or ramp < x < eps - ramp else 1 if x < eps - x else -1)

        def k(p):
            total = 0.0
            for j, side in zip(pairs, ramps):
                x = p + j
                xi = 2 * x / eps - 1
                u = 1.0 if side == 0 else (x if side > 0 else eps - x) / ramp
                total += (1 - quadratic * xi ** 2 - quartic * xi ** 4) * u ** 3 * (10 - 15 * u + 6 * u ** 2)
            return data["pair"] * total
        return k
    return Law(breaks, [formula((a + b) / 2) for a, b in zip(breaks, breaks[1:] + [1.0])])


def distinct(breaks):
    """Sorted, without the repetitions that differ by rounding."""
    breaks = sorted(breaks)
    return [b for a, b in zip([-1.0, *breaks], breaks) if b - a > 1e-12 and b < 1 - 1e-12]


def table(data):
    """Linear between the points; two values at one phase are a jump."""
    x, y = [*data["phase"], data["phase"][0] + 1.0], [*data["value"], data["value"][0]]
    lines = [(a, ka, (kb - ka) / (b - a)) for a, b, ka, kb in zip(x, x[1:], y, y[1:]) if b > a]
    return Law([a for a, _, _ in lines], [lambda p, a=a, k=k, slope=slope: k + slope * (p - a) for a, k, slope in lines])
