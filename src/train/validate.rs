//! Every rule a model has to satisfy, and the way from a [`Config`] to a [`GearTrain`].
//!
//! Each check pushes a [`Problem`] that names key, rule and found value and then goes on, so that one run
//! finds everything.

use core::f64::consts::{FRAC_PI_2, TAU};

use super::speeds::{Transmission, spread};
use super::{Gear, GearAddress, GearTrain, Mesh, Rotor, Section, names};
use crate::config::{
    self, BaseCircle, Basis, Config, Disk, MeshDamping, MeshStiffness, Place, Planar, Problem,
};
use crate::mesh::{LineOfAction, StiffnessLaw, ToothPair, pair_damping};

/// More elements than this on one shaft make the dense eigenproblem slow and gain nothing.
const MOST_ELEMENTS: f64 = 400.0;

/// Checks a configuration against every rule. Gives the train and warnings, or all problems.
pub fn validate(config: &Config) -> Result<(GearTrain, Vec<Problem>), Vec<Problem>> {
    let mut problems = Vec::new();
    names::check(config, &mut problems);
    let root = Place::root();
    check_simulation(&root.table("simulation"), &config.simulation, &mut problems);
    check_basis(&root.table("basis"), &config.basis, &mut problems);
    check_vibration(config, &mut problems);
    for (name, material) in &config.materials {
        let place = root.table(&format!("material.{name}"));
        let mut rules = Rules {
            place: &place,
            problems: &mut problems,
        };
        rules.positive("youngs_modulus", material.youngs_modulus, "Pa");
        rules.positive("density", material.density, "kg/m^3");
        let nu = material.poisson_ratio;
        rules.ensure("poisson_ratio", nu > -1.0 && nu <= 0.5, || {
            format!("must be greater than -1 and at most 0.5, found {nu}")
        });
    }
    if config.rotors.is_empty() {
        problems.push(root.problem(
            "rotor",
            "rotor: at least one [[rotor]] is needed".to_string(),
        ));
    }
    let mut rotors = Vec::new();
    for (index, rotor) in config.rotors.iter().enumerate() {
        let place = root.element("rotor", index, Some(&rotor.name));
        rotors.push(resolve_rotor(&place, rotor, config, &mut problems));
    }
    let mut meshes = Vec::new();
    for (index, mesh) in config.meshes.iter().enumerate() {
        let place = root.element("mesh", index, Some(&mesh.name));
        meshes.extend(resolve_mesh(&place, mesh, &rotors, &mut problems));
    }
    if problems.is_empty() {
        check_speeds(&root, &rotors, &meshes, &mut problems);
        check_phases(config, &meshes, &mut problems);
    }
    if !problems.is_empty() {
        return Err(problems);
    }
    let train = GearTrain {
        name: config.name.clone(),
        description: config.description.clone(),
        simulation: config.simulation.clone(),
        basis: config.basis.clone(),
        rotors,
        meshes,
        gearbox_vibration: config.gearbox_vibration,
    };
    let warnings = unbalanced_torques(&train);
    Ok((train, warnings))
}

/// Pushes problems about the keys of one table.
struct Rules<'a> {
    place: &'a Place,
    problems: &'a mut Vec<Problem>,
}

impl Rules<'_> {
    fn ensure(&mut self, key: &str, holds: bool, message: impl FnOnce() -> String) {
        if !holds {
            self.problems
                .push(self.place.problem(key, format!("{key}: {}", message())));
        }
    }

    fn finite(&mut self, key: &str, value: f64) {
        self.ensure(key, value.is_finite(), || {
            format!("must be a finite number, found {value}")
        });
    }

    fn positive(&mut self, key: &str, value: f64, unit: &str) {
        self.ensure(key, value > 0.0 && value.is_finite(), || {
            format!("must be greater than 0 and finite, found {value} {unit}")
                .trim_end()
                .to_string()
        });
    }

    fn not_negative(&mut self, key: &str, value: f64, unit: &str) {
        self.ensure(key, value >= 0.0 && value.is_finite(), || {
            format!("must be 0 or more and finite, found {value} {unit}")
                .trim_end()
                .to_string()
        });
    }

    fn on_shaft(&mut self, position: f64, length: f64) {
        let end = length * (1.0 + 1e-9); // sums of segment lengths carry rounding
        if position.is_nan() || position < 0.0 || position > end {
            let rule = if position > end {
                format!("position {position} m lies beyond the shaft's end at {length} m")
            } else {
                format!(
                    "position: must be a distance from the left end, 0 or more, found {position} m"
                )
            };
            self.problems.push(self.place.problem("position", rule));
        }
    }
}

fn check_simulation(place: &Place, simulation: &config::Simulation, problems: &mut Vec<Problem>) {
    let mut rules = Rules { place, problems };
    let tolerance = simulation.tolerance;
    rules.ensure("tolerance", tolerance > 0.0 && tolerance <= 0.1, || {
        format!("must be greater than 0 and at most 0.1, found {tolerance}")
    });
    rules.positive("stop_time", simulation.stop_time, "s");
    rules.positive("step_size", simulation.step_size, "s");
}

fn check_basis(place: &Place, basis: &Basis, problems: &mut Vec<Problem>) {
    let mut rules = Rules { place, problems };
    match *basis {
        Basis::Counts {
            lateral_modes,
            torsional_modes,
        } => {
            rules.ensure("lateral_modes", lateral_modes >= 1, || {
                "must be at least 1, found 0".to_string()
            });
            rules.ensure("torsional_modes", torsional_modes >= 1, || {
                "must be at least 1 (the rigid rotation counts), found 0".to_string()
            });
        }
        Basis::MaxFrequency(frequency) => rules.positive("max_frequency", frequency, "Hz"),
    }
}

fn check_vibration(config: &Config, problems: &mut Vec<Problem>) {
    let (place, vibration) = (
        Place::root().table("gearbox_vibration"),
        &config.gearbox_vibration,
    );
    let mut rules = Rules {
        place: &place,
        problems,
    };
    rules.finite("amplitude_x", vibration.amplitude_x);
    rules.finite("amplitude_y", vibration.amplitude_y);
    rules.finite("phase_y", vibration.phase_y);
    rules.not_negative("frequency", vibration.frequency, "Hz");
}

fn resolve_rotor(
    place: &Place,
    rotor: &config::Rotor,
    config: &Config,
    problems: &mut Vec<Problem>,
) -> Rotor {
    let mut rules = Rules { place, problems };
    rules.finite("speed", rotor.speed);
    rules.finite("angle", rotor.angle);
    rules.not_negative("lateral_damping_ratio", rotor.lateral_damping_ratio, "");
    rules.not_negative("torsional_damping_ratio", rotor.torsional_damping_ratio, "");
    rules.ensure("segment", !rotor.segments.is_empty(), || {
        "at least one [[rotor.segment]] is needed".to_string()
    });
    let sections = resolve_sections(place, rotor, config, problems);
    let length = sections.last().map_or(0.0, |section| section.end);
    check_elements(place, rotor, length, problems);
    let gear = |gear: &config::Gear| Gear {
        name: gear.name.clone(),
        body: gear.body,
        teeth: gear.teeth,
        base_radius: gear.base.radius(gear.teeth),
    };
    Rotor {
        name: rotor.name.clone(),
        speed: rotor.speed,
        angle: rotor.angle,
        max_element_length: rotor.max_element_length.unwrap_or(length / 20.0),
        lateral_damping_ratio: rotor.lateral_damping_ratio,
        torsional_damping_ratio: rotor.torsional_damping_ratio,
        sections,
        disks: rotor.disks.clone(),
        gears: rotor.gears.iter().map(gear).collect(),
        bearings: rotor.bearings.clone(),
        unbalances: rotor.unbalances.clone(),
        torques: rotor.torques.clone(),
        basis_supports: rotor.basis_supports.clone(),
        probes: rotor.probes.clone(),
    }
}

fn resolve_sections(
    rotor_place: &Place,
    rotor: &config::Rotor,
    config: &Config,
    problems: &mut Vec<Problem>,
) -> Vec<Section> {
    let nothing = config::Material {
        youngs_modulus: 1.0,
        poisson_ratio: 0.0,
        density: 1.0,
    };
    let mut sections = Vec::new();
    let mut start = 0.0;
    for (index, segment) in rotor.segments.iter().enumerate() {
        let place = rotor_place.element("segment", index, None);
        let mut rules = Rules {
            place: &place,
            problems,
        };
        rules.positive("length", segment.length, "m");
        rules.positive("outer_diameter", segment.outer_diameter, "m");
        rules.not_negative("inner_diameter", segment.inner_diameter, "m");
        let (outer, inner) = (segment.outer_diameter, segment.inner_diameter);
        rules.ensure("inner_diameter", !(inner >= outer), || {
            format!("must be less than the outer diameter of {outer} m, found {inner} m")
        });
        let material = config.materials.get(&segment.material);
        rules.ensure("material", material.is_some(), || {
            let known: Vec<&str> = config.materials.keys().map(String::as_str).collect();
            format!(
                "no [material.{}] in this file; there is: {}",
                segment.material,
                known.join(", ")
            )
        });
        let end = start + segment.length;
        let material = material.copied().unwrap_or(nothing);
        sections.push(Section {
            start,
            end,
            outer_diameter: outer,
            inner_diameter: inner,
            material,
        });
        start = end;
    }
    sections
}

/// Rules for everything that sits on the shaft.
fn check_elements(
    rotor_place: &Place,
    rotor: &config::Rotor,
    length: f64,
    problems: &mut Vec<Problem>,
) {
    let place = |kind, index, name| rotor_place.element(kind, index, name);
    for (index, disk) in rotor.disks.iter().enumerate() {
        let place = place("disk", index, None);
        check_body(
            &mut Rules {
                place: &place,
                problems,
            },
            disk,
            length,
        );
    }
    for (index, gear) in rotor.gears.iter().enumerate() {
        let place = place("gear", index, Some(&gear.name));
        check_gear(
            &mut Rules {
                place: &place,
                problems,
            },
            gear,
            length,
        );
    }
    for (index, bearing) in rotor.bearings.iter().enumerate() {
        let place = place("bearing", index, Some(&bearing.name));
        Rules {
            place: &place,
            problems,
        }
        .on_shaft(bearing.position, length);
        check_planar(
            &place.table("stiffness"),
            &bearing.stiffness,
            "N/m",
            problems,
        );
        check_planar(&place.table("damping"), &bearing.damping, "N s/m", problems);
    }
    for (index, unbalance) in rotor.unbalances.iter().enumerate() {
        let place = place("unbalance", index, Some(&unbalance.name));
        let mut rules = Rules {
            place: &place,
            problems,
        };
        rules.on_shaft(unbalance.position, length);
        rules.not_negative("moment", unbalance.moment, "kg m");
        rules.finite("phase", unbalance.phase);
    }
    for (index, torque) in rotor.torques.iter().enumerate() {
        let place = place("torque", index, Some(&torque.name));
        let mut rules = Rules {
            place: &place,
            problems,
        };
        rules.on_shaft(torque.position, length);
        rules.finite("value", torque.value);
        rules.not_negative("slope", torque.slope, "N m s/rad");
    }
    for (index, support) in rotor.basis_supports.iter().enumerate() {
        let place = place("basis_support", index, None);
        let mut rules = Rules {
            place: &place,
            problems,
        };
        rules.on_shaft(support.position, length);
        rules.not_negative("lateral", support.lateral, "N/m");
        rules.not_negative("torsional", support.torsional, "N m/rad");
    }
    for (index, probe) in rotor.probes.iter().enumerate() {
        let place = place("probe", index, Some(&probe.name));
        Rules {
            place: &place,
            problems,
        }
        .on_shaft(probe.position, length);
    }
    check_element_length(rotor_place, rotor, length, problems);
}

fn check_element_length(
    place: &Place,
    rotor: &config::Rotor,
    length: f64,
    problems: &mut Vec<Problem>,
) {
    let mut rules = Rules { place, problems };
    let longest = rotor.max_element_length.unwrap_or(length / 20.0);
    if rotor.max_element_length.is_some() {
        rules.positive("max_element_length", longest, "m");
        rules.ensure("max_element_length", !(length / longest > MOST_ELEMENTS), || {
            let smallest = length / MOST_ELEMENTS;
            format!("must be at least {smallest} m (1/{MOST_ELEMENTS} of the shaft), found {longest} m")
        });
    }
}

fn check_body(rules: &mut Rules<'_>, body: &Disk, length: f64) {
    rules.on_shaft(body.position, length);
    rules.not_negative("mass", body.mass, "kg");
    rules.not_negative("polar_inertia", body.polar_inertia, "kg m^2");
    rules.not_negative("diametral_inertia", body.diametral_inertia, "kg m^2");
}

fn check_gear(rules: &mut Rules<'_>, gear: &config::Gear, length: f64) {
    check_body(rules, &gear.body, length);
    rules.ensure("teeth", gear.teeth >= 1 && gear.teeth <= 100_000, || {
        format!("must be from 1 to 100000, found {}", gear.teeth)
    });
    match gear.base {
        BaseCircle::Radius(radius) => rules.positive("base_radius", radius, "m"),
        BaseCircle::Rack {
            module,
            pressure_angle,
        } => {
            rules.positive("module", module, "m");
            check_pressure_angle(rules, pressure_angle);
        }
    }
}

fn check_pressure_angle(rules: &mut Rules<'_>, angle: f64) {
    rules.ensure("pressure_angle", angle > 0.0 && angle < FRAC_PI_2, || {
        format!("must be between 0 and pi/2 rad, found {angle}")
    });
}

fn check_planar(place: &Place, planar: &Planar, unit: &str, problems: &mut Vec<Problem>) {
    let mut rules = Rules { place, problems };
    rules.not_negative("xx", planar.xx, unit);
    rules.not_negative("yy", planar.yy, unit);
    rules.finite("xy", planar.xy);
    rules.finite("yx", planar.yx);
}

/// `None` when the gears cannot be found.
fn resolve_mesh(
    place: &Place,
    mesh: &config::Mesh,
    rotors: &[Rotor],
    problems: &mut Vec<Problem>,
) -> Option<Mesh> {
    let before = problems.len();
    let mut rules = Rules { place, problems };
    rules.finite("center_angle", mesh.center_angle);
    check_pressure_angle(&mut rules, mesh.pressure_angle);
    rules.finite("phase", mesh.phase.unwrap_or(0.0));
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

fn check_stiffness(place: &Place, stiffness: &MeshStiffness, problems: &mut Vec<Problem>) {
    let mut rules = Rules { place, problems };
    let contact_ratio_rule = |rules: &mut Rules<'_>, contact_ratio: f64| {
        rules.ensure(
            "contact_ratio",
            (1.0..=100.0).contains(&contact_ratio),
            || format!("must be from 1 to 100, found {contact_ratio}"),
        );
    };
    match *stiffness {
        MeshStiffness::Constant { mean } => rules.positive("mean", mean, "N/m"),
        MeshStiffness::Rectangular {
            fewer_pairs,
            more_pairs,
            contact_ratio,
        } => {
            contact_ratio_rule(&mut rules, contact_ratio);
            rules.positive("pair or single", fewer_pairs, "N/m");
            rules.ensure("double", more_pairs >= fewer_pairs && more_pairs.is_finite(), || {
                format!("must be at least the single stiffness of {fewer_pairs} N/m, found {more_pairs}")
            });
        }
        MeshStiffness::ToothPair {
            pair,
            quadratic,
            quartic,
            ramp,
            contact_ratio,
        } => {
            contact_ratio_rule(&mut rules, contact_ratio);
            rules.positive("pair", pair, "N/m");
            rules.not_negative("ramp", ramp, "pitches");
            let weakest = ToothPair {
                pair,
                quadratic,
                quartic,
                ramp,
                contact_ratio,
            }
            .weakest();
            rules.ensure("quadratic", weakest >= 0.0, || {
                format!(
                    "1 - quadratic xi^2 - quartic xi^4 must not be negative for |xi| <= 1, \
                     found {weakest} with quadratic {quadratic} and quartic {quartic}"
                )
            });
        }
    }
}

fn stiffness_law(stiffness: &MeshStiffness) -> StiffnessLaw {
    match *stiffness {
        MeshStiffness::Constant { mean } => StiffnessLaw::constant(mean),
        MeshStiffness::Rectangular {
            fewer_pairs,
            more_pairs,
            contact_ratio,
        } => StiffnessLaw::rectangular(fewer_pairs, more_pairs, contact_ratio),
        MeshStiffness::ToothPair {
            pair,
            quadratic,
            quartic,
            ramp,
            contact_ratio,
        } => StiffnessLaw::tooth_pair(ToothPair {
            pair,
            quadratic,
            quartic,
            ramp,
            contact_ratio,
        }),
    }
}

/// Speeds must fit the tooth numbers, around loops too.
fn check_speeds(root: &Place, rotors: &[Rotor], meshes: &[Mesh], problems: &mut Vec<Problem>) {
    let teeth = |address: GearAddress| rotors[address.rotor].gears[address.gear].teeth;
    let transmissions: Vec<Transmission> = meshes
        .iter()
        .map(|mesh| Transmission {
            rotors: mesh.gears.map(|gear| gear.rotor),
            ratio: -f64::from(teeth(mesh.gears[0])) / f64::from(teeth(mesh.gears[1])),
        })
        .collect();
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
fn check_phases(config: &Config, meshes: &[Mesh], problems: &mut Vec<Problem>) {
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

/// Warns of meshed rotors whose torques do not balance and that no load slope holds.
fn unbalanced_torques(train: &GearTrain) -> Vec<Problem> {
    let ratios = super::speed_ratios(train);
    let mut warnings = Vec::new();
    for leader in 0..train.rotors.len() {
        let members = || {
            let zipped = train.rotors.iter().zip(&ratios);
            zipped.filter(move |(_, ratio)| ratio.leader == leader)
        };
        let torques = || members().flat_map(|(rotor, _)| &rotor.torques);
        // Power per leader speed: torques count with their speed ratio.
        let shares = || {
            members()
                .flat_map(|(rotor, ratio)| rotor.torques.iter().map(|one| one.value * ratio.ratio))
        };
        let (sum, size) = (shares().sum::<f64>(), shares().map(f64::abs).sum::<f64>());
        if sum.abs() > 1e-9 * size && torques().all(|torque| torque.slope == 0.0) {
            let name = &train.rotors[leader].name;
            let place = Place::root().element("rotor", leader, Some(name));
            let message = format!(
                "torque: the torques on this rotor and those meshed with it leave {sum} N m (seen at \
                 this rotor) and no load has a slope: at prescribed speed the rotation will drift"
            );
            warnings.push(place.problem("torque", message));
        }
    }
    warnings
}
