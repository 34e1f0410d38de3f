"""Frequencies of the uncoupled rotors and of the whole train."""
import math

import numpy as np
from scipy.linalg import eig

from .system import System

TWO_PI = 2 * math.pi


def frequencies(model, full=False):
    """Uncoupled elastic frequencies [Hz] of the basis eigenproblem: {rotor: {"lateral": [...], "torsional": [...]}}."""
    s = model if isinstance(model, System) else System(model, full)
    return {name: dict(lateral=list(map(float, f[0])), torsional=list(map(float, f[1]))) for name, f in s.frequencies.items()}


def coupled(model, full=False):
    """Oscillating eigenvalues of the whole system with mean mesh stiffness and all teeth in contact on the reference
    flank, at the speeds of the file, by |lambda|; rigid and overdamped ones left out."""
    s = model if isinstance(model, System) else System(model, full)
    k, d = s.stiffness.copy(), s.damping.copy()
    if s.free:
        d += s.speed0[s.owner][:, None] * s.gyroscopic
    for b in s.bearings.values():
        if not b.linear:
            k += b.rows.T @ b.at_speed[0] @ b.rows
            d += b.rows.T @ b.at_speed[1] @ b.rows
    for m in s.meshes:
        for t in m.terms[:1] if m.terms[0].one_sided else m.terms:
            k += m.mean * np.outer(t.left, t.right)
            d += m.c * np.outer(t.left, t.right)
    a = np.block([[np.zeros_like(k), np.eye(s.n)], [-s.minv @ k, -s.minv @ d]])
    values = sorted((z for z in eig(a, right=False) if z.imag > TWO_PI * 0.05), key=abs)
    return [dict(frequency_hz=abs(z) / TWO_PI, damped_hz=z.imag / TWO_PI, damping_ratio=-z.real / abs(z)) for z in values]
