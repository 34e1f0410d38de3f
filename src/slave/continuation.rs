//! The inputs of a master that holds them over every step, continued through the step from what they were before.
//!
//! ```text
//!   velocities, torques, forces    w(t) = w + w' t,   w' = (w - w at the last communication point) / (length of the last step)
//!   displacements                  u(t) = u + (v + v' h / 2) t          v: the velocity that belongs to u, h: the step
//! ```
//!
//! Held inputs lag half a step behind, which takes energy out of a loop or puts it in; continued ones do not. The values that the
//! master has set stay what they are.

use serde::{Deserialize, Serialize};

use crate::model::{BaseMotion, Inputs};

/// What is known from the last step.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(super) struct Continuation {
    /// The inputs at its start.
    before: Inputs,
    /// Its length [s]; 0 before the first one.
    step: f64,
    /// How the inputs are continued: room for the answer.
    rate: Inputs,
}

impl Continuation {
    /// Before the first step; `inputs` are any of the right shape.
    pub(super) fn new(inputs: &Inputs) -> Continuation {
        Continuation {
            before: inputs.clone(),
            step: 0.0,
            rate: inputs.clone(),
        }
    }

    /// The inputs at the start of a step of this length.
    pub(super) fn note(&mut self, inputs: &Inputs, step: f64) {
        self.before.overwrite(inputs);
        self.step = step;
    }

    /// How the inputs change per second in the next step [s].
    pub(super) fn rate(&mut self, inputs: &Inputs, next: f64) -> &Inputs {
        let per_second = if self.step > 0.0 {
            1.0 / self.step
        } else {
            0.0
        };
        let rate = |now: f64, before: f64| (now - before) * per_second;
        let (before, change) = (&self.before, &mut self.rate);
        let torques = inputs.torques.iter().zip(&before.torques);
        for ((now, before), change) in torques.zip(&mut change.torques) {
            *change = rate(*now, *before);
        }
        let forces = inputs.forces.iter().flatten();
        let forces = forces.zip(before.forces.iter().flatten());
        for ((now, before), change) in forces.zip(change.forces.iter_mut().flatten()) {
            *change = rate(*now, *before);
        }
        let bases = inputs.bases.iter().zip(&before.bases);
        for ((now, before), change) in bases.zip(&mut change.bases) {
            let velocity = [0, 1].map(|axis| rate(now.velocity[axis], before.velocity[axis]));
            *change = BaseMotion {
                displacement: [0, 1].map(|axis| now.velocity[axis] + 0.5 * next * velocity[axis]),
                velocity,
            };
        }
        &self.rate
    }

    /// Whether it belongs to inputs of this shape and consists of numbers.
    pub(super) fn fits(&self, inputs: &Inputs) -> bool {
        let all = [&self.before, &self.rate].into_iter();
        self.step.is_finite()
            && all.fold(true, |fits, one| {
                fits && one.is_like(inputs) && one.is_finite()
            })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn inputs(torque: f64, displacement: f64, velocity: f64) -> Inputs {
        Inputs {
            torques: vec![torque],
            bases: vec![BaseMotion {
                displacement: [displacement, 0.0],
                velocity: [velocity, 0.0],
            }],
            forces: vec![[2.0 * torque, 0.0]],
        }
    }

    #[test]
    fn a_parabola_with_its_velocity_is_continued_exactly() {
        // u = t^2 / 2, v = t at 0.1 s, after a step of 0.1 s: over the next 0.3 s u grows by 0.03 + 0.045.
        let mut continuation = Continuation::new(&inputs(0.0, 0.0, 0.0));
        continuation.note(&inputs(5.0, 0.0, 0.0), 0.1);
        let now = inputs(6.0, 0.005, 0.1);
        let rate = continuation.rate(&now, 0.3);
        let base = rate.bases[0];
        assert!((0.3 * base.displacement[0] - 0.075).abs() < 1e-15);
        assert!((base.velocity[0] - 1.0).abs() < 1e-15);
        assert!((rate.torques[0] - 10.0).abs() < 1e-12 && (rate.forces[0][0] - 20.0).abs() < 1e-12);
    }

    #[test]
    fn before_the_first_step_only_displacements_move() {
        let mut continuation = Continuation::new(&inputs(0.0, 0.0, 0.0));
        let rate = continuation.rate(&inputs(6.0, 0.005, 0.1), 0.3);
        assert_eq!(
            rate,
            &Inputs {
                torques: vec![0.0],
                forces: vec![[0.0; 2]],
                ..inputs(0.0, 0.1, 0.0)
            }
        );
    }
}
