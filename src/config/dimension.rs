//! The kinds of numbers in a model file: what they are called, and their SI unit.
//!
//! Every key names its kind where it is read (`config/read/`). Angles are a kind of their own, so that an angular
//! speed [rad/s] is neither a frequency [Hz] nor a torsional stiffness [N m/rad] a torque.

use std::borrow::Cow;

/// A kind of number.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Dimension {
    /// With its article: "a length".
    pub(super) name: Cow<'static, str>,
    /// The SI unit, empty for plain numbers. `config/quantity.rs` understands it.
    pub(super) unit: Cow<'static, str>,
}

const fn dimension(name: &'static str, unit: &'static str) -> Dimension {
    Dimension {
        name: Cow::Borrowed(name),
        unit: Cow::Borrowed(unit),
    }
}

pub(super) const NUMBER: Dimension = dimension("a plain number", "");
pub(super) const PITCHES: Dimension = dimension("a plain number (of tooth pitches)", "");
pub(super) const MODULES: Dimension = dimension("a plain number (of modules)", "");
pub(super) const LENGTH: Dimension = dimension("a length", "m");
pub(super) const ANGLE: Dimension = dimension("an angle", "rad");
pub(super) const TIME: Dimension = dimension("a time", "s");
pub(super) const FREQUENCY: Dimension = dimension("a frequency", "Hz");
pub(super) const ANGULAR_SPEED: Dimension = dimension("an angular speed", "rad/s");
pub(super) const MASS: Dimension = dimension("a mass", "kg");
pub(super) const INERTIA: Dimension = dimension("a moment of inertia", "kg m^2");
pub(super) const UNBALANCE: Dimension = dimension("an unbalance", "kg m");
pub(super) const DENSITY: Dimension = dimension("a density", "kg/m^3");
pub(super) const PRESSURE: Dimension = dimension("a pressure", "Pa");
pub(super) const TORQUE: Dimension = dimension("a torque", "N m");
pub(super) const STIFFNESS: Dimension = dimension("a stiffness", "N/m");
pub(super) const CUBIC_STIFFNESS: Dimension = dimension("a cubic stiffness", "N/m^3");
pub(super) const DAMPING: Dimension = dimension("a damping", "N s/m");
pub(super) const TORSIONAL_STIFFNESS: Dimension = dimension("a torsional stiffness", "N m/rad");
pub(super) const TORSIONAL_DAMPING: Dimension = dimension("a torsional damping", "N m s/rad");

/// What else people write, to be named when it stands in the wrong place.
const FORCE: Dimension = dimension("a force", "N");
const VELOCITY: Dimension = dimension("a velocity", "m/s");

/// The kinds by which a misplaced quantity is named.
pub(super) const NAMED: [&Dimension; 18] = [
    &LENGTH,
    &ANGLE,
    &TIME,
    &FREQUENCY,
    &ANGULAR_SPEED,
    &MASS,
    &INERTIA,
    &UNBALANCE,
    &DENSITY,
    &PRESSURE,
    &TORQUE,
    &STIFFNESS,
    &CUBIC_STIFFNESS,
    &DAMPING,
    &TORSIONAL_STIFFNESS,
    &TORSIONAL_DAMPING,
    &FORCE,
    &VELOCITY,
];

/// Force per power of a length; `exponent` as the file writes it.
pub(super) fn force_per_power(exponent: &str) -> Dimension {
    Dimension {
        name: Cow::Borrowed("a force per power of a length"),
        unit: Cow::Owned(format!("N/m^({exponent})")),
    }
}
