//! The rules of the basis, and the basis of a file that names none.

use super::rules::Rules;
use super::{Basis, Mesh};
use crate::config::{self, BasisModes, Place, Problem};

/// Every rotor vibrates at least up to this frequency [Hz], whatever its meshes do.
const LEAST_FREQUENCY: f64 = 1000.0;
/// Mesh forces have harmonics: the third one is the last that usually matters.
const MESH_HARMONICS: f64 = 3.0;

/// Checks `[basis]`.
pub(super) fn check_basis(basis: Option<&config::Basis>, problems: &mut Vec<Problem>) {
    let place = Place::root().table("basis");
    let mut rules = Rules {
        place: &place,
        problems,
    };
    match basis.and_then(|basis| basis.modes) {
        Some(BasisModes::Counts {
            lateral_modes,
            torsional_modes,
        }) => {
            rules.ensure("lateral_modes", lateral_modes >= 1, || {
                "must be at least 1, found 0".to_string()
            });
            rules.ensure("torsional_modes", torsional_modes >= 1, || {
                "must be at least 1 (the rigid rotation counts), found 0".to_string()
            });
        }
        Some(BasisModes::MaxFrequency(frequency)) => {
            rules.positive("max_frequency", frequency, "Hz");
        }
        None => {}
    }
}

/// Without `[basis]`, modes up to three times the highest mesh frequency and static shapes.
pub(super) fn resolve_basis(basis: Option<&config::Basis>, meshes: &[Mesh]) -> Basis {
    let fastest = meshes
        .iter()
        .map(|mesh| mesh.phase_rate.abs())
        .fold(0.0, f64::max);
    let default = BasisModes::MaxFrequency((MESH_HARMONICS * fastest).max(LEAST_FREQUENCY));
    match basis {
        None => Basis {
            modes: default,
            static_shapes: true,
        },
        Some(basis) => Basis {
            modes: basis.modes.unwrap_or(default),
            static_shapes: basis.static_shapes,
        },
    }
}
