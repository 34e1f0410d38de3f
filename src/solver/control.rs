//! What the control of the step length remembers from step to step.

use serde::{Deserialize, Serialize};

use super::Piece;

/// Pieces of a law are told apart by their number modulo this.
const KINDS: usize = 8;
/// The motion may be ahead of time by this part of the tolerance, between these bounds, of a step; then a step makes up for it.
/// Lengths cannot be told apart below the first one (see [`super::grid::canonical`]).
const AHEAD: f64 = 0.25;
const AHEAD_WITHIN: (f64, f64) = (1e-9, 1e-5);

/// Memory of the step control; one entry per monitor in each list.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(super) struct Control {
    /// Step that the last error estimates ask for [s]; 0 before the first step.
    pub(super) wanted_step: f64,
    /// The same when last in each piece of each law: a ramp asks for shorter steps than what lies between ramps. 0 where unknown.
    by_piece: Vec<[f64; KINDS]>,
    /// By how much longer the steps so far were than the time they took [s]: lengths are rounded.
    ahead: f64,
    /// Time over which the mean squares run [s].
    pub(super) elapsed: f64,
    /// Time integral of the square of what is monitored.
    pub(super) squares: Vec<f64>,
    /// Recent peaks of two derivatives of what is monitored, where the method needs them.
    pub(super) peaks: Vec<[f64; 2]>,
}

impl Control {
    /// Nothing remembered.
    pub(super) fn new(monitors: usize, laws: usize) -> Control {
        Control {
            wanted_step: 0.0,
            by_piece: vec![[0.0; KINDS]; laws],
            ahead: 0.0,
            elapsed: 0.0,
            squares: vec![0.0; monitors],
            peaks: vec![[0.0; 2]; monitors],
        }
    }

    /// Step to try in these pieces [s]: the shortest that any of them asks for.
    pub(super) fn step_in(&self, pieces: &[Piece]) -> f64 {
        let mut shortest = f64::INFINITY;
        for (wanted, piece) in self.by_piece.iter().zip(pieces) {
            let wanted = wanted[piece.index % KINDS];
            if wanted > 0.0 && wanted < shortest {
                shortest = wanted;
            }
        }
        if shortest < f64::INFINITY {
            shortest
        } else {
            self.wanted_step
        }
    }

    /// The last step in these pieces, of which the shortest wanted step has decided, asks for this one [s], or at least for it. What
    /// decided takes it over; the others keep what is longer, so that this one is the shortest now.
    pub(super) fn want(&mut self, step: f64, at_least: bool, (decided, pieces): (f64, &[Piece])) {
        let step = if at_least { step.max(decided) } else { step };
        self.wanted_step = step;
        for (wanted, piece) in self.by_piece.iter_mut().zip(pieces) {
            let wanted = &mut wanted[piece.index % KINDS];
            if *wanted <= decided || *wanted < step {
                *wanted = step;
            }
        }
    }

    /// What a step of such a length is to make up for [s]: nothing where the motion is hardly ahead of time or behind. What
    /// rotates freely would otherwise be so much further or less far in the end, however small the tolerance.
    pub(super) fn due(&self, step: f64, tolerance: f64) -> f64 {
        let allowed = (AHEAD * tolerance).clamp(AHEAD_WITHIN.0, AHEAD_WITHIN.1);
        if self.ahead.abs() < allowed * step {
            0.0
        } else {
            self.ahead
        }
    }

    /// A step of this length has taken so much time [s].
    pub(super) fn took(&mut self, length: f64, time: f64) {
        self.ahead += length - time;
    }

    /// Becomes the same as another one in what steps ask for, and in how far they have come.
    pub(super) fn go_on_like(&mut self, other: &Control) {
        self.wanted_step = other.wanted_step;
        self.ahead = other.ahead;
        self.by_piece.copy_from_slice(&other.by_piece);
    }

    /// Lengths of the lists.
    pub(super) fn lengths(&self) -> [usize; 3] {
        [self.squares.len(), self.peaks.len(), self.by_piece.len()]
    }

    /// Whether all numbers are finite and none is negative.
    pub(super) fn is_valid(&self) -> bool {
        let numbers = self.squares.iter().chain(self.peaks.iter().flatten());
        let numbers = numbers.chain(self.by_piece.iter().flatten());
        let mut numbers = numbers.chain([&self.wanted_step, &self.elapsed]);
        numbers.all(|number| number.is_finite() && *number >= 0.0) && self.ahead.is_finite()
    }

    /// Becomes the same as another one of the same system, without allocation.
    pub(super) fn copy_from(&mut self, other: &Control) {
        self.go_on_like(other);
        self.elapsed = other.elapsed;
        self.squares.copy_from_slice(&other.squares);
        self.peaks.copy_from_slice(&other.peaks);
    }
}
