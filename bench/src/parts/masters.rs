//! The FMU as a master sees it: a communication step through the C interface.

use core::f64::consts::TAU;
use std::time::Instant;

use geartrain::interface::Quantity;

use crate::clock::{Measure, in_rounds};
use crate::fmu::{Fmu, Slave};
use crate::models::{MODES, odd_speed, three_stage};
use crate::table::Table;

/// Communication step [s]: that of the example's DefaultExperiment.
const STEP: f64 = 2e-5;
/// Steps of one measurement, short enough to be left alone by other programs now and then: 36 mesh periods at 3000 rpm.
const COUNT: usize = 1000;
/// Measurements before those that count: caches fill.
const WARM_UP: usize = 20;
/// Gearbox motion that the master sends: amplitude [m] and frequency [Hz].
const AMPLITUDE: f64 = 1e-6;
const FREQUENCY: f64 = 230.0;
/// Torque that it adds to those of the file [N m].
const TORQUE: f64 = 20.0;

/// What a master exchanges in every step.
struct Exchange {
    inputs: Vec<u32>,
    /// Mean, amplitude and phase of every input.
    motions: Vec<[f64; 3]>,
    outputs: Vec<u32>,
}

/// Which calls the master makes in every step.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Calls {
    StepOnly,
    All,
}

/// Measures and prints.
pub fn run() -> Result<(), String> {
    let step = 1e6 * STEP;
    println!(
        "A communication step of {step} us through the C interface of the packed release library: three_stage from\n\
         equilibrium, default tolerance. All: fmi2SetReal of every gearbox displacement and velocity and of the torques, with\n\
         values that change in every step, fmi2DoStep, fmi2GetReal of all bearing and mesh forces.\n"
    );
    let mut table = Table::new(&[
        "speed",
        "modes",
        "inputs",
        "outputs",
        "calls",
        "ns per communication step",
        "ms per simulated s",
    ]);
    let mut fmus = Vec::new();
    for speed in ["3000 rpm", "2961.7 rpm"] {
        for modes in MODES {
            let text = three_stage(modes);
            let text = if speed == "3000 rpm" {
                text
            } else {
                odd_speed(&text)
            };
            let fmu = Fmu::of(&text)?;
            let exchange = Exchange::of(&fmu);
            fmus.push((speed, modes, fmu, exchange));
        }
    }
    let (mut lines, mut measures) = (Vec::new(), Vec::new());
    for (speed, modes, fmu, exchange) in &fmus {
        for (name, calls) in [("doStep only", Calls::StepOnly), ("all", Calls::All)] {
            lines.push(vec![
                speed.to_string(),
                modes.to_string(),
                exchange.inputs.len().to_string(),
                exchange.outputs.len().to_string(),
                name.to_string(),
            ]);
            measures.push(time_of_step(fmu, exchange, calls));
        }
    }
    let times = in_rounds(&mut measures);
    for (mut cells, seconds) in lines.into_iter().zip(&times.best) {
        cells.extend([
            format!("{:.0}", 1e9 * seconds),
            format!("{:.2}", 1e3 * seconds / STEP),
        ]);
        table.row(cells);
    }
    table.print();
    println!("{}\n", times.quiet);
    Ok(())
}

/// Wall time of one step [s].
fn time_of_step<'a>(fmu: &'a Fmu, exchange: &'a Exchange, calls: Calls) -> Measure<'a> {
    let slave = fmu.instantiate();
    slave.initialize();
    let mut first = 0;
    let mut measure = move || {
        let clock = Instant::now();
        exchange.steps(&slave, calls, first);
        first += COUNT;
        clock.elapsed().as_secs_f64() / COUNT as f64
    };
    for _ in 0..WARM_UP {
        measure();
    }
    Box::new(measure)
}

impl Exchange {
    fn of(fmu: &Fmu) -> Exchange {
        let inputs = fmu.references(|quantity| {
            matches!(
                quantity,
                Quantity::Torque { .. }
                    | Quantity::BaseDisplacement { .. }
                    | Quantity::BaseVelocity { .. }
            )
        });
        let outputs = fmu.references(|quantity| {
            matches!(
                quantity,
                Quantity::MeshForce { .. } | Quantity::BearingForce { .. }
            )
        });
        let mut means = vec![0.0; inputs.len()];
        fmu.instantiate().get(&inputs, &mut means);
        let rate = AMPLITUDE * TAU * FREQUENCY;
        let motion = |(&reference, &mean): (&u32, &f64)| match fmu.quantity(reference) {
            Quantity::Torque { .. } => [mean, TORQUE, 0.0],
            Quantity::BaseDisplacement { bearing, .. } => [mean, AMPLITUDE, bearing as f64],
            Quantity::BaseVelocity { bearing, .. } => [mean, rate, bearing as f64 + TAU / 4.0],
            other => unreachable!("{other:?} is no input"),
        };
        Exchange {
            motions: inputs.iter().zip(&means).map(motion).collect(),
            inputs,
            outputs,
        }
    }

    /// `COUNT` steps from number `first`.
    fn steps(&self, slave: &Slave<'_>, calls: Calls, first: usize) {
        // One period of the master's own values, made before the clock would see it.
        let (mut values, mut results) =
            (vec![0.0; self.inputs.len()], vec![0.0; self.outputs.len()]);
        let turn = TAU * FREQUENCY * STEP;
        let (step_sine, step_cosine) = libm::sincos(turn);
        let (mut sine, mut cosine) = libm::sincos(turn * first as f64);
        let ways: Vec<[f64; 3]> = self
            .motions
            .iter()
            .map(|&[mean, size, phase]| {
                let (sine, cosine) = libm::sincos(phase);
                [mean, size * cosine, size * sine]
            })
            .collect();
        for index in first..first + COUNT {
            if calls == Calls::All {
                for (value, [mean, along_sine, along_cosine]) in values.iter_mut().zip(&ways) {
                    *value = mean + along_sine * sine + along_cosine * cosine;
                }
                (sine, cosine) = (
                    sine * step_cosine + cosine * step_sine,
                    cosine * step_cosine - sine * step_sine,
                );
                slave.set(&self.inputs, &values);
            }
            slave.step(index as f64 * STEP, STEP);
            if calls == Calls::All {
                slave.get(&self.outputs, &mut results);
                std::hint::black_box(&results);
            }
        }
    }
}
