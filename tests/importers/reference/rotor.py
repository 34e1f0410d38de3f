"""Finite elements of one rotor (eq 2, design 8.1, 8.4)."""
import math

import numpy as np
from scipy.linalg import eigh

from .bearing import coefficients


def cowper(nu, ratio):
    """Cowper shear factor of a circular section, ratio = inner / outer diameter."""
    a = (1 + ratio ** 2) ** 2
    return 6 * (1 + nu) * a / ((7 + 6 * nu) * a + (20 + 12 * nu) * ratio ** 2)


def element(seg, h):
    """Element matrices over a length h: bending K, M, polar inertia G on [x, bx, x, bx]; torsion K_T, J on [th, th].

    Deflection w = sum a_i s^i (cubic, s = z/h); section slope b = w' - gamma with the constant shear strain
    gamma = V/(kappa G A) = -E I w'''/(kappa G A): the exact static solution of an unloaded Timoshenko element.
    """
    mat, do, di = seg["material"], seg["outer_diameter"], seg["inner_diameter"]
    e, nu, rho = mat["youngs_modulus"], mat["poisson_ratio"], mat["density"]
    g = e / (2 * (1 + nu))
    area, inertia = math.pi * (do ** 2 - di ** 2) / 4, math.pi * (do ** 4 - di ** 4) / 64
    ga = cowper(nu, di / do) * g * area
    shear = -6 * e * inertia / (ga * h ** 3) * np.array([0, 0, 0, 1])                   # gamma of the a_i

    def w(s):
        return np.array([1, s, s ** 2, s ** 3])

    def slope(s):
        return np.array([0, 1, 2 * s, 3 * s ** 2]) / h - shear

    def curvature(s):
        return np.array([0, 0, 2, 6 * s]) / h ** 2

    a = np.linalg.inv(np.array([w(0), slope(0), w(1), slope(1)]))                       # a_i = a @ nodal values
    k, m_t, m_r, k_t, j = np.zeros((4, 4)), np.zeros((4, 4)), np.zeros((4, 4)), np.zeros((2, 2)), np.zeros((2, 2))
    points, weights = np.polynomial.legendre.leggauss(4)                                # exact to degree 7; w*w has 6
    for s, q in zip((points + 1) / 2, weights * h / 2):
        n, b, c, y = w(s) @ a, slope(s) @ a, curvature(s) @ a, shear @ a
        k += q * (e * inertia * np.outer(c, c) + ga * np.outer(y, y))
        m_t += q * rho * area * np.outer(n, n)
        m_r += q * rho * inertia * np.outer(b, b)
        lin, dlin = np.array([1 - s, s]), np.array([-1, 1]) / h
        k_t += q * g * 2 * inertia * np.outer(dlin, dlin)
        j += q * rho * 2 * inertia * np.outer(lin, lin)
    return k, m_t + m_r, 2 * m_r, k_t, j


class Rotor:
    """Matrices of one rotor; plane x and plane y share K_s, M and G.

    `design_speed`, at which speed-dependent bearings give K_xx for the modes, is the file's `speed` (in free spin: the
    initial speed)."""

    def __init__(self, r):
        self.data, self.name, self.design_speed, self.angle = r, r["name"], r["speed"], r["angle"]
        self.z = self._nodes(r)
        n = len(self.z)
        self.ks, self.m, self.g = (np.zeros((2 * n, 2 * n)) for _ in range(3))
        self.kt, self.j = np.zeros((n, n)), np.zeros((n, n))
        self._shaft(r)
        for d in r["disk"] + r["gear"]:
            i = self.node(d["position"])
            self.m[2 * i, 2 * i] += d["mass"]
            self.m[2 * i + 1, 2 * i + 1] += d["diametral_inertia"]
            self.g[2 * i + 1, 2 * i + 1] += d["polar_inertia"]
            self.j[i, i] += d["polar_inertia"]
        self.kxx, self.ksup, self.ksup_t = np.zeros_like(self.ks), np.zeros_like(self.ks), np.zeros_like(self.kt)
        for b in r["bearing"]:
            i = 2 * self.node(b["position"])
            self.kxx[i, i] += coefficients(b)(self.design_speed)[0][0, 0]
        for s in r["basis_support"]:
            i = self.node(s["position"])
            self.ksup[2 * i, 2 * i] += s["lateral"]
            self.ksup_t[i, i] += s["torsional"]
        # design 8.4: C = M V diag(2 zeta w) V' M, lateral with bearings and supports, torsional without supports
        self.w, self.v = modes(self.ks + self.kxx + self.ksup, self.m, 2 - held(self.kxx + self.ksup))
        self.wt, self.vt = modes(self.kt + self.ksup_t, self.j, 1 - min(1, held(self.ksup_t)))
        self.c = modal_damping(self.m, self.w, self.v, r["lateral_damping_ratio"])
        self.ct = modal_damping(self.j, *modes(self.kt, self.j, 1), r["torsional_damping_ratio"])

    def _shaft(self, r):
        ends = np.cumsum([s["length"] for s in r["segment"]])
        for i, (left, right) in enumerate(zip(self.z, self.z[1:])):
            seg = r["segment"][min(int(np.searchsorted(ends, (left + right) / 2)), len(ends) - 1)]
            k, m, g, kt, j = element(seg, right - left)
            lat, tor = slice(2 * i, 2 * i + 4), slice(i, i + 2)
            self.ks[lat, lat] += k
            self.m[lat, lat] += m
            self.g[lat, lat] += g
            self.kt[tor, tor] += kt
            self.j[tor, tor] += j

    @staticmethod
    def _nodes(r):
        """Design 8.1: every named position is a node, spans divided into ceil(span / max_element_length)."""
        ends = np.cumsum([s["length"] for s in r["segment"]])
        named = [0.0, *ends]
        for key in ("disk", "gear", "bearing", "unbalance", "torque", "basis_support", "probe"):
            named += [d["position"] for d in r[key]]
        for b in r["bow"]:
            named += b["positions"]
        stations = [0.0]
        for z in sorted(named):
            if z - stations[-1] > 1e-9 * ends[-1]:
                stations.append(z)
        nodes = [0.0]
        for a, b in zip(stations, stations[1:]):
            count = max(1, math.ceil((b - a) / r["max_element_length"] * (1 - 1e-9)))
            nodes += [a + (b - a) * (i + 1) / count for i in range(count)]
        return np.array(nodes)

    def node(self, position):
        i = int(np.argmin(abs(self.z - position)))
        if abs(self.z[i] - position) > 1e-8 * self.z[-1]:
            raise ValueError(f"{self.name}: {position} is not a node")
        return i

    def bow_force(self, bow):
        """K_s r of the shape of least strain energy through the given offsets (eq 2): Schur complement, exact for rigid parts."""
        c = [2 * self.node(z) for z in bow["positions"]]
        f = np.setdiff1d(np.arange(len(self.ks)), c)
        kcc, kcf, kff = self.ks[np.ix_(c, c)], self.ks[np.ix_(c, f)], self.ks[np.ix_(f, f)]
        force = np.zeros(len(self.ks))
        if len(c) > 2:                                                     # two offsets are a rigid motion
            force[c] = (kcc - kcf @ np.linalg.solve(kff, kcf.T)) @ np.array(bow["amplitudes"], float)
        return force


def held(k):
    """At how many places a diagonal stiffness holds the shaft, two being enough."""
    return min(2, np.count_nonzero(np.diag(k)))


def modes(k, m, rigid):
    """Angular frequencies and mass-normalised modes of K v = w^2 M v; the lowest `rigid` frequencies are exactly 0."""
    w2, v = eigh(k, m)
    w2[:rigid] = 0.0
    return np.sqrt(np.maximum(w2, 0.0)), v


def modal_damping(m, w, v, ratio):
    mv = m @ v
    return mv * (2 * ratio * w) @ mv.T
