"""The assembled equations (eq 2, 4): M q'' + D q' + K q = f - mesh forces, q = [A, B, A_t] of every rotor.

Section 4 of the equations is Phi' (...) Phi of section 2, and so it is written here: the basis support appears only in
the eigenproblem, K_yy - K_xx and the cross terms come with the bearings.

Prescribed speed: the angle of a rotor is angle + Om t, theta is what comes on top.  Free spin: theta is the rotation since
t = 0, phi = (1'J theta)/(1'J 1) its mean over the rotor; Om, Om' likewise.
"""
import math

import numpy as np

from .basis import basis
from .bearing import RadialForce, coefficients
from .mesh import Mesh
from .model_file import load
from .rotor import Rotor

TWO_PI = 2 * math.pi


class Bearing:
    """K and C over the speed of the rotor; `shaft`: (x, y) of the shaft there; `rows`: relative to the housing of the model
    under it; `radial`: nonlinear force or None; `linear`: K and C do not change during a run."""

    def __init__(self, rotor, shaft, under, data, free):
        self.rotor, self.shaft, self.rows, self.coefficients = rotor, shaft, shaft - under, coefficients(data)
        self.held = bool(np.any(under))
        self.linear = not (free and "at_speed" in data)
        self.radial = RadialForce(data["nonlinear"]) if "nonlinear" in data else None


class System:
    def __init__(self, model, full=False):
        self.model = load(model)
        self.free = self.model["simulation"]["speed"] == "free"
        self.rotors = {r["name"]: Rotor(r) for r in self.model["rotor"]}
        self.index = {name: i for i, name in enumerate(self.rotors)}
        self.phi, self.at, self.frequencies, self.n = {}, {}, {}, 0
        for name, r in self.rotors.items():
            phi, phit, lateral, torsional = basis(r, self.model["basis"], full)
            edges = self.n + np.cumsum([0, phi.shape[1], phi.shape[1], phit.shape[1]])
            self.at[name] = [slice(a, b) for a, b in zip(edges, edges[1:])]
            self.phi[name], self.frequencies[name] = (phi, phit), (lateral, torsional)
            self.n = int(edges[-1])
        housing = self.model["housing"] or dict(point=[], mode=[], connect={})
        self.eta = slice(self.n, self.n + len(housing["mode"]))
        self.n = self.eta.stop
        n, count = self.n, len(self.rotors)
        self.mass, self.damping, self.stiffness, self.gyroscopic = (np.zeros((n, n)) for _ in range(4))
        self.owner = np.zeros(n, int)                                      # the rotor of each coordinate
        self.mean = np.zeros((count, n))                                   # phi = mean . q
        self.rigid = np.zeros((n, count))                                  # unit rotation of a whole rotor
        self.torque, self.torque_rows, self.bearings = np.zeros(n), {}, {}
        self.unbalance, self.bow = np.zeros((n, count), complex), np.zeros((n, count), complex)
        self._housing(housing)
        for name, r in self.rotors.items():
            self._shaft(name, r)
            self._turning(name, r)
            self._ports(name, r)
        self.angle0 = np.array([r.angle for r in self.rotors.values()])
        self.speed0 = np.array([r.design_speed for r in self.rotors.values()])
        if not self.free:
            self.damping += self.speed0[self.owner][:, None] * self.gyroscopic
        self.minv = np.linalg.inv(self.mass)
        self._linear_bearings()
        self._meshes([Mesh(k, self) for k in self.model["mesh"]])
        vib = self.model["gearbox_vibration"]
        self.vibration = vib["amplitude_x"], vib["amplitude_y"], vib["phase_y"], TWO_PI * vib["frequency"]

    # ------------------------------------------------------------ assembly
    def _housing(self, housing):
        """eta'' + 2 zeta w eta' + w^2 eta = psi' F; `points`: name -> (x, y) rows, `forces`: those on which forces act."""
        w = TWO_PI * np.array([m["frequency"] for m in housing["mode"]])
        zeta = np.array([m["damping_ratio"] for m in housing["mode"]])
        self.mass[self.eta, self.eta] = np.eye(len(w))
        self.stiffness[self.eta, self.eta] = np.diag(w ** 2)
        self.damping[self.eta, self.eta] = np.diag(2 * zeta * w)
        self.own_stiffness, self.own_damping = self.stiffness.copy(), self.damping.copy()
        self.points, self.connect = {}, housing["connect"]
        for p in housing["point"]:
            self.points[p["name"]] = rows = np.zeros((2, self.n))
            for i, m in enumerate(housing["mode"]):
                rows[:, self.eta.start + i] = m["shape"].get(p["name"], [0.0, 0.0])

    def _shaft(self, name, r):
        (x, y, t), (phi, phit) = self.at[name], self.phi[name]
        for s in (x, y):
            self.mass[s, s] = phi.T @ r.m @ phi
            self.stiffness[s, s] = phi.T @ r.ks @ phi
            self.damping[s, s] = phi.T @ r.c @ phi
        self.mass[t, t] = phit.T @ r.j @ phit
        self.stiffness[t, t] = phit.T @ r.kt @ phit
        self.damping[t, t] = phit.T @ r.ct @ phit
        gyro = phi.T @ r.g @ phi                                           # + Om G y' + Om' G y for x, - for y
        self.gyroscopic[x, y], self.gyroscopic[y, x] = gyro, -gyro
        i, ones = self.index[name], np.ones(len(r.j))
        self.owner[x.start:t.stop] = i
        self.mean[i, t] = ones @ r.j @ phit / (ones @ r.j @ ones)
        self.rigid[t, i] = np.linalg.solve(self.mass[t, t], phit.T @ r.j @ ones)

    def _turning(self, name, r):
        """Forces that turn with the shaft, F_x + i F_y = w e^{i phi}: Re for plane x, Im w = Re(-i w) for plane y."""
        (x, y, _), (phi, _), i = self.at[name], self.phi[name], self.index[name]
        for u in r.data["unbalance"]:
            w = u["moment"] * np.exp(1j * u["phase"]) * phi[2 * r.node(u["position"])]
            self.unbalance[x, i] += w
            self.unbalance[y, i] -= 1j * w
        for b in r.data["bow"]:
            w = phi.T @ r.bow_force(b) * np.exp(1j * b["phase"])
            self.bow[x, i] += w
            self.bow[y, i] -= 1j * w

    def _ports(self, name, r):
        for d in r.data["torque"]:
            row = self.rows(name, d["position"])[2]
            self.torque += d["value"] * row
            self.damping += d["slope"] * np.outer(row, row)                # of theta': in free spin the whole speed
            self.torque_rows[f"{name}.{d['name']}"] = row, d["value"]
        for b in r.data["bearing"]:
            path = f"{name}.{b['name']}"
            shaft = self.rows(name, b["position"])[:2]
            under = self.points[self.connect[path]] if path in self.connect else 0 * shaft
            self.bearings[path] = Bearing(self.index[name], shaft, under, b, self.free)

    def _linear_bearings(self):
        """K and C of the bearings that do not change, and how the gearbox pushes through them."""
        for b in self.bearings.values():
            b.at_speed = b.coefficients(self.speed0[b.rotor])
            if b.linear:
                self.stiffness += b.rows.T @ b.at_speed[0] @ b.rows
                self.damping += b.rows.T @ b.at_speed[1] @ b.rows
        self.special = [(name, b) for name, b in self.bearings.items() if b.radial or not b.linear]

    def _meshes(self, meshes):
        self.meshes, self.terms = meshes, [t for m in meshes for t in m.terms]
        self.mesh_of = np.array([i for i, m in enumerate(meshes) for _ in m.terms], int)
        self.left, self.right = (np.array([getattr(t, side) for t in self.terms]).reshape(-1, self.n) for side in ("left", "right"))
        self.relief, self.gap = (np.array([getattr(t, key) for t in self.terms]) for key in ("relief", "gap"))
        self.one_sided = np.array([t.one_sided for t in self.terms], bool)
        self.contact_damping = np.array([m.c for m in meshes])[self.mesh_of]
        self.mesh_mean = np.array([m.mean for m in meshes])[self.mesh_of]
        self.offset, self.rate = np.array([m.offset for m in meshes]), np.array([m.rate for m in meshes])
        self.phase_rows = np.array([m.pitches * m.rows[0][2] for m in meshes]).reshape(-1, self.n)

    def rows(self, rotor, position):
        """Rows r with x = r[0].q, y = r[1].q, theta = r[2].q at a station."""
        i, (x, y, t), (phi, phit) = self.rotors[rotor].node(position), self.at[rotor], self.phi[rotor]
        rows = np.zeros((3, self.n))
        rows[0, x] = phi[2 * i]
        rows[1, y] = phi[2 * i]
        rows[2, t] = phit[i]
        return rows

    # ------------------------------------------------------------ rotation and mesh phase
    def rotation(self, t, q, v):
        """Angle and speed of every rotor."""
        return (self.angle0 + self.mean @ q, self.mean @ v) if self.free else (self.angle0 + self.speed0 * t, self.speed0)

    def phase(self, t, q, v):
        """Phase of every mesh and its rate, in pitches; in free spin from the node of gear a (design 8.8)."""
        if self.free:
            return self.offset + self.phase_rows @ q, self.phase_rows @ v
        return self.offset + self.rate * t, self.rate

    # ------------------------------------------------------------ forces
    def base(self, t, base_motion):
        """(x, y, vx, vy) of every bearing: given functions of time plus gearbox_vibration (design 8.11)."""
        ax, ay, ph, w = self.vibration
        v = np.array([ax * math.sin(w * t), ay * math.sin(w * t + ph), ax * w * math.cos(w * t), ay * w * math.cos(w * t + ph)])
        return {name: v + np.array(base_motion[name](t)) if name in base_motion else v for name in self.bearings}

    def contact(self, t, q, v, k):
        """Deformation d and k d + c d' of every contact term, not yet clamped."""
        d, rate = self.right @ q - self.gap, self.right @ v
        if any(m.harmonics for m in self.meshes):
            e = np.array([m.error(p, dp) for m, p, dp in zip(self.meshes, *self.phase(t, q, v))])[self.mesh_of]
            d, rate = d - self.relief * e[:, 0], rate - self.relief * e[:, 1]
        return d, k * d + self.contact_damping * rate

    def acceleration(self, t, q, v, mesh_force, base_motion, torques):
        """q'' under the forces of the contact terms.

        The torsion does not feel Om' of its own rotor otherwise than through itself, so it comes first; then Om' acts on
        the lateral motion, by Om' G and by the unbalance m e (Om^2 - i Om') e^{i phi}."""
        f = self.torque - self.stiffness @ q - self.damping @ v - self.left.T @ mesh_force
        for name, fun in torques.items():
            row, value = self.torque_rows[name]
            f = f + (fun(t) - value) * row
        angle, speed = self.rotation(t, q, v)
        turning = np.exp(1j * angle)
        f += (self.unbalance @ (speed ** 2 * turning) + self.bow @ turning).real
        f += self._bearing_forces(t, q, v, speed, base_motion)
        if not self.free:
            return self.minv @ f
        f -= speed[self.owner] * (self.gyroscopic @ v)
        a = self.minv @ f
        spin_up = self.mean @ a
        f = -spin_up[self.owner] * (self.gyroscopic @ q) + (self.unbalance @ (-1j * spin_up * turning)).real
        return a + self.minv @ f

    def _bearing_forces(self, t, q, v, speed, base_motion):
        """What M, D, K do not hold: the push of the gearbox, bearings over the speed, nonlinear forces."""
        f = np.zeros(self.n)
        moves = base_motion or self.vibration[0] or self.vibration[1]
        base = self.base(t, base_motion) if moves else {}
        for name, moved in base.items():
            b = self.bearings[name]
            if b.linear:
                f += (b.at_speed[0] @ moved[:2] + b.at_speed[1] @ moved[2:]) @ b.rows
        for name, b in self.special:
            moved = base.get(name, np.zeros(4))
            u = b.rows @ q - moved[:2]
            if b.radial:
                f -= b.radial(u) @ b.rows
            if not b.linear:
                k, c = b.coefficients(speed[b.rotor])
                f -= (k @ u + c @ (b.rows @ v - moved[2:])) @ b.rows
        return f
