//! How large the error of a step is.
//!
//! At two further places of the step the true forces are evaluated; what they differ by from the cubic, as quintic bubbles,
//! moves the end of the step by e. The change of force that belongs to e is the error of one step; it adds up over the steps
//! that the motion remembers, and is held below the tolerance:
//!
//! ```text
//!   SAFETY |F(d + e_d, d' + e_v) - F(d, d')| n <= tolerance x RMS of F over the run so far,   n = min(t, 1/(zeta w)) / h
//! ```
//!
//! Where a motion is what matters, its own e counts; where a force can hide e, because teeth are in flight or a contact is
//! just opening, e counts with a typical stiffness. w is the frequency of the force by itself, zeta the lightest damping ratio in it.

use super::super::march::{Span, Task};
use super::super::{Forcing, State};
use super::kernel::Kernel;
use super::polynomials::END;

/// What errors of single steps amount to when they add up over n steps, as part of n times the largest: they have either
/// sign. Measured over tolerances from 1e-2 to 1e-8, with smooth and with stepped stiffness, the error is then 0.01 to
/// 0.8 of the tolerance; exceptions are at the end of the tables in docs/performance.md.
const SAFETY: f64 = 0.25;

impl Kernel {
    /// Error of the step in units of the bound, on the scale of every monitor.
    pub(super) fn error<F: Forcing>(&self, task: Task<'_, F>, state: &State, span: Span) -> f64 {
        let (sight, control) = (&self.sight, &state.control);
        let elapsed = control.elapsed + span.step;
        let mut worst: f64 = 0.0;
        for (monitor, squares) in task.system.monitors.iter().zip(&control.squares) {
            if monitor.couplings.is_empty() && monitor.motion.is_empty() {
                continue; // exact
            }
            let mean = (squares + span.step * sight.mean_square(monitor)) / elapsed;
            let reference = mean.sqrt().max(monitor.floor);
            let decay = monitor.damping_ratio * monitor.frequency;
            let remembered = (1.0 / decay.max(f64::MIN_POSITIVE)).min(elapsed);
            let steps = (remembered / span.step).max(1.0);
            let scale = SAFETY * steps / (reference * task.tolerance);
            let deflection = |i: usize| sight.trial[0][i] - sight.points[END][0][i];
            let force = |i: usize| {
                let change = self.nodes.change[i];
                let hidden = monitor.stiffness * deflection(i);
                // Written so that a NaN stays one.
                if hidden.abs() > change.abs() {
                    hidden
                } else {
                    change
                }
            };
            let of_force = monitor.couplings.clone().map(force);
            let of_motion = monitor.motion.clone().map(deflection);
            for change in of_force.chain(of_motion) {
                let relative = scale * change.abs();
                // f64::max would drop a NaN.
                worst = if relative <= worst { worst } else { relative };
            }
        }
        worst
    }
}
