//! What varies in a [`System`]: forces of couplings, loads, and slow parameters.

use super::{Block, System};

/// What the couplings see at one instant.
#[derive(Debug, Clone, Copy)]
pub struct Instant<'a> {
    /// Time [s].
    pub time: f64,
    /// d of every coupling.
    pub deflection: &'a [f64],
    /// d' of every coupling.
    pub rate: &'a [f64],
    /// The values of the slow parameters that the blocks in use belong to.
    pub slow: &'a [f64],
}

/// What varies.
pub trait Forcing {
    /// What acts along [`System::loads`].
    fn loads(&self) -> &[Ramp];
    /// When these have their first values [s]: the start of the call, at which the state is.
    fn since(&self) -> f64;
    /// The parts of f that turn with fixed frequencies.
    fn harmonics(&self) -> &[Harmonic];
    /// Chooses the pieces that end whatever the motion, those that hold just after `time`, and gives when the first of them ends;
    /// infinity when none does.
    fn follow_time(&self, time: f64, pieces: &mut [Piece]) -> f64;
    /// Chooses the others, for a stretch that begins with `start`.
    fn follow_motion(&self, start: Instant<'_>, pieces: &mut [Piece]);
    /// How far from a breakpoint a step may end without harm to a solution of this tolerance [s]: pieces that join smoothly may be
    /// continued a little; 0 where one jumps or has a kink.
    fn slack(&self, tolerance: f64) -> f64;
    /// F of every coupling, each law continued smoothly from its piece.
    fn forces_into(&self, at: Instant<'_>, pieces: &[Piece], forces: &mut [f64]);
    /// The same, and for every coupling how its own force depends on its own deflection and rate, as far as that is fast.
    fn springs_into(
        &self,
        at: Instant<'_>,
        pieces: &[Piece],
        forces: &mut [f64],
        tangents: &mut [Spring],
    );
    /// Whether all forces are straight lines in their own deflection and rate while their pieces last.
    fn is_straight(&self) -> bool;
    /// These lines at some times, for every coupling.
    fn lines_into<const N: usize>(&self, times: [f64; N], pieces: &[Piece], lines: &mut [Lines<N>]);
    /// Whether time alone ends pieces.
    fn is_timed(&self) -> bool;
    /// Positive while the motion keeps a law in its piece; infinity where only time ends the piece.
    fn margin(&self, law: usize, piece: Piece, at: Instant<'_>) -> f64;
    /// The piece that follows when the motion has ended one.
    fn next_piece(&self, law: usize, piece: Piece, at: Instant<'_>) -> Piece;
    /// The slow parameters where couplings see these rates.
    fn slow_into(&self, rates: &[f64], slow: &mut [f64]);
    /// Whether the blocks should be made anew: `used` are the values they belong to, `now` the present ones.
    fn is_stale(&self, used: &[f64], now: &[f64]) -> bool;
    /// Overwrites the blocks with those of these slow parameters.
    fn blocks_into(&self, slow: &[f64], blocks: &mut [Block]);

    /// f(t): overwrites `load`, one entry per coordinate.
    fn load_into(&self, system: &System, time: f64, load: &mut [f64]) {
        load.fill(0.0);
        for (column, ramp) in system.loads.iter().zip(self.loads()) {
            column.add_to(ramp.after(time - self.since()), load);
        }
        for harmonic in self.harmonics() {
            let (sine, cosine) = libm::sincos(harmonic.angle(time));
            let target = &mut load[harmonic.offset..];
            for ((entry, c), s) in target.iter_mut().zip(&harmonic.cosine).zip(&harmonic.sine) {
                *entry += c * cosine + s * sine;
            }
        }
    }
}

/// A load that changes linearly during a call: first + rate (t - since).
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Ramp {
    /// The first value.
    pub first: f64,
    /// Change per second.
    pub rate: f64,
}

/// A load that turns with a fixed circular frequency: cosine cos(w t + phase) + sine sin(w t + phase).
#[derive(Debug, Clone)]
pub struct Harmonic {
    /// w [rad/s].
    pub frequency: f64,
    /// Angle at time 0 [rad].
    pub phase: f64,
    /// First coordinate of both parts.
    pub offset: usize,
    /// Load at the angle 0.
    pub cosine: Vec<f64>,
    /// Load at a quarter turn.
    pub sine: Vec<f64>,
}

/// A smooth piece of a law; only the [`Forcing`] that made it can read it.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Piece {
    /// Where the argument of a periodic law is counted from: the period the piece lies in.
    pub origin: f64,
    /// Which piece.
    pub index: usize,
}

/// A tangent of a force.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Spring {
    /// dF/dd.
    pub stiffness: f64,
    /// dF/dd'.
    pub damping: f64,
}

/// A force as straight lines in deflection and rate, at N times.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Lines<const N: usize> {
    /// dF/dd.
    pub stiffness: [f64; N],
    /// dF/dd'.
    pub damping: [f64; N],
    /// The force at rest.
    pub rest: [f64; N],
}

impl<const N: usize> Lines<N> {
    /// No force.
    pub const ZERO: Lines<N> = Lines {
        stiffness: [0.0; N],
        damping: [0.0; N],
        rest: [0.0; N],
    };

    /// The force on one of them.
    #[inline(always)]
    pub fn at(&self, index: usize, deflection: f64, rate: f64) -> f64 {
        self.stiffness[index] * deflection + self.damping[index] * rate + self.rest[index]
    }
}

impl Ramp {
    /// The value after some seconds.
    pub fn after(self, elapsed: f64) -> f64 {
        self.first + self.rate * elapsed
    }
}

impl Harmonic {
    /// w t + phase [rad].
    pub fn angle(&self, time: f64) -> f64 {
        self.frequency * time + self.phase
    }

    /// Cosine and sine load of a block; `None` where both are zero.
    pub(super) fn on_block(&self, block: &Block) -> Option<[Vec<f64>; 2]> {
        let part = |load: &[f64]| -> Vec<f64> {
            let entry = |i: usize| {
                i.checked_sub(self.offset)
                    .and_then(|i| load.get(i))
                    .copied()
            };
            block.range().map(|i| entry(i).unwrap_or(0.0)).collect()
        };
        let parts = [part(&self.cosine), part(&self.sine)];
        parts
            .iter()
            .flatten()
            .any(|&value| value != 0.0)
            .then_some(parts)
    }
}
