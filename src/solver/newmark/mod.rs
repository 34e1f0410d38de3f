//! The Newmark-beta method of the paper with variable steps: average acceleration (beta 1/4, gamma 1/2),
//! implicit in the blocks and in the couplings.
//!
//! ```text
//!   q1 = q~ + h^2/4 a1        q~ = q0 + h v0 + h^2/4 a0
//!   v1 = v~ + h/2 a1          v~ = v0 + h/2 a0
//!   a1 = y - sum over m of z_m F_m         y = A^-1 (f1 - D v~ - K q~)
//!   A  = I + h/2 D + h^2/4 K               z_m = A^-1 b_m
//!   F_m = k_m w_m q1 + c_m w_m v1          (I + kappa Z) F = k w (q~ + h^2/4 y) + c w (v~ + h/2 y)
//!                                          Z_ml = w_m z_l,  kappa = h^2/4 k + h/2 c
//! ```
//!
//! A depends on h alone and is inverted block by block once per step length; a step then costs products
//! with small matrices and one linear system with as many unknowns as there are couplings.
//!
//! **Two solutions.** The equations are solved twice side by side, with steps h (coarse) and h/2 (fine). The
//! method is symmetric, its error has even powers of h only, so that
//!
//! ```text
//!   q = (4 q_fine - q_coarse) / 3
//! ```
//!
//! is of fourth order. The extrapolation is passive: neither solution is changed by it, and the method stays
//! A-stable and without numerical damping. `control` says how long a step may be.
//!
//! Sources: Newmark, J. Eng. Mech. Div. ASCE 85 (1959); extrapolation: Hairer, Norsett, Wanner, Solving
//! Ordinary Differential Equations I, II.9.

mod control;
mod kernel;

use control::{control_error, differentiate};
use kernel::{Kernel, Span, Work, accept};

use super::{Control, Counts, Forcing, State, StepError, System, Track, copy_tracks};

/// After this many steps of one call their average length must be useful [s]: no machine vibrates in the GHz.
const PATIENCE: u64 = 1_000_000;
const SMALLEST_USEFUL_STEP: f64 = 1e-11;
/// No call takes more steps: some minutes of work.
const MOST_STEPS: u64 = 100_000_000;

/// The integrator with its workspace. It holds nothing that influences a result: everything that does
/// is in the [`State`].
#[derive(Debug, Clone)]
pub struct Newmark {
    kernel: Kernel,
    work: [Work; 2],
    before: State,
    retry: [Track; 2],
    differences: Vec<f64>,
    next_control: Control,
    counts: Counts,
    /// Steps tried since `since`, the start of the present call.
    tried: u64,
    since: f64,
}

impl Newmark {
    /// A workspace for this system.
    pub fn new(system: &System) -> Newmark {
        let work = Work::new(system);
        let before = system.state_at(0.0, vec![0.0; system.size]);
        Newmark {
            kernel: Kernel::new(system),
            work: [work.clone(), work],
            retry: before.tracks.clone(),
            next_control: before.control.clone(),
            differences: vec![0.0; system.monitors.len()],
            before,
            counts: Counts::default(),
            tried: 0,
            since: 0.0,
        }
    }

    /// Work done since the workspace was made.
    pub fn counts(&self) -> Counts {
        Counts {
            factorizations: self.kernel.factorizations(),
            ..self.counts
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
        if until <= state.time {
            return Ok(());
        }
        self.before.copy_from(state);
        let result = self.advance(system, forcing, state, until, tolerance);
        if result.is_err() {
            state.copy_from(&self.before);
        }
        result
    }

    fn advance(
        &mut self,
        system: &System,
        forcing: &impl Forcing,
        state: &mut State,
        until: f64,
        tolerance: f64,
    ) -> Result<(), StepError> {
        (self.tried, self.since) = (0, state.time);
        // Less than rounding lets times differ is no stretch of time.
        let rounding = 4.0 * f64::EPSILON * until.abs();
        while state.time < until - rounding {
            let next = forcing.next_breakpoint(state.time + rounding);
            let stop = if next < until - rounding { next } else { until };
            self.cross_smooth_stretch(system, forcing, state, stop, tolerance)?;
        }
        state.time = until;
        let [coarse, fine] = &state.tracks;
        extrapolate(&fine.position, &coarse.position, &mut state.position);
        extrapolate(&fine.velocity, &coarse.velocity, &mut state.velocity);
        if state
            .position
            .iter()
            .chain(&state.velocity)
            .all(|value| value.is_finite())
        {
            Ok(())
        } else {
            Err(StepError::NotFinite { time: until })
        }
    }

    /// From the state's time to `stop` with equal steps, replanned when the error estimate asks for it.
    fn cross_smooth_stretch(
        &mut self,
        system: &System,
        forcing: &impl Forcing,
        state: &mut State,
        stop: f64,
        tolerance: f64,
    ) -> Result<(), StepError> {
        self.kernel.enter_pieces(forcing, 0.5 * (state.time + stop));
        self.evaluate_accelerations(system, forcing, state);
        if state.control.wanted_step == 0.0 {
            state.control.wanted_step = (stop - state.time) / 16.0;
        }
        while state.time < stop {
            let (start, length) = (state.time, stop - state.time);
            let count = equal_steps(length / state.control.wanted_step);
            let step = length / count as f64;
            if start + 0.5 * step == start {
                return Err(StepError::StepTooSmall { time: start, step });
            }
            for number in 1..=count {
                self.check_progress(state.time, step)?;
                let last = number == count;
                let end = if last {
                    stop
                } else {
                    start + length * (number as f64 / count as f64)
                };
                let span = Span {
                    start: state.time,
                    end,
                    step,
                };
                let error = self.try_step(system, forcing, state, span, tolerance)?;
                // The estimate grows with h^4; the factor aims a little below the bound.
                let ratio = (0.8 / error.sqrt().sqrt()).clamp(0.2, 1.5);
                state.control.wanted_step = step * ratio;
                if error > 1.0 || (ratio > 1.4 && !last) {
                    break;
                }
            }
        }
        Ok(())
    }

    /// A call has to end: refuses to go on without end with steps that lead nowhere.
    fn check_progress(&self, time: f64, step: f64) -> Result<(), StepError> {
        let average = (time - self.since) / self.tried as f64;
        if self.tried >= PATIENCE && average < SMALLEST_USEFUL_STEP {
            return Err(StepError::StepTooSmall { time, step });
        }
        if self.tried >= MOST_STEPS {
            return Err(StepError::TooManySteps {
                time,
                steps: self.tried,
            });
        }
        Ok(())
    }

    /// One coarse step and two fine ones, taken back if their error is more than 1.5 of the bound. Gives the
    /// error relative to the bound.
    fn try_step(
        &mut self,
        system: &System,
        forcing: &impl Forcing,
        state: &mut State,
        span: Span,
        tolerance: f64,
    ) -> Result<f64, StepError> {
        self.tried += 1;
        copy_tracks(&mut self.retry, &state.tracks);
        let [coarse, fine] = &mut self.work;
        self.kernel
            .step(system, forcing, &state.tracks[0], span, coarse)?;
        accept(&mut state.tracks[0], coarse, span.step);
        let (middle, step) = (0.5 * (span.start + span.end), 0.5 * span.step);
        self.differences.fill(0.0);
        differentiate(system, &mut self.differences, fine.acceleration(), 1.0);
        for (half, weight) in [
            (
                Span {
                    end: middle,
                    step,
                    ..span
                },
                -2.0,
            ),
            (
                Span {
                    start: middle,
                    step,
                    ..span
                },
                1.0,
            ),
        ] {
            self.kernel
                .step(system, forcing, &state.tracks[1], half, fine)?;
            accept(&mut state.tracks[1], fine, step);
            differentiate(system, &mut self.differences, fine.acceleration(), weight);
        }
        let next = &mut self.next_control;
        let error =
            control_error(system, state, fine, &self.differences, span.step, next) / tolerance;
        if !error.is_finite() {
            return Err(StepError::NotFinite { time: span.end });
        }
        if error > 1.5 {
            self.counts.rejected += 1;
            copy_tracks(&mut state.tracks, &self.retry);
            self.evaluate_accelerations(system, forcing, state);
        } else {
            self.counts.steps += 1;
            state.time = span.end;
            core::mem::swap(&mut state.control, next);
        }
        Ok(error)
    }

    fn evaluate_accelerations(&mut self, system: &System, forcing: &impl Forcing, state: &State) {
        for (track, work) in state.tracks.iter().zip(&mut self.work) {
            self.kernel
                .evaluate_acceleration(system, forcing, track, state.time, work);
        }
    }
}

/// (4 fine - coarse) / 3.
fn extrapolate(fine: &[f64], coarse: &[f64], result: &mut [f64]) {
    for ((value, fine), coarse) in result.iter_mut().zip(fine).zip(coarse) {
        *value = fine + (fine - coarse) / 3.0;
    }
}

/// The number of equal steps for a stretch of `lengths` wanted steps: 1, 2, 3, 4, 6, 8, 12, 16, 24 ...,
/// so that few different step lengths occur.
fn equal_steps(lengths: f64) -> u64 {
    let needed = (lengths * (1.0 - 1e-9)).ceil().max(1.0);
    if needed <= 3.0 {
        return needed as u64;
    }
    let mut power: u64 = 2;
    while (power as f64) < needed && power < 1 << 60 {
        power *= 2;
    }
    let between = power / 4 * 3;
    if between as f64 >= needed {
        between
    } else {
        power
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn step_counts_are_the_next_of_a_small_set() {
        let counts = [0.3, 1.0, 1.0 + 1e-12, 2.5, 3.5, 4.5, 6.1, 9.0, 13.0, 17.0].map(equal_steps);
        assert_eq!(counts, [1, 1, 1, 3, 4, 6, 8, 12, 16, 24]);
    }
}
