//! From the text of a model file to a [`Config`]: which keys exist, their types and defaults.

mod housing;
mod mesh;
mod planar;
mod rotor;
mod tooth_geometry;

use std::collections::BTreeMap;

use super::dimension::{ANGLE, DENSITY, FREQUENCY, LENGTH, NUMBER, PRESSURE, TIME};
use super::document::{Document, Table};
use super::place::Place;
use super::spot::Lines;
use super::{
    Basis, BasisModes, Config, GearboxVibration, Kind, Material, Problem, Simulation, SolverChoice,
    SpeedMode, Start,
};

pub use housing::Files;

use housing::Beside;

/// What a model file says, and what is wrong with it.
#[derive(Debug)]
pub struct Reading {
    /// Everything that could be read, with placeholders (NaN, empty) where there are problems; `None`
    /// when the text is not TOML.
    pub config: Option<Config>,
    /// Syntax errors, missing keys, wrong types, unknown keys.
    pub problems: Vec<Problem>,
    /// Where every key stands.
    pub lines: Lines,
}

const KINDS: [(&str, Kind); 2] = [("gear_train", Kind::GearTrain), ("housing", Kind::Housing)];

/// Reads the text of a model file, and with `files` those that it names.
pub fn read(text: &str, files: Files<'_>) -> Reading {
    let document = Document::new(Place::root(), text);
    let mut beside = Beside::default();
    let config = document
        .parse()
        .map(|entries| top(document.top(entries.get_ref()), files, &mut beside));
    let (mut problems, mut lines) = document.into_findings();
    problems.extend(beside.problems);
    lines.extend(beside.lines);
    Reading {
        config,
        problems,
        lines,
    }
}

fn top(table: Table<'_, '_>, files: Files<'_>, beside: &mut Beside) -> Config {
    let kind = table.choice("kind", None, &KINDS);
    let config = if kind == Some(Kind::Housing) {
        housing_alone(&table, files, beside)
    } else {
        gear_train(&table, files, beside)
    };
    table.finish();
    config
}

fn housing_alone(table: &Table<'_, '_>, files: Files<'_>, beside: &mut Beside) -> Config {
    Config {
        kind: Kind::Housing,
        name: table.string("name"),
        description: table.optional_string("description").unwrap_or_default(),
        simulation: simulation(table.table("simulation"), Kind::Housing),
        basis: None,
        materials: BTreeMap::new(),
        rotors: Vec::new(),
        meshes: Vec::new(),
        gearbox_vibration: gearbox_vibration(None),
        housing: Some(housing::alone(table, files, beside)),
    }
}

fn gear_train(table: &Table<'_, '_>, files: Files<'_>, beside: &mut Beside) -> Config {
    let simulation = simulation(table.table("simulation"), Kind::GearTrain);
    let free = simulation.speed == SpeedMode::Free;
    Config {
        kind: Kind::GearTrain,
        housing: table.table("housing").map(|table| {
            let housing = housing::embedded(&table, files, beside);
            table.finish();
            housing
        }),
        name: table.string("name"),
        description: table.optional_string("description").unwrap_or_default(),
        simulation,
        basis: table.table("basis").map(|table| {
            let basis = basis(&table);
            table.finish();
            basis
        }),
        materials: table
            .named_tables("material")
            .into_iter()
            .map(material)
            .collect(),
        rotors: table
            .tables("rotor")
            .into_iter()
            .map(|table| rotor::rotor(table, free))
            .collect(),
        meshes: table.tables("mesh").into_iter().map(mesh::mesh).collect(),
        gearbox_vibration: gearbox_vibration(table.table("gearbox_vibration")),
    }
}

fn simulation(table: Option<Table<'_, '_>>, kind: Kind) -> Simulation {
    let defaults = Simulation {
        speed: SpeedMode::Prescribed,
        solver: SolverChoice::Exponential,
        start: Start::Equilibrium,
        tolerance: 1e-4,
        input_extrapolation: 0.0,
        known_bearings: 0.0,
        stop_time: 1.0,
        step_size: 1e-5,
    };
    let Some(table) = table else { return defaults };
    let speeds = [
        ("prescribed", SpeedMode::Prescribed),
        ("free", SpeedMode::Free),
    ];
    let solvers = [
        ("exponential", SolverChoice::Exponential),
        ("newmark", SolverChoice::Newmark),
    ];
    let starts = [("equilibrium", Start::Equilibrium), ("rest", Start::Rest)];
    let simulation = Simulation {
        speed: table
            .choice("speed", Some(defaults.speed), &speeds)
            .unwrap_or(defaults.speed),
        solver: table
            .choice("solver", Some(defaults.solver), &solvers)
            .unwrap_or(defaults.solver),
        start: table
            .choice("start", Some(defaults.start), &starts)
            .unwrap_or(defaults.start),
        tolerance: table.number_or("tolerance", &NUMBER, defaults.tolerance),
        input_extrapolation: f64::from(u8::from(table.boolean_or("input_extrapolation", false))),
        known_bearings: match kind {
            Kind::Housing => f64::from(u8::from(table.boolean_or("known_bearings", false))),
            Kind::GearTrain => 0.0,
        },
        stop_time: table.number_or("stop_time", &TIME, defaults.stop_time),
        step_size: table.number_or("step_size", &TIME, defaults.step_size),
    };
    table.finish();
    simulation
}

fn basis(table: &Table<'_, '_>) -> Basis {
    let static_shapes = table.boolean_or("static_shapes", false);
    let counts = ["lateral_modes", "torsional_modes"];
    let modes = if let Some(frequency) = table.optional_number("max_frequency", &FREQUENCY) {
        for key in counts {
            if table.has(key) {
                table.problem(key, "contradicts max_frequency; give one or the other");
            }
        }
        Some(BasisModes::MaxFrequency(frequency))
    } else if counts.map(|key| table.has(key)) == [false, false] {
        None
    } else {
        Some(BasisModes::Counts {
            lateral_modes: table.count("lateral_modes"),
            torsional_modes: table.count("torsional_modes"),
        })
    };
    Basis {
        modes,
        static_shapes,
    }
}

fn material((name, table): (String, Table<'_, '_>)) -> (String, Material) {
    let material = Material {
        youngs_modulus: table.number("youngs_modulus", &PRESSURE),
        poisson_ratio: table.number("poisson_ratio", &NUMBER),
        density: table.number("density", &DENSITY),
    };
    table.finish();
    (name, material)
}

fn gearbox_vibration(table: Option<Table<'_, '_>>) -> GearboxVibration {
    let Some(table) = table else {
        return GearboxVibration {
            amplitude_x: 0.0,
            amplitude_y: 0.0,
            phase_y: 0.0,
            frequency: 0.0,
        };
    };
    let vibration = GearboxVibration {
        amplitude_x: table.number_or("amplitude_x", &LENGTH, 0.0),
        amplitude_y: table.number_or("amplitude_y", &LENGTH, 0.0),
        phase_y: table.number_or("phase_y", &ANGLE, 0.0),
        frequency: table.number("frequency", &FREQUENCY),
    };
    table.finish();
    vibration
}
