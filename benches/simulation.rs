//! Wall time per simulated second and steps taken: `cargo bench` or `cargo xtask bench`.
//!
//! Prints a table; nothing is asserted. Errors are RMS errors of the mesh force relative to the RMS of its
//! alternating part, against a converged solution computed in the same run.

#![allow(clippy::print_stdout)]

#[path = "../tests/support/mod.rs"]
mod support;

use std::time::Instant;

use support::{case_four, started};

const STEP: f64 = 2e-5;
const COUNT: usize = 2500;

/// Mesh force at every communication point.
fn run(text: &str, tolerance: f64) -> (Vec<f64>, geartrain::solver::Counts, f64) {
    let mut simulation = started(text, tolerance);
    let mut forces = Vec::with_capacity(COUNT);
    let clock = Instant::now();
    for index in 1..=COUNT {
        simulation
            .advance_to(STEP * index as f64)
            .expect("the example is stable");
        forces.push(simulation.motion().mesh_force(0));
    }
    (forces, simulation.counts(), clock.elapsed().as_secs_f64())
}

fn main() {
    let simulated = STEP * COUNT as f64;
    let more_modes = case_four()
        .replace("lateral_modes = 3", "lateral_modes = 10")
        .replace("torsional_modes = 3", "torsional_modes = 8");
    println!("three_stage, case 4, {simulated} s, communication step {STEP} s\n");
    println!(
        "     solver  modes  tolerance  ms per simulated s  steps per simulated s  ns per step  factorizations      error"
    );
    for (modes, text) in [("3/3", case_four()), ("10/8", more_modes)] {
        let (converged, ..) = run(&text, 1e-9);
        let mean = converged.iter().sum::<f64>() / converged.len() as f64;
        let alternating: Vec<f64> = converged.iter().map(|force| force - mean).collect();
        let newmark = text.replace("[simulation]", "[simulation]\nsolver = \"newmark\"");
        let runs =
            [1e-2, 1e-3, 1e-4, 1e-5, 1e-6].map(|tolerance| (&text, "exponential", tolerance));
        let slow = [1e-3, 1e-5].map(|tolerance| (&newmark, "newmark", tolerance));
        for (text, solver, tolerance) in runs.into_iter().chain(slow) {
            let (forces, counts, seconds) = run(text, tolerance);
            let error = support::rms_difference(&forces, &converged) / support::rms(&alternating);
            println!(
                "{solver:>11}  {modes:>5}  {tolerance:>9.0e}  {:>18.1}  {:>21.3e}  {:>11.0}  {:>14}  {error:>9.1e}",
                1e3 * seconds / simulated,
                counts.steps as f64 / simulated,
                1e9 * seconds / counts.steps as f64,
                counts.factorizations,
            );
        }
    }
    let text = case_four();
    let clock = Instant::now();
    let repeats = 50;
    for _ in 0..repeats {
        std::hint::black_box(started(&text, 1e-4));
    }
    let milliseconds = 1e3 * clock.elapsed().as_secs_f64() / f64::from(repeats);
    println!("\nread, validate, assemble (three times) and start: {milliseconds:.2} ms");
}
