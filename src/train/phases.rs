//! Mesh phases that follow from geometry.
//!
//! ```text
//!   p = s z_a phi_a / 2 pi + p_0        p_0 of two meshes of gear a differs by -s z_a (psi_j - psi_i) / 2 pi
//! ```
//!
//! The same tooth of a reaches the direction psi_j later than psi_i by (psi_j - psi_i) / Om_a. The first mesh of a
//! gear a has p_0 = 0: only differences between meshes matter. For meshes on which a gear has different roles
//! (driven here, driving there, seen from the other gear, or inside a ring) the difference depends on tooth
//! thicknesses and tip radii, which a model file does not have; the rule is applied and a warning says so.

use core::f64::consts::TAU;

use super::{GearTrain, Mesh};
use crate::config::{Config, Place, Problem};

/// Adds p_0 to every mesh. `config` is what the train was made from. Gives warnings where geometry is not enough.
pub(super) fn settle(config: &Config, train: &mut GearTrain) -> Vec<Problem> {
    let mut warnings = Vec::new();
    let mut offsets: Vec<f64> = Vec::new();
    for (index, said) in config.meshes.iter().enumerate() {
        let (earlier, mesh) = (&train.meshes[..index], &train.meshes[index]);
        let offset = said.phase.unwrap_or_else(|| {
            let first = earlier.iter().position(|one| one.gears[0] == mesh.gears[0]);
            first.map_or(0.0, |first| {
                let turned = said.center_angle - config.meshes[first].center_angle;
                let teeth = f64::from(train.gear(mesh.gears[0]).teeth);
                offsets[first] - mesh.line.flank * teeth * turned / TAU
            })
        });
        let doubtful = earlier.iter().find(|one| thickness_matters(one, mesh));
        if let (None, Some(other)) = (said.phase, doubtful) {
            let place = Place::root().element("mesh", index, Some(&mesh.name));
            let message = format!(
                "phase: missing, {offset} pitches are assumed; relative to mesh \"{}\", where one of the gears has \
                 another role or flank, it depends on tooth thicknesses: give phase if it matters",
                other.name
            );
            warnings.push(place.problem("phase", message));
        }
        offsets.push(offset);
    }
    for (mesh, offset) in train.meshes.iter_mut().zip(offsets) {
        mesh.start_phase += offset;
    }
    warnings
}

/// Whether two meshes share a gear that does not show both of them the same flank in the same way.
fn thickness_matters(one: &Mesh, other: &Mesh) -> bool {
    let ([a, b], [other_a, other_b]) = (one.gears, other.gears);
    let alike =
        one.line.flank == other.line.flank && one.line.is_internal() == other.line.is_internal();
    (a == other_a && !alike) || a == other_b || b == other_a || b == other_b
}
