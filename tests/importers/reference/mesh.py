"""One mesh: line of action, contact terms, phase, transmission error (eq 3)."""
import math

import numpy as np

from .model_file import gear
from .stiffness import law

TWO_PI = 2 * math.pi


class Term:
    """A rank-one contact law: force on q = -left F, F = k d + c d', d = right.q - relief e - gap; `one_sided`: F only
    while it presses.  `sign` of the mesh torque, -sign R F on each gear; `output` of F in the mesh force."""

    def __init__(self, left, right, normal, sign, relief=1.0, gap=0.0, one_sided=False, output=1.0):
        self.left, self.right, self.normal, self.sign = left, right, normal, sign
        self.relief, self.gap, self.one_sided, self.output = relief, gap, one_sided, output


class Mesh:
    """`terms`: one for bilateral contact, one per flank for unilateral contact, lateral and rotational part apart for
    as_printed (design 8.10: the torque follows from the rotational part alone, without transmission error)."""

    def __init__(self, data, system):
        self.data, self.name, self.flank = data, data["name"], data["flank"]
        (ra, ga), (rb, gb) = (gear(system.model, path) for path in data["gears"])
        self.radius = np.array([ga["base_radius"], gb["base_radius"] * (-1 if data["internal"] else 1)])
        self.rows = [system.rows(r["name"], g["position"]) for r, g in ((ra, ga), (rb, gb))]
        self.law, self.factor = law(data["stiffness"]), data["stiffness_factor"]
        self.mean = self.law.mean * self.factor
        self.c = data.get("damping", 2 * data["damping_ratio"] * math.sqrt(self.mean * reduced_mass(ga, gb)))
        # phase p = offset + pitches (rotation of gear a since t = 0)
        self.pitches = self.flank * ga["teeth"] / TWO_PI
        self.offset = self.pitches * ra["angle"] + data["phase"]
        self.rate = self.pitches * ra["speed"]
        self.harmonics = [(h["amplitude"], TWO_PI * h["order"], h["phase"]) for h in data["transmission_error"]]
        self.terms = self._terms(data)
        self.right = self.terms[0].right

    def _terms(self, data):
        s = self.flank
        n, lateral, rotation = self._deflection(s)
        if data["contact"] == "unilateral":
            back, *parts = self._deflection(-s)
            if data["torque_coupling"] != "consistent":
                raise NotImplementedError("as_printed with unilateral contact")
            return [Term(lateral + rotation, lateral + rotation, n, s, one_sided=True),
                    Term(sum(parts), sum(parts), back, -s, relief=-1.0, gap=data["backlash"], one_sided=True, output=-1.0)]
        if data["torque_coupling"] == "as_printed":
            return [Term(lateral, lateral + rotation, n, 0), Term(rotation, rotation, 0 * n, s, relief=0.0, output=0.0)]
        return [Term(lateral + rotation, lateral + rotation, n, s)]

    def _deflection(self, s):
        """Normal a -> b on flank s, and the two parts of delta = n.(u_a - u_b) + s (R_a th_a + R_b th_b)."""
        psi = self.data["center_angle"] + (math.pi if self.data["internal"] else 0.0)
        alpha = psi + s * (math.pi / 2 - self.data["pressure_angle"])
        n = np.array([math.cos(alpha), math.sin(alpha)])
        (xa, ya, ta), (xb, yb, tb) = self.rows
        return n, n[0] * (xa - xb) + n[1] * (ya - yb), s * (self.radius[0] * ta + self.radius[1] * tb)

    def stiffness(self, p, piece=None):
        return self.factor * self.law.value(p, piece)

    def error(self, p, rate):
        """Transmission error e and its time derivative (design 8.6)."""
        e = de = 0.0
        for amplitude, order, phase in self.harmonics:
            e += amplitude * math.cos(order * p + phase)
            de -= amplitude * order * rate * math.sin(order * p + phase)
        return e, de

    def break_times(self, t_end):
        """When a rotor of prescribed speed passes the breakpoints."""
        if not self.rate or not self.law.breaks:
            return []
        low, high = sorted((self.offset, self.offset + self.rate * t_end))
        pieces = range(self.law.piece(low), self.law.piece(high) + 2)
        return [(self.law.start(i) - self.offset) / self.rate for i in pieces]


def reduced_mass(a, b):
    """m_eq of both gears alone at their base radii; 0 when one has no inertia."""
    if not a["polar_inertia"] or not b["polar_inertia"]:
        return 0.0
    return 1 / (a["base_radius"] ** 2 / a["polar_inertia"] + b["base_radius"] ** 2 / b["polar_inertia"])
