"""Independent reference for geartrain: the equations of equations.md, written for reading and for accuracy, not for speed.

Nothing here is shared with the Rust program.  "eq" = equations.md, "design" = design.md.  SI units, plain numbers only,
prescribed speed.  Element matrices come from Gauss integration of the Timoshenko shape functions, dynamics from DOP853
between the breakpoints of the mesh stiffness (and, for unilateral contact, between located contact events).

    python reference.py MODEL.toml --frequencies          JSON: uncoupled and coupled frequencies
    python reference.py MODEL.toml --simulate 0.02 1e-4   CSV of every output, t = 0, 1e-4, ... 0.02
"""
import copy
import json
import math
import sys
import tomllib

import numpy as np
from scipy.integrate import DOP853
from scipy.linalg import eig, eigh
from scipy.optimize import brentq

TWO_PI = 2 * math.pi


# ---------------------------------------------------------------- 1. model file (design 2)
def load(source):
    """Model file (path) or dict -> dict with every default of design 2 filled in."""
    if isinstance(source, dict):
        m = copy.deepcopy(source)
    else:
        with open(source, "rb") as f:
            m = tomllib.load(f)
    sim = m.setdefault("simulation", {})
    sim.setdefault("speed", "prescribed")
    sim.setdefault("start", "equilibrium")
    if sim["speed"] != "prescribed":
        raise NotImplementedError("free spin")
    vib = m.setdefault("gearbox_vibration", {})
    for key in ("amplitude_x", "amplitude_y", "phase_y", "frequency"):
        vib.setdefault(key, 0.0)
    for r in m["rotor"]:
        r.setdefault("angle", 0.0)
        r.setdefault("lateral_damping_ratio", 0.0)
        r.setdefault("torsional_damping_ratio", 0.0)
        for key in ("segment", "disk", "gear", "bearing", "unbalance", "bow", "torque", "basis_support", "probe"):
            r.setdefault(key, [])
        for s in r["segment"]:
            s.setdefault("inner_diameter", 0.0)
            if not isinstance(s.get("material"), dict):                    # already resolved when loaded twice
                s["material"] = m["material"][s.get("material", "default")]
        for g in r["gear"]:
            if "base_radius" not in g:
                g["base_radius"] = 0.5 * g["module"] * g["teeth"] * math.cos(g["pressure_angle"])
        for b in r["bearing"]:
            for key in ("stiffness", "damping"):
                d = b.setdefault(key, {})
                d.setdefault("xx", 0.0)
                d.setdefault("yy", d["xx"])
                d.setdefault("xy", 0.0)
                d.setdefault("yx", 0.0)
        for u in r["unbalance"] + r["bow"]:
            u.setdefault("phase", 0.0)
        for t in r["torque"]:
            t.setdefault("value", 0.0)
            t.setdefault("slope", 0.0)
        for s in r["basis_support"]:
            s.setdefault("lateral", 0.0)
            s.setdefault("torsional", 0.0)
        length = sum(s["length"] for s in r["segment"])
        r.setdefault("max_element_length", length / 20)
    first = {}                                     # design 8.8: gear -> first mesh in which it is gear a
    for k in m.setdefault("mesh", []):
        for key, value in dict(internal=False, flank=1, contact="bilateral", backlash=0.0, damping_ratio=0.0,
                               torque_coupling="consistent", transmission_error=[], stiffness_factor=1.0).items():
            k.setdefault(key, value)
        for e in k["transmission_error"]:
            e.setdefault("phase", 0.0)
        a = k["gears"][0]
        if "phase" not in k:
            k["phase"] = 0.0
            if a in first:
                f = first[a]
                k["phase"] = f["phase"] - k["flank"] * _gear(m, a)[1]["teeth"] * (k["center_angle"] - f["center_angle"]) / TWO_PI
        first.setdefault(a, k)
    mesh_hz = [abs(r["speed"]) * g["teeth"] / TWO_PI for r, g in (_gear(m, k["gears"][0]) for k in m["mesh"])]
    basis = m.setdefault("basis", dict(static_shapes=True))
    basis.setdefault("static_shapes", False)
    basis.setdefault("max_frequency", max([1000.0] + [3 * f for f in mesh_hz]))        # a count of modes goes before it
    return m


def _gear(model, path):
    rotor, gear = path.split(".")
    r = next(r for r in model["rotor"] if r["name"] == rotor)
    return r, next(g for g in r["gear"] if g["name"] == gear)


# ---------------------------------------------------------------- 2. finite elements (eq 2)
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
    """Finite-element matrices of one rotor; plane x and plane y share K_s, M and G."""

    def __init__(self, r):
        self.data, self.name, self.speed, self.angle = r, r["name"], r["speed"], r["angle"]
        self.z = self._nodes(r)
        n = len(self.z)
        self.ks, self.m, self.g = (np.zeros((2 * n, 2 * n)) for _ in range(3))
        self.kt, self.j = np.zeros((n, n)), np.zeros((n, n))
        ends = np.cumsum([s["length"] for s in r["segment"]])
        for i in range(n - 1):
            middle = (self.z[i] + self.z[i + 1]) / 2
            seg = r["segment"][min(int(np.searchsorted(ends, middle)), len(ends) - 1)]
            k, m, g, kt, j = element(seg, self.z[i + 1] - self.z[i])
            lat, tor = slice(2 * i, 2 * i + 4), slice(i, i + 2)
            self.ks[lat, lat] += k
            self.m[lat, lat] += m
            self.g[lat, lat] += g
            self.kt[tor, tor] += kt
            self.j[tor, tor] += j
        for d in r["disk"] + r["gear"]:
            i = self.node(d["position"])
            self.m[2 * i, 2 * i] += d["mass"]
            self.m[2 * i + 1, 2 * i + 1] += d["diametral_inertia"]
            self.g[2 * i + 1, 2 * i + 1] += d["polar_inertia"]
            self.j[i, i] += d["polar_inertia"]
        self.kxx, self.ksup, self.ksup_t = np.zeros_like(self.ks), np.zeros_like(self.ks), np.zeros_like(self.kt)
        for b in r["bearing"]:
            i = 2 * self.node(b["position"])
            self.kxx[i, i] += b["stiffness"]["xx"]
        for s in r["basis_support"]:
            i = self.node(s["position"])
            self.ksup[2 * i, 2 * i] += s["lateral"]
            self.ksup_t[i, i] += s["torsional"]
        # design 8.4: C = M V diag(2 zeta w) V' M, lateral with bearings and supports, torsional without supports
        self.w, self.v = modes(self.ks + self.kxx + self.ksup, self.m)
        self.wt, self.vt = modes(self.kt + self.ksup_t, self.j)
        mv = self.m @ self.v
        self.c = mv * (2 * r["lateral_damping_ratio"] * self.w) @ mv.T
        w_free, v_free = modes(self.kt, self.j)
        jv = self.j @ v_free
        self.ct = jv * (2 * r["torsional_damping_ratio"] * w_free) @ jv.T

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

    def basis(self, opt, full):
        """Phi, Phi_t (eq 4, design 8.2, 8.3) and the listed elastic frequencies in Hz."""
        listed = [w[w > 0] / TWO_PI for w in (self.w, self.wt)]
        if full:
            return np.eye(len(self.w)), np.eye(len(self.wt)), *listed

        def count(w, key, least):
            by_frequency = np.sum(w <= TWO_PI * opt["max_frequency"])
            return min(len(w), int(opt.get(key, max(least, by_frequency))))

        n, nt = count(self.w, "lateral_modes", 2), count(self.wt, "torsional_modes", 1)
        phi, phit = self.v[:, :n], self.vt[:, :nt]
        listed = [w[w > 0] / TWO_PI for w in (self.w[:n], self.wt[:nt])]
        if opt["static_shapes"]:
            at = [self.node(d["position"]) for d in self.data["gear"]]
            lateral = [2 * (i) for i in at + [self.node(b["position"]) for b in self.data["bearing"]]]
            torsion = at + [self.node(t["position"]) for t in self.data["torque"]]
            phi = np.hstack([phi, static_shapes(self.ks + self.kxx, self.m, phi, lateral, self.ks + self.kxx + self.ksup)])
            phit = np.hstack([phit, static_shapes(self.kt, self.j, phit, torsion, self.kt + self.ksup_t)])
        return phi, phit, *listed

    def bow_force(self, bow):
        """K_s r of the shape of least strain energy through the given offsets (eq 2): Schur complement, exact for rigid parts."""
        c = [2 * self.node(z) for z in bow["positions"]]
        f = np.setdiff1d(np.arange(len(self.ks)), c)
        kcc, kcf, kff = self.ks[np.ix_(c, c)], self.ks[np.ix_(c, f)], self.ks[np.ix_(f, f)]
        force = np.zeros(len(self.ks))
        if len(c) > 2:                                                     # two offsets are a rigid motion
            force[c] = (kcc - kcf @ np.linalg.solve(kff, kcf.T)) @ np.array(bow["amplitudes"], float)
        return force


def modes(k, m):
    """Angular frequencies (exactly 0 for rigid modes) and mass-normalised modes of K v = w^2 M v."""
    w2, v = eigh(k, m)
    return np.sqrt(np.where(w2 > 1e-12 * w2[-1], w2, 0.0)), v


def static_shapes(k, m, phi, loads, k_basis):
    """Deflections under unit loads (inertia relief when free), made orthonormal to phi and to each other (eq 4)."""
    loads = sorted(set(loads))
    w, v = modes(k, m)
    rigid = v[:, w == 0]
    f = np.eye(len(k))[:, loads]
    f = f - m @ rigid @ (rigid.T @ f)
    b = m @ rigid
    x = np.linalg.solve(np.block([[k, b], [b.T, np.zeros((b.shape[1],) * 2)]]), np.vstack([f, np.zeros((b.shape[1], f.shape[1]))]))[: len(k)]
    x = x / np.sqrt(np.sum(x * (m @ x), axis=0))
    for _ in range(2):
        x = x - phi @ (phi.T @ (m @ x))
    s, u = np.linalg.eigh(x.T @ m @ x)
    keep = s > 1e-16
    x = x @ u[:, keep] / np.sqrt(s[keep])
    return x @ np.linalg.eigh(x.T @ k_basis @ x)[1] if x.shape[1] else x


# ---------------------------------------------------------------- 4. meshes (eq 3)
def stiffness_law(law):
    """k(p) over the phase p in pitches (period 1), its mean, and the phases in [0, 1) where it is not smooth."""
    kind = law["law"]
    eps = law.get("contact_ratio", 1.0)
    if kind == "constant":
        return (lambda p: law["mean"]), law["mean"], []
    if kind == "fourier":
        terms = [(i + 1, c, 0.0) for i, c in enumerate(law.get("cosine", []))]
        terms += [(i + 1, 0.0, s) for i, s in enumerate(law.get("sine", []))]

        def k(p):
            return law["mean"] * (1 + sum(c * math.cos(TWO_PI * i * p) + s * math.sin(TWO_PI * i * p) for i, c, s in terms))
        return k, law["mean"], []
    if kind == "rectangular":
        few = math.floor(eps)
        low, high = (law["pair"] * few, law["pair"] * (few + 1)) if "pair" in law else (law["single"], law["double"])

        def k(p):
            return high if p % 1.0 < eps - few else low
        breaks = [0.0, eps % 1.0]
    elif kind == "tooth_pair":
        ramp, quad, quart = law.get("ramp", 0.0), law.get("quadratic", 0.0), law.get("quartic", 0.0)

        def k(p):
            total, x = 0.0, p % 1.0
            while x <= eps:
                xi = 2 * x / eps - 1
                u = min(1.0, min(x, eps - x) / ramp) if ramp > 0 else 1.0
                total += (1 - quad * xi ** 2 - quart * xi ** 4) * u ** 3 * (10 - 15 * u + 6 * u ** 2)
                x += 1.0
            return law["pair"] * total
        breaks = [0.0, eps % 1.0, ramp % 1.0, (eps - ramp) % 1.0] + ([eps / 2 % 1.0] if 2 * ramp > eps else [])
    elif kind == "table":
        phase, value = law["phase"], law["value"]
        xs = [phase[-1] - 1.0, *phase, phase[0] + 1.0]
        ys = [value[-1], *value, value[0]]

        def k(p):
            x = p % 1.0
            i = max(i for i in range(len(xs) - 1) if xs[i] <= x)           # at a jump the new value holds
            return ys[i] + (ys[i + 1] - ys[i]) * (x - xs[i]) / (xs[i + 1] - xs[i]) if xs[i + 1] > xs[i] else ys[i]
        breaks = [x % 1.0 for x in phase]
    else:
        raise ValueError(kind)
    breaks = sorted(set(breaks))
    points, weights = np.polynomial.legendre.leggauss(10)                  # exact: every law is a polynomial in between
    mean = sum((b - a) / 2 * sum(q * k((a + b) / 2 + (b - a) / 2 * x) for x, q in zip(points, weights))
               for a, b in zip(breaks, breaks[1:] + [breaks[0] + 1]))
    return k, float(mean), breaks


class Mesh:
    """Geometry, stiffness and transmission error of one mesh.

    `terms` are rank-one contact laws: force on q = -left F, F = k d + c d', d = right.q - relief e - gap.  One for
    bilateral contact, one per flank for unilateral contact, lateral and rotational part apart for as_printed."""

    def __init__(self, data, system):
        self.data, self.name, s = data, data["name"], data["flank"]
        (self.ra, ga), (self.rb, gb) = (_gear(system.model, path) for path in data["gears"])
        self.radius = ga["base_radius"], gb["base_radius"] * (-1 if data["internal"] else 1)
        rows = [system.rows(r["name"], g["position"]) for r, g in ((self.ra, ga), (self.rb, gb))]
        self.flank, self.backlash = s, data["backlash"]
        self.law, mean, self.breaks = stiffness_law(data["stiffness"])
        self.factor = data["stiffness_factor"]
        self.mean = mean * self.factor
        m_eq = 1 / (ga["base_radius"] ** 2 / ga["polar_inertia"] + gb["base_radius"] ** 2 / gb["polar_inertia"]) \
            if ga["polar_inertia"] and gb["polar_inertia"] else 0.0
        self.c = data.get("damping", 2 * data["damping_ratio"] * math.sqrt(self.mean * m_eq))
        self.rate = s * ga["teeth"] * self.ra["speed"] / TWO_PI            # pitches per second
        self.offset = s * ga["teeth"] * self.ra["angle"] / TWO_PI + data["phase"]

        def flank(sign):
            """Normal a -> b, and delta = n.(u_a - u_b) + s (R_a th_a + R_b th_b) split into its two parts."""
            psi = data["center_angle"] + (math.pi if data["internal"] else 0.0)
            alpha = psi + sign * (math.pi / 2 - data["pressure_angle"])
            n = np.array([math.cos(alpha), math.sin(alpha)])
            lateral = n[0] * (rows[0][0] - rows[1][0]) + n[1] * (rows[0][1] - rows[1][1])
            return n, lateral, sign * (self.radius[0] * rows[0][2] + self.radius[1] * rows[1][2])

        n, lateral, rotation = flank(s)
        self.right = lateral + rotation
        if data["contact"] == "unilateral":
            if data["torque_coupling"] != "consistent":
                raise NotImplementedError("as_printed with unilateral contact")
            nb, lb, rb = flank(-s)
            self.terms = [Term(lateral + rotation, lateral + rotation, 1.0, 0.0, True, n, s),
                          Term(lb + rb, lb + rb, -1.0, self.backlash, True, nb, -s)]
        elif data["torque_coupling"] == "as_printed":
            self.terms = [Term(lateral, lateral + rotation, 1.0, 0.0, False, n, 0),
                          Term(rotation, rotation, 0.0, 0.0, False, 0 * n, s)]
        else:
            self.terms = [Term(lateral + rotation, lateral + rotation, 1.0, 0.0, False, n, s)]

    def phase(self, t):
        return self.offset + self.rate * t

    def stiffness(self, t):
        return self.factor * self.law(self.phase(t))

    def error(self, t):
        """Transmission error e and its rate (design 8.6)."""
        e = de = 0.0
        for h in self.data["transmission_error"]:
            arg = TWO_PI * h["order"] * self.phase(t) + h["phase"]
            e += h["amplitude"] * math.cos(arg)
            de -= h["amplitude"] * TWO_PI * h["order"] * self.rate * math.sin(arg)
        return e, de

    def break_times(self, t_end):
        if not self.rate:
            return []
        low, high = sorted((self.phase(0.0), self.phase(t_end)))
        return [(n + b - self.offset) / self.rate for b in self.breaks for n in range(math.floor(low) - 1, math.ceil(high) + 1)]


class Term:
    def __init__(self, left, right, relief, gap, one_sided, normal, torque_sign):
        self.left, self.right, self.relief, self.gap, self.one_sided = left, right, relief, gap, one_sided
        self.normal, self.torque_sign = normal, torque_sign


# ---------------------------------------------------------------- 3. the assembled system (eq 4)
class System:
    """M q'' + D q' + K q + mesh = f(t); q = [A, B, A_t] of every rotor.  K, D hold everything but the meshes.

    Section 4 of the equations is Phi' (...) Phi of section 2; so it is written here: the basis support appears only in
    the eigenproblem, K_yy - K_xx and the cross terms come with the bearings."""

    def __init__(self, model, full=False):
        self.model = load(model)
        self.rotors = {r["name"]: Rotor(r) for r in self.model["rotor"]}
        self.phi, self.at, self.frequencies, self.n = {}, {}, {}, 0
        for name, r in self.rotors.items():
            phi, phit, lateral, torsional = r.basis(self.model["basis"], full)
            nl, nt = phi.shape[1], phit.shape[1]
            edges = self.n + np.array([0, nl, 2 * nl, 2 * nl + nt])
            self.at[name] = [slice(a, b) for a, b in zip(edges, edges[1:])]
            self.phi[name], self.frequencies[name] = (phi, phit), (lateral, torsional)
            self.n = int(edges[-1])
        self.mass, self.damping, self.stiffness = (np.zeros((self.n, self.n)) for _ in range(3))
        self.torque, self.cosine, self.sine, self.bearings, self.torque_rows = np.zeros(self.n), {}, {}, {}, {}
        for name, r in self.rotors.items():
            self._assemble(name, r)
        self.meshes = [Mesh(k, self) for k in self.model["mesh"]]
        vib = self.model["gearbox_vibration"]
        self.vibration = vib["amplitude_x"], vib["amplitude_y"], vib["phase_y"], TWO_PI * vib["frequency"]

    def _assemble(self, name, r):
        (x, y, t), (phi, phit) = self.at[name], self.phi[name]
        for s in (x, y):
            self.mass[s, s] = phi.T @ r.m @ phi
            self.stiffness[s, s] = phi.T @ r.ks @ phi
            self.damping[s, s] = phi.T @ r.c @ phi
        gyro = r.speed * phi.T @ r.g @ phi
        self.damping[x, y] += gyro
        self.damping[y, x] -= gyro
        self.mass[t, t] = phit.T @ r.j @ phit
        self.stiffness[t, t] = phit.T @ r.kt @ phit
        self.damping[t, t] = phit.T @ r.ct @ phit
        for b in r.data["bearing"]:
            rx, ry, _ = self.rows(name, b["position"])
            u = np.array([rx, ry])
            k, c = ([[d["xx"], d["xy"]], [d["yx"], d["yy"]]] for d in (b["stiffness"], b["damping"]))
            k, c = np.array(k), np.array(c)
            self.stiffness += u.T @ k @ u
            self.damping += u.T @ c @ u
            self.bearings[f"{name}.{b['name']}"] = u, k, c
        for d in r.data["torque"]:
            row = self.rows(name, d["position"])[2]
            self.torque += d["value"] * row
            self.damping += d["slope"] * np.outer(row, row)
            self.torque_rows[f"{name}.{d['name']}"] = row, d["value"]
        # forces turning with the shaft: F_x + i F_y = f e^{i(phi + phase)} -> cosine cos(phi) + sine sin(phi)
        self.cosine[name], self.sine[name] = np.zeros(self.n), np.zeros(self.n)
        turning = []
        for u in r.data["unbalance"]:
            f = np.zeros(len(r.m))
            f[2 * r.node(u["position"])] = u["moment"] * r.speed ** 2
            turning.append((f, u["phase"]))
        turning += [(r.bow_force(b), b["phase"]) for b in r.data["bow"]]
        for f, phase in turning:
            f = phi.T @ f
            c, s = math.cos(phase), math.sin(phase)
            self.cosine[name][x] += f * c
            self.cosine[name][y] += f * s
            self.sine[name][x] -= f * s
            self.sine[name][y] += f * c

    def rows(self, rotor, position):
        """Rows r with x = r[0].q, y = r[1].q, theta = r[2].q at a station."""
        i, (x, y, t), (phi, phit) = self.rotors[rotor].node(position), self.at[rotor], self.phi[rotor]
        rows = np.zeros((3, self.n))
        rows[0, x] = phi[2 * i]
        rows[1, y] = phi[2 * i]
        rows[2, t] = phit[i]
        return rows

    def base(self, t, base_motion, vibrate=True):
        """(x, y, vx, vy) of every bearing: given functions of time plus gearbox_vibration (design 8.11)."""
        ax, ay, ph, w = self.vibration
        v = np.array([ax * math.sin(w * t), ay * math.sin(w * t + ph), ax * w * math.cos(w * t), ay * w * math.cos(w * t + ph)])
        return {b: v * vibrate + (np.array(base_motion[b](t)) if b in base_motion else 0.0) for b in self.bearings}

    def force(self, t, base_motion, torques):
        """f(t): torques, unbalance, bow, K u_b + C u_b' of the bearings."""
        f = self.torque.copy()
        for name, r in self.rotors.items():
            a = r.angle + r.speed * t
            f += math.cos(a) * self.cosine[name] + math.sin(a) * self.sine[name]
        for name, fun in torques.items():
            row, value = self.torque_rows[name]
            f += (fun(t) - value) * row
        if base_motion or self.vibration[0] or self.vibration[1]:
            for b, motion in self.base(t, base_motion).items():
                u, k, c = self.bearings[b]
                f += (k @ motion[:2] + c @ motion[2:]) @ u
        return f

    # ------------------------------------------------------------ 5. equilibrium (design 8.5)
    def equilibrium(self, base_motion=None, torques=None):
        """Static solution with mean mesh stiffness; rigid modes carry unbalanced torque and have zero (inertia-weighted) mean."""
        f = self.torque.copy()
        for name, fun in (torques or {}).items():
            f += (fun(0.0) - self.torque_rows[name][1]) * self.torque_rows[name][0]
        for b, motion in self.base(0.0, base_motion or {}, vibrate=False).items():
            u, k, _ = self.bearings[b]
            f += k @ motion[:2] @ u
        active = [[not t.one_sided or i == 0 for i, t in enumerate(m.terms)] for m in self.meshes]
        for _ in range(50):
            k, load = self.stiffness.copy(), f.copy()
            for m, on in zip(self.meshes, active):
                for term, closed in zip(m.terms, on):
                    if closed:
                        k += m.mean * np.outer(term.left, term.right)
                        load += m.mean * term.gap * term.left
            w2, v = eigh((k + k.T) / 2, self.mass)
            rigid = self.mass @ v[:, abs(w2) < (TWO_PI * 0.05) ** 2]
            border = np.zeros((rigid.shape[1],) * 2)
            q = np.linalg.solve(np.block([[k, rigid], [rigid.T, border]]), np.append(load, np.zeros(len(border))))[: self.n]
            found = [[not t.one_sided or t.right @ q - t.gap > 0 for t in m.terms] for m in self.meshes]
            if found == active:
                return q
            active = found
        raise RuntimeError("contact of the equilibrium not found")


# ---------------------------------------------------------------- 7. simulation
def simulate(model, t_end, times, rtol=1e-11, base_motion=None, torques=None, initial=None, full=False):
    """All outputs of design 3 at `times`.

    base_motion = {"rotor.bearing": t -> (x, y, vx, vy)}, torques = {"rotor.torque": t -> T}; initial = (q, q') overrides
    the start of the model file.  DOP853 runs from breakpoint to breakpoint of every k(t); a unilateral flank carries
    F = k d + c d' while min(d, F) > 0, and every change of sign of that is located as an event.
    """
    s = model if isinstance(model, System) else System(model, full)
    base_motion, torques, times = base_motion or {}, torques or {}, np.asarray(times, float)
    if initial is not None:
        q0, v0 = initial
    else:
        v0 = np.zeros(s.n)
        q0 = s.equilibrium(base_motion, torques) if s.model["simulation"]["start"] == "equilibrium" else np.zeros(s.n)
    y = np.concatenate([q0, v0])

    terms = [(m, t) for m in s.meshes for t in m.terms]
    owner = [s.meshes.index(m) for m, _ in terms]
    right = np.array([t.right for _, t in terms]).reshape(-1, s.n)
    relief, gap = np.array([t.relief for _, t in terms]), np.array([t.gap for _, t in terms])
    damping = np.array([m.c for m, _ in terms])
    one_sided = np.array([t.one_sided for _, t in terms], bool)
    left = np.linalg.solve(s.mass, np.array([t.left for _, t in terms]).reshape(-1, s.n).T)
    minv = np.linalg.inv(s.mass)
    linear = -minv @ np.hstack([s.stiffness, s.damping])

    def contact(t, y, k):
        """Deformation d and k d + c d' of every term, not yet clamped."""
        e = np.array([m.error(t) for m in s.meshes]).reshape(-1, 2)[owner] if owner else np.zeros((0, 2))
        d = right @ y[:s.n] - relief * e[:, 0] - gap
        return d, k * d + damping * (right @ y[s.n:] - relief * e[:, 1])

    pitch = min([1 / abs(m.rate) for m in s.meshes if m.rate], default=math.inf)
    merge = 1e-11 * pitch if math.isfinite(pitch) else 0.0
    cuts = [0.0]
    for t in sorted(t for m in s.meshes for t in m.break_times(t_end)):
        if cuts[-1] + 2 * merge < t < t_end - 2 * merge:
            cuts.append(t)
    cuts.append(t_end)
    scale = np.repeat([1e-6, 1e-3], s.n)
    result = np.zeros((len(times), 2 * s.n))
    for a, b in zip(cuts, cuts[1:]):
        inner = a + 2 * merge, b - 2 * merge                               # never look at k(t) across the breakpoint

        def stiffness(t):
            t = min(max(t, inner[0]), inner[1])
            k = [m.stiffness(t) for m in s.meshes]
            return np.array([k[i] for i in owner])

        def closing(t, y):
            """Positive where a one-sided term carries force."""
            return np.minimum(*contact(t, y, stiffness(t)))

        def rhs(time, y):
            f = contact(time, y, stiffness(time))[1] * active
            return np.concatenate([y[s.n:], linear @ y + minv @ s.force(time, base_motion, torques) - left @ f])

        active = ~one_sided | (closing(a, y) > 0)
        solver = DOP853(rhs, a, y, b, rtol=rtol, atol=rtol * scale)
        while solver.status == "running":
            message = solver.step()
            if solver.status == "failed":
                raise RuntimeError(message)
            t0, t, path = solver.t_old, solver.t, solver.dense_output()
            changed = None
            if one_sided.any():                                            # look inside the step: no short contact is missed
                for c, d in zip(np.linspace(t0, t, 9), np.linspace(t0, t, 9)[1:]):
                    roots = []
                    for i in np.flatnonzero(((closing(d, path(d)) > 0) != active) & one_sided):
                        def value(x):
                            return closing(x, path(x))[i]
                        roots.append((brentq(value, c, d, xtol=1e-18) if value(c) * value(d) < 0 else c, i))
                    if roots:
                        root, changed = min(roots)
                        t = max(root, t0 + 1e-6 * (t - t0))                # a start at d = 0 must advance too
                        break
            inside = (times >= t0) & (times < t)
            if inside.any():
                result[inside] = path(times[inside]).T
            if changed is not None:
                active[changed] ^= True
                solver = DOP853(rhs, t, path(t), b, rtol=rtol, atol=rtol * scale)
        y = solver.y
    result[times >= t_end] = y
    return outputs(s, times, result, base_motion)


def outputs(s, times, states, base_motion):
    """Names of design 3 from the states [q, q']; k(t) is the one just after t."""
    q, v = states[:, :s.n], states[:, s.n:]
    out = {"time": times, "state": states}
    for name, r in s.rotors.items():
        out[f"{name}.speed"] = np.full(len(times), r.speed)
        out[f"{name}.angle"] = r.angle + r.speed * times
        for d in r.data["gear"] + r.data["probe"]:
            for key, row in zip(("x", "y", "theta"), s.rows(name, d["position"])):
                out[f"{name}.{d['name']}.{key}"] = q @ row
        for g in r.data["gear"]:
            out[f"{name}.{g['name']}.mesh_torque"] = np.zeros(len(times))
    base = [s.base(t, base_motion) for t in times]
    for b, (u, k, c) in s.bearings.items():
        moved = np.array([motion[b] for motion in base]).reshape(-1, 4)
        f = (q @ u.T - moved[:, :2]) @ k.T + (v @ u.T - moved[:, 2:]) @ c.T            # of the rotor on the gearbox
        out[f"{b}.x"], out[f"{b}.y"] = (q @ u.T).T
        out[f"{b}.force_x"], out[f"{b}.force_y"] = f.T
    for m in s.meshes:
        after = times + (1e-11 / abs(m.rate) if m.rate else 0.0)
        k = np.array([m.stiffness(t) for t in after])
        e, de = np.array([m.error(t) for t in times]).reshape(-1, 2).T
        total, force = np.zeros(len(times)), np.zeros((len(times), 2))
        for i, term in enumerate(m.terms):
            d = q @ term.right - term.relief * e - term.gap
            f = k * d + m.c * (v @ term.right - term.relief * de)
            if term.one_sided:
                f = np.where((d > 0) & (f > 0), f, 0.0)
            total += f * (0.0 if not term.normal.any() else 1.0 if i == 0 else -1.0)
            force += f[:, None] * term.normal
            for gear, radius in zip(m.data["gears"], m.radius):
                out[f"{gear}.mesh_torque"] -= term.torque_sign * radius * f
        out[f"{m.name}.force"], out[f"{m.name}.stiffness"] = total, k
        out[f"{m.name}.force_x"], out[f"{m.name}.force_y"] = force.T
        out[f"{m.name}.deflection"] = q @ m.right - e
    return out


# ---------------------------------------------------------------- 8. frequencies
def frequencies(model, full=False):
    """Uncoupled elastic frequencies [Hz] of the basis eigenproblem: {rotor: {"lateral": [...], "torsional": [...]}}."""
    s = model if isinstance(model, System) else System(model, full)
    return {name: dict(lateral=list(map(float, f[0])), torsional=list(map(float, f[1]))) for name, f in s.frequencies.items()}


def coupled(model, full=False):
    """Oscillating eigenvalues of the whole system with mean mesh stiffness, by |lambda|; rigid and overdamped ones left out."""
    s = model if isinstance(model, System) else System(model, full)
    k, d = s.stiffness.copy(), s.damping.copy()
    for m in s.meshes:
        for t in m.terms[:1] if m.terms[0].one_sided else m.terms:         # unilateral: on the reference flank
            k += m.mean * np.outer(t.left, t.right)
            d += m.c * np.outer(t.left, t.right)
    a = np.block([[np.zeros_like(k), np.eye(s.n)], [-np.linalg.solve(s.mass, k), -np.linalg.solve(s.mass, d)]])
    values = eig(a, right=False)
    values = sorted((z for z in values if z.imag > TWO_PI * 0.05), key=abs)
    return [dict(frequency_hz=abs(z) / TWO_PI, damped_hz=z.imag / TWO_PI, damping_ratio=-z.real / abs(z)) for z in values]


def main(args):
    model = System(args[0])
    if "--frequencies" in args:
        meshes = [dict(name=m.name, frequency=abs(m.rate), mean_stiffness=m.mean, damping=m.c) for m in model.meshes]
        print(json.dumps(dict(rotors=frequencies(model), meshes=meshes, coupled=coupled(model)), indent=1))
    if "--simulate" in args:
        stop, step = map(float, args[args.index("--simulate") + 1:][:2])
        times = np.minimum(np.arange(round(stop / step) + 1) * step, stop)
        out = simulate(model, stop, times)
        out.pop("state")
        print(",".join(out))
        for line in zip(*out.values()):
            print(",".join(repr(float(x)) for x in line))


if __name__ == "__main__":
    main(sys.argv[1:])
