//! The rules of one rotor, and the way from its tables to a [`Rotor`].

use super::bearings::resolve_bearing;
use super::rules::Rules;
use super::{Gear, Rotor, Section};
use crate::config::{self, BaseCircle, Config, Disk, Place, Problem, SpeedMode};

/// More elements than this on one shaft make the dense eigenproblem slow and gain nothing.
const MOST_ELEMENTS: f64 = 400.0;
/// Every place is a station; more of them make the dense eigenproblem slow.
const MOST_ATTACHED: usize = 400;
/// Larger angles leave too few digits for the phase of the teeth [rad].
const LARGEST_ANGLE: f64 = 1e6;
/// Positions closer than this part of the shaft's length are one station.
pub const SAME_PLACE: f64 = 1e-9;
/// No shaft turns faster [rad/s]; far above it, the teeth would pass in less than rounding of time.
const FASTEST: f64 = 1e6;

/// Checks a rotor; what is wrong with it becomes problems.
pub(super) fn resolve_rotor(
    place: &Place,
    rotor: &config::Rotor,
    config: &Config,
    problems: &mut Vec<Problem>,
) -> Rotor {
    let mut rules = Rules { place, problems };
    rules.ensure("speed", rotor.speed.abs() <= FASTEST, || {
        format!(
            "must be within -{FASTEST} and {FASTEST} rad/s, found {} rad/s",
            rotor.speed
        )
    });
    rules.ensure("angle", rotor.angle.abs() <= LARGEST_ANGLE, || {
        format!(
            "must be within -{LARGEST_ANGLE} and {LARGEST_ANGLE} rad, found {} rad",
            rotor.angle
        )
    });
    let attached = [
        rotor.segments.len(),
        rotor.disks.len(),
        rotor.gears.len(),
        rotor.bearings.len(),
        rotor.unbalances.len(),
        rotor.bows.iter().map(|bow| bow.positions.len()).sum(),
        rotor.torques.len(),
        rotor.basis_supports.len(),
        rotor.probes.len(),
    ];
    let attached: usize = attached.iter().sum();
    rules.ensure("name", attached <= MOST_ATTACHED, || {
        format!(
            "a rotor may have at most {MOST_ATTACHED} segments and things on it, found {attached}"
        )
    });
    rules.not_negative("lateral_damping_ratio", rotor.lateral_damping_ratio, "");
    rules.not_negative("torsional_damping_ratio", rotor.torsional_damping_ratio, "");
    rules.ensure("segment", !rotor.segments.is_empty(), || {
        "at least one [[rotor.segment]] is needed".to_string()
    });
    let before = problems.len();
    let sections = resolve_sections(place, rotor, config, problems);
    // Without valid segments nothing lies beyond the shaft's end.
    let known = problems.len() == before;
    let length = sections
        .last()
        .filter(|_| known)
        .map_or(f64::INFINITY, |section| section.end);
    let free = config.simulation.speed == SpeedMode::Free;
    check_elements(place, rotor, length, free, problems);
    let mut bearings = Vec::new();
    for (index, bearing) in rotor.bearings.iter().enumerate() {
        let place = place.element("bearing", index, Some(&bearing.name));
        bearings.push(resolve_bearing(
            &place,
            bearing,
            (rotor.speed, free),
            problems,
        ));
    }
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
        bearings,
        unbalances: rotor.unbalances.clone(),
        bows: rotor.bows.clone(),
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
        rules.ensure("inner_diameter", inner < outer || outer.is_nan(), || {
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
    free: bool,
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
    for (index, bow) in rotor.bows.iter().enumerate() {
        let place = place("bow", index, None);
        check_bow(
            &mut Rules {
                place: &place,
                problems,
            },
            bow,
            length,
        );
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
        rules.ensure("torsional", !free || support.torsional == 0.0, || {
            format!(
                "must be 0 in free spin, whose basis needs the rigid rotation, found {} N m/rad",
                support.torsional
            )
        });
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
        rules.ensure("max_element_length", !(length.is_finite() && length / longest > MOST_ELEMENTS), || {
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
            rules.pressure_angle(pressure_angle);
        }
    }
}

fn check_bow(rules: &mut Rules<'_>, bow: &config::Bow, length: f64) {
    let (places, offsets) = (bow.positions.len(), bow.amplitudes.len());
    rules.ensure("positions", places > 0, || {
        "needs at least one position, and three to bend the shaft".to_string()
    });
    rules.ensure("amplitudes", offsets == places, || {
        format!("needs one offset for each of the {places} positions, found {offsets}")
    });
    for (index, &position) in bow.positions.iter().enumerate() {
        rules.along_shaft("positions", position, length);
        // Closer positions are one station, which has one offset.
        let same = |other: &&f64| (**other - position).abs() <= SAME_PLACE * length;
        let other = bow.positions[..index].iter().find(same);
        if let Some(other) = other.filter(|_| length.is_finite()) {
            rules.ensure("positions", false, || {
                format!("must all be different, found {other} m and {position} m")
            });
        }
    }
    for &amplitude in &bow.amplitudes {
        rules.finite("amplitudes", amplitude);
    }
    rules.finite("phase", bow.phase);
}
