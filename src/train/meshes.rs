//! The rules of meshes, and the way from their tables to a [`Mesh`].

use core::f64::consts::TAU;

use super::laws::{check_stiffness, stiffness_law};
use super::rules::Rules;
use super::speeds::{spread, transmissions};
use super::{GearAddress, Mesh, Rotor};
use crate::config::{self, Config, MeshDamping, Place, Problem};
use crate::mesh::{LineOfAction, pair_damping};

/// Highest mesh frequency [Hz]: a step ends at every breakpoint of the stiffness.
const FASTEST_MESH: f64 = 1e6;

/// Checks a mesh; `None` when something is wrong with it, which becomes problems.
pub(super) fn resolve_mesh(
    place: &Place,
    mesh: &config::Mesh,
    rotors: &[Rotor],
    problems: &mut Vec<Problem>,
) -> Option<Mesh> {
    let before = problems.len();
    let mut rules = Rules { place, problems };
    rules.finite("center_angle", mesh.center_angle);
    rules.pressure_angle(mesh.pressure_angle);
    let phase = mesh.phase.unwrap_or(0.0);
    rules.ensure("phase", phase.abs() <= 1e6, || {
        format!("must be within -1e6 and 1e6 pitches, found {phase}")
    });
    rules.positive("stiffness_factor", mesh.stiffness_factor, "");
    match mesh.damping {
        MeshDamping::Ratio(ratio) => rules.not_negative("damping_ratio", ratio, ""),
        MeshDamping::Coefficient(damping) => rules.not_negative("damping", damping, "N s/m"),
    }
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
    let sizes = [a, b].map(|address| {
        let gear = &rotors[address.rotor].gears[address.gear];
        (gear.base_radius, gear.body.polar_inertia)
    });
    if matches!(mesh.damping, MeshDamping::Ratio(ratio) if ratio > 0.0) {
        rules.ensure(
            "damping_ratio",
            sizes.iter().all(|&(_, inertia)| inertia > 0.0),
            || "needs gears with a polar_inertia greater than 0; give damping instead".to_string(),
        );
    }
    (rules.problems.len() == before).then(|| build_mesh(mesh, [a, b], sizes, rotors))
}

/// A mesh whose parts are all valid. `sizes`: base radius [m] and inertia [kg m^2] of a and b.
fn build_mesh(
    mesh: &config::Mesh,
    gears: [GearAddress; 2],
    sizes: [(f64, f64); 2],
    rotors: &[Rotor],
) -> Mesh {
    let s = mesh.flank.sign();
    let stiffness = stiffness_law(&mesh.stiffness);
    let damping = match mesh.damping {
        MeshDamping::Coefficient(damping) => damping,
        MeshDamping::Ratio(ratio) => {
            pair_damping(ratio, mesh.stiffness_factor * stiffness.mean(), sizes)
        }
    };
    let rotor_a = &rotors[gears[0].rotor];
    // p = s z_a phi_a / 2 pi + p0
    let pitches = s * f64::from(rotor_a.gears[gears[0].gear].teeth) / TAU;
    Mesh {
        name: mesh.name.clone(),
        gears,
        line: LineOfAction::external(
            mesh.center_angle,
            mesh.pressure_angle,
            s,
            sizes[0].0,
            sizes[1].0,
        ),
        torque_coupling: mesh.torque_coupling,
        stiffness,
        stiffness_factor: mesh.stiffness_factor,
        damping,
        start_phase: pitches * rotor_a.angle + mesh.phase.unwrap_or(0.0),
        phase_rate: pitches * rotor_a.speed,
    }
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

/// Speeds must fit the tooth numbers, around loops too, and no mesh may be too fast.
pub(super) fn check_speeds(
    root: &Place,
    rotors: &[Rotor],
    meshes: &[Mesh],
    problems: &mut Vec<Problem>,
) {
    let teeth = |address: GearAddress| rotors[address.rotor].gears[address.gear].teeth;
    let transmissions = transmissions(rotors, meshes);
    for (index, (mesh, transmission)) in meshes.iter().zip(&transmissions).enumerate() {
        let [a, b] = transmission.rotors.map(|rotor| &rotors[rotor]);
        let expected = a.speed * transmission.ratio;
        if (b.speed - expected).abs() > 1e-6 * expected.abs().max(b.speed.abs()) {
            let place = root.element("mesh", index, Some(&mesh.name));
            let message = format!(
                "gears: {} : {} teeth ask for a speed of {expected} rad/s of rotor \"{}\" (that of \
                 \"{}\" is {} rad/s), found {} rad/s",
                teeth(mesh.gears[0]),
                teeth(mesh.gears[1]),
                b.name,
                a.name,
                a.speed,
                b.speed
            );
            problems.push(place.problem("gears", message));
        }
    }
    for (index, mesh) in meshes.iter().enumerate() {
        if mesh.phase_rate.abs() > FASTEST_MESH {
            let place = root.element("mesh", index, Some(&mesh.name));
            let rate = mesh.phase_rate.abs();
            let message = format!(
                "gears: their teeth pass with {rate} Hz, at most {FASTEST_MESH} Hz can be followed"
            );
            problems.push(place.problem("gears", message));
        }
    }
    for contradiction in spread(rotors.len(), &transmissions).1 {
        let index = contradiction.transmission;
        let place = root.element("mesh", index, Some(&meshes[index].name));
        let message = format!(
            "gears: closes a loop of meshes with the ratio {}, the other way around it is {}; this \
             train cannot turn",
            transmissions[index].ratio, contradiction.other_ratio
        );
        problems.push(place.problem("gears", message));
    }
}

/// A phase may be left out only where nothing ties it to another mesh.
pub(super) fn check_phases(config: &Config, meshes: &[Mesh], problems: &mut Vec<Problem>) {
    for (index, mesh) in config.meshes.iter().enumerate() {
        let shared = meshes[..index].iter().find(|other| {
            other
                .gears
                .iter()
                .any(|gear| meshes[index].gears.contains(gear))
        });
        if let (None, Some(other)) = (mesh.phase, shared) {
            let place = Place::root().element("mesh", index, Some(&mesh.name));
            let message = format!(
                "phase: missing; mesh \"{}\" is on the same gear, and phases from geometry are not \
                 available yet",
                other.name
            );
            problems.push(place.problem("phase", message));
        }
    }
}
