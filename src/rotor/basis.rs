//! The shapes that represent one direction of a rotor: the lowest modes, then static shapes.

use core::f64::consts::TAU;

use nalgebra::DMatrix;

use super::elastic::Elastic;
use super::static_shapes::static_shapes;
use super::{Cause, FiniteElements};
use crate::config::BasisModes;
use crate::linalg::Modes;
use crate::train::{Basis, Rotor};

/// Number of coordinates of a rotor and what they stand for. The modes come first, then the static shapes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ModeCounts {
    /// Coordinates per lateral plane.
    pub lateral: usize,
    /// Torsional coordinates, a rigid rotation included.
    pub torsional: usize,
    /// How many lateral coordinates are modes.
    pub lateral_modes: usize,
    /// How many torsional coordinates are modes, a rigid rotation included.
    pub torsional_modes: usize,
}

/// Which modes are kept, and how many static shapes are added.
#[derive(Debug, Clone, Copy)]
pub(super) struct Extent {
    modes: usize,
    shapes: Option<usize>,
}

/// Phi or Phi_t.
pub(super) struct Shapes {
    /// One shape per column, mass normalised.
    pub(super) columns: DMatrix<f64>,
    /// w^2 of each, supports included [rad^2/s^2].
    pub(super) squared_frequencies: Vec<f64>,
    /// How many of them are modes.
    pub(super) modes: usize,
}

impl Shapes {
    pub(super) fn of(elastic: &Elastic, extent: Extent, loads: &[usize]) -> Result<Shapes, Cause> {
        let (modes, wanted) = (&elastic.modes, extent.modes);
        let available = modes.shapes.ncols();
        if wanted > available {
            return Err(Cause::TooFewModes { wanted, available });
        }
        let mut shapes = Shapes {
            columns: modes.shapes.columns(0, wanted).into_owned(),
            squared_frequencies: modes.squared_frequencies[..wanted].to_vec(),
            modes: wanted,
        };
        if extent.shapes != Some(0) {
            let added =
                static_shapes(elastic, wanted, loads, extent.shapes).ok_or(Cause::NoModes)?;
            shapes.append(&added.shapes);
            shapes.squared_frequencies.extend(added.squared_frequencies);
        }
        Ok(shapes)
    }

    fn append(&mut self, added: &DMatrix<f64>) {
        let (rows, kept) = self.columns.shape();
        self.columns
            .resize_horizontally_mut(kept + added.ncols(), 0.0);
        self.columns
            .view_mut((0, kept), (rows, added.ncols()))
            .copy_from(added);
    }

    /// Natural frequencies of the modes [Hz].
    pub(super) fn frequencies(&self) -> Vec<f64> {
        self.squared_frequencies[..self.modes]
            .iter()
            .map(|w2| w2.sqrt() / TAU)
            .collect()
    }
}

/// How far the basis goes in the lateral planes and in torsion. `counts` fixes it; otherwise `basis` decides.
pub(super) fn extents(
    basis: &Basis,
    counts: Option<ModeCounts>,
    lateral: &Modes,
    torsional: &Modes,
) -> [Extent; 2] {
    if let Some(counts) = counts {
        let extent = |modes, all| Extent {
            modes,
            shapes: Some(all - modes),
        };
        return [
            extent(counts.lateral_modes, counts.lateral),
            extent(counts.torsional_modes, counts.torsional),
        ];
    }
    let modes = match basis.modes {
        BasisModes::Counts {
            lateral_modes,
            torsional_modes,
        } => [lateral_modes, torsional_modes],
        BasisModes::MaxFrequency(frequency) => {
            let below = |modes: &Modes| {
                let squared = modes.squared_frequencies.iter();
                squared.filter(|w2| w2.sqrt() <= TAU * frequency).count()
            };
            [below(lateral).max(2), below(torsional).max(1)]
        }
    };
    modes.map(|modes| Extent {
        modes,
        shapes: if basis.static_shapes { None } else { Some(0) },
    })
}

/// Where unit loads make the lateral static shapes: bearings and gears.
pub(super) fn lateral_loads(rotor: &Rotor, elements: &FiniteElements) -> Vec<usize> {
    let bearings = rotor.bearings.iter().map(|bearing| bearing.position);
    let gears = rotor.gears.iter().map(|gear| gear.body.position);
    let displacement = |position| 2 * elements.stations.at(position);
    ascending(bearings.chain(gears).map(displacement))
}

/// Where unit torques make the torsional static shapes: gears and external torques.
pub(super) fn torsional_loads(rotor: &Rotor, elements: &FiniteElements) -> Vec<usize> {
    let gears = rotor.gears.iter().map(|gear| gear.body.position);
    let torques = rotor.torques.iter().map(|torque| torque.position);
    ascending(
        gears
            .chain(torques)
            .map(|position| elements.stations.at(position)),
    )
}

fn ascending(indices: impl Iterator<Item = usize>) -> Vec<usize> {
    let mut indices: Vec<usize> = indices.collect();
    indices.sort_unstable();
    indices.dedup();
    indices
}
