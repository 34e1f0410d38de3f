//! How far a rotor gives under a static unit load at the places where the train takes hold of it.
//!
//! ```text
//!   g = w K^-1 w'          displacement [m/N] or rotation [rad/(N m)] at the load, meshes open
//! ```
//!
//! A rotor that can turn freely is balanced by its inertia: its rigid rotation is left out of K^-1 (inertia relief). A
//! rotor that is not held sideways has no lateral compliance.

use nalgebra::{DMatrix, DVector};

use crate::model::{Coordinates, ModalModel};
use crate::solver::Row;

/// A torsional stiffness below this is none [rad^2/s^2]: 0.05 Hz.
const RIGID: f64 = 0.1;
/// Smallest pivot relative to the largest below which a rotor is not held.
const LOOSE: f64 = 1e-14;

/// What is loaded.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Place {
    /// A gear of the rotor, sideways or in torsion.
    Gear(usize),
    /// A bearing of the rotor, sideways.
    Bearing(usize),
    /// A torque of the rotor, in torsion.
    Torque(usize),
}

/// Where and in which direction a unit load acts.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Spot {
    /// Index of the rotor.
    pub rotor: usize,
    /// What sits there.
    pub place: Place,
    /// Whether the load is a torque.
    pub torsional: bool,
}

/// A compliance at a spot.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Compliance {
    /// Where.
    pub spot: Spot,
    /// In x and y [m/N], or twice the same in torsion [rad/(N m)].
    pub values: [f64; 2],
}

/// The compliances of every rotor at its gears, bearings and torques; always the same spots for the same train
/// unless a rotor is not held.
pub fn static_compliances(model: &ModalModel) -> Vec<Compliance> {
    let mut found = Vec::new();
    for (index, rotor) in model.rotors.iter().enumerate() {
        let blocks = &model.system.blocks;
        let lateral = inverse(&rotor.lateral.stiffness(blocks));
        let torsional = inverse_without_rotation(&rotor.torsional.stiffness(blocks));
        let mut add = |place: Place, torsional: bool, values: [f64; 2]| {
            let spot = Spot {
                rotor: index,
                place,
                torsional,
            };
            found.push(Compliance { spot, values });
        };
        let twist = |row: &Row| [along(row, &rotor.torsional, &torsional); 2];
        for (gear, station) in rotor.gears.iter().enumerate() {
            if let Some(lateral) = &lateral {
                let rows = [&station.x, &station.y];
                let values = rows.map(|row| along(row, &rotor.lateral, lateral));
                add(Place::Gear(gear), false, values);
            }
            add(Place::Gear(gear), true, twist(&station.theta));
        }
        for (bearing, held) in rotor.bearings.iter().enumerate() {
            if let Some(lateral) = &lateral {
                let rows = [&held.station.x, &held.station.y];
                add(
                    Place::Bearing(bearing),
                    false,
                    rows.map(|row| along(row, &rotor.lateral, lateral)),
                );
            }
        }
        for (torque, row) in rotor.torques.iter().enumerate() {
            add(Place::Torque(torque), true, twist(row));
        }
    }
    found
}

/// w K^-1 w'.
fn along(row: &Row, place: &Coordinates, inverse: &DMatrix<f64>) -> f64 {
    let entries = place.range().map(|coordinate| row.entry(coordinate));
    let w = DVector::from_iterator(inverse.nrows(), entries);
    w.dot(&(inverse * &w))
}

fn inverse(stiffness: &DMatrix<f64>) -> Option<DMatrix<f64>> {
    let lu = stiffness.clone().full_piv_lu();
    let pivots = lu.u().diagonal().abs();
    (pivots.min() > LOOSE * pivots.max())
        .then(|| lu.try_inverse())
        .flatten()
}

fn inverse_without_rotation(stiffness: &DMatrix<f64>) -> DMatrix<f64> {
    let mut inverse = DMatrix::zeros(stiffness.nrows(), stiffness.ncols());
    let eigen = stiffness.clone().symmetric_eigen();
    for (value, shape) in eigen
        .eigenvalues
        .iter()
        .zip(eigen.eigenvectors.column_iter())
        .filter(|(value, _)| value.abs() > RIGID)
    {
        inverse += shape * shape.transpose() / *value;
    }
    inverse
}
