//! The rows of the housing: forces on its points, how they move, its modes.

use super::super::parameter::Parameter;
use super::super::{Quantity, Unit};
use super::{AXES, Table};
use crate::config::Kind;
use crate::model::Housing as ModalHousing;
use crate::train::Housing;

/// What is shown of the motion of a point: ending of the name, unit, meaning.
type Shown = (
    &'static str,
    Unit,
    fn(usize, usize) -> Quantity,
    &'static str,
);

const MOTION: [Shown; 3] = [
    (
        "",
        Unit::Meter,
        |point, axis| Quantity::PointDisplacement { point, axis },
        "Displacement",
    ),
    (
        "v",
        Unit::MeterPerSecond,
        |point, axis| Quantity::PointVelocity { point, axis },
        "Velocity",
    ),
    (
        "a",
        Unit::MeterPerSecondSquared,
        |point, axis| Quantity::PointAcceleration { point, axis },
        "Acceleration",
    ),
];

impl Table<'_> {
    pub(super) fn point_forces(&mut self, housing: &Housing) {
        let loaded = housing.points.iter().filter(|point| point.takes_forces);
        for (force, point) in loaded.enumerate() {
            for (axis, letter) in AXES.into_iter().enumerate() {
                self.input(
                    format!("{}.force_{letter}", point.name),
                    Unit::Newton,
                    Quantity::PointForce { force, axis },
                    0.0,
                    format!("Force on the housing at {} in {letter}", point.name),
                );
            }
        }
    }

    pub(super) fn points(&mut self, housing: &Housing) {
        for (index, point) in housing.points.iter().enumerate() {
            for (prefix, unit, quantity, what) in MOTION {
                for (axis, letter) in AXES.into_iter().enumerate() {
                    self.row(
                        format!("{}.{prefix}{letter}", point.name),
                        unit,
                        quantity(index, axis),
                        format!("{what} of the housing at {} in {letter}", point.name),
                    );
                }
            }
        }
    }

    pub(super) fn housing_parameters(&mut self, housing: &Housing) {
        for mode in 0..housing.modes.len() {
            let number = mode + 1;
            self.parameter(
                format!("housing.frequency[{number}]"),
                Unit::Hertz,
                Parameter::HousingFrequency { mode },
                format!("Natural frequency of mode {number} of the housing alone"),
            );
        }
        for mode in 0..housing.modes.len() {
            let number = mode + 1;
            self.parameter(
                format!("housing.damping_ratio[{number}]"),
                Unit::One,
                Parameter::HousingDampingRatio { mode },
                format!("Damping ratio of mode {number} of the housing alone"),
            );
        }
    }

    /// What a housing by itself knows of the bearings on it; in a gear train they are bearings of that train.
    pub(super) fn known_bearings(&mut self) {
        let structure = self.config.housing.iter();
        let structure = structure.filter(|_| self.config.kind == Kind::Housing);
        let points = structure.flat_map(|housing| &housing.points).enumerate();
        let known = points.filter(|(_, point)| point.bearing.is_some());
        let known: Vec<(usize, String)> = known
            .map(|(index, point)| (index, point.name.clone()))
            .collect();
        for (point, name) in &known {
            let point = *point;
            self.coefficients(
                name,
                &format!("the bearing on {name}, as far as the housing knows"),
                |entry| Parameter::PointStiffness { point, entry },
                |entry| Parameter::PointDamping { point, entry },
            );
        }
        if !known.is_empty() {
            self.parameter(
                "simulation.known_bearings".to_string(),
                Unit::One,
                Parameter::KnownBearings,
                "1: forces of bearings follow the housing's motion within a step, by the stiffness and damping that its points state; 0: not"
                    .to_string(),
            );
        }
    }

    pub(super) fn housing_coordinates(&mut self, housing: &ModalHousing) {
        for (index, mode) in housing.modes.iter().enumerate() {
            let number = index + 1;
            self.row(
                format!("housing.modal[{number}]"),
                Unit::One,
                Quantity::Modal {
                    coordinate: mode.place.range().start,
                },
                format!("Modal coordinate of mode {number} of the housing, mass normalised"),
            );
        }
    }
}
