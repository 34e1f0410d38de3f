"""The static start (design 8.5).

Mean mesh stiffness, no transmission error, bow, unbalance or vibration; the torques are those "set at the end of
initialization", the inputs: what a load line takes at the initial speed of a free spin acts from then on.  Torques that
do not balance accelerate the connected train as a rigid body; the rigid part of the solution itself is zero in the mean
(weighted with the inertia).
The potential of bearings and contacts is convex, so damped Newton steps

    (J + mu M) dq = -g(q),     mu -> 0 with |g|

find the contacts and clearances that close, each no longer than until the potential rises along it: dq.g(q + a dq) = 0.
"""
import numpy as np
from scipy.linalg import eigh, null_space
from scipy.optimize import brentq


def equilibrium(s, base_motion, torques):
    load = s.torque.copy()
    for name, fun in torques.items():
        row, value = s.torque_rows[name]
        load += (fun(0.0) - value) * row
    base = {name: np.array(base_motion[name](0.0))[:2] if name in base_motion else np.zeros(2) for name in s.bearings}
    for name, b in s.bearings.items():
        load += b.at_speed[0] @ base[name] @ b.rows
    k = s.stiffness + sum((b.rows.T @ b.at_speed[0] @ b.rows for b in s.bearings.values() if not b.linear), np.zeros((s.n, s.n)))
    radial = [(b.radial, b.rows, base[name]) for name, b in s.bearings.items() if b.radial]

    def force(q):
        d = s.right @ q - s.gap
        f = k @ q - load + s.left.T @ (s.mesh_mean * np.where(s.one_sided, np.maximum(d, 0.0), d))
        return f + sum((law(rows @ q - moved) @ rows for law, rows, moved in radial), np.zeros(s.n))

    def tangent(q):
        closed = ~s.one_sided | (s.right @ q - s.gap > 0)
        j = k + s.left.T @ ((s.mesh_mean * closed)[:, None] * s.right)
        return j + sum((rows.T @ law.stiffness(rows @ q - moved) @ rows for law, rows, moved in radial), np.zeros((s.n, s.n)))

    carrier = s.mass @ rigid_motions(s, k)
    corner = np.zeros((carrier.shape[1],) * 2)
    project = np.eye(s.n) - carrier @ np.linalg.solve(carrier.T @ s.minv @ carrier, carrier.T @ s.minv)

    def size(g):
        return np.sqrt(g @ s.minv @ g)

    q = np.zeros(s.n)
    g = project @ force(q)
    start = size(g)
    for _ in range(500):
        if size(g) == 0:
            return q
        mu = 4e3 * min(1.0, size(g) / start)                               # (2 pi 10 Hz)^2 at first
        step = np.linalg.solve(np.block([[tangent(q) + mu * s.mass, carrier], [carrier.T, corner]]), np.append(-g, np.diag(corner)))[: s.n]
        if step @ force(q + step) > 1e-6 * abs(step @ g):
            step *= brentq(lambda a: step @ force(q + a * step), 0.0, 1.0, xtol=1e-12)
        q = q + step
        g = project @ force(q)
        if np.sqrt(step @ s.mass @ step) < 1e-14 * np.sqrt(q @ s.mass @ q):
            return q
        if size(g) < 1e-13 * start and mu < 1e-6:
            return q
    raise RuntimeError("no equilibrium found")


def rigid_motions(s, k):
    """Rotations that strain nothing and leave every mesh as it is.  A few modes computed with torsional supports cannot
    rotate without strain: what then vibrates, above 0.05 Hz, is not rigid."""
    motions = s.rigid @ null_space(np.vstack([m.right for m in s.meshes] + [np.zeros(s.n)]) @ s.rigid, rcond=1e-6)
    w2, v = eigh(motions.T @ k @ motions, motions.T @ s.mass @ motions)
    return motions @ v[:, w2 < (2 * np.pi * 0.05) ** 2]
