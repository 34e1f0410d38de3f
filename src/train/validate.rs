//! Every rule a model has to satisfy, and the way from a [`Config`] to a [`GearTrain`].
//!
//! Each check pushes a [`Problem`] that names key, rule and found value and then goes on, so that one run
//! finds everything.

use super::basis::{check_basis, resolve_basis};
use super::centres::open_loops;
use super::housing::{no_known_bearings, points_at_rest, resolve_housing};
use super::meshes::{resolve_mesh, rings_meshed_from_outside};
use super::phases;
use super::rotors::resolve_rotor;
use super::rules::Rules;
use super::speeds::{check_speeds, unequal_base_pitches};
use super::{GearTrain, names, speed_ratios};
use crate::config::{Config, Kind, Place, Problem, SolverChoice, SpeedMode};

/// Checks a configuration against every rule. Gives the train and warnings, or all problems.
pub fn validate(config: &Config) -> Result<(GearTrain, Vec<Problem>), Vec<Problem>> {
    let mut problems = Vec::new();
    names::check(config, &mut problems);
    let root = Place::root();
    check_simulation(&root.table("simulation"), config, &mut problems);
    check_basis(config.basis.as_ref(), &mut problems);
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
    if config.kind == Kind::GearTrain && config.rotors.is_empty() {
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
        meshes.extend(resolve_mesh(
            &place,
            mesh,
            &rotors,
            &config.materials,
            &mut problems,
        ));
    }
    let housing = config.housing.as_ref();
    let housing = housing.map(|housing| resolve_housing(housing, config, &mut problems));
    if problems.is_empty() {
        check_speeds(&rotors, &meshes, &mut problems);
    }
    if !problems.is_empty() {
        return Err(problems);
    }
    let mut train = GearTrain {
        name: config.name.clone(),
        description: config.description.clone(),
        simulation: config.simulation.clone(),
        basis: resolve_basis(config.basis.as_ref(), &meshes),
        rotors,
        meshes,
        gearbox_vibration: config.gearbox_vibration,
        housing,
    };
    let mut warnings = phases::settle(config, &mut train);
    warnings.extend(rings_meshed_from_outside(&train));
    warnings.extend(open_loops(&train));
    let unequal = unequal_base_pitches(&train);
    if train.simulation.speed == SpeedMode::Prescribed {
        warnings.extend(unequal);
        warnings.extend(unbalanced_torques(&train));
    } else if !unequal.is_empty() {
        // The teeth themselves carry the rotation: they have to fit.
        return Err(unequal);
    }
    warnings.extend(bows_without_force(&train));
    if let Some(housing) = &train.housing {
        warnings.extend(points_at_rest(config, housing));
        warnings.extend(no_known_bearings(config));
    }
    Ok((train, warnings))
}

fn check_simulation(place: &Place, config: &Config, problems: &mut Vec<Problem>) {
    let simulation = &config.simulation;
    let mut rules = Rules { place, problems };
    if config.kind == Kind::Housing {
        let (speed, solver) = (simulation.speed, simulation.solver);
        rules.ensure("speed", speed == SpeedMode::Prescribed, || {
            "a housing has no rotation, leave this key away".to_string()
        });
        rules.ensure("solver", solver == SolverChoice::Exponential, || {
            "the modes of a housing are solved exactly, leave this key away".to_string()
        });
    }
    let tolerance = simulation.tolerance;
    rules.ensure("tolerance", (1e-12..=0.1).contains(&tolerance), || {
        format!(
            "must be at least 1e-12, which is near rounding, and at most 0.1, found {tolerance}"
        )
    });
    for (key, share) in [
        ("input_extrapolation", simulation.input_extrapolation),
        ("known_bearings", simulation.known_bearings),
    ] {
        rules.ensure(key, (0.0..=1.0).contains(&share), || {
            format!("must be from 0 (off) to 1 (on), found {share}")
        });
    }
    rules.positive("stop_time", simulation.stop_time, "s");
    rules.positive("step_size", simulation.step_size, "s");
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

/// Warns of meshed rotors whose torques do not balance and that no load slope holds.
fn unbalanced_torques(train: &GearTrain) -> Vec<Problem> {
    let ratios = speed_ratios(train);
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

/// Warns of bows that bend nothing.
fn bows_without_force(train: &GearTrain) -> Vec<Problem> {
    let mut warnings = Vec::new();
    for (number, rotor) in train.rotors.iter().enumerate() {
        let shaft = Place::root().element("rotor", number, Some(&rotor.name));
        for (index, bow) in rotor.bows.iter().enumerate() {
            let count = bow.positions.len();
            if count < 3 {
                let message = format!(
                    "positions: a straight shaft passes through {count} offsets without bending, so that this \
                     bow gives no force; three positions or more bend it"
                );
                let place = shaft.element("bow", index, None);
                warnings.push(place.problem("positions", message));
            }
        }
    }
    warnings
}
