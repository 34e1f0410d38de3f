//! How large a communication step with a gearbox model may be.
//!
//! ```text
//!   step = 1 / (n f),     f: highest excitation frequency
//! ```
//!
//! n comes from measurements on the three-stage example (mesh frequency 1800 Hz) beside a gearbox of 10 kg per
//! bearing, for an RMS error of the bearing forces of 1 %: 1.3e-5 s when the master holds its inputs and reads
//! the outputs after setting them, 4.2e-5 s when it gives input derivatives (linear).
//!
//! A force that a step holds lags half a step behind and takes k h / 2 from the damping c of its
//! bearing. The same measurements became unstable at 2.6 c / k and, with derivatives, at 5 c / k of the stiff
//! bearings (k = 1e8 N/m, c = 2000 N s/m). Damping of the gearbox helps, and nothing is known about it here.

use crate::model::ModalModel;

/// Steps per period of the excitation with inputs that are held: 1 / (1800 Hz x 1.3e-5 s).
const PER_PERIOD_HELD: f64 = 43.0;
/// With linear input derivatives: 1 / (1800 Hz x 4.2e-5 s).
const PER_PERIOD_DERIVATIVES: f64 = 13.2;
/// Largest stable step per c / k, held.
const STABLE_HELD: f64 = 2.6;

/// A communication step and what it is based on.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SuggestedStep {
    /// For 1 % in the bearing forces with held inputs [s].
    pub held: f64,
    /// The same with input derivatives [s].
    pub with_derivatives: f64,
    /// Highest excitation frequency [Hz].
    pub frequency: f64,
    /// Where the dampers of the bearings alone keep a loop with held inputs stable [s]; `None` when a
    /// bearing has no damper.
    pub stable_to: Option<f64>,
}

/// The step for a train whose range of interest ends at three times its highest excitation frequency [Hz].
pub fn suggested_step(model: &ModalModel, range_of_interest: f64) -> SuggestedStep {
    let frequency = range_of_interest / 3.0;
    let times = model.bearings().flat_map(|bearing| {
        let (k, c) = (bearing.stiffness, bearing.damping);
        [(k.xx, c.xx), (k.yy, c.yy)]
    });
    let shortest = times
        .filter(|(k, _)| *k > 0.0)
        .map(|(k, c)| c / k)
        .fold(f64::INFINITY, f64::min);
    SuggestedStep {
        held: one_digit(1.0 / (PER_PERIOD_HELD * frequency)),
        with_derivatives: one_digit(1.0 / (PER_PERIOD_DERIVATIVES * frequency)),
        frequency,
        stable_to: (shortest > 0.0 && shortest.is_finite()).then_some(STABLE_HELD * shortest),
    }
}

/// The next number downward that has one significant digit.
fn one_digit(value: f64) -> f64 {
    let exponent = libm::floor(libm::log10(value));
    let digit = libm::floor(value / libm::pow(10.0, exponent) + 1e-9);
    // A quotient of two exact numbers: 1e-5, not 1.0000000000000001e-5.
    digit / libm::pow(10.0, -exponent)
}
