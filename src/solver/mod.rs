//! Time integration of a second-order system whose linear part falls into small blocks that a few
//! scalar forces couple.
//!
//! ```text
//!   q'' + D q' + K q = f(t) - sum over m of b_m F_m         unit mass matrix; D, K block diagonal
//!   F = F(t, d, d'),   d_m = w_m q                          one force per coupling, along one row
//! ```
//!
//! The system's constant part is a [`System`]; what varies is asked of a [`Forcing`]. Its laws are smooth
//! **pieces**: some end at times known in advance (breakpoints), others when the motion ends them (a contact
//! opens); steps end exactly there. Two integrators know how to step: [`Exponential`] and [`Newmark`].
//! Knows no gears, no modes and no files.

mod control;
mod error;
mod exponential;
mod integrator;
mod march;
mod newmark;
mod row;

use nalgebra::DMatrix;
use serde::{Deserialize, Serialize};

pub use error::StepError;
pub use exponential::Exponential;
pub use integrator::Integrator;
pub use newmark::Newmark;
pub use row::Row;

use crate::linalg::multiply_add;
use control::Control;
use exponential::Turning;

/// The constant part of the equations of motion.
#[derive(Debug, Clone, Default)]
pub struct System {
    /// Number of coordinates.
    pub size: usize,
    /// The diagonal blocks, contiguous and in order, at the first values of the slow parameters.
    pub blocks: Vec<Block>,
    /// The forces between and on the blocks.
    pub couplings: Vec<Coupling>,
    /// The columns along which the outside loads the coordinates, each within one block.
    pub loads: Vec<Row>,
    /// Number of laws that have pieces.
    pub laws: usize,
    /// First values of the slow parameters, on which the blocks may depend.
    pub slow: Vec<f64>,
    /// What the tolerance holds for.
    pub monitors: Vec<Monitor>,
}

/// Forces whose error is controlled relative to their own RMS over the run.
#[derive(Debug, Clone)]
pub struct Monitor {
    /// The couplings that make up the force; none for a displacement that only the linear part moves.
    pub couplings: core::ops::Range<usize>,
    /// The couplings whose deflections are to be right where they are what matters, and not a force.
    pub motion: core::ops::Range<usize>,
    /// The displacement that the force belongs to is `row * q`.
    pub row: Row,
    /// Damping ratio of the most lightly damped fast motion in it: how long an error of phase lasts.
    pub damping_ratio: f64,
    /// Circular frequency that the force gives the displacement by itself [rad/s].
    pub frequency: f64,
    /// Damping per stiffness of the force [s].
    pub rate_weight: f64,
    /// What an error of deflection counts, in force per deflection, where the force at the moment may hide it: that of teeth
    /// in flight or of a contact just opening. 0 for forces that show it always.
    pub stiffness: f64,
    /// Forces below this count as zero.
    pub floor: f64,
}

/// One diagonal block: coordinates `offset .. offset + n`, damping and stiffness n x n.
#[derive(Debug, Clone)]
pub struct Block {
    /// Index of the block's first coordinate.
    pub offset: usize,
    /// D [1/s].
    pub damping: DMatrix<f64>,
    /// K [1/s^2].
    pub stiffness: DMatrix<f64>,
}

/// A scalar force: deflection `row * q`, force on the coordinates `-column * F`.
#[derive(Debug, Clone)]
pub struct Coupling {
    /// w; empty where the force follows from time or from other couplings alone.
    pub row: Row,
    /// b; equal to w where the force follows from a potential, empty where it only observes.
    pub column: Row,
}

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
    /// The first time clearly after `time` at which the piece of some law ends whatever the motion; infinity
    /// when there is none.
    fn next_breakpoint(&self, time: f64) -> f64;
    /// How far from a breakpoint a step may end without harm to a solution of this tolerance [s]: pieces that join smoothly may be
    /// continued a little; 0 where one jumps or has a kink.
    fn slack(&self, tolerance: f64) -> f64;
    /// The piece of every law in a stretch that begins with `start` and contains the time `inside`.
    fn enter(&self, start: Instant<'_>, inside: f64, pieces: &mut [Piece]);
    /// F of every coupling, each law continued smoothly from its piece.
    fn forces_into(&self, at: Instant<'_>, pieces: &[Piece], forces: &mut [f64]);
    /// Whether all forces are straight lines in their own deflection and rate while their pieces last.
    fn is_straight(&self) -> bool;
    /// These lines at a time, for every coupling.
    fn lines_into(&self, time: f64, pieces: &[Piece], lines: &mut [Line]);
    /// For every coupling how its own force depends on its own deflection and rate, as far as that is fast.
    fn tangents_into(&self, at: Instant<'_>, pieces: &[Piece], tangents: &mut [Spring]);
    /// Positive while the motion keeps a law in its piece; infinity where only time ends the piece.
    fn margin(&self, law: usize, piece: Piece, at: Instant<'_>) -> f64;
    /// The piece that follows when the motion has ended one.
    fn next_piece(&self, law: usize, piece: Piece, at: Instant<'_>) -> Piece;
    /// The slow parameters in this motion.
    fn slow_into(&self, position: &[f64], velocity: &[f64], slow: &mut [f64]);
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

/// A force as a straight line in deflection and rate.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Line {
    /// Its slopes.
    pub spring: Spring,
    /// Its value at rest.
    pub rest: f64,
}

/// Everything that moves: what a snapshot has to keep so that the continuation is the same to the bit.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct State {
    /// Time [s].
    pub time: f64,
    /// q: the best value the solver has.
    pub position: Vec<f64>,
    /// q'.
    pub velocity: Vec<f64>,
    /// The solutions of Newmark's method, from which that value comes; none for the other one.
    tracks: Vec<Track>,
    /// The same motion in the decoupled states of the exponential method; none before its first step.
    decoupled: Vec<f64>,
    /// Where that method has turned the harmonics.
    turning: Turning,
    /// The slow parameters that the blocks in use belong to.
    slow: Vec<f64>,
    control: Control,
}

/// One numerical solution.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
struct Track {
    position: Vec<f64>,
    velocity: Vec<f64>,
}

/// Work done so far.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Counts {
    /// Accepted steps.
    pub steps: u64,
    /// Steps repeated because their error was too large.
    pub rejected: u64,
    /// Step lengths for which coefficients had to be computed.
    pub factorizations: u64,
    /// Evaluations of all forces.
    pub evaluations: u64,
    /// Pieces that the motion ended.
    pub events: u64,
    /// Times that the blocks were made anew.
    pub refreshes: u64,
}

impl System {
    /// The state with these displacements and velocities at `time`, one entry per coordinate, for a solver
    /// that carries `tracks` solutions of its own.
    fn state_at(&self, time: f64, position: Vec<f64>, velocity: Vec<f64>, tracks: usize) -> State {
        let track = Track {
            position: position.clone(),
            velocity: velocity.clone(),
        };
        State {
            time,
            position,
            velocity,
            tracks: vec![track; tracks],
            decoupled: Vec::with_capacity(2 * self.size), // so that steps allocate nothing
            turning: Turning::default(),
            slow: self.slow.clone(),
            control: Control::new(self.monitors.len()),
        }
    }

    /// q'' in a state, just after its time.
    pub fn acceleration(&self, forcing: &impl Forcing, state: &State) -> Vec<f64> {
        let State {
            time,
            position,
            velocity,
            ..
        } = state;
        let zeros = || vec![0.0; self.couplings.len()];
        let (mut deflection, mut rate, mut forces) = (zeros(), zeros(), zeros());
        self.deflections_into(position, velocity, &mut deflection, &mut rate);
        let at = Instant {
            time: *time,
            deflection: &deflection,
            rate: &rate,
            slow: &self.slow,
        };
        let mut pieces = vec![Piece::default(); self.laws];
        let inside = forcing.next_breakpoint(*time).min(time + 1.0);
        forcing.enter(at, 0.5 * (time + inside), &mut pieces);
        forcing.forces_into(at, &pieces, &mut forces);
        let mut acceleration = vec![0.0; self.size];
        forcing.load_into(self, *time, &mut acceleration);
        for block in &self.blocks {
            let range = block.range();
            let target = &mut acceleration[range.clone()];
            multiply_add(
                -1.0,
                block.damping.as_slice(),
                &velocity[range.clone()],
                target,
            );
            multiply_add(-1.0, block.stiffness.as_slice(), &position[range], target);
        }
        for (coupling, force) in self.couplings.iter().zip(&forces) {
            coupling.column.add_to(-force, &mut acceleration);
        }
        acceleration
    }

    /// d and d' of every coupling.
    fn deflections_into(
        &self,
        position: &[f64],
        velocity: &[f64],
        deflection: &mut [f64],
        rate: &mut [f64],
    ) {
        for ((coupling, deflection), rate) in self.couplings.iter().zip(deflection).zip(rate) {
            *deflection = coupling.row.dot(position);
            *rate = coupling.row.dot(velocity);
        }
    }
}

impl State {
    /// Whether another state has the same shape and consists of finite numbers.
    pub fn is_like(&self, other: &State) -> bool {
        let lengths = |state: &State| {
            let tracks = state.tracks.iter();
            let own = [state.position.len(), state.velocity.len(), state.slow.len()];
            let control = state.control.lengths();
            tracks
                .flat_map(|track| [track.position.len(), track.velocity.len()])
                .chain(own)
                .chain(control)
                .collect::<Vec<usize>>()
        };
        let tracks = self
            .tracks
            .iter()
            .flat_map(|track| track.position.iter().chain(&track.velocity));
        let numbers = tracks
            .chain(&self.position)
            .chain(&self.velocity)
            .chain(&self.decoupled)
            .chain(&self.slow);
        let states = [0, 2 * self.position.len()];
        lengths(self) == lengths(other)
            && states.contains(&self.decoupled.len())
            && self.turning.is_like(&other.turning)
            && self.time.is_finite()
            && numbers.copied().all(f64::is_finite)
            && self.control.is_valid()
    }

    /// Becomes the same as another state of the same system, without allocation.
    pub fn copy_from(&mut self, other: &State) {
        self.time = other.time;
        self.position.clone_from(&other.position);
        self.velocity.clone_from(&other.velocity);
        self.decoupled.clone_from(&other.decoupled);
        self.turning.copy_from(&other.turning);
        self.slow.clone_from(&other.slow);
        self.control.copy_from(&other.control);
        copy_tracks(&mut self.tracks, &other.tracks);
    }
}

impl Line {
    /// The force.
    pub fn at(&self, deflection: f64, rate: f64) -> f64 {
        self.spring.stiffness * deflection + self.spring.damping * rate + self.rest
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
    fn on_block(&self, block: &Block) -> Option<[Vec<f64>; 2]> {
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

/// Copies solutions without allocation, which the derived `clone_from` would need.
fn copy_tracks(target: &mut [Track], source: &[Track]) {
    for (target, source) in target.iter_mut().zip(source) {
        target.position.clone_from(&source.position);
        target.velocity.clone_from(&source.velocity);
    }
}

impl Block {
    /// Number of coordinates.
    pub fn len(&self) -> usize {
        self.stiffness.nrows()
    }

    /// Whether the block has no coordinates.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The block's coordinates.
    pub fn range(&self) -> core::ops::Range<usize> {
        self.offset..self.offset + self.len()
    }
}
