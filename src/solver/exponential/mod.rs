//! The exponential collocation method: the linear blocks exactly, the forces between them as polynomials.
//!
//! ```text
//!   eta' = B eta + load(t) - sum over m of b_m F_m(t, d, d')       decoupled states of every block (`part`)
//!   F_m(s) = sum over j of l_j(s/h) F_m(s_j)                       cubic through four Lobatto nodes (`polynomials`)
//!   F_j = F(s_j, d(s_j), p'(s_j))                                  the forces are few (`nodes`, `equations`, `few`)
//! ```
//!
//! p is the quintic through the deflections at the nodes and the rates at both ends.
//!
//! However fast a mode of the blocks is, the step does not feel it: only the forces have to be followed. Torques,
//! held inputs, unbalance and gearbox vibration are exact. The method is of order six where forces are smooth, and
//! steps end where they are not (`events`). It keeps no memory of earlier steps but the control's mean squares
//! (`control`). What depends on the step length alone is kept for the lengths in use (`coefficients`, `exchange`).
//!
//! Sources: Hochbruck, Ostermann, Acta Numerica 19 (2010); collocation on Lobatto points: Hairer, Wanner, Solving Ordinary
//! Differential Equations II, IV.5.

mod block_diagonal;
mod coefficients;
mod control;
mod elimination;
mod equations;
mod events;
mod exchange;
mod few;
mod kernel;
mod lanes;
mod loads;
mod motion;
mod nodes;
mod panel;
mod part;
mod passes;
mod polynomials;
mod rows;
mod scratch;
mod shapes;
mod sight;
mod turning;

use super::control::Control;
use super::march::{March, Task};
use super::state::Track;
use super::{Counts, Forcing, Harmonic, State, StepError, System};
use kernel::Kernel;

pub(super) use shapes::Shapes;
pub(super) use turning::Turning;

/// The integrator with its workspace. It holds nothing that influences a result: everything that does is in the
/// [`State`].
#[derive(Debug, Clone)]
pub struct Exponential {
    march: March,
    kernel: Kernel,
    before: Before,
}

/// What a call changes of a state before it is known to succeed, as it was at the start.
#[derive(Debug, Clone)]
struct Before {
    time: f64,
    turning: Turning,
    slow: Vec<f64>,
    control: Control,
}

impl Exponential {
    /// A workspace for this system under harmonics like these.
    pub fn new(system: &System, harmonics: &[Harmonic]) -> Exponential {
        Exponential {
            march: March::new(system),
            kernel: Kernel::new(system, harmonics),
            before: Before {
                time: 0.0,
                turning: Turning::unknown(harmonics.len()),
                slow: system.slow.clone(),
                control: Control::new(system.monitors.len(), system.laws),
            },
        }
    }

    /// The state with these displacements and velocities at `time`, one entry per coordinate.
    pub fn state_at(
        &self,
        system: &System,
        time: f64,
        position: Vec<f64>,
        velocity: Vec<f64>,
    ) -> State {
        let whole = Track { position, velocity };
        State {
            turning: Turning::unknown(self.before.turning.angles.len()),
            ..system.state_at(time, whole, (0, self.kernel.states()))
        }
    }

    /// Work done since the workspace was made.
    pub fn counts(&self) -> Counts {
        self.march.counts(self.kernel.counts())
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
        if until <= state.time {
            return Ok(());
        }
        self.before.take(state);
        let task = Task {
            system,
            forcing,
            tolerance,
        };
        self.kernel.take_over(task, state);
        let result = self
            .march
            .advance(&mut self.kernel, task, state, until)
            .and_then(|()| self.kernel.hand_back(task, state));
        if result.is_err() {
            self.before.put_back(state);
        }
        result
    }
}

impl Before {
    fn take(&mut self, state: &State) {
        self.time = state.time;
        self.turning.copy_from(&state.turning);
        self.slow.clone_from(&state.slow);
        self.control.copy_from(&state.control);
    }

    fn put_back(&self, state: &mut State) {
        state.time = self.time;
        state.turning.copy_from(&self.turning);
        state.slow.clone_from(&self.slow);
        state.control.copy_from(&self.control);
    }
}
