//! The inputs of a master that holds them over every step, continued through the step from what they were before.
//!
//! ```text
//!   velocities, torques, forces    w' = slope of the line from w with the mean, over the next step, of the parabola through w now and
//!                                  at the last two communication points
//!   displacements                  u' = v + w' h / 2          v: the velocity that belongs to u, w': that of v, h: the next step
//! ```
//!
//! Held inputs lag half a step behind, which takes energy out of a loop or puts it in; continued ones do not: `docs/coupling.md`.
//! The values that the master has set stay what they are.

use serde::{Deserialize, Serialize};

use crate::model::Inputs;

/// A step may be so many times longer than the one before: beyond, what happened there says nothing.
const LONGER: f64 = 4.0;

/// What is known from the last steps.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(super) struct Continuation {
    /// The inputs at the start of the last step, and of the one before.
    before: [Inputs; 2],
    /// The lengths of these steps [s]; 0 where there was none.
    steps: [f64; 2],
    /// How the inputs are continued: room for the answer.
    rate: Inputs,
}

impl Continuation {
    /// Before the first step; `inputs` are any of the right shape.
    pub(super) fn new(inputs: &Inputs) -> Continuation {
        Continuation {
            before: [inputs.clone(), inputs.clone()],
            steps: [0.0; 2],
            rate: inputs.clone(),
        }
    }

    /// The inputs at the start of a step of this length.
    pub(super) fn note(&mut self, inputs: &Inputs, step: f64) {
        self.before.swap(0, 1);
        self.before[0].overwrite(inputs);
        self.steps = [step, self.steps[0]];
    }

    /// How the inputs change per second in the next step [s]; `share` of it, from 0 to 1, counts.
    pub(super) fn rate(&mut self, inputs: &Inputs, next: f64, share: f64) -> &Inputs {
        let line = Line::over(self.steps, next, share);
        let ([one, two], change) = (&self.before, &mut self.rate);
        let past = one.values().iter().zip(two.values());
        let all = inputs.values().iter().zip(past);
        for ((now, (one, two)), change) in all.zip(change.values_mut()) {
            *change = line.of(*now, *one, *two);
        }
        for (now, change) in inputs.bases().iter().zip(change.bases_mut()) {
            for axis in 0..2 {
                change[axis] = share * now[2 + axis] + 0.5 * next * change[2 + axis];
            }
        }
        &self.rate
    }

    /// Whether it belongs to inputs of this shape and what is known consists of numbers.
    pub(super) fn fits(&self, inputs: &Inputs) -> bool {
        let [one, two] = &self.before;
        let known = |past: &Inputs| past.is_like(inputs) && past.is_finite();
        let lengths = self
            .steps
            .iter()
            .all(|step| step.is_finite() && *step >= 0.0);
        lengths && known(one) && known(two) && self.rate.is_like(inputs)
    }
}

/// A line with the mean of a parabola over the next step, as far as points are known.
struct Line {
    /// Per change over the last step and over the one before [1/s].
    weights: [f64; 2],
}

impl Line {
    /// w' = d_1 + (d_1 - d_2) (2 h / 3 + h_1) / (h_1 + h_2),   d_i = change / h_i (divided differences)
    fn over([last, before]: [f64; 2], next: f64, share: f64) -> Line {
        let known = |step: f64, after: f64| step > 0.0 && after <= LONGER * step;
        let weights = match (known(last, next), known(before, last)) {
            (false, _) => [0.0; 2],
            (true, false) => [1.0 / last, 0.0],
            (true, true) => {
                let bend = (2.0 / 3.0 * next + last) / (last + before);
                [(1.0 + bend) / last, -bend / before]
            }
        };
        Line {
            weights: weights.map(|weight| share * weight),
        }
    }

    /// For a value now, at the start of the last step, and of the one before.
    fn of(&self, now: f64, one: f64, two: f64) -> f64 {
        self.weights[0] * (now - one) + self.weights[1] * (one - two)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::BaseMotion;

    fn inputs(torque: f64, displacement: f64, velocity: f64) -> Inputs {
        let base = BaseMotion {
            displacement: [displacement, 0.0],
            velocity: [velocity, 0.0],
        };
        Inputs::new(&[torque], &[base], &[[2.0 * torque, 0.0]])
    }

    #[test]
    fn the_mean_of_a_parabola_is_kept_whatever_the_steps() {
        // w = t^2 at 0, 0.1 and 0.3 s; its mean over the next 0.3 s is (0.6^3 - 0.3^3) / (3 0.3) = 0.21. The velocity is w, too.
        let mut continuation = Continuation::new(&inputs(0.0, 0.0, 0.0));
        continuation.note(&inputs(0.0, 0.0, 0.0), 0.1);
        continuation.note(&inputs(0.01, 0.0, 0.01), 0.2);
        let rate = continuation.rate(&inputs(0.09, 0.005, 0.09), 0.3, 1.0);
        // Half the step times the slope from 0.09 to the mean.
        assert!((0.15 * rate.torques()[0] - 0.12).abs() < 1e-15);
        assert!((0.15 * rate.forces()[0][0] - 0.24).abs() < 1e-15);
        assert!((0.15 * rate.base(0).velocity[0] - 0.12).abs() < 1e-15);
        // The mean velocity.
        assert!((rate.base(0).displacement[0] - 0.21).abs() < 1e-15);
    }

    #[test]
    fn a_tiny_step_says_nothing_about_a_long_one() {
        let mut continuation = Continuation::new(&inputs(0.0, 0.0, 0.0));
        continuation.note(&inputs(5.0, 0.0, 0.0), 1e-9);
        assert_eq!(
            continuation
                .rate(&inputs(6.0, 0.0, 0.0), 0.3, 1.0)
                .torques(),
            [0.0]
        );
    }

    #[test]
    fn two_points_make_a_line() {
        let mut continuation = Continuation::new(&inputs(0.0, 0.0, 0.0));
        continuation.note(&inputs(5.0, 0.0, 0.0), 0.1);
        let rate = continuation.rate(&inputs(6.0, 0.0, 0.0), 0.3, 1.0);
        assert!((rate.torques()[0] - 10.0).abs() < 1e-12);
    }

    #[test]
    fn before_the_first_step_only_displacements_move() {
        let mut continuation = Continuation::new(&inputs(0.0, 0.0, 0.0));
        let rate = continuation.rate(&inputs(6.0, 0.005, 0.1), 0.3, 1.0);
        let mut only = inputs(0.0, 0.1, 0.0);
        only.forces_mut()[0] = [0.0; 2];
        assert_eq!(rate, &only);
    }
}
