//! The choice between the solvers.

use super::{Counts, Exponential, Forcing, Harmonic, Newmark, State, StepError, System};

/// One of the solvers with its workspace.
#[derive(Debug, Clone)]
pub enum Integrator {
    /// Exponential collocation.
    Exponential(Box<Exponential>),
    /// Newmark's method.
    Newmark(Box<Newmark>),
}

impl Integrator {
    /// Exponential collocation for this system under harmonics like these.
    pub fn exponential(system: &System, harmonics: &[Harmonic]) -> Integrator {
        Integrator::Exponential(Box::new(Exponential::new(system, harmonics)))
    }

    /// Newmark's method for this system.
    pub fn newmark(system: &System) -> Integrator {
        Integrator::Newmark(Box::new(Newmark::new(system)))
    }

    /// The state with these displacements and velocities at `time`, one entry per coordinate.
    pub fn state_at(
        &self,
        system: &System,
        time: f64,
        position: Vec<f64>,
        velocity: Vec<f64>,
    ) -> State {
        match self {
            Integrator::Exponential(solver) => solver.state_at(system, time, position, velocity),
            Integrator::Newmark(_) => Newmark::state_at(system, time, position, velocity),
        }
    }

    /// Advances the state to exactly `until`; a time that is not ahead changes nothing. After an error the
    /// state is the one before the call.
    pub fn advance_to(
        &mut self,
        system: &System,
        forcing: &impl Forcing,
        state: &mut State,
        until: f64,
        tolerance: f64,
    ) -> Result<(), StepError> {
        match self {
            Integrator::Exponential(solver) => {
                solver.advance_to(system, forcing, state, until, tolerance)
            }
            Integrator::Newmark(solver) => {
                solver.advance_to(system, forcing, state, until, tolerance)
            }
        }
    }

    /// Work done since the workspace was made.
    pub fn counts(&self) -> Counts {
        match self {
            Integrator::Exponential(solver) => solver.counts(),
            Integrator::Newmark(solver) => solver.counts(),
        }
    }
}
