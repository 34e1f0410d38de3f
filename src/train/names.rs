//! Which names may be used, so that every FMI variable has a name of its own.

use std::collections::BTreeMap;

use crate::config::{Config, Place, Problem, Rotor};

/// Names beside the rotors, meshes and points of the housing.
const RESERVED_AT_TOP: [&str; 5] = ["simulation", "gearbox_vibration", "housing", "time", "der"];

/// Names beside the elements of a rotor.
const RESERVED_ON_ROTOR: [&str; 9] = [
    "modal",
    "speed",
    "angle",
    "mean_speed",
    "lateral_frequency",
    "torsional_frequency",
    "lateral_damping_ratio",
    "torsional_damping_ratio",
    "der",
];

/// Names beside the quantities of a mesh: none can collide, meshes have no elements of their own.
pub(super) fn check(config: &Config, problems: &mut Vec<Problem>) {
    let root = Place::root();
    if !is_identifier(&config.name) || config.name.len() > 64 {
        let rule = "name: must be a C identifier of at most 64 characters";
        problems.push(root.problem("name", format!("{rule}, found \"{}\"", config.name)));
    }
    if let Some(letter) = config
        .description
        .chars()
        .find(|letter| letter.is_control())
    {
        let rule = "description: must be one line without control characters";
        problems.push(root.problem("description", format!("{rule}, found {letter:?}")));
    }
    let mut top = Namespace::new(
        &RESERVED_AT_TOP,
        "among rotors, meshes and points of the housing",
    );
    for (index, rotor) in config.rotors.iter().enumerate() {
        let place = root.element("rotor", index, Some(&rotor.name));
        top.claim(&place, &rotor.name, problems);
        check_rotor(&place, rotor, problems);
    }
    for (index, mesh) in config.meshes.iter().enumerate() {
        top.claim(
            &root.element("mesh", index, Some(&mesh.name)),
            &mesh.name,
            problems,
        );
    }
    if let Some(housing) = &config.housing {
        for (index, point) in housing.points.iter().enumerate() {
            let place = housing.place().element("point", index, Some(&point.name));
            top.claim(&place, &point.name, problems);
        }
    }
}

fn check_rotor(rotor_place: &Place, rotor: &Rotor, problems: &mut Vec<Problem>) {
    let mut names = Namespace::new(&RESERVED_ON_ROTOR, "among the elements of this rotor");
    let mut claim_all = |kind: &str, elements: Vec<&str>| {
        for (index, name) in elements.into_iter().enumerate() {
            names.claim(
                &rotor_place.element(kind, index, Some(name)),
                name,
                problems,
            );
        }
    };
    claim_all(
        "gear",
        rotor.gears.iter().map(|gear| gear.name.as_str()).collect(),
    );
    claim_all(
        "bearing",
        rotor
            .bearings
            .iter()
            .map(|bearing| bearing.name.as_str())
            .collect(),
    );
    claim_all(
        "unbalance",
        rotor
            .unbalances
            .iter()
            .map(|one| one.name.as_str())
            .collect(),
    );
    claim_all(
        "torque",
        rotor
            .torques
            .iter()
            .map(|torque| torque.name.as_str())
            .collect(),
    );
    claim_all(
        "probe",
        rotor
            .probes
            .iter()
            .map(|probe| probe.name.as_str())
            .collect(),
    );
}

/// Names that must differ from each other and from the reserved ones.
struct Namespace {
    reserved: &'static [&'static str],
    scope: &'static str,
    taken: BTreeMap<String, String>,
}

impl Namespace {
    fn new(reserved: &'static [&'static str], scope: &'static str) -> Namespace {
        Namespace {
            reserved,
            scope,
            taken: BTreeMap::new(),
        }
    }

    fn claim(&mut self, place: &Place, name: &str, problems: &mut Vec<Problem>) {
        if !is_identifier(name) {
            let rule =
                "name: must consist of letters, digits and underscores and not start with a digit";
            problems.push(place.problem("name", format!("{rule}, found \"{name}\"")));
        } else if self.reserved.contains(&name) {
            problems.push(place.problem(
                "name",
                format!("name: \"{name}\" is reserved, choose another"),
            ));
        } else if let Some(other) = self
            .taken
            .insert(name.to_string(), place.words().to_string())
        {
            let rule = format!("name: must be unique {}", self.scope);
            problems.push(place.problem("name", format!("{rule}, \"{name}\" is also {other}")));
        }
    }
}

fn is_identifier(name: &str) -> bool {
    let mut letters = name.chars();
    letters
        .next()
        .is_some_and(|first| first.is_ascii_alphabetic() || first == '_')
        && letters.all(|letter| letter.is_ascii_alphanumeric() || letter == '_')
}
