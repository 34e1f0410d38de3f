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
mod forcing;
mod grid;
mod integrator;
mod march;
mod newmark;
mod pose;
mod row;
mod state;

use nalgebra::DMatrix;

pub use error::StepError;
pub use exponential::Exponential;
pub use forcing::{Forcing, Harmonic, Instant, Lines, Piece, Ramp, Spring};
pub use integrator::Integrator;
pub use newmark::Newmark;
pub use row::Row;
pub use state::State;

use crate::linalg::multiply_add;
use control::Control;
use exponential::Turning;
use pose::Pose;
use state::{Track, copy_tracks};

/// The constant part of the equations of motion.
#[derive(Debug, Clone, Default)]
pub struct System {
    /// Number of coordinates.
    pub size: usize,
    /// The diagonal blocks, contiguous and in order, at the first values of the slow parameters.
    pub blocks: Vec<Block>,
    /// The forces between and on the blocks.
    pub couplings: Vec<Coupling>,
    /// So many of them, the first ones, are springs: their forces answer fast to their own deflections and rates. Those of the
    /// others hardly do.
    pub springs: usize,
    /// The columns along which the outside loads the coordinates, each within one block.
    pub loads: Vec<Row>,
    /// Number of laws that have pieces.
    pub laws: usize,
    /// First values of the slow parameters, on which the blocks may depend.
    pub slow: Vec<f64>,
    /// What the tolerance holds for.
    pub monitors: Vec<Monitor>,
    /// What is read off after every call, because it is often asked for.
    pub readings: Vec<Reading>,
}

/// A number that follows from displacements and velocities: `position q + velocity q'`.
#[derive(Debug, Clone)]
pub struct Reading {
    /// Per displacement.
    pub position: Row,
    /// Per velocity.
    pub velocity: Row,
}

/// Forces whose error is controlled relative to their own RMS over the run.
#[derive(Debug, Clone)]
pub struct Monitor {
    /// The couplings that make up the force; none for a displacement that only the linear part moves.
    pub couplings: core::ops::Range<usize>,
    /// The monitors whose forces count beside its own: an error is as large as it is beside all of them.
    pub beside: Vec<usize>,
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
    /// What an error of rate counts, in force per rate [N s/m]: what it becomes as the motion swings.
    pub impedance: f64,
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
    /// that carries `tracks` solutions of its own or `states` decoupled ones.
    fn state_at(&self, time: f64, whole: Track, (tracks, states): (usize, usize)) -> State {
        let zeros = || vec![0.0; self.couplings.len()];
        let mut state = State {
            time,
            tracks: vec![whole.clone(); tracks],
            pose: Pose::new(whole, states),
            seen: [zeros(), zeros()],
            readings: vec![0.0; self.readings.len()],
            turning: Turning::default(),
            slow: self.slow.clone(),
            control: Control::new(self.monitors.len(), self.laws),
        };
        state.read_off(self);
        state
    }

    /// q'' in a state, just after its time.
    pub fn acceleration(&self, forcing: &impl Forcing, state: &State) -> Vec<f64> {
        let (time, position, velocity) = (state.time, state.position(), state.velocity());
        let [deflection, rate] = &state.seen;
        let at = Instant {
            time,
            deflection,
            rate,
            slow: &self.slow,
        };
        let mut forces = vec![0.0; self.couplings.len()];
        let mut pieces = vec![Piece::default(); self.laws];
        forcing.follow_time(time, &mut pieces);
        forcing.follow_motion(at, &mut pieces);
        forcing.forces_into(at, &pieces, &mut forces);
        let mut acceleration = vec![0.0; self.size];
        forcing.load_into(self, time, &mut acceleration);
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
