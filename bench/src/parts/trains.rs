//! What the tolerance buys on random trains: the error of mesh forces over the tolerance, and what a small disturbance does to
//! the trains that exceed it.

use geartrain::interface::Interface;
use geartrain::model::Inputs;
use geartrain::simulation::Simulation;
use geartrain::train::{Loaded, load};
use random_trains::{Support, Train, of_seed};

use crate::forces::Forces;
use crate::problem::started;
use crate::series;
use crate::table::Table;

/// The trains.
const SEEDS: core::ops::Range<u64> = 0..40;
/// Decades of tolerance; the second is the default.
const TOLERANCES: [f64; 4] = [1e-2, 1e-4, 1e-6, 1e-8];
/// The converged solution.
const CONVERGED: f64 = 1e-9;
/// Communication step [s] and number: long ones, so that the tolerance alone decides on steps.
const STEPS: (f64, u32) = (3.7e-4, 27);
/// What the results at the default tolerance are to be within.
const PROMISED: f64 = 1e-3;
/// Torques change by this part of themselves per second, bearings move with this velocity [m/s].
const INPUTS: (f64, f64) = (10.0, 1e-3);
/// A disturbance: torques off by this part of themselves in the first communication step.
const DISTURBANCE: f64 = 1e-7;
/// Its effect is first measured after so many of them.
const EARLY: usize = 3;

/// Errors of one train.
struct Errors {
    seed: u64,
    what: String,
    at: Vec<f64>,
    steps: Vec<u64>,
    growth: Option<f64>,
}

/// Measures and prints.
pub fn run() -> Result<(), String> {
    let (step, count) = STEPS;
    println!(
        "Error over tolerance on random trains, default solver: {} trains that differ in all that users vary, {:.0} ms, communication\n\
         steps of {:.0} us, torques and bearings that move. Error: RMS of the difference from the solution at {CONVERGED:e} / RMS, worst mesh.\n",
        SEEDS.count(),
        1e3 * step * f64::from(count),
        1e6 * step
    );
    let mut all = Vec::new();
    for seed in SEEDS {
        match errors(seed) {
            Ok(errors) => all.push(errors),
            Err(why) => println!("seed {seed}: {why}"),
        }
    }
    summary(&all);
    breaking(&all);
    Ok(())
}

/// One line per tolerance.
fn summary(all: &[Errors]) {
    let mut table = Table::new(&[
        "tolerance",
        "trains",
        "steps",
        "median error",
        "90 %",
        "worst",
        "of seed",
        "above tolerance",
        "above 1e-3",
    ]);
    for (index, tolerance) in TOLERANCES.into_iter().enumerate() {
        let mut sorted: Vec<(f64, u64)> = all.iter().map(|one| (one.at[index], one.seed)).collect();
        sorted.sort_by(|one, other| one.0.total_cmp(&other.0));
        let above = |bound: f64| sorted.iter().filter(|(error, _)| *error > bound).count();
        let part = |share: usize| sorted[(sorted.len() - 1) * share / 100];
        let steps: u64 = all.iter().map(|one| one.steps[index]).sum();
        table.row(vec![
            format!("{tolerance:.0e}"),
            sorted.len().to_string(),
            steps.to_string(),
            format!("{:.1e}", part(50).0),
            format!("{:.1e}", part(90).0),
            format!("{:.1e}", part(100).0),
            part(100).1.to_string(),
            above(tolerance).to_string(),
            above(PROMISED).to_string(),
        ]);
    }
    table.print();
}

/// The trains that exceed a tolerance.
fn breaking(all: &[Errors]) {
    println!(
        "Trains whose error exceeds a tolerance. growth: what a disturbance of the torques in the first communication step has become at\n\
         its largest, in parts of what it was after {EARLY} of them.\n"
    );
    let mut headings = vec!["seed".to_string(), "growth".to_string()];
    headings.extend(TOLERANCES.map(|tolerance| format!("{tolerance:.0e}")));
    headings.push("what".to_string());
    let mut table = Table::new(&headings.iter().map(String::as_str).collect::<Vec<_>>());
    for one in all {
        let Some(growth) = one.growth else { continue };
        let mut row = vec![one.seed.to_string(), format!("{growth:.1}")];
        row.extend(one.at.iter().map(|error| format!("{error:.1e}")));
        row.push(one.what.clone());
        table.row(row);
    }
    table.print();
}

fn errors(seed: u64) -> Result<Errors, String> {
    let train = of_seed(seed);
    let text = train.text();
    let forces = |tolerance, disturbance| forces(&text, tolerance, disturbance);
    let converged = forces(CONVERGED, 0.0)?;
    let (mut at, mut steps) = (Vec::new(), Vec::new());
    for tolerance in TOLERANCES {
        let found = forces(tolerance, 0.0)?;
        at.push(found.promised_error(&converged));
        steps.push(found.steps);
    }
    let exceeds = at
        .iter()
        .zip(TOLERANCES)
        .any(|(error, bound)| *error > bound);
    let growth = exceeds
        .then(|| forces(CONVERGED, DISTURBANCE).map(|disturbed| growth(&disturbed, &converged)))
        .transpose()?;
    Ok(Errors {
        seed,
        what: described(&train),
        at,
        steps,
        growth,
    })
}

/// The mesh forces of a model file in free steps.
fn forces(text: &str, tolerance: f64, disturbance: f64) -> Result<Forces, String> {
    let Loaded { config, train, .. } = load(text).map_err(|problems| format!("{problems:?}"))?;
    let mut simulation = started(&train, &config.simulation, tolerance);
    let rate = set_moving(&mut simulation);
    if disturbance != 0.0 {
        let off: Vec<f64> = simulation
            .inputs()
            .torques()
            .iter()
            .map(|torque| disturbance * torque)
            .collect();
        let add = |simulation: &mut Simulation, sign: f64| {
            let torques = simulation.inputs_mut().torques_mut().iter_mut();
            torques
                .zip(&off)
                .for_each(|(torque, off)| *torque += sign * off);
        };
        add(&mut simulation, 1.0);
        let reached = simulation.advance_along(STEPS.0, Some(&rate));
        reached.map_err(|error| error.to_string())?;
        add(&mut simulation, -1.0);
    }
    let interface = Interface::of(&config, &train, simulation.model());
    Forces::of(simulation, &interface, STEPS, Some(&rate))
}

/// Gives the bearings velocities, and the rates of all inputs.
fn set_moving(simulation: &mut Simulation) -> Inputs {
    let mut rate = simulation.inputs().clone();
    rate.torques_mut()
        .iter_mut()
        .for_each(|torque| *torque *= INPUTS.0);
    let bases = simulation.inputs_mut().bases_mut().iter_mut();
    for ((number, base), rate) in (0_u32..).zip(bases).zip(rate.bases_mut()) {
        let (sine, cosine) = libm::sincos(1.0 + f64::from(number));
        let [x, y] = [INPUTS.1 * cosine, INPUTS.1 * sine];
        (base[2], base[3]) = (x, y);
        *rate = [x, y, 0.0, 0.0];
    }
    rate
}

/// The largest difference from the undisturbed run relative to the largest of the first ones, of the mesh where it grows most.
fn growth(disturbed: &Forces, converged: &Forces) -> f64 {
    let pairs = disturbed.meshes.iter().zip(&converged.meshes);
    series::worst(pairs.map(|(one, other)| {
        let differences = one
            .iter()
            .zip(other)
            .map(|(one, other)| (one - other).abs());
        let early = differences.clone().take(EARLY).fold(0.0, f64::max);
        let late = differences.fold(0.0, f64::max);
        if early > 0.0 { late / early } else { 1.0 }
    }))
}

/// What a train has that is not linear, or moves on its own.
fn described(train: &Train) -> String {
    let backlash = train.links.iter().any(|link| link.backlash.is_some());
    let any = |is: fn(&Support) -> bool| train.shafts.iter().any(|shaft| is(&shaft.support));
    let kinds = [
        ("free spin", train.simulation.contains("free")),
        ("backlash", backlash),
        (
            "radial bearings",
            any(|support| matches!(support, Support::Radial(..))),
        ),
        (
            "bearings over speed",
            any(|support| matches!(support, Support::OverSpeed(_))),
        ),
    ];
    let found: Vec<&str> = kinds
        .iter()
        .filter(|kind| kind.1)
        .map(|kind| kind.0)
        .collect();
    if found.is_empty() {
        "linear".to_string()
    } else {
        found.join(", ")
    }
}
