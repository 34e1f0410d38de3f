//! How large gears and disks are drawn: a model file gives their inertia, not their shape.
//!
//! ```text
//!   disk   J = m (r^2 + r_i^2) / 2    ->  r                   r_i: radius of the shaft there
//!   gear   operating pitch radius of its (first) mesh
//!   both   m = rho pi (r^2 - r_i^2) w ->  w                   rho: density of the shaft there
//! ```

use core::f64::consts::PI;

use crate::config::Disk;
use crate::train::{GearAddress, GearTrain, Rotor, Section};

/// A pressure angle for gears that mesh with nothing [rad].
const USUAL: f64 = 20.0 * PI / 180.0;

/// Half the width and the radius of a drawn body [m].
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Body {
    pub(super) half_width: f64,
    pub(super) radius: f64,
}

/// A disk without teeth.
pub(super) fn disk(rotor: &Rotor, disk: &Disk) -> Body {
    let inner = shaft_radius(rotor, disk.position);
    let square = 2.0 * disk.polar_inertia / disk.mass - inner * inner;
    let radius = if square.is_finite() && square > 0.0 {
        square.sqrt()
    } else {
        0.0
    };
    solid(rotor, disk, radius.max(1.3 * inner))
}

/// A gear with this pitch radius [m].
pub(super) fn gear(rotor: &Rotor, body: &Disk, radius: f64) -> Body {
    solid(rotor, body, radius)
}

/// The radius [m] at which a gear touches its mate.
pub(super) fn pitch_radius(train: &GearTrain, gear: GearAddress) -> f64 {
    let meshing = train.meshes.iter().find_map(|mesh| {
        let side = mesh.gears.iter().position(|other| *other == gear)?;
        Some(mesh.pitch_radii()[side])
    });
    meshing.unwrap_or_else(|| train.gear(gear).base_radius / libm::cos(USUAL))
}

/// Whether a gear is a ring around another one.
pub(super) fn is_ring(train: &GearTrain, gear: GearAddress) -> bool {
    let inside = |mesh: &crate::train::Mesh| mesh.line.is_internal() && mesh.gears[1] == gear;
    train.meshes.iter().any(inside)
}

fn solid(rotor: &Rotor, disk: &Disk, radius: f64) -> Body {
    let inner = shaft_radius(rotor, disk.position);
    let density = section(rotor, disk.position).map_or(7850.0, |section| section.material.density);
    let area = PI * (radius * radius - inner * inner);
    let width = disk.mass / (density * area);
    let [least, most] = [0.006 * rotor.length(), 0.3 * rotor.length()];
    let width = if width.is_finite() {
        width.clamp(least, most)
    } else {
        least
    };
    Body {
        half_width: 0.5 * width,
        radius,
    }
}

/// How far a rotor reaches from its centre line [m], gears aside that mesh.
pub(super) fn extent(rotor: &Rotor) -> f64 {
    let shaft = rotor
        .sections
        .iter()
        .map(|section| 0.5 * section.outer_diameter);
    let disks = rotor.disks.iter().map(|one| disk(rotor, one).radius);
    let gears = rotor
        .gears
        .iter()
        .map(|gear| gear.base_radius / libm::cos(USUAL));
    shaft.chain(disks).chain(gears).fold(0.0, f64::max)
}

/// Outer radius of the shaft at a position [m].
pub(super) fn shaft_radius(rotor: &Rotor, position: f64) -> f64 {
    section(rotor, position).map_or(0.0, |section| 0.5 * section.outer_diameter)
}

fn section(rotor: &Rotor, position: f64) -> Option<&Section> {
    let here = rotor
        .sections
        .iter()
        .find(|section| section.end >= position);
    here.or(rotor.sections.last())
}
