//! Where the shafts stand: every mesh says where the centre of its gear b lies, seen from that of a.
//!
//! ```text
//!   c_b - c_a = (R_a + R_b) / cos p (cos psi, sin psi)          in a ring (R_b - R_a) / cos p
//! ```
//!
//! Around a loop of meshes the centres must close; nothing else in the model depends on them.

use super::{GearTrain, Mesh};
use crate::config::{Place, Problem};

/// How far a loop may stay open, relative to the centre distance of the mesh that closes it: angles and radii in
/// files are often rounded, and profile shift moves operating angles by more than base radii tell.
const OPEN: f64 = 0.02;

/// Warns of meshes whose gears other meshes have put somewhere else.
pub(super) fn open_loops(train: &GearTrain) -> Vec<Problem> {
    let centres = centres(train);
    let mut warnings = Vec::new();
    for (index, mesh) in train.meshes.iter().enumerate() {
        let own = mesh.centre_offset();
        let [a, b] = mesh.gears.map(|gear| centres[gear.rotor]);
        let around = [b[0] - a[0], b[1] - a[1]];
        let gap = libm::hypot(around[0] - own[0], around[1] - own[1]);
        if gap > OPEN * libm::hypot(own[0], own[1]) {
            let place = Place::root().element("mesh", index, Some(&mesh.name));
            let polar = |[x, y]: [f64; 2]| {
                let (distance, angle) = (libm::hypot(x, y), libm::atan2(y, x));
                format!("{distance:.6} m at {angle:.6} rad")
            };
            let message = format!(
                "center_angle: puts the centre of \"{}\" {} from that of \"{}\", the other meshes of the loop put it \
                 {}: check the center_angle, pressure_angle and base radii around the loop",
                train.gear_name(mesh.gears[1]),
                polar(own),
                train.gear_name(mesh.gears[0]),
                polar(around)
            );
            warnings.push(place.problem("center_angle", message));
        }
    }
    warnings
}

impl Mesh {
    /// From the centre of gear a to that of gear b, c_b - c_a [m].
    pub fn centre_offset(&self) -> [f64; 2] {
        let line = &self.line;
        let distance = (line.radius_a + line.radius_b).abs() / self.cosine_of_pressure_angle();
        line.center_line.map(|component| distance * component)
    }

    /// Operating pitch radii of gears a and b [m].
    pub fn pitch_radii(&self) -> [f64; 2] {
        let cosine = self.cosine_of_pressure_angle();
        [self.line.radius_a, self.line.radius_b].map(|radius| radius.abs() / cosine)
    }

    fn cosine_of_pressure_angle(&self) -> f64 {
        let line = &self.line;
        // n = cos p x (across) + sin p x (along the centre line, away from it in a ring)
        let along = line.normal[0] * line.center_line[0] + line.normal[1] * line.center_line[1];
        (1.0 - along * along).max(0.0).sqrt()
    }
}

/// The centre of every rotor [m] in the x-y plane, the first rotor of each connected train at the origin; the first
/// mesh that reaches a rotor decides.
pub fn centres(train: &GearTrain) -> Vec<[f64; 2]> {
    let mut centres: Vec<Option<[f64; 2]>> = vec![None; train.rotors.len()];
    for leader in 0..centres.len() {
        if centres[leader].is_some() {
            continue;
        }
        centres[leader] = Some([0.0; 2]);
        while let Some((rotor, centre)) = train.meshes.iter().find_map(|mesh| next(mesh, &centres))
        {
            centres[rotor] = Some(centre);
        }
    }
    centres.into_iter().flatten().collect()
}

/// The rotor that a mesh places next to one that stands already.
fn next(mesh: &Mesh, centres: &[Option<[f64; 2]>]) -> Option<(usize, [f64; 2])> {
    let ([a, b], [x, y]) = (mesh.gears.map(|gear| gear.rotor), mesh.centre_offset());
    match (centres[a], centres[b]) {
        (Some(centre), None) => Some((b, [centre[0] + x, centre[1] + y])),
        (None, Some(centre)) => Some((a, [centre[0] - x, centre[1] - y])),
        _ => None,
    }
}
