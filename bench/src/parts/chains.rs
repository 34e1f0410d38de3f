//! How the cost of a step grows with the number of rotors.

use std::time::Instant;

use crate::clock::{Measure, in_rounds};
use crate::models::{MODES, Phases, chain};
use crate::problem::{loaded, started};
use crate::table::Table;

const ROTORS: [usize; 4] = [3, 10, 30, 100];
/// Communication step [s]: a hundredth of the mesh period, so that breakpoints of the stiffness lie on it.
const STEP: f64 = 2e-5;
/// Steps before the first measurement, and in each: one mesh period.
const WARM_UP: u32 = 300;
const COUNT: u32 = 100;
const TOLERANCE: f64 = 1e-4;

/// Measures and prints.
pub fn run() -> Result<(), String> {
    println!(
        "Chains of rotors, each in mesh with the next, {} modes per rotor: wall time of a communication step of {} us at the\n\
         same tolerance, inputs held, and of reading the model up to its first step. In phase: all meshes pass the same phase\n\
         together; apart: each its own, changing stiffness pieces at communication points only; anywhere: between them too.\n",
        MODES[0],
        1e6 * STEP
    );
    let mut table = Table::new(&[
        "meshes",
        "rotors",
        "ns per communication step",
        "steps in it",
        "ns per step",
        "ns per step and rotor",
        "ms to start",
    ]);
    let (mut chains, mut measures) = (Vec::new(), Vec::<Measure<'_>>::new());
    for (name, phases) in [
        ("in phase", Phases::Together),
        ("apart", Phases::Apart),
        ("anywhere", Phases::Anywhere),
    ] {
        for rotors in ROTORS {
            let clock = Instant::now();
            let (train, settings) = loaded(&chain(rotors, MODES[0], phases));
            let mut simulation = started(&train, &settings, TOLERANCE);
            let start = clock.elapsed().as_secs_f64();
            let mut index = 0;
            let mut advance = move |count: u32| {
                let clock = Instant::now();
                for _ in 0..count {
                    index += 1;
                    let until = f64::from(index) * STEP;
                    simulation.advance_to(until).expect("the chain is stable");
                }
                let seconds = clock.elapsed().as_secs_f64() / f64::from(count);
                (seconds, simulation.counts().steps)
            };
            let (_, before) = advance(WARM_UP);
            let (_, after) = advance(COUNT);
            let steps = (after - before) as f64 / f64::from(COUNT);
            chains.push((name, rotors, steps, start));
            measures.push(Box::new(move || advance(COUNT).0));
        }
    }
    let times = in_rounds(&mut measures);
    let all: Vec<_> = chains.iter().zip(&times.best).collect();
    for ((name, rotors, steps, start), seconds) in &all {
        table.row(vec![
            name.to_string(),
            rotors.to_string(),
            format!("{:.0}", 1e9 * *seconds),
            format!("{steps:.2}"),
            format!("{:.0}", 1e9 * *seconds / steps),
            format!("{:.0}", 1e9 * *seconds / steps / *rotors as f64),
            format!("{:.1}", 1e3 * start),
        ]);
    }
    table.print();
    println!("{}\n", times.quiet);
    for of_phases in all.chunks(ROTORS.len()) {
        let communication: Vec<f64> = of_phases.iter().map(|(_, seconds)| **seconds).collect();
        let own = of_phases
            .iter()
            .map(|((_, _, steps, _), seconds)| *seconds / steps);
        println!(
            "{}: from 10 to 100 rotors a communication step grows with their number to the power {:.2}, a step to the power {:.2}",
            of_phases[0].0.0,
            exponent(&communication),
            exponent(&own.collect::<Vec<f64>>())
        );
    }
    println!();
    Ok(())
}

/// The power of the number of rotors that fits times from 10 rotors on best.
fn exponent(seconds: &[f64]) -> f64 {
    let points = ROTORS
        .iter()
        .zip(seconds)
        .filter(|(rotors, _)| **rotors >= 10);
    let points: Vec<[f64; 2]> = points
        .map(|(&rotors, &seconds)| [libm::log(rotors as f64), libm::log(seconds)])
        .collect();
    let mean =
        |axis: usize| points.iter().map(|point| point[axis]).sum::<f64>() / points.len() as f64;
    let [x, y] = [mean(0), mean(1)];
    let along = points
        .iter()
        .map(|point| (point[0] - x) * (point[1] - y))
        .sum::<f64>();
    along
        / points
            .iter()
            .map(|point| (point[0] - x) * (point[0] - x))
            .sum::<f64>()
}
