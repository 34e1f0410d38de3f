//! How large the error of a step is.
//!
//! At two further places of the step the true forces are evaluated; what they differ by from the cubic, as quintic bubbles,
//! moves the end of the step by e. The change of force that belongs to e is the error of one step; it adds up over the steps
//! that the motion remembers, and is held below the tolerance:
//!
//! ```text
//!   max(1, s n) |F(d + e_d, d' + e_v) - F(d, d')| <= tolerance x RMS of F over the run so far,   n = min(t, 1/(zeta w)) / h
//!   s = 1/4 where errors of either sign add up, 1 where they have one
//! ```
//!
//! An error of momentum becomes one of force a quarter of a vibration later: e_v counts with the impedance k/w as well. Where a
//! motion is what matters, its own e counts; where a force can hide e, because teeth are in flight or a contact is
//! just opening, e counts with a typical stiffness. w is the frequency of the force by itself, zeta the lightest damping ratio in it.

use super::super::march::{Span, Task};
use super::super::{Forcing, State};
use super::kernel::Kernel;
use super::nodes::larger;

/// The next step is at most so many times longer; its accumulated error grows with the sixth power of that.
const GROWTH: f64 = 2.0;
/// What errors of single steps amount to when they add up over n steps, as part of n times the largest, where laws are straight lines
/// that only time ends: errors have either sign. Measured over tolerances from 1e-2 to 1e-8, with smooth and with stepped stiffness,
/// the error is then 0.01 to 0.8 of the tolerance; exceptions are at the end of the tables in docs/performance.md.
const EITHER_SIGN: f64 = 0.25;
/// The same for contacts that part, curved laws and free rotations: errors have one sign.
const ONE_SIGN: f64 = 1.0;

/// By how much longer the next step may be, for an error in units of the bound.
pub(super) fn growth(error: f64) -> f64 {
    let room = 0.8 / error.max(1e-12);
    if room >= GROWTH * GROWTH * GROWTH * GROWTH * GROWTH * GROWTH {
        GROWTH
    } else {
        sixth_root(room).max(0.2)
    }
}

/// To 1e-3: value = 2^(6 q + r) m with m from 1 to 2.
fn sixth_root(value: f64) -> f64 {
    /// 2^(r/6).
    const PARTS: [f64; 6] = [
        1.0,
        1.122_462_048_309_373,
        1.259_921_049_894_873_2,
        core::f64::consts::SQRT_2,
        1.587_401_051_968_199_4,
        1.781_797_436_280_678_5,
    ];
    const MANTISSA: u32 = f64::MANTISSA_DIGITS - 1;
    let bits = value.to_bits();
    let exponent = bits >> MANTISSA; // from 2^-1023
    let power = exponent + 3; // from 2^-1026, a multiple of six
    let mantissa = f64::from_bits((bits & ((1 << MANTISSA) - 1)) | 1.0_f64.to_bits());
    // The parabola through the sixth roots of 1, 3/2 and 2.
    let root = mantissa * (0.226_65 - 0.034_73 * mantissa) + 0.808_08;
    let whole = f64::from_bits((power / 6 + 1023 - 171) << MANTISSA);
    root * PARTS[(power % 6) as usize] * whole
}

impl Kernel {
    /// Error of the step in units of the bound, on the scale of every monitor.
    pub(super) fn error<F: Forcing>(
        &mut self,
        task: Task<'_, F>,
        state: &State,
        span: Span,
    ) -> f64 {
        let (sight, control) = (&self.sight, &state.control);
        let elapsed = control.elapsed + span.step;
        let (per_elapsed, per_step) = (1.0 / elapsed, 1.0 / span.step);
        let monitors = &task.system.monitors;
        let share = if task.forcing.is_straight() && task.forcing.is_timed() {
            EITHER_SIGN
        } else {
            ONE_SIGN
        };
        for (mean, monitor) in self.squares.iter_mut().zip(monitors) {
            *mean = sight.mean_square(monitor);
        }
        let mean_square = |number: usize| {
            (control.squares[number] + span.step * self.squares[number]) * per_elapsed
        };
        let mut worst = 0.0;
        for (number, monitor) in monitors.iter().enumerate() {
            if monitor.couplings.is_empty() && monitor.motion.is_empty() {
                continue; // exact
            }
            let mut mean = mean_square(number);
            for &other in &monitor.beside {
                mean += mean_square(other);
            }
            let reference = mean.sqrt().max(monitor.floor);
            let decay = monitor.damping_ratio * monitor.frequency;
            let remembered = (1.0 / decay.max(f64::MIN_POSITIVE)).min(elapsed);
            let steps = (remembered * per_step).max(1.0);
            let scale = (share * steps).max(1.0) / (reference * task.tolerance);
            let (mut largest, mut sum) = (0.0, 0.0);
            for i in monitor.couplings.clone() {
                let [deflection, rate] = sight.drift[i];
                let hidden = (monitor.stiffness * deflection, monitor.impedance * rate);
                for change in [sight.change[i], hidden.0, hidden.1] {
                    largest = larger(largest, change.abs());
                    sum += change;
                }
            }
            for i in monitor.motion.clone() {
                largest = larger(largest, sight.drift[i][0].abs());
                sum += sight.drift[i][0];
            }
            // A NaN is no larger than anything, but spoils sums.
            worst = larger(worst, scale * largest) + 0.0 * sum;
        }
        worst
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sixth_roots_are_as_accurate_as_promised() {
        for value in [1e-9, 3e-3, 0.5, 1.0, 7.0, 63.0] {
            let root = sixth_root(value);
            let power = root * root * root * root * root * root;
            assert!((power / value - 1.0).abs() < 6e-3, "{value}: {root}");
        }
    }
}
