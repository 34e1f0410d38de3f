//! The smallest basis that is large enough: modes to some frequency and static shapes, which make every static
//! compliance exact.

use super::basis_check::Reference;
use super::basis_errors::BasisErrors;
use crate::config::BasisModes;
use crate::model::ModalModel;
use crate::rotor::{ModeCounts, ReductionError};
use crate::train::{Basis, GearTrain};

/// Values of `max_frequency` that are tried, as multiples of the range of interest.
const TRIED: [f64; 12] = [
    0.25, 0.5, 0.75, 1.0, 1.25, 1.5, 2.0, 2.5, 3.0, 4.0, 6.0, 10.0,
];

/// A basis that is large enough.
#[derive(Debug, Clone)]
pub struct Recommendation {
    /// Keep every mode up to here [Hz].
    pub max_frequency: f64,
    /// Which are these.
    pub counts: Vec<ModeCounts>,
    /// What remains.
    pub errors: BasisErrors,
}

/// The lowest `max_frequency` among those tried that is large enough with `static_shapes`; `None` when none is.
pub fn recommend(
    train: &GearTrain,
    reference: &Reference,
) -> Result<Option<Recommendation>, ReductionError> {
    for multiple in TRIED {
        let max_frequency = two_digits(multiple * reference.highest_frequency);
        let mut candidate = train.clone();
        candidate.basis = Basis {
            modes: BasisModes::MaxFrequency(max_frequency),
            static_shapes: true,
        };
        let model = ModalModel::assemble(&candidate, None)?;
        let errors = reference.errors(&model);
        if errors.sufficient() {
            return Ok(Some(Recommendation {
                max_frequency,
                counts: model.counts(),
                errors,
            }));
        }
    }
    Ok(None)
}

/// The next number upward that has two significant digits.
fn two_digits(value: f64) -> f64 {
    let unit = libm::pow(10.0, libm::floor(libm::log10(value)) - 1.0);
    // 1e-9: a number that has two digits but for rounding stays.
    libm::ceil(value / unit - 1e-9) * unit
}
