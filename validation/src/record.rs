//! One variant in motion: what it does just after the start, and when the free vibration has gone.

use geartrain::simulation::Simulation;

use crate::machine::Variant;
use crate::spectrum::Spectrum;

/// Length of a window [s]: a spectral line every 2 Hz.
pub const WINDOW: f64 = 0.5;
/// Samples in a window: 32.8 kHz.
pub const SAMPLES: usize = 16_384;
/// Start of the settled window [s]. Free lateral vibration has not gone by then, but its frequencies lie apart from those of the
/// excitation; from free vibration of the mesh nothing is left.
pub const SETTLED: f64 = 1.0;

/// Something that is recorded; stages and modes count from 1.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Signal {
    /// Force of the mesh of stage 1 with this stage [N].
    MeshForce(usize),
    /// Displacement of a stage's gear in x [m].
    GearX(usize),
    /// Displacement of a stage's gear in y [m].
    GearY(usize),
    /// Modal coordinate A_i of a stage, lateral in x [m kg^1/2].
    A(usize, usize),
    /// Modal coordinate B_i of a stage, lateral in y [m kg^1/2].
    B(usize, usize),
    /// Modal coordinate At_i of a stage, torsional, elastic modes only [rad kg^1/2 m].
    At(usize, usize),
}

/// When.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Window {
    /// From the static equilibrium at 0 s to [`WINDOW`].
    Start,
    /// From [`SETTLED`] on.
    Settled,
}

/// All signals of a run in both windows.
#[derive(Debug)]
pub struct Record {
    /// Per window and sample, in the order of [`signals`].
    samples: [Vec<Vec<f64>>; 2],
}

impl Record {
    /// Runs a variant.
    pub fn of(variant: &Variant) -> Record {
        let mut simulation = variant.simulation();
        Record {
            samples: [0.0, SETTLED].map(|from| record(&mut simulation, from)),
        }
    }

    /// A signal in a window.
    pub fn signal(&self, signal: Signal, window: Window) -> Vec<f64> {
        let index = signals().iter().position(|one| *one == signal);
        let index = index.expect("a signal that is recorded");
        let samples = &self.samples[usize::from(window == Window::Settled)];
        samples.iter().map(|sample| sample[index]).collect()
    }

    /// Spectrum of a lateral modal coordinate, both planes together.
    pub fn lateral(&self, stage: usize, mode: usize, window: Window) -> Spectrum {
        let y = self.spectrum(Signal::B(stage, mode), window);
        self.spectrum(Signal::A(stage, mode), window).beside(&y)
    }

    /// Spectrum of the displacement of a gear, both directions together.
    pub fn gear(&self, stage: usize, window: Window) -> Spectrum {
        let y = self.spectrum(Signal::GearY(stage), window);
        self.spectrum(Signal::GearX(stage), window).beside(&y)
    }

    /// Its spectrum.
    pub fn spectrum(&self, signal: Signal, window: Window) -> Spectrum {
        Spectrum::of(&self.signal(signal, window), WINDOW)
    }
}

/// Everything that is recorded.
pub fn signals() -> Vec<Signal> {
    let mut all = vec![Signal::MeshForce(2), Signal::MeshForce(3)];
    for stage in 1..=3 {
        all.extend([Signal::GearX(stage), Signal::GearY(stage)]);
        for mode in 1..=2 {
            all.extend([
                Signal::A(stage, mode),
                Signal::B(stage, mode),
                Signal::At(stage, mode),
            ]);
        }
    }
    all
}

fn record(simulation: &mut Simulation, from: f64) -> Vec<Vec<f64>> {
    let signals = signals();
    let mut samples = Vec::with_capacity(SAMPLES);
    for index in 0..SAMPLES {
        let time = from + WINDOW * (index as f64 / SAMPLES as f64);
        simulation
            .advance_to(time)
            .expect("a bilateral train moves on");
        samples.push(
            signals
                .iter()
                .map(|signal| value(simulation, *signal))
                .collect(),
        );
    }
    samples
}

fn value(simulation: &Simulation, signal: Signal) -> f64 {
    let motion = simulation.motion();
    let rotor = |stage: usize| &motion.model.rotors[stage - 1];
    let coordinate = |index: usize| motion.state.position()[index];
    match signal {
        Signal::MeshForce(stage) => motion.mesh_force(stage - 2),
        Signal::GearX(stage) => motion.displacement(&rotor(stage).gears[0].x),
        Signal::GearY(stage) => motion.displacement(&rotor(stage).gears[0].y),
        Signal::A(stage, mode) => coordinate(rotor(stage).lateral.range().start + mode - 1),
        Signal::B(stage, mode) => {
            coordinate(rotor(stage).lateral.range().start + rotor(stage).counts.lateral + mode - 1)
        }
        // The rigid rotation is the first torsional coordinate.
        Signal::At(stage, mode) => coordinate(rotor(stage).torsional.range().start + mode),
    }
}
