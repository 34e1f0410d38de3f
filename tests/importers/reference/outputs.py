"""The variables of design 3 from the states [q, q']."""
import numpy as np


def outputs(s, times, states, base_motion):
    """k(t) is the one just after t."""
    q, v = states[:, :s.n], states[:, s.n:]
    out = {"time": times, "state": states}
    angles, speeds = (np.array(a).reshape(-1, len(s.rotors)) for a in zip(*map(s.rotation, times, q, v)))
    for name, r in s.rotors.items():
        i = s.index[name]
        out[f"{name}.speed"], out[f"{name}.angle"] = speeds[:, i], angles[:, i]
        turned = s.mean[i] if s.free else 0.0                              # theta is what comes on top of the mean rotation
        for d in r.data["gear"] + r.data["probe"]:
            x, y, theta = s.rows(name, d["position"])
            path = f"{name}.{d['name']}"
            out[f"{path}.x"], out[f"{path}.y"], out[f"{path}.theta"] = q @ x, q @ y, q @ (theta - turned)
        for g in r.data["gear"]:
            out[f"{name}.{g['name']}.mesh_torque"] = np.zeros(len(times))
    _bearings(s, times, q, v, speeds, base_motion, out)
    _meshes(s, times, q, v, out)
    _housing(s, q, v, out)
    return out


def _bearings(s, times, q, v, speeds, base_motion, out):
    """Force of the rotor on the gearbox."""
    base = [s.base(t, base_motion) for t in times]
    for name, b in s.bearings.items():
        moved = np.array([motion[name] for motion in base]).reshape(-1, 4)
        du, dv = q @ b.rows.T - moved[:, :2], v @ b.rows.T - moved[:, 2:]
        force = np.zeros((len(times), 2))
        for i in range(len(times)):
            k, c = b.at_speed if b.linear else b.coefficients(speeds[i, b.rotor])
            force[i] = k @ du[i] + c @ dv[i] + (b.radial(du[i]) if b.radial else 0.0)
        out[f"{name}.x"], out[f"{name}.y"] = (q @ b.shaft.T).T
        out[f"{name}.force_x"], out[f"{name}.force_y"] = force.T


def _housing(s, q, v, out):
    """Without forces from outside; the accelerations are those that the bearings leave."""
    force = sum((np.array([out[f"{name}.force_x"], out[f"{name}.force_y"]]).T @ s.points[point]
                 for name, point in s.connect.items()), np.zeros_like(q))
    a = force - v @ s.own_damping - q @ s.own_stiffness
    for name, rows in s.points.items():
        for kind, values in (("", q), ("v", v), ("a", a)):
            out[f"{name}.{kind}x"], out[f"{name}.{kind}y"] = (values @ rows.T).T


def _meshes(s, times, q, v, out):
    phases, rates = (np.array(a).reshape(len(times), -1) for a in zip(*map(s.phase, times, q, v)))
    for i, m in enumerate(s.meshes):
        p, rate = phases[:, i], rates[:, i]
        k = np.array([m.stiffness(x) for x in p + 1e-11 * np.sign(rate)])
        e, de = np.array(list(map(m.error, p, rate))).reshape(-1, 2).T
        total, force = np.zeros(len(times)), np.zeros((len(times), 2))
        for term in m.terms:
            d = q @ term.right - term.relief * e - term.gap
            f = k * d + m.c * (v @ term.right - term.relief * de)
            if term.one_sided:
                f = np.where((d > 0) & (f > 0), f, 0.0)
            total += f * term.output
            force += f[:, None] * term.normal
            for gear, radius in zip(m.data["gears"], m.radius):
                out[f"{gear}.mesh_torque"] -= term.sign * radius * f
        out[f"{m.name}.force"], out[f"{m.name}.stiffness"] = total, k
        out[f"{m.name}.force_x"], out[f"{m.name}.force_y"] = force.T
        out[f"{m.name}.deflection"] = q @ m.right - e
