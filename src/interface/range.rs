//! The values that parameters may take: the rules of [`crate::train`] as a master can know them beforehand.

use super::{Parameter, PlanarEntry, Quantity, VibrationEntry};

/// Least and greatest value; `None` where there is no bound.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Range {
    /// Least value. A factor on a stiffness must be greater than its bound of 0, and a housing's frequency too where the start is
    /// an equilibrium; all other bounds are allowed.
    pub min: Option<f64>,
    /// Greatest value.
    pub max: Option<f64>,
}

const ANY: Range = Range {
    min: None,
    max: None,
};
const NOT_NEGATIVE: Range = Range {
    min: Some(0.0),
    max: None,
};

impl Quantity {
    /// The values that a parameter may be given, and that frequencies can have.
    pub fn range(self) -> Range {
        match self {
            Quantity::Parameter(parameter) => parameter.range(),
            Quantity::LateralFrequency { .. } | Quantity::TorsionalFrequency { .. } => NOT_NEGATIVE,
            _ => ANY,
        }
    }
}

impl Parameter {
    fn range(self) -> Range {
        match self {
            Parameter::MeanSpeed { .. } => Range {
                min: Some(-1e6),
                max: Some(1e6),
            },
            Parameter::BearingStiffness { entry, .. }
            | Parameter::BearingDamping { entry, .. }
            | Parameter::PointStiffness { entry, .. }
            | Parameter::PointDamping { entry, .. } => match entry {
                PlanarEntry::Xx | PlanarEntry::Yy => NOT_NEGATIVE,
                PlanarEntry::Xy | PlanarEntry::Yx => ANY,
            },
            Parameter::LateralDampingRatio { .. }
            | Parameter::TorsionalDampingRatio { .. }
            | Parameter::UnbalanceMoment { .. }
            | Parameter::StiffnessFactor { .. }
            | Parameter::Backlash { .. }
            | Parameter::Clearance { .. }
            | Parameter::HousingFrequency { .. }
            | Parameter::HousingDampingRatio { .. }
            | Parameter::Vibration(VibrationEntry::Frequency) => NOT_NEGATIVE,
            Parameter::UnbalancePhase { .. } | Parameter::Vibration(_) => ANY,
            Parameter::InputExtrapolation | Parameter::KnownBearings => Range {
                min: Some(0.0),
                max: Some(1.0),
            },
            Parameter::Tolerance => Range {
                min: Some(1e-12),
                max: Some(0.1),
            },
        }
    }
}
