//! Which outputs of a gear train and of its housing feed which inputs of the other, where they are two FMUs.

use crate::train::{GearTrain, Housing};

/// A bearing and the point of a housing that it stands on, each by its name.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Contact {
    /// `rotor.bearing`.
    pub bearing: String,
    /// The point.
    pub point: String,
}

/// A value that passes from an output to an input, each by its name in its own FMU.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Link {
    /// Whether it is an output of the train.
    pub from_train: bool,
    /// The output.
    pub output: String,
    /// The input.
    pub input: String,
}

/// The bearings that move with points named after them: `rotor_bearing`.
pub fn contacts_by_name(train: &GearTrain, housing: &Housing) -> Vec<Contact> {
    let mut contacts = Vec::new();
    for rotor in &train.rotors {
        for bearing in &rotor.bearings {
            let point = format!("{}_{}", rotor.name, bearing.name);
            let loaded = |one: &&crate::train::HousingPoint| one.takes_forces && one.name == point;
            if housing.points.iter().any(|one| loaded(&one)) {
                let bearing = format!("{}.{}", rotor.name, bearing.name);
                contacts.push(Contact { bearing, point });
            }
        }
    }
    contacts
}

/// Forces on the housing and its motion under every bearing.
pub fn links(contacts: &[Contact]) -> Vec<Link> {
    let mut links = Vec::new();
    for Contact { bearing, point } in contacts {
        for axis in ["x", "y"] {
            links.push(Link {
                from_train: true,
                output: format!("{bearing}.force_{axis}"),
                input: format!("{point}.force_{axis}"),
            });
        }
        for motion in ["x", "y", "vx", "vy"] {
            links.push(Link {
                from_train: false,
                output: format!("{point}.{motion}"),
                input: format!("{bearing}.housing.{motion}"),
            });
        }
    }
    links
}
