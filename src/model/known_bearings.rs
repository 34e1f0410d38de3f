//! A housing by itself that knows the bearings which stand on its points: their forces follow its motion within a step.
//!
//! ```text
//!   at a communication point   R = F + K u + C u'              F: the whole force of the bearing, an input; R: what the shaft's motion makes of it
//!   within the step            F = R - K u - C u',             R held, or R' = F' + K u' + C u'' with input derivatives F'
//!   eta'' + (2 zeta w + psi' C psi) eta' + (w^2 + psi' K psi) eta = psi' R        one block, solved exactly
//! ```
//!
//! Only steps know this system. Everything else (equilibrium, natural vibrations, accelerations under the forces as they are set) is
//! that of the housing as it is, and with short steps so is the motion, however wrong K and C may be.

use nalgebra::{DMatrix, DVector};

use super::inputs::product;
use super::{Housing, Inputs, ModalModel, Motion};
use crate::config;
use crate::solver::{Block, Row, System};
use crate::train;

/// The bearings, and the housing that stands on them.
#[derive(Debug, Clone)]
pub(super) struct KnownBearings {
    system: System,
    bearings: Vec<KnownBearing>,
}

/// A bearing on a point that takes forces.
#[derive(Debug, Clone)]
struct KnownBearing {
    /// The place of its force among the inputs.
    force: usize,
    coefficients: config::KnownBearing,
    /// Displacement of the point in x and y [m].
    rows: [Row; 2],
    /// Acceleration of the point per displacement and per velocity of the modes, without forces from outside.
    recoil: [[Row; 2]; 2],
    /// Acceleration of the point per force on every point that takes some, x and y of each [1/kg].
    mobility: [Vec<f64>; 2],
}

impl KnownBearings {
    /// Those of a housing, if there are any.
    pub(super) fn of(housing: &Housing, points: &[train::HousingPoint]) -> Option<KnownBearings> {
        if points.iter().all(|point| point.bearing.is_none()) {
            return None;
        }
        let size = housing.modes.len();
        let loads: Vec<DVector<f64>> = housing
            .loaded()
            .map(|row| DVector::from_vec(row.to_dense(size)))
            .collect();
        let of_modes = |value: fn(&super::Mode) -> f64| {
            DVector::from_iterator(size, housing.modes.iter().map(value))
        };
        let stiffness = of_modes(|mode| mode.frequency * mode.frequency);
        let damping = of_modes(|mode| 2.0 * mode.damping_ratio * mode.frequency);
        let row = |values: DVector<f64>| Row::new(0, 0, values.as_slice().to_vec());
        let known = |(point, bearing): (&super::Point, &train::HousingPoint)| {
            let (force, coefficients) = (point.force?, bearing.bearing?);
            let own = [&loads[2 * force], &loads[2 * force + 1]];
            let recoil = |matrix: &DVector<f64>| own.map(|own| row(-own.component_mul(matrix)));
            Some(KnownBearing {
                force,
                coefficients,
                rows: own.map(|own| row(own.clone())),
                recoil: [recoil(&stiffness), recoil(&damping)],
                mobility: own.map(|own| loads.iter().map(|load| own.dot(load)).collect()),
            })
        };
        let bearings = housing.points.iter().zip(points).filter_map(known);
        let bearings: Vec<KnownBearing> = bearings.collect();
        let mut block = Block {
            offset: 0,
            stiffness: DMatrix::from_diagonal(&stiffness),
            damping: DMatrix::from_diagonal(&damping),
        };
        for bearing in &bearings {
            let config::KnownBearing { stiffness, damping } = bearing.coefficients;
            let own = &loads[2 * bearing.force..][..2];
            for (matrix, planar) in [
                (&mut block.stiffness, stiffness),
                (&mut block.damping, damping),
            ] {
                for (push, entries) in own.iter().zip(planar.rows()) {
                    for (moved, entry) in own.iter().zip(entries) {
                        matrix.ger(entry, push, moved, 1.0);
                    }
                }
            }
        }
        let system = System {
            size,
            blocks: vec![block],
            loads: loads.into_iter().map(row).collect(),
            ..System::default()
        };
        Some(KnownBearings { system, bearings })
    }
}

impl ModalModel {
    /// The equations of motion within a step; [`ModalModel::system`] holds at its ends.
    pub fn system_in_steps(&self) -> &System {
        let known = self.known_bearings.as_ref();
        known.map_or(&self.system, |known| &known.system)
    }

    /// Whether forces on the housing follow its motion within a step.
    pub fn knows_bearings(&self) -> bool {
        self.known_bearings.is_some()
    }
}

impl Motion<'_> {
    /// Adds `factor` (K u + C u') to the forces of known bearings among `forces`.
    pub fn add_known_forces(&self, factor: f64, forces: &mut Inputs) {
        for bearing in self.known_bearings() {
            let displacement = bearing.rows.each_ref().map(|row| self.displacement(row));
            let velocity = bearing.rows.each_ref().map(|row| self.velocity(row));
            bearing.add(factor, [displacement, velocity], forces);
        }
    }

    /// Adds `factor` (K u' + C u''), with u'' under the forces as they are now.
    pub fn add_known_force_rates(&self, factor: f64, rates: &mut Inputs) {
        for bearing in self.known_bearings() {
            let velocity = bearing.rows.each_ref().map(|row| self.velocity(row));
            let acceleration = [0, 1].map(|axis| {
                let [per_displacement, per_velocity] = &bearing.recoil;
                let forces = self.inputs.forces().as_flattened();
                let pushed = bearing.mobility[axis].iter().zip(forces);
                self.displacement(&per_displacement[axis])
                    + self.velocity(&per_velocity[axis])
                    + pushed
                        .map(|(mobility, force)| mobility * force)
                        .sum::<f64>()
            });
            bearing.add(factor, [velocity, acceleration], rates);
        }
    }

    fn known_bearings(&self) -> impl Iterator<Item = &KnownBearing> {
        let known = self.model.known_bearings.iter();
        known.flat_map(|known| &known.bearings)
    }
}

impl KnownBearing {
    fn add(&self, factor: f64, [moved, rate]: [[f64; 2]; 2], forces: &mut Inputs) {
        let spring = product(&self.coefficients.stiffness, moved);
        let damper = product(&self.coefficients.damping, rate);
        for axis in 0..2 {
            forces.forces_mut()[self.force][axis] += factor * (spring[axis] + damper[axis]);
        }
    }
}
