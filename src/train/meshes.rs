//! The rules of meshes, and the way from their tables to a [`Mesh`].

use core::f64::consts::TAU;
use std::collections::BTreeMap;

use super::laws::{MOST_HARMONICS, check_stiffness, stiffness_law};
use super::rules::Rules;
use super::tooth_geometry::MeshedGear;
use super::{Gear, GearAddress, GearTrain, Mesh, Rotor};
use crate::config::{self, Contact, Material, MeshDamping, Place, Problem, TorqueCoupling};
use crate::mesh::{ErrorHarmonic, LineOfAction, StiffnessLaw, TransmissionError, pair_damping};

/// Larger angles leave too few digits for phases that follow from them [rad].
const LARGEST_ANGLE: f64 = 1e3;

/// Checks a mesh; `None` when something is wrong with it, which becomes problems.
pub(super) fn resolve_mesh(
    place: &Place,
    mesh: &config::Mesh,
    rotors: &[Rotor],
    materials: &BTreeMap<String, Material>,
    problems: &mut Vec<Problem>,
) -> Option<Mesh> {
    let before = problems.len();
    let mut rules = Rules { place, problems };
    let angle = mesh.center_angle;
    rules.ensure("center_angle", angle.abs() <= LARGEST_ANGLE, || {
        format!("must be within -{LARGEST_ANGLE} and {LARGEST_ANGLE} rad, found {angle}")
    });
    rules.pressure_angle(mesh.pressure_angle);
    let phase = mesh.phase.unwrap_or(0.0);
    rules.ensure("phase", phase.abs() <= 1e6, || {
        format!("must be within -1e6 and 1e6 pitches, found {phase}")
    });
    rules.positive("stiffness_factor", mesh.stiffness_factor, "");
    if mesh.contact == Contact::Unilateral {
        rules.not_negative("backlash", mesh.backlash, "m");
        let printed = mesh.torque_coupling == TorqueCoupling::AsPrinted;
        rules.ensure("torque_coupling", !printed, || {
            "as_printed is the paper's linear contact; use contact = \"bilateral\" with it"
                .to_string()
        });
    }
    match mesh.damping {
        MeshDamping::Ratio(ratio) => rules.not_negative("damping_ratio", ratio, ""),
        MeshDamping::Coefficient(damping) => rules.not_negative("damping", damping, "N s/m"),
    }
    check_transmission_error(place, &mesh.transmission_error, problems);
    let mut rules = Rules { place, problems };
    let gears = [0, 1].map(|side| find_gear(&mut rules, &mesh.gears[side], rotors));
    check_stiffness(&place.table("stiffness"), &mesh.stiffness, problems);
    let [Some(a), Some(b)] = gears else {
        return None;
    };
    let mut rules = Rules { place, problems };
    rules.ensure("gears", a.rotor != b.rotor, || {
        let (one, two) = (&mesh.gears[0], &mesh.gears[1]);
        format!("must be on two different rotors, found \"{one}\" and \"{two}\"")
    });
    let pair = [a, b].map(|address| &rotors[address.rotor].gears[address.gear]);
    if mesh.internal {
        check_ring(&mut rules, pair);
    }
    let sizes = pair.map(|gear| (gear.base_radius, gear.body.polar_inertia));
    if matches!(mesh.damping, MeshDamping::Ratio(ratio) if ratio > 0.0) {
        rules.ensure(
            "damping_ratio",
            sizes
                .iter()
                .all(|&(_, inertia)| inertia > 0.0 || inertia.is_nan()),
            || "needs gears with a polar_inertia greater than 0; give damping instead".to_string(),
        );
    }
    // A number that could not be read (0, NaN) has its problem already.
    let unread = pair
        .iter()
        .any(|gear| gear.teeth == 0 || gear.base_radius.is_nan());
    if unread || rules.problems.len() > before {
        return None;
    }
    let meshed = [0, 1].map(|side| {
        let rotor = &rotors[[a, b][side].rotor];
        MeshedGear {
            rotor,
            gear: &rotor.gears[[a, b][side].gear],
            address: &mesh.gears[side],
        }
    });
    let mut rules = Rules {
        place: &place.table("stiffness"),
        problems,
    };
    let stiffness = stiffness_law(&mut rules, mesh, meshed, materials)?;
    Some(build_mesh(mesh, [a, b], sizes, stiffness, rotors))
}

/// A mesh whose parts are all valid. `sizes`: base radius [m] and inertia [kg m^2] of a and b.
fn build_mesh(
    mesh: &config::Mesh,
    gears: [GearAddress; 2],
    sizes: [(f64, f64); 2],
    stiffness: StiffnessLaw,
    rotors: &[Rotor],
) -> Mesh {
    let s = mesh.flank.sign();
    let damping = match mesh.damping {
        MeshDamping::Coefficient(damping) => damping,
        MeshDamping::Ratio(ratio) => {
            pair_damping(ratio, mesh.stiffness_factor * stiffness.mean(), sizes)
        }
    };
    let line = if mesh.internal {
        LineOfAction::internal
    } else {
        LineOfAction::external
    };
    let rotor_a = &rotors[gears[0].rotor];
    // p = s z_a phi_a / 2 pi + p0; p0 is added when all meshes are known.
    let pitches = s * f64::from(rotor_a.gears[gears[0].gear].teeth) / TAU;
    Mesh {
        name: mesh.name.clone(),
        gears,
        line: line(
            mesh.center_angle,
            mesh.pressure_angle,
            s,
            sizes[0].0,
            sizes[1].0,
        ),
        backlash: (mesh.contact == Contact::Unilateral).then_some(mesh.backlash),
        torque_coupling: mesh.torque_coupling,
        stiffness,
        stiffness_factor: mesh.stiffness_factor,
        damping,
        transmission_error: transmission_error(&mesh.transmission_error),
        start_phase: pitches * rotor_a.angle,
        pitches,
        phase_rate: pitches * rotor_a.speed,
    }
}

/// A ring has room for the gear inside it.
fn check_ring(rules: &mut Rules<'_>, [a, b]: [&Gear; 2]) {
    // A number that could not be read (0, NaN) has its problem already.
    rules.ensure("gears", b.teeth > a.teeth || b.teeth == 0, || {
        format!(
            "with internal = true the second gear is the ring and must have more teeth than the first, found \
             {} : {}; swap the two (center_angle and flank belong to the first), or give other tooth numbers",
            a.teeth, b.teeth
        )
    });
    let too_small = b.base_radius <= a.base_radius && b.teeth > a.teeth;
    rules.ensure("gears", !too_small, || {
        format!(
            "with internal = true the base radius of the second gear, the ring, must be greater than that of \
             the first, found {} m and {} m",
            b.base_radius, a.base_radius
        )
    });
}

/// Warns of rings that have a mesh on the outside too: those teeth would need a base circle of their own.
pub(super) fn rings_meshed_from_outside(train: &GearTrain) -> Vec<Problem> {
    let mut warnings = Vec::new();
    for (index, mesh) in train.meshes.iter().enumerate() {
        let ring = mesh.gears[1];
        let outside = train.meshes.iter().find(|other| {
            other.gears[0] == ring || (other.gears[1] == ring && !other.line.is_internal())
        });
        if let (true, Some(other)) = (mesh.line.is_internal(), outside) {
            let place = Place::root().element("mesh", index, Some(&mesh.name));
            let message = format!(
                "gears: \"{}\" is a ring here and an external gear in mesh \"{}\": give its outer teeth a gear of \
                 their own on that rotor",
                train.gear_name(ring),
                other.name
            );
            warnings.push(place.problem("gears", message));
        }
    }
    warnings
}

fn check_transmission_error(
    mesh: &Place,
    harmonics: &[config::ErrorHarmonic],
    problems: &mut Vec<Problem>,
) {
    for (index, harmonic) in harmonics.iter().enumerate() {
        let place = mesh.element("transmission_error", index, None);
        let mut rules = Rules {
            place: &place,
            problems,
        };
        let order = harmonic.order;
        rules.ensure("order", (1..=MOST_HARMONICS).contains(&order), || {
            format!("must be from 1 (once per tooth) to {MOST_HARMONICS}, found {order}")
        });
        rules.finite("amplitude", harmonic.amplitude);
        rules.finite("phase", harmonic.phase);
    }
}

fn transmission_error(harmonics: &[config::ErrorHarmonic]) -> TransmissionError {
    let convert = |one: &config::ErrorHarmonic| ErrorHarmonic {
        order: one.order,
        amplitude: one.amplitude,
        phase: one.phase,
    };
    let harmonics: Vec<ErrorHarmonic> = harmonics.iter().map(convert).collect();
    TransmissionError::new(&harmonics)
}

fn find_gear(rules: &mut Rules<'_>, address: &str, rotors: &[Rotor]) -> Option<GearAddress> {
    let found = address.split_once('.').and_then(|(rotor_name, gear_name)| {
        let rotor = rotors.iter().position(|rotor| rotor.name == rotor_name)?;
        let gear = rotors[rotor]
            .gears
            .iter()
            .position(|gear| gear.name == gear_name)?;
        Some(GearAddress { rotor, gear })
    });
    rules.ensure("gears", found.is_some(), || {
        let known: Vec<String> = rotors
            .iter()
            .flat_map(|rotor| {
                rotor
                    .gears
                    .iter()
                    .map(|gear| format!("{}.{}", rotor.name, gear.name))
            })
            .collect();
        format!(
            "there is no gear \"{address}\"; the gears are: {}",
            known.join(", ")
        )
    });
    found
}
