//! The law of one mesh: how hard its teeth push in a given motion.
//!
//! ```text
//!   phase      p = p_0 + s z_a phi_a / 2 pi          phi_a = phi_0 + Om t, in free spin the angle of gear a
//!   bilateral  F = k(p) (delta - e) + c (delta' - e')
//!   unilateral on the reference flank the same where both delta - e and F are positive, else 0; on the back flank with its own
//!              line of action, +e and the backlash b: F = k(p) (delta_back + e - b) + c (delta_back' + e')
//! ```
//!
//! Where the paper's equation (6) is taken literally, the torque follows the rotational part of delta alone.

use super::Mesh;
use crate::mesh::StiffnessLaw;
use crate::solver::{Instant, Lines, Piece, Spring};

/// A flank of a unilateral mesh that carries nothing, and one that does: pieces of its law.
const OPEN: usize = 0;
const CLOSED: usize = 1;

/// Breakpoints closer than this [pitches] to the present phase are behind, and closer than rounding of the
/// phase, which grows over a long run.
const PASSED: f64 = 1e-9;

/// Where a mesh is in its cycle.
#[derive(Debug, Clone, Copy)]
pub(super) struct Phase {
    /// p [pitches].
    pub(super) value: f64,
    /// p' [pitches/s].
    pub(super) rate: f64,
}

/// Deflection of a flank beyond its transmission error and backlash [m], and its rate [m/s].
#[derive(Debug, Clone, Copy)]
pub(super) struct Compression {
    pub(super) depth: f64,
    pub(super) rate: f64,
}

impl Mesh {
    /// Number of laws with pieces: the stiffness, and each flank that can part.
    pub(super) fn law_count(&self) -> usize {
        if self.backlash.is_some() { 3 } else { 1 }
    }

    /// The phase in a motion.
    pub(super) fn phase(&self, at: Instant<'_>) -> Phase {
        match self.turning {
            None => self.phase_at(at.time),
            Some(coupling) => self.phase_of(at.deflection[coupling], at.rate[coupling]),
        }
    }

    /// The phase at a time, at prescribed speed.
    #[inline(always)]
    pub(super) fn phase_at(&self, time: f64) -> Phase {
        Phase {
            value: self.start_phase + self.phase_rate * time,
            rate: self.phase_rate,
        }
    }

    /// The phase when gear a has turned by an angle [rad], with its angular velocity [rad/s].
    pub(super) fn phase_of(&self, angle: f64, velocity: f64) -> Phase {
        Phase {
            value: self.start_phase + self.pitches * angle,
            rate: self.pitches * velocity,
        }
    }

    /// k [N/m]; at a jump the value that holds from then on.
    pub(super) fn stiffness(&self, phase: Phase) -> f64 {
        self.stiffness_in(piece_of(&self.law, phase.ahead()), phase)
    }

    fn stiffness_in(&self, piece: Piece, phase: Phase) -> f64 {
        let [stiffness] = self.stiffnesses(piece, [phase.value]);
        stiffness
    }

    /// Transmission error [m] and its rate [m/s].
    pub(super) fn error_at(&self, phase: Phase) -> [f64; 2] {
        let [[error], [slope]] = self.error.values_and_slopes([phase.value]);
        [error, slope * phase.rate]
    }

    /// Compression of a flank (0 reference, 1 back) from transmission error and deflection, each with its rate.
    pub(super) fn compression(
        &self,
        flank: usize,
        error: [f64; 2],
        motion: [f64; 2],
    ) -> Compression {
        let (sign, gap) = if flank == 0 {
            (1.0, 0.0)
        } else {
            (-1.0, self.backlash.unwrap_or(0.0))
        };
        Compression {
            depth: motion[0] - sign * error[0] - gap,
            rate: motion[1] - sign * error[1],
        }
    }

    /// dk/dp [N/m per pitch]; at a jump that of the piece that holds from then on.
    pub(super) fn stiffness_slope(&self, phase: Phase) -> f64 {
        let piece = piece_of(&self.law, phase.ahead());
        self.factor * self.law.slope(phase.value - piece.origin, piece.index)
    }

    /// How a compression changes with the phase and with its deflection and rate.
    pub(super) fn compression_change(
        &self,
        flank: usize,
        phase: Phase,
        change: Phase,
        motion: [f64; 2],
    ) -> Compression {
        let sign = if flank == 0 { 1.0 } else { -1.0 };
        let [_, [slope]] = self.error.values_and_slopes([phase.value]);
        let curvature = self.error.curvature(phase.value);
        Compression {
            depth: motion[0] - sign * slope * change.value,
            rate: motion[1] - sign * (curvature * change.value * phase.rate + slope * change.rate),
        }
    }

    /// k [N/m] in some phases, continued smoothly from a piece.
    #[inline(always)]
    fn stiffnesses<const N: usize>(&self, piece: Piece, phases: [f64; N]) -> [f64; N] {
        let cycles = phases.map(|phase| phase - piece.origin);
        let values = self.law.values(cycles, piece.index);
        values.map(|value| self.factor * value)
    }

    /// Overwrites the lines of the mesh's couplings at some times, at prescribed speed.
    #[inline(always)]
    pub(super) fn lines_into<const N: usize>(
        &self,
        times: [f64; N],
        pieces: &[Piece],
        lines: &mut [Lines<N>],
    ) {
        let phases = times.map(|time| self.phase_at(time).value);
        let stiffness = self.stiffnesses(pieces[self.first_law], phases);
        let phases = || times.map(|time| self.phase_at(time));
        self.lines_with(
            stiffness,
            phases,
            pieces,
            &mut lines[self.couplings.clone()],
        );
    }

    /// Overwrites the lines of the mesh's couplings with these stiffnesses in some phases: those of each flank, or of what the torque
    /// follows.
    #[inline(always)]
    fn lines_with<const N: usize>(
        &self,
        stiffness: [f64; N],
        phases: impl Fn() -> [Phase; N],
        pieces: &[Piece],
        lines: &mut [Lines<N>],
    ) {
        for lines in &mut *lines {
            *lines = Lines {
                stiffness,
                damping: [self.damping; N],
                rest: [0.0; N],
            };
        }
        if self.backlash.is_some() || !self.error.is_zero() {
            self.shift(phases(), pieces, lines);
        }
    }

    /// Moves the lines of the flanks by transmission error and backlash; nothing remains of those of an open one.
    #[inline(always)]
    fn shift<const N: usize>(&self, phases: [Phase; N], pieces: &[Piece], lines: &mut [Lines<N>]) {
        let [errors, slopes] = self
            .error
            .values_and_slopes(phases.map(|phase| phase.value));
        // Without backlash the second coupling follows the rotations alone.
        let flanks = if self.backlash.is_some() { 2 } else { 1 };
        for (flank, lines) in lines.iter_mut().enumerate().take(flanks) {
            if self.backlash.is_some() && pieces[self.first_law + 1 + flank].index == OPEN {
                *lines = Lines::ZERO;
                continue;
            }
            for i in 0..N {
                let error = [errors[i], slopes[i] * phases[i].rate];
                let still = self.compression(flank, error, [0.0; 2]);
                lines.rest[i] = self.held_force(lines.stiffness[i], still);
            }
        }
    }

    /// F of a flank with stiffness k; 0 where a unilateral flank is open.
    pub(super) fn flank_force(&self, k: f64, compression: Compression) -> f64 {
        let force = self.held_force(k, compression);
        let open = self.backlash.is_some() && !(compression.depth > 0.0 && force > 0.0);
        if open { 0.0 } else { force }
    }

    /// k d + c d'.
    fn held_force(&self, k: f64, Compression { depth, rate }: Compression) -> f64 {
        k * depth + self.damping * rate
    }

    /// Overwrites the forces of the mesh's couplings, and their tangents where these are wanted.
    pub(super) fn forces_into(
        &self,
        at: Instant<'_>,
        pieces: &[Piece],
        forces: &mut [f64],
        mut tangents: Option<&mut [Spring]>,
    ) {
        let phase = self.phase(at);
        let stiffness = self.stiffnesses(pieces[self.first_law], [phase.value]);
        let mut lines = [Lines::ZERO; 2];
        let lines = &mut lines[..self.couplings.len()];
        self.lines_with(stiffness, || [phase], pieces, lines);
        for (coupling, line) in self.couplings.clone().zip(lines) {
            forces[coupling] = line.at(0, at.deflection[coupling], at.rate[coupling]);
            if let Some(tangents) = &mut tangents {
                tangents[coupling] = Spring {
                    stiffness: line.stiffness[0],
                    damping: line.damping[0],
                };
            }
        }
        if let Some(observer) = self.turning {
            forces[observer] = 0.0;
        }
    }

    /// Chooses the piece of the stiffness just after a time at prescribed speed, and gives when it ends; infinity where it does not,
    /// or where the motion ends it.
    pub(super) fn follow_time(&self, time: f64, pieces: &mut [Piece]) -> f64 {
        if self.turning.is_some() {
            return f64::INFINITY;
        }
        let piece = piece_of(&self.law, self.phase_at(time).ahead());
        pieces[self.first_law] = piece;
        if self.law.is_smooth() || self.phase_rate == 0.0 {
            return f64::INFINITY;
        }
        let [start, end] = self.ends(piece);
        let next = if self.phase_rate > 0.0 { end } else { start };
        (piece.origin + next - self.start_phase) / self.phase_rate
    }

    /// Chooses the other pieces, for a stretch that begins with `start`: what the flanks do, and in free spin the stiffness.
    pub(super) fn follow_motion(&self, start: Instant<'_>, pieces: &mut [Piece]) {
        if self.turning.is_some() {
            pieces[self.first_law] = piece_of(&self.law, self.phase(start).ahead());
        }
        if self.backlash.is_some() {
            for flank in [0, 1] {
                let stiffness = pieces[self.first_law];
                let closed = self.contact_margin(flank, |_| stiffness, start) > 0.0;
                pieces[self.first_law + 1 + flank].index = if closed { CLOSED } else { OPEN };
            }
        }
    }

    /// Positive where a flank is pressed together and would push: in metres. Only the force of a flank that is being relieved depends
    /// on the piece of the stiffness.
    fn contact_margin(
        &self,
        flank: usize,
        stiffness: impl Fn(Phase) -> Piece,
        at: Instant<'_>,
    ) -> f64 {
        let phase = self.phase(at);
        let coupling = self.couplings.start + flank;
        let motion = [at.deflection[coupling], at.rate[coupling]];
        let Compression { depth, rate } = self.compression(flank, self.error_at(phase), motion);
        if rate >= 0.0 {
            return depth; // the damper pushes, too
        }
        depth + self.damping / self.stiffness_in(stiffness(phase), phase) * rate
    }

    /// Whether time alone ends pieces of its laws.
    pub(super) fn is_timed(&self) -> bool {
        self.backlash.is_none() && self.turning.is_none()
    }

    /// Positive while the motion keeps law number `law` of the mesh in its piece.
    pub(super) fn margin(&self, law: usize, piece: Piece, at: Instant<'_>) -> f64 {
        if law == 0 {
            if self.turning.is_none() || self.law.is_smooth() {
                return f64::INFINITY;
            }
            let cycle = self.phase(at).value - piece.origin;
            let [start, end] = self.ends(piece);
            return (cycle - start).min(end - cycle);
        }
        // The stiffness that the contact is judged with: at its breakpoints the contact is entered anew.
        let stiffness = |phase: Phase| piece_of(&self.law, phase.value);
        let margin = self.contact_margin(law - 1, stiffness, at);
        if piece.index == CLOSED {
            margin
        } else {
            -margin
        }
    }

    /// The piece that follows when the motion has ended one of law number `law`.
    pub(super) fn next_piece(&self, law: usize, piece: Piece, at: Instant<'_>) -> Piece {
        if law > 0 {
            let index = if piece.index == OPEN { CLOSED } else { OPEN };
            return Piece { index, ..piece };
        }
        let [start, end] = self.ends(piece);
        let cycle = self.phase(at).value - piece.origin;
        let last = self.law.starts().len() - 1; // a law has a first piece
        let (origin, index) = (piece.origin, piece.index);
        let (origin, index) = match 2.0 * cycle > start + end {
            true if index == last => (origin + 1.0, 0),
            true => (origin, index + 1),
            false if index == 0 => (origin - 1.0, last),
            false => (origin, index - 1),
        };
        Piece { origin, index }
    }

    /// Start and end of a piece of the stiffness in its cycle.
    fn ends(&self, piece: Piece) -> [f64; 2] {
        let starts = self.law.starts();
        [
            starts[piece.index],
            starts.get(piece.index + 1).copied().unwrap_or(1.0),
        ]
    }

    /// How far from the end of a piece of the stiffness a step may end at prescribed speed [s].
    pub(super) fn slack(&self, tolerance: f64) -> f64 {
        if self.phase_rate == 0.0 {
            return f64::INFINITY; // the phase never comes there
        }
        self.law.slack(tolerance) / self.phase_rate.abs()
    }
}

impl Phase {
    /// The phase a moment later, beyond a breakpoint that has just been reached.
    fn ahead(self) -> f64 {
        self.value
            + PASSED
                .max(8.0 * f64::EPSILON * self.value.abs())
                .copysign(self.rate)
    }
}

fn piece_of(law: &StiffnessLaw, phase: f64) -> Piece {
    let origin = floor(phase);
    Piece {
        origin,
        index: law.piece(phase - origin),
    }
}

/// The largest integer not above a number, without the call that CPUs of every age need for it.
fn floor(phase: f64) -> f64 {
    let towards_zero = phase as i64 as f64; // beyond 2^63 a phase has lost all digits
    if towards_zero > phase {
        towards_zero - 1.0
    } else {
        towards_zero
    }
}

#[cfg(test)]
mod tests;
