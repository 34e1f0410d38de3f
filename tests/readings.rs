//! What is read off after every call says the same as the displacements and velocities that it follows from.

#![allow(missing_docs)]

mod support;

use geartrain::simulation::Simulation;
use geartrain::solver::Row;
use support::{case_four, model_file, started};

/// Prescribed and free speed, housings, journal bearings, bearings with clearance; and Newmark's method.
fn models() -> [String; 7] {
    let newmark = "[simulation]\nsolver = \"newmark\"";
    [
        case_four(),
        case_four().replace("[simulation]", newmark),
        model_file("box.toml"),
        model_file("boxed.toml"),
        model_file("boxed_journal.toml"),
        model_file("rolling.toml"),
        model_file("run_up.toml"),
    ]
}

/// Sum of the products of a row, and that of their sizes.
fn along(row: &Row, values: &[f64]) -> [f64; 2] {
    let products = (0..values.len()).map(|i| row.entry(i) * values[i]);
    products.fold([0.0; 2], |[sum, size], one| [sum + one, size + one.abs()])
}

fn compare(simulation: &Simulation, text: &str) {
    let motion = simulation.motion();
    let (system, state) = (&motion.model.system, motion.state);
    let (position, velocity) = (state.position(), state.velocity());
    // Rounding of 2n products by either way, of states that may be larger than what they add up to: 1e-10 of the sizes.
    let check = |found: f64, [exact, size]: [f64; 2]| {
        assert!(
            (found - exact).abs() <= 1e-10 * size,
            "{found} {exact} {text}"
        );
    };
    for (number, coupling) in system.couplings.iter().enumerate() {
        let [deflection, rate] = state.seen(number);
        check(deflection, along(&coupling.row, position));
        check(rate, along(&coupling.row, velocity));
    }
    for (number, reading) in system.readings.iter().enumerate() {
        let [spring, damper] = [
            along(&reading.position, position),
            along(&reading.velocity, velocity),
        ];
        let both = [spring[0] + damper[0], spring[1] + damper[1]];
        check(state.reading(number), both);
    }
}

#[test]
fn readings_are_what_their_rows_say() {
    for text in models() {
        let mut simulation = started(&text, 1e-4);
        compare(&simulation, &text);
        for step in 1..=50 {
            simulation.advance_to(2e-5 * f64::from(step)).unwrap();
            compare(&simulation, &text);
        }
    }
}
