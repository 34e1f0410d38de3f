//! One direction of a rotor's motion, a plane or torsion, with its modes.
//!
//! ```text
//!   (K + K_sup) phi = w^2 M phi       K: shaft and K_xx, or K_T;  K_sup: basis supports, for the modes only
//! ```
//!
//! A motion without any strain is known better than an eigenvalue solver finds it: the rotation is exactly the same
//! at all stations, the displacement exactly linear along the shaft.

use nalgebra::DMatrix;

use super::FiniteElements;
use crate::linalg::{Modes, natural_modes};
use crate::train::Rotor;

/// Matrices and modes of one direction, full order.
pub(super) struct Elastic {
    /// M or J.
    pub(super) mass: DMatrix<f64>,
    /// K without the supports.
    pub(super) stiffness: DMatrix<f64>,
    /// K + K_sup.
    pub(super) supported: DMatrix<f64>,
    /// Modes with the supports.
    pub(super) modes: Modes,
    /// Modes without them; `None`: there are no supports.
    unsupported: Option<Modes>,
    /// How many motions have no strain in the shaft: shift and tilt, or the rotation.
    strainless: usize,
}

/// Below this part of the w^2 of the first mode that must strain the shaft, a mode hardly does: soft bearings hold it.
const SOFT: f64 = 1e-4;

impl Elastic {
    /// One plane of a rotor, with the direct bearing stiffness K_xx at its mean speed.
    pub(super) fn lateral(rotor: &Rotor, elements: &FiniteElements) -> Option<Elastic> {
        let mut stiffness = elements.shaft_stiffness.clone();
        for bearing in &rotor.bearings {
            let displacement = 2 * elements.stations.at(bearing.position);
            let spring = bearing.coefficients(rotor.speed).stiffness.xx;
            stiffness[(displacement, displacement)] += spring;
        }
        let supports = rotor.basis_supports.iter().map(|support| {
            let displacement = 2 * elements.stations.at(support.position);
            (displacement, support.lateral)
        });
        let positions = elements.stations.positions();
        let strainless =
            DMatrix::from_fn(stiffness.nrows(), 2, |i, motion| match (i % 2, motion) {
                (0, 0) | (1, 1) => 1.0,
                (0, 1) => positions[i / 2],
                _ => 0.0,
            });
        Elastic::of(&elements.mass, stiffness, supports, &strainless)
    }

    /// Torsion of a rotor.
    pub(super) fn torsional(rotor: &Rotor, elements: &FiniteElements) -> Option<Elastic> {
        let supports = rotor
            .basis_supports
            .iter()
            .map(|support| (elements.stations.at(support.position), support.torsional));
        let stiffness = elements.torsional_stiffness.clone();
        let strainless = DMatrix::from_element(stiffness.nrows(), 1, 1.0);
        Elastic::of(&elements.inertia, stiffness, supports, &strainless)
    }

    fn of(
        mass: &DMatrix<f64>,
        stiffness: DMatrix<f64>,
        supports: impl Iterator<Item = (usize, f64)>,
        strainless: &DMatrix<f64>,
    ) -> Option<Elastic> {
        let mut supported = stiffness.clone();
        for (index, spring) in supports {
            supported[(index, index)] += spring;
        }
        let modes = |stiffness| modes_with_exact_rigid_motion(stiffness, mass, strainless);
        let unsupported = if supported == stiffness {
            None
        } else {
            Some(modes(&stiffness)?)
        };
        Some(Elastic {
            modes: modes(&supported)?,
            unsupported,
            mass: mass.clone(),
            stiffness,
            supported,
            strainless: strainless.ncols(),
        })
    }

    /// The modes without the supports.
    pub(super) fn unsupported(&self) -> &Modes {
        self.unsupported.as_ref().unwrap_or(&self.modes)
    }

    /// How many of the first of these modes, with or without the supports, have no strain in the shaft or hardly any.
    pub(super) fn soft_count(&self, modes: &Modes) -> usize {
        let squared = &modes.squared_frequencies;
        let straining = squared.get(self.strainless).copied().unwrap_or(0.0);
        let soft = |w2: &&f64| **w2 <= SOFT * straining;
        squared
            .iter()
            .take(self.strainless)
            .take_while(soft)
            .count()
    }
}

/// Natural modes; those without strain become combinations of the given motions, mass normalised.
fn modes_with_exact_rigid_motion(
    stiffness: &DMatrix<f64>,
    mass: &DMatrix<f64>,
    strainless: &DMatrix<f64>,
) -> Option<Modes> {
    let mut modes = natural_modes(stiffness, mass)?;
    let rigid = modes.rigid_count().min(strainless.ncols());
    let weighted = strainless.transpose() * mass;
    let inertia = (&weighted * strainless).cholesky()?;
    for index in 0..rigid {
        let share = inertia.solve(&(&weighted * modes.shapes.column(index)));
        let mut shape = strainless * share;
        for other in 0..index {
            let other = modes.shapes.column(other);
            let along = other.dot(&(mass * &shape));
            shape.axpy(-along, &other, 1.0);
        }
        shape /= shape.dot(&(mass * &shape)).sqrt();
        modes.shapes.set_column(index, &shape);
    }
    Some(modes)
}
