//! The tables of the page.

use std::f64::consts::TAU;

use geartrain::analysis::{
    Answers, BandErrors, CHANNELS, Campbell, Excites, Vibration, VibrationErrors,
};
use geartrain::description::html::Cell;
use geartrain::interface::{Causality, Interface};

use super::super::frequencies::{exciters, iso_stiffness};
use super::super::{Inspection, json, kind, whirl};

pub const ROTORS: [&str; 5] = [
    "rotor",
    "speed [rpm]",
    "speed [rad/s]",
    "lateral [Hz]",
    "torsional [Hz]",
];

pub fn rotors(inspection: &Inspection) -> Vec<Vec<Cell>> {
    let pairs = inspection.train.rotors.iter().zip(&inspection.model.rotors);
    let row = |(rotor, modal): (&geartrain::train::Rotor, &geartrain::model::Rotor)| {
        vec![
            rotor.name.as_str().into(),
            Cell::fixed(modal.speed * 60.0 / TAU, 2),
            Cell::fixed(modal.speed, 3),
            Cell::list(&modal.lateral_frequencies, 2),
            Cell::list(&json::elastic(modal), 2),
        ]
    };
    pairs.map(row).collect()
}

pub const MESHES: [&str; 7] = [
    "mesh",
    "gear a",
    "gear b",
    "f [Hz]",
    "mean k [N/m]",
    "c [N s/m]",
    "ISO 6336-1 [N/m]",
];

pub fn meshes(inspection: &Inspection) -> Vec<Vec<Cell>> {
    let train = &inspection.train;
    let pairs = train.meshes.iter().zip(&inspection.model.meshes);
    let row = |(mesh, modal): (&geartrain::train::Mesh, &geartrain::model::Mesh)| {
        let [a, b] = mesh.gears.map(|gear| train.gear_name(gear));
        vec![
            mesh.name.as_str().into(),
            a.into(),
            b.into(),
            Cell::fixed(modal.frequency(), 3),
            Cell::scientific(modal.mean_stiffness(), 4),
            Cell::fixed(modal.damping, 1),
            iso_stiffness(mesh).map_or("-".into(), |norm| Cell::scientific(norm, 4)),
        ]
    };
    pairs.map(row).collect()
}

pub const VIBRATIONS: [&str; 7] = [
    "no.",
    "f [Hz]",
    "damped [Hz]",
    "damping",
    "kind",
    "rotor",
    "whirl",
];

/// Vibrations with their numbers, counted from one.
pub fn vibrations<'a>(
    inspection: &Inspection,
    vibrations: impl Iterator<Item = (usize, &'a Vibration)>,
) -> Vec<Vec<Cell>> {
    let row = |(index, one): (usize, &Vibration)| {
        let mut row = vec![(index + 1).to_string().into()];
        row.extend(vibration(inspection, one));
        row
    };
    vibrations.map(row).collect()
}

fn vibration(inspection: &Inspection, one: &Vibration) -> [Cell; 6] {
    [
        Cell::fixed(one.natural.frequency, 2),
        Cell::fixed(one.natural.damped_frequency, 2),
        Cell::percent(one.natural.damping_ratio),
        kind(one.kind).into(),
        inspection.rotor_name(one.rotor).into(),
        whirl(one.whirl).unwrap_or("-").into(),
    ]
}

pub const CRITICAL: [&str; 9] = [
    "speed [rpm]",
    "[rad/s]",
    "f [Hz]",
    "damped [Hz]",
    "damping",
    "kind",
    "rotor",
    "whirl",
    "excited by",
];

pub fn critical_speeds(inspection: &Inspection, table: &Campbell) -> Vec<Vec<Cell>> {
    let row = |critical: &geartrain::analysis::CriticalSpeed| {
        let mut row = vec![
            Cell::fixed(critical.speed * 60.0 / TAU, 1),
            Cell::fixed(critical.speed, 2),
        ];
        row.extend(vibration(inspection, &critical.vibration));
        row.push(exciters(inspection, table, critical.excitation).into());
        row
    };
    table.critical_speeds.iter().map(row).collect()
}

/// Damped frequencies of the numbered vibrations over the speeds of the table, with a head.
pub fn over_speed(inspection: &Inspection, table: &Campbell) -> (Vec<String>, Vec<Vec<Cell>>) {
    let speeds = table
        .points
        .iter()
        .map(|point| format!("{:.0} rpm", point.speed * 60.0 / TAU));
    let head = std::iter::once("no.".to_string()).chain(speeds).collect();
    let rows = (0..inspection.vibrations.oscillating.len()).map(|number| {
        let cell = |point: &geartrain::analysis::Point| {
            let place = point
                .branches
                .iter()
                .position(|branch| *branch == Some(number));
            place.map_or("-".into(), |place| {
                Cell::fixed(point.vibrations[place].natural.damped_frequency, 2)
            })
        };
        let cells = table.points.iter().map(cell);
        std::iter::once((number + 1).to_string().into())
            .chain(cells)
            .collect()
    });
    (head, rows.collect())
}

/// Errors [%] of every channel that the train has, with a head.
pub fn errors(bands: &[BandErrors]) -> (Vec<String>, Vec<Vec<Cell>>) {
    let present = |channel: &usize| bands.iter().any(|band| band.channels[*channel].is_some());
    let channels: Vec<usize> = (0..CHANNELS.len()).filter(present).collect();
    let name = |channel: &usize| {
        let (excites, answers) = CHANNELS[*channel];
        let excites = match excites {
            Excites::Supports => "all supports",
            Excites::Bearing => "one support",
            Excites::TransmissionError => "transm. error",
            Excites::Torque => "torque",
        };
        match answers {
            Answers::Meshes => format!("{excites}: mesh"),
            Answers::Bearings => format!("{excites}: bearing"),
        }
    };
    let head = ["from [Hz]".to_string(), "to [Hz]".to_string()];
    let head = head.into_iter().chain(channels.iter().map(name)).collect();
    let row = |band: &BandErrors| {
        let percent = |channel: &usize| {
            let error = band.channels[*channel];
            error.map_or("-".into(), Cell::percent)
        };
        let edges = [Cell::fixed(band.from, 1), Cell::fixed(band.to, 1)];
        edges
            .into_iter()
            .chain(channels.iter().map(percent))
            .collect()
    };
    (head, bands.iter().map(row).collect())
}

pub const MODES: [&str; 5] = [
    "rotor",
    "lateral modes",
    "static shapes",
    "torsional modes",
    "static shapes",
];

/// Modes and static shapes kept; the rigid rotation is one of the torsional modes.
pub fn modes(inspection: &Inspection) -> Vec<Vec<Cell>> {
    let pairs = inspection.train.rotors.iter().zip(&inspection.model.rotors);
    let row = |(rotor, modal): (&geartrain::train::Rotor, &geartrain::model::Rotor)| {
        let counts = modal.counts;
        let counts = [
            counts.lateral_modes,
            counts.lateral - counts.lateral_modes,
            counts.torsional_modes,
            counts.torsional - counts.torsional_modes,
        ];
        let cells = counts.map(|count| Cell::fixed(count as f64, 0));
        std::iter::once(rotor.name.as_str().into())
            .chain(cells)
            .collect()
    };
    pairs.map(row).collect()
}

/// Errors of the steady forces under the gearbox vibration.
pub fn under_vibration(inspection: &Inspection, errors: &VibrationErrors) -> Vec<Vec<Cell>> {
    let meshes = inspection.train.meshes.iter().map(|mesh| mesh.name.clone());
    let bearings = inspection.train.rotors.iter().flat_map(|rotor| {
        let bearings = rotor.bearings.iter();
        bearings.map(|bearing| format!("{}.{}", rotor.name, bearing.name))
    });
    let forces = meshes
        .zip(&errors.meshes)
        .chain(bearings.zip(&errors.bearings));
    let row = |(name, error): (String, &f64)| vec![name.into(), Cell::percent(*error)];
    forces.map(row).collect()
}

pub const COMPLIANCES: [&str; 4] = ["rotor", "place", "direction", "error"];

pub fn compliances(inspection: &Inspection) -> Vec<Vec<Cell>> {
    let mut sorted = inspection.basis.errors.compliances.clone();
    sorted.sort_by(|one, two| two.1.total_cmp(&one.1));
    let row = |(spot, error): &(geartrain::analysis::Spot, f64)| {
        let direction = if spot.torsional {
            "torsional"
        } else {
            "lateral"
        };
        vec![
            inspection.rotor_name(spot.rotor).into(),
            json::place(inspection, spot).into(),
            direction.into(),
            Cell::percent(*error),
        ]
    };
    sorted.iter().map(row).collect()
}

pub const PARAMETERS: [&str; 4] = ["name", "start", "unit", "meaning"];

pub fn parameters(inspection: &Inspection) -> Vec<Vec<Cell>> {
    let interface = Interface::of(&inspection.config, &inspection.train, &inspection.model);
    let parameters = interface.variables.iter();
    let parameters = parameters.filter(|one| one.causality() == Causality::Parameter);
    let row = |one: &geartrain::interface::Variable| {
        let start = one.start.unwrap_or(f64::NAN);
        vec![
            one.name.as_str().into(),
            Cell::Number(format!("{start}"), start),
            one.unit.name().into(),
            one.description.as_str().into(),
        ]
    };
    parameters.map(row).collect()
}
