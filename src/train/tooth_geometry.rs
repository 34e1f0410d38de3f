//! The rules of the law `tooth_geometry`, and the way from its table to a [`SpurPair`]: teeth that cannot be made or cannot
//! mesh are refused with what to change.

use std::collections::BTreeMap;

use super::rules::Rules;
use super::{Gear, Rotor};
use crate::config::{self, Material, ToothGeometry};
use crate::mesh::{FITTED_BODIES, PathOfContact, SpurGear, SpurPair, Tooth};

/// Thinner tips [modules] break, and their stiffness changes too steeply to be represented.
const THINNEST_TIP: f64 = 0.1;
/// Part of the teeth without any undercut that suffices: 14 of 17 at 20 degrees, the usual practical limit.
const UNDERCUT_TEETH: f64 = 0.8;
/// Sum of profile shifts [modules] by which rounding of the pressure angle may exceed that of a mesh without backlash.
const SHIFT_ROUNDING: f64 = 0.005;
/// Least root radius relative to the base radius: below it a tooth is no cantilever.
const DEEPEST_ROOT: f64 = 0.5;

/// One gear of the mesh, where it sits, and its name in the file.
#[derive(Clone, Copy)]
pub(super) struct MeshedGear<'a> {
    pub(super) rotor: &'a Rotor,
    pub(super) gear: &'a Gear,
    pub(super) address: &'a str,
}

/// Rules of single numbers.
pub(super) fn check_numbers(rules: &mut Rules<'_>, geometry: &ToothGeometry) {
    rules.positive("face_width", geometry.face_width, "m");
    rules.positive("module", geometry.module, "m");
    let angle = geometry.rack_pressure_angle;
    let right = core::f64::consts::FRAC_PI_2;
    rules.ensure("rack_pressure_angle", angle > 0.0 && angle < right, || {
        format!("must be between 0 and pi/2 rad, found {angle}")
    });
    for (key, pair) in [
        ("addendum", geometry.addendum),
        ("dedendum", geometry.dedendum),
        ("bore_radius", geometry.bore_radius.unwrap_or([1.0; 2])),
    ] {
        let [a, b] = pair;
        let positive = |value: f64| value > 0.0 && value.is_finite();
        rules.ensure(key, positive(a) && positive(b), || {
            format!("both must be greater than 0 and finite, found {a} and {b}")
        });
    }
    rules.all_finite("profile_shift", &geometry.profile_shift);
}

/// The pair of gears; `None` when something is wrong with it, which becomes problems with keys of `[mesh.stiffness]`.
pub(super) fn resolve(
    rules: &mut Rules<'_>,
    geometry: &ToothGeometry,
    mesh: &config::Mesh,
    gears: [MeshedGear<'_>; 2],
    materials: &BTreeMap<String, Material>,
) -> Option<SpurPair> {
    let before = rules.problems.len();
    rules.ensure("law", !mesh.internal, || {
        "\"tooth_geometry\" is for external gears only; give the mesh with a ring another law, such as \"constant\" or \
         \"tooth_pair\""
            .to_string()
    });
    if mesh.internal {
        return None;
    }
    let made = [0, 1].map(|side| {
        check_base_radius(rules, geometry, &gears[side]);
        spur_gear(rules, geometry, side, &gears[side], materials)
    });
    let [Some(a), Some(b)] = made else {
        return None;
    };
    let pair = SpurPair {
        module: geometry.module,
        rack_pressure_angle: geometry.rack_pressure_angle,
        pressure_angle: mesh.pressure_angle,
        face_width: geometry.face_width,
        gears: [a, b],
    };
    let made = rules.problems.len();
    check_teeth(rules, &pair, gears.map(|gear| gear.address));
    if rules.problems.len() == made {
        check_mesh(rules, &pair, gears.map(|gear| gear.address));
    }
    (rules.problems.len() == before).then_some(pair)
}

/// The base circle is given by the gear and by the rack: both must say the same.
fn check_base_radius(rules: &mut Rules<'_>, geometry: &ToothGeometry, gear: &MeshedGear<'_>) {
    let (teeth, given) = (gear.gear.teeth, gear.gear.base_radius);
    let per_module = 0.5 * f64::from(teeth) * libm::cos(geometry.rack_pressure_angle);
    let made = per_module * geometry.module;
    rules.ensure("module", (made / given - 1.0).abs() <= 1e-6, || {
        format!(
            "with {teeth} teeth and a rack_pressure_angle of {} rad it makes a base radius of {made} m, but that \
             of \"{}\" is {given} m; change that, or the module to {} m",
            geometry.rack_pressure_angle,
            gear.address,
            given / per_module
        )
    });
}

fn spur_gear(
    rules: &mut Rules<'_>,
    geometry: &ToothGeometry,
    side: usize,
    gear: &MeshedGear<'_>,
    materials: &BTreeMap<String, Material>,
) -> Option<SpurGear> {
    let before = rules.problems.len();
    let name = &geometry.material[side];
    let material = materials.get(name);
    rules.ensure("material", material.is_some(), || {
        let known: Vec<&str> = materials.keys().map(String::as_str).collect();
        format!(
            "no [material.{name}] in this file; there is: {}",
            known.join(", ")
        )
    });
    let (teeth, dedendum) = (f64::from(gear.gear.teeth), geometry.dedendum[side]);
    let profile_shift = geometry.profile_shift[side];
    let root_radius = geometry.module * (0.5 * teeth + profile_shift - dedendum);
    let deepest = DEEPEST_ROOT * gear.gear.base_radius;
    rules.ensure("dedendum", root_radius > deepest, || {
        let address = gear.address;
        format!(
            "leaves a root radius of {root_radius:.6} m of \"{address}\", must be more than {deepest:.6} m; reduce \
             dedendum or raise profile_shift"
        )
    });
    if rules.problems.len() > before {
        return None;
    }
    Some(SpurGear {
        teeth,
        addendum: geometry.addendum[side],
        dedendum,
        profile_shift,
        bore_radius: bore_radius(rules, geometry, side, gear, root_radius),
        youngs_modulus: material?.youngs_modulus,
        poisson_ratio: material?.poisson_ratio,
    })
}

/// Where the gear body is held: as given, or by the shaft as far as the formula for the body allows.
fn bore_radius(
    rules: &mut Rules<'_>,
    geometry: &ToothGeometry,
    side: usize,
    gear: &MeshedGear<'_>,
    root_radius: f64,
) -> f64 {
    let address = gear.address;
    let [least, most] = [FITTED_BODIES[1], FITTED_BODIES[0]].map(|ratio| root_radius / ratio);
    match geometry.bore_radius {
        Some(radii) => {
            let radius = radii[side];
            // A bound copied from this message is rounded.
            let inside = radius > least * (1.0 - 1e-3) && radius < most * (1.0 + 1e-3);
            rules.ensure("bore_radius", inside, || {
                format!(
                    "must be from {least:.6} m to {most:.6} m for \"{address}\" (1/{} to 1/{} of its root radius, for which \
                     the stiffness of the gear body is known), found {radius} m",
                    FITTED_BODIES[1], FITTED_BODIES[0]
                )
            });
            radius
        }
        None => {
            let shaft = shaft_radius(gear);
            rules.ensure("module", shaft < root_radius, || {
                format!(
                    "the root circle of \"{address}\" with a radius of {root_radius:.6} m lies inside its shaft with a \
                     radius of {shaft} m; give a smaller shaft or larger teeth"
                )
            });
            shaft.clamp(least, most)
        }
    }
}

/// Outer radius of the shaft at the gear [m]; at a step the larger one.
fn shaft_radius(gear: &MeshedGear<'_>) -> f64 {
    let (position, close) = (gear.gear.body.position, 1e-9 * gear.rotor.length());
    let mut start = 0.0;
    let mut radius: f64 = 0.0;
    for section in &gear.rotor.sections {
        if (start - close..=section.end + close).contains(&position) {
            radius = radius.max(0.5 * section.outer_diameter);
        }
        start = section.end;
    }
    radius
}

/// Teeth that a rack can make.
fn check_teeth(rules: &mut Rules<'_>, pair: &SpurPair, addresses: [&str; 2]) {
    let sine = libm::sin(pair.rack_pressure_angle);
    for (side, tooth) in pair.teeth().iter().enumerate() {
        let (gear, address) = (&pair.gears[side], addresses[side]);
        let tip = 2.0 * tooth.tip_radius * tooth.half_angle_at(tooth.tip_radius) / pair.module;
        rules.ensure("addendum", tip >= THINNEST_TIP, || {
            format!(
                "the teeth of \"{address}\" come to a point: {tip:.3} modules thick at the tip, at least {THINNEST_TIP} \
                 is needed; reduce addendum or profile_shift"
            )
        });
        // Without undercut z >= 2 (h - x) / sin^2 alpha, h being the straight part of the rack's flank: as deep as the
        // other gear's tips reach, the rest of the dedendum being rounded (ISO 53).
        let straight = gear.dedendum.min(pair.gears[1 - side].addendum);
        let least_shift = straight - gear.teeth * sine * sine / (2.0 * UNDERCUT_TEETH);
        rules.ensure("profile_shift", gear.profile_shift >= least_shift, || {
            format!(
                "the {} teeth of \"{address}\" are undercut; a profile_shift of at least {least_shift:.4} or more teeth \
                 are needed, found {}",
                gear.teeth, gear.profile_shift
            )
        });
    }
}

/// Teeth that can mesh at the operating pressure angle.
fn check_mesh(rules: &mut Rules<'_>, pair: &SpurPair, addresses: [&str; 2]) {
    let before = rules.problems.len();
    check_backlash(rules, pair);
    if rules.problems.len() > before {
        return; // teeth that are too close collide elsewhere, too
    }
    let (teeth, path) = (pair.teeth(), pair.path_of_contact());
    for side in [0, 1] {
        let (own, other) = (addresses[side], addresses[1 - side]);
        check_interference(rules, side, &teeth, &path, [own, other]);
        let clearance = path.centre_distance - teeth[1 - side].tip_radius - teeth[side].root_radius;
        rules.ensure("dedendum", clearance > 0.0, || {
            format!(
                "the tips of \"{other}\" run into the root of \"{own}\" by {:.4} modules; raise the dedendum of \
                 \"{own}\", reduce the addendum of \"{other}\", or raise the mesh's pressure_angle",
                -clearance / pair.module
            )
        });
    }
    let contact_ratio = path.contact_ratio();
    rules.ensure("addendum", contact_ratio >= 1.0, || {
        format!(
            "the contact ratio is {contact_ratio:.4}, must be at least 1, or no teeth are in contact at times; raise \
             addendum or lower the mesh's pressure_angle"
        )
    });
}

/// inv(alpha_w) = inv(alpha) + 2 tan(alpha) (x_a + x_b) / (z_a + z_b) without backlash; less shift leaves some.
fn check_backlash(rules: &mut Rules<'_>, pair: &SpurPair) {
    let [a, b] = pair.gears;
    let tangent = libm::tan(pair.rack_pressure_angle);
    let involute = |angle: f64| libm::tan(angle) - angle;
    let largest = (involute(pair.pressure_angle) - involute(pair.rack_pressure_angle))
        * (a.teeth + b.teeth)
        / (2.0 * tangent);
    let sum = a.profile_shift + b.profile_shift;
    rules.ensure("profile_shift", sum <= largest + SHIFT_ROUNDING, || {
        format!(
            "the teeth are too thick for each other's gaps: at the mesh's pressure_angle of {} rad the sum of \
             profile_shift may be at most {largest:.4}, found {sum}; reduce it or raise the pressure_angle",
            pair.pressure_angle
        )
    });
}

/// Tips may touch the other tooth above its base circle only. `addresses`: of this gear and of the other.
fn check_interference(
    rules: &mut Rules<'_>,
    side: usize,
    teeth: &[Tooth; 2],
    path: &PathOfContact,
    addresses: [&str; 2],
) {
    let [own, other] = addresses;
    let tooth = &teeth[1 - side];
    let most = libm::hypot(tooth.base_radius, path.tangent);
    rules.ensure("addendum", path.lowest[side] > 0.0, || {
        format!(
            "the tips of \"{other}\" cut into the teeth of \"{own}\" below their base circle: its tip radius is {:.6} m, \
             must be less than {most:.6} m; reduce the addendum of \"{other}\" or give \"{own}\" a larger profile_shift",
            tooth.tip_radius
        )
    });
}
