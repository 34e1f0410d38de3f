"""Phi and Phi_t: the modes that are kept, and static shapes (eq 4, design 8.2, 8.3)."""
import math

import numpy as np

from .rotor import held, modes

TWO_PI = 2 * math.pi


def basis(rotor, opt, full):
    """Phi, Phi_t and the listed elastic frequencies in Hz; `full`: every degree of freedom of the finite elements."""
    if full:
        return np.eye(len(rotor.w)), np.eye(len(rotor.wt)), *(w[w > 0] / TWO_PI for w in (rotor.w, rotor.wt))

    def count(w, key, least):
        by_frequency = np.sum(w <= TWO_PI * opt["max_frequency"])
        return min(len(w), int(opt.get(key, max(least, by_frequency))))

    n, nt = count(rotor.w, "lateral_modes", 2), count(rotor.wt, "torsional_modes", 1)
    phi, phit = rotor.v[:, :n], rotor.vt[:, :nt]
    listed = [w[w > 0] / TWO_PI for w in (rotor.w[:n], rotor.wt[:nt])]
    if opt["static_shapes"]:
        gears, bearings, torques = ([rotor.node(d["position"]) for d in rotor.data[key]] for key in ("gear", "bearing", "torque"))
        k = rotor.ks + rotor.kxx
        lateral = static_shapes(k, rotor.m, phi, [2 * i for i in gears + bearings], rotor.ksup, 2 - held(rotor.kxx))
        torsion = static_shapes(rotor.kt, rotor.j, phit, gears + torques, rotor.ksup_t, 1)
        phi, phit = np.hstack([phi, lateral]), np.hstack([phit, torsion])
    return phi, phit, *listed


def static_shapes(k, m, phi, loads, support, rigid):
    """Deflections under unit loads (inertia relief when free), made orthonormal to phi and to each other (eq 4),
    in the order of their frequencies with the supports of the basis.  Rigid motions are among them: they are in phi
    unless the supports of the basis have bent them, and a shaft must be able to follow its neighbours without strain."""
    f = np.eye(len(k))[:, sorted(set(loads))]
    free = modes(k, m, rigid)[1][:, :rigid]
    b = m @ free
    f = f - b @ np.linalg.solve(m, b).T @ f                                # rigid modes r = M^-1 b: f - M r r' f
    bordered = np.block([[k, b], [b.T, np.zeros((rigid, rigid))]])
    x = np.linalg.solve(bordered, np.vstack([f, np.zeros((rigid, f.shape[1]))]))[: len(k)]
    x = np.hstack([x, free])
    # In the coordinates y = L' x (M = L L') orthonormal is what it is in a textbook.
    lower = np.linalg.cholesky(m)
    y, p = lower.T @ x, lower.T @ phi
    y = y / np.linalg.norm(y, axis=0)
    for _ in range(2):
        y = y - p @ (p.T @ y)
    u, s, _ = np.linalg.svd(y, full_matrices=False)
    x = np.linalg.solve(lower.T, u[:, s > 1e-8])                           # the rest is in phi already
    return x @ np.linalg.eigh(x.T @ (k + support) @ x)[1] if x.shape[1] else x
