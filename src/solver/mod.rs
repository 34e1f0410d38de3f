//! Time integration of a second-order system whose linear part falls into small blocks that a few
//! scalar springs couple.
//!
//! ```text
//!   q'' + D q' + K q = f(t) - sum over m of b_m F_m         unit mass matrix; D, K block diagonal
//!   F_m = k_m(t) d_m + c_m d_m',   d_m = w_m q              one spring per coupling, rank one
//! ```
//!
//! The system's constant part is a [`System`]; what varies in time is asked of a [`Forcing`]. Between two
//! neighbouring breakpoints every k_m and f is smooth, and steps end exactly there.
//! Knows no gears, no modes and no files.

mod newmark;

use core::fmt;

use nalgebra::DMatrix;

use crate::linalg::{add_scaled, dot};

pub use newmark::Newmark;

/// The constant part of the equations of motion.
#[derive(Debug, Clone, Default)]
pub struct System {
    /// Number of coordinates.
    pub size: usize,
    /// The diagonal blocks, contiguous and in order.
    pub blocks: Vec<Block>,
    /// The springs between the blocks.
    pub couplings: Vec<Coupling>,
    /// Displacements whose error is controlled.
    pub monitors: Vec<Monitor>,
}

/// A displacement whose error is controlled relative to its own RMS over the run.
#[derive(Debug, Clone)]
pub struct Monitor {
    /// The displacement is `row * q`.
    pub row: Row,
    /// Damping ratio of the most lightly damped fast motion in it: how long an error of phase lasts.
    pub damping_ratio: f64,
    /// Damping per stiffness of the force that belongs to the displacement [s].
    pub rate_weight: f64,
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

/// A scalar spring: deflection `row * q`, force on the coordinates `-column * F`.
#[derive(Debug, Clone)]
pub struct Coupling {
    /// w.
    pub row: Row,
    /// b; equal to w where the spring follows from a potential.
    pub column: Row,
}

/// A row vector that is zero outside a few blocks.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Row {
    parts: Vec<Part>,
}

#[derive(Debug, Clone, PartialEq)]
struct Part {
    block: usize,
    offset: usize,
    values: Vec<f64>,
}

/// What varies in time.
pub trait Forcing {
    /// f(t): overwrites `load`, one entry per coordinate.
    fn load_into(&self, time: f64, load: &mut [f64]);
    /// The first time clearly after `time` at which some k or f is not smooth; infinity when there is none.
    fn next_breakpoint(&self, time: f64) -> f64;
    /// For each coupling, the smooth piece of its law that `time` lies in.
    fn pieces_into(&self, time: f64, pieces: &mut [Piece]);
    /// The law of a coupling at `time`, continued smoothly from the given piece.
    fn spring(&self, coupling: usize, piece: Piece, time: f64) -> Spring;
}

/// A smooth piece of a periodic law; only the [`Forcing`] that made it can read it.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Piece {
    /// Where the argument of the law is counted from: the period the piece lies in.
    pub origin: f64,
    /// Which piece of the period.
    pub index: usize,
}

/// A coupling at one instant.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Spring {
    /// k.
    pub stiffness: f64,
    /// c.
    pub damping: f64,
}

/// Everything that moves: what a snapshot has to keep so that the continuation is the same to the bit.
#[derive(Debug, Clone, PartialEq)]
pub struct State {
    /// Time [s].
    pub time: f64,
    /// q: the best value the solver has.
    pub position: Vec<f64>,
    /// q'.
    pub velocity: Vec<f64>,
    /// The solver's own solutions, from which that value comes.
    tracks: [Track; 2],
    control: Control,
}

/// One numerical solution.
#[derive(Debug, Clone, PartialEq)]
struct Track {
    position: Vec<f64>,
    velocity: Vec<f64>,
}

/// Memory of the step control; one entry per monitor in each list.
#[derive(Debug, Clone, PartialEq)]
struct Control {
    /// Step that the last error estimates ask for [s]; 0 before the first step.
    wanted_step: f64,
    /// Time over which the mean squares run [s].
    elapsed: f64,
    /// Time integral of the square of the displacement.
    squares: Vec<f64>,
    /// Recent peaks of the displacement's second and fourth derivatives.
    peaks: Vec<[f64; 2]>,
}

/// Work done so far.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Counts {
    /// Accepted steps.
    pub steps: u64,
    /// Steps repeated because their error was too large.
    pub rejected: u64,
    /// Step lengths for which operators had to be computed.
    pub factorizations: u64,
}

/// Why an advance failed; the state is then the one before it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum StepError {
    /// The error bound would need steps that no longer change the time.
    StepTooSmall {
        /// Where [s].
        time: f64,
        /// The step asked for [s].
        step: f64,
    },
    /// The call asks for more work than one call should do.
    TooManySteps {
        /// How far it came [s].
        time: f64,
        /// Steps taken.
        steps: u64,
    },
    /// The solution left the range of numbers, as that of an unstable system does in the end.
    NotFinite {
        /// Where [s].
        time: f64,
    },
    /// The step's equations have no unique solution.
    Singular {
        /// Where [s].
        time: f64,
        /// The step [s].
        step: f64,
    },
}

impl System {
    /// The state with these displacements and no velocity at `time`; one entry per coordinate.
    pub fn state_at(&self, time: f64, position: Vec<f64>) -> State {
        let velocity = vec![0.0; self.size];
        let track = Track {
            position: position.clone(),
            velocity: velocity.clone(),
        };
        let control = Control {
            wanted_step: 0.0,
            elapsed: 0.0,
            squares: vec![0.0; self.monitors.len()],
            peaks: vec![[0.0; 2]; self.monitors.len()],
        };
        State {
            time,
            position,
            velocity,
            tracks: [track.clone(), track],
            control,
        }
    }
}

impl State {
    /// Becomes the same as another state of the same system, without allocation.
    pub fn copy_from(&mut self, other: &State) {
        self.time = other.time;
        self.position.clone_from(&other.position);
        self.velocity.clone_from(&other.velocity);
        self.control.wanted_step = other.control.wanted_step;
        self.control.elapsed = other.control.elapsed;
        self.control.squares.clone_from(&other.control.squares);
        self.control.peaks.clone_from(&other.control.peaks);
        copy_tracks(&mut self.tracks, &other.tracks);
    }
}

/// Copies both solutions without allocation, which the derived `clone_from` would need.
fn copy_tracks(target: &mut [Track; 2], source: &[Track; 2]) {
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

impl Row {
    /// A row over the coordinates of one block: number `block`, first coordinate `offset`.
    pub fn new(block: usize, offset: usize, values: Vec<f64>) -> Row {
        Row {
            parts: vec![Part {
                block,
                offset,
                values,
            }],
        }
    }

    /// This row grows by `scale` times another one.
    pub fn add(&mut self, scale: f64, other: &Row) {
        for part in &other.parts {
            match self.parts.iter_mut().find(|own| own.block == part.block) {
                Some(own) => add_scaled(scale, &part.values, &mut own.values),
                None => {
                    let values = part.values.iter().map(|value| scale * value).collect();
                    self.parts.push(Part { values, ..*part });
                }
            }
        }
    }

    /// The entry of one coordinate.
    pub fn entry(&self, coordinate: usize) -> f64 {
        let part = self
            .parts
            .iter()
            .find(|part| part.range().contains(&coordinate));
        part.map_or(0.0, |part| part.values[coordinate - part.offset])
    }

    /// All entries of a system of this size.
    pub fn to_dense(&self, size: usize) -> Vec<f64> {
        let mut dense = vec![0.0; size];
        self.add_to(1.0, &mut dense);
        dense
    }

    /// row * q.
    pub fn dot(&self, q: &[f64]) -> f64 {
        self.parts
            .iter()
            .map(|part| dot(&part.values, &q[part.range()]))
            .sum()
    }

    /// Product with another row: only blocks that both touch contribute.
    pub fn dot_row(&self, other: &Row) -> f64 {
        let mut sum = 0.0;
        for mine in &self.parts {
            for theirs in other.parts.iter().filter(|part| part.block == mine.block) {
                sum += dot(&mine.values, &theirs.values);
            }
        }
        sum
    }

    /// q += scale * row'.
    pub fn add_to(&self, scale: f64, q: &mut [f64]) {
        for part in &self.parts {
            add_scaled(scale, &part.values, &mut q[part.range()]);
        }
    }
}

impl Part {
    fn range(&self) -> core::ops::Range<usize> {
        self.offset..self.offset + self.values.len()
    }
}

impl fmt::Display for StepError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            StepError::StepTooSmall { time, step } => write!(
                f,
                "at time {time} s the tolerance asks for a step of {step:e} s, too small to be taken; \
                 a larger tolerance may help"
            ),
            StepError::TooManySteps { time, steps } => write!(
                f,
                "after {steps} steps only time {time} s is reached; use smaller communication steps"
            ),
            StepError::NotFinite { time } => write!(
                f,
                "the solution grew beyond all numbers at time {time} s; the system is probably unstable"
            ),
            StepError::Singular { time, step } => write!(
                f,
                "the equations of the step of {step:e} s at time {time} s have no unique solution"
            ),
        }
    }
}
