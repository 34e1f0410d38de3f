//! The rules that many keys share. Each pushes a [`Problem`] that names key, rule and found value.

use core::f64::consts::FRAC_PI_2;

use crate::config::{Place, Problem};

/// Pushes problems about the keys of one table.
pub(super) struct Rules<'a> {
    pub(super) place: &'a Place,
    pub(super) problems: &'a mut Vec<Problem>,
}

impl Rules<'_> {
    pub(super) fn ensure(&mut self, key: &str, holds: bool, message: impl FnOnce() -> String) {
        if !holds {
            self.problems
                .push(self.place.problem(key, format!("{key}: {}", message())));
        }
    }

    pub(super) fn finite(&mut self, key: &str, value: f64) {
        self.ensure(key, value.is_finite(), || {
            format!("must be a finite number, found {value}")
        });
    }

    pub(super) fn all_finite(&mut self, key: &str, values: &[f64]) {
        if let Some(wrong) = values.iter().find(|value| !value.is_finite()) {
            self.ensure(key, false, || {
                format!("every entry must be a finite number, found {wrong}")
            });
        }
    }

    pub(super) fn positive(&mut self, key: &str, value: f64, unit: &str) {
        self.ensure(key, value > 0.0 && value.is_finite(), || {
            format!("must be greater than 0 and finite, found {value} {unit}")
                .trim_end()
                .to_string()
        });
    }

    pub(super) fn not_negative(&mut self, key: &str, value: f64, unit: &str) {
        self.ensure(key, value >= 0.0 && value.is_finite(), || {
            format!("must be 0 or more and finite, found {value} {unit}")
                .trim_end()
                .to_string()
        });
    }

    pub(super) fn on_shaft(&mut self, position: f64, length: f64) {
        self.along_shaft("position", position, length);
    }

    /// A position under another key than `position`.
    pub(super) fn along_shaft(&mut self, key: &str, position: f64, length: f64) {
        let end = length * (1.0 + 1e-9); // sums of segment lengths carry rounding
        if position.is_nan() || position < 0.0 || position > end {
            let rule = if position > end {
                format!("{key} {position} m lies beyond the shaft's end at {length} m")
            } else {
                format!(
                    "{key}: must be a distance from the left end, 0 or more, found {position} m"
                )
            };
            self.problems.push(self.place.problem(key, rule));
        }
    }

    /// A pressure angle lies between 0 and a right angle.
    pub(super) fn pressure_angle(&mut self, angle: f64) {
        self.ensure("pressure_angle", angle > 0.0 && angle < FRAC_PI_2, || {
            format!("must be between 0 and pi/2 rad, found {angle}")
        });
    }
}
