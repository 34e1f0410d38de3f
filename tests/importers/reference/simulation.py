"""Integration of the equations from event to event.

DOP853 runs over smooth pieces only.  At prescribed speed the mesh stiffness jumps at times known in advance; whatever
else switches is located inside the step, on its dense output, and the run begins anew there:

* a unilateral flank carries F = k d + c d' while min(d, F) > 0 (no adhesion),
* in free spin a mesh passes a breakpoint of k when its gear gets there, forward or backward,
* a bearing closes its clearance at r = clearance.
"""
import numpy as np
from scipy.integrate import DOP853
from scipy.optimize import brentq

from .equilibrium import equilibrium
from .outputs import outputs
from .system import System

PITCH_TOLERANCE = 1e-12      # of a breakpoint in free spin, in pitches: above the rounding of a phase


def simulate(model, t_end, times, rtol=1e-11, base_motion=None, torques=None, initial=None, full=False, knots=()):
    """All outputs of design 3 at `times`, and "state": the rows [q, q'].

    base_motion = {"rotor.bearing": t -> (x, y, vx, vy)}, torques = {"rotor.torque": t -> T}, smooth except at the times
    `knots`; initial = (q, q') overrides the start of the model file.
    """
    s = model if isinstance(model, System) else System(model, full)
    base_motion, torques, times = base_motion or {}, torques or {}, np.asarray(times, float)
    q, v = initial or start(s, base_motion, torques)
    y = np.concatenate([q, v])
    scale = np.repeat([1e-6, 1e-3], s.n)
    result = np.zeros((len(times), 2 * s.n))
    cuts = breakpoints(s, t_end, knots)
    switches = Switches(s, base_motion)
    for a, b in zip(cuts, cuts[1:]):
        switches.set(a, b, y)
        margin = 1e-9 * (b - a)                                            # inputs are not looked at across a knot

        def rhs(t, y):
            q, v = y[:s.n], y[s.n:]
            f = s.contact(t, q, v, switches.stiffness(t, q, v))[1] * switches.closed
            return np.concatenate([v, s.acceleration(min(max(t, a + margin), b - margin), q, v, f, base_motion, torques)])

        solver = DOP853(rhs, a, y, b, rtol=rtol, atol=rtol * scale)
        while solver.status == "running":
            message = solver.step()
            if solver.status == "failed":
                raise RuntimeError(message)
            t0, t, path = solver.t_old, solver.t, solver.dense_output()
            event = switches.first(t0, t, path)
            if event:
                t = max(event[0], t0 + 1e-6 * (t - t0))                    # a start on the switch must advance too
            inside = (times >= t0) & (times < t)
            if inside.any():
                result[inside] = path(times[inside]).T
            if event:
                y = path(t)
                switches.flip(event[1])
                if t >= b:
                    break
                solver = DOP853(rhs, t, y, b, rtol=rtol, atol=rtol * scale)
        else:
            y = solver.y
    result[times >= t_end] = y
    return outputs(s, times, result, base_motion)


def start(s, base_motion, torques):
    """q and q' at t = 0 (design 8.5)."""
    q = equilibrium(s, base_motion, torques) if s.model["simulation"]["start"] == "equilibrium" else np.zeros(s.n)
    return q, s.rigid @ s.speed0 if s.free else np.zeros(s.n)


def breakpoints(s, t_end, knots):
    """Where the run is cut from the outset."""
    times = sorted([*knots, *(t for m in s.meshes if not s.free for t in m.break_times(t_end))])
    merge = 2e-11 / max(abs(s.rate), default=1.0) if s.rate.any() else 1e-12 * t_end
    cuts = [0.0]
    for t in times:
        if cuts[-1] + merge < t < t_end - merge:
            cuts.append(t)
    return [*cuts, t_end]


class Switches:
    """What is different on the two sides of an event: `closed` contact terms, the `piece` of every k(p), `outside`
    bearings whose clearance is used up.  An event is an index into these three, in this order, each mesh twice."""

    def __init__(self, system, base_motion):
        self.s, self.base_motion = system, base_motion
        self.piece, self.closed = None, ~system.one_sided
        self.gaps = [(name, b) for name, b in system.bearings.items() if b.radial and b.radial.clearance > 0]
        self.outside = np.zeros(len(self.gaps), bool)
        # Look inside a step where something may switch twice, so that no short contact is missed.
        self.samples = 8 if system.one_sided.any() or self.gaps else 1 if system.free else 0

    def set(self, a, b, y):
        """For a run from time a, with no known breakpoint before b."""
        s, q, v = self.s, y[:self.s.n], y[self.s.n:]
        if not s.free:
            self.piece = [m.law.piece(p) for m, p in zip(s.meshes, s.phase((a + b) / 2, q, v)[0])]
        elif self.piece is None:
            self.piece = [m.law.piece(p) for m, p in zip(s.meshes, s.phase(a, q, v)[0])]
        self.closed = ~s.one_sided | (self._closing(a, q, v) > 0)
        self.outside = self._beyond(a, q) > 0

    def stiffness(self, t, q, v):
        """Of the mesh of every contact term, each in its piece."""
        k = [m.stiffness(p, i) for m, p, i in zip(self.s.meshes, self.s.phase(t, q, v)[0], self.piece)]
        return np.array(k)[self.s.mesh_of] if k else np.zeros(0)

    def _closing(self, t, q, v):
        return np.minimum(*self.s.contact(t, q, v, self.stiffness(t, q, v)))

    def _beyond(self, t, q):
        base = self.s.base(t, self.base_motion) if self.gaps else {}
        return np.array([b.radial.beyond(b.rows @ q - base[name][:2]) for name, b in self.gaps])

    def changed(self, t, y):
        """Positive where an event has passed."""
        s, q, v = self.s, y[:self.s.n], y[self.s.n:]
        contact = np.where(s.one_sided, self._closing(t, q, v) * np.where(self.closed, -1, 1), -1.0)
        phases = np.full(2 * len(s.meshes), -1.0)
        if s.free:
            for i, (m, p, piece) in enumerate(zip(s.meshes, s.phase(t, q, v)[0], self.piece)):
                if m.law.breaks:
                    phases[2 * i:2 * i + 2] = p - m.law.start(piece + 1), m.law.start(piece) - p
        return np.concatenate([contact, phases - PITCH_TOLERANCE, self._beyond(t, q) * np.where(self.outside, -1, 1)])

    def first(self, t0, t1, path):
        """(time, event) of the first event in a step, or None."""
        if not self.samples:
            return None
        grid = np.linspace(t0, t1, self.samples + 1)
        before = self.changed(t0, path(t0))
        for a, b in zip(grid, grid[1:]):
            after = self.changed(b, path(b))
            events = np.flatnonzero(after > 0)
            if len(events):
                def root(i):
                    return brentq(lambda t: self.changed(t, path(t))[i], a, b, xtol=1e-18) if before[i] < 0 else a
                return min((root(i), i) for i in events)
            before = after
        return None

    def flip(self, event):
        terms, meshes = len(self.closed), len(self.piece)
        if event < terms:
            self.closed[event] ^= True
        elif event < terms + 2 * meshes:
            mesh, backward = divmod(event - terms, 2)
            self.piece[mesh] += -1 if backward else 1
        else:
            self.outside[event - terms - 2 * meshes] ^= True
