//! What every solver is given: a start, times at which the mesh forces are wanted, and a converged answer to compare with.

use std::time::Instant;

use geartrain::config;
use geartrain::model::ModalModel;
use geartrain::simulation::Simulation;
use geartrain::train::{GearTrain, load};

use crate::equations::Equations;
use crate::series;

/// An initial value problem with the times that count.
#[derive(Debug, Clone)]
pub struct Problem {
    /// x' = f(t, x).
    pub equations: Equations,
    /// x at time 0.
    pub start: Vec<f64>,
    /// When the mesh forces are wanted [s].
    pub times: Vec<f64>,
    /// How large each coordinate of x becomes: what a relative tolerance refers to.
    pub scale: Vec<f64>,
}

/// What came out, at what cost.
#[derive(Debug, Clone)]
pub struct Run {
    /// Mesh forces [N]: all meshes at the first time, then at the next.
    pub forces: Vec<f64>,
    /// Wall time [s].
    pub seconds: f64,
    /// Steps taken.
    pub steps: u64,
}

/// A part of the smallest scale among displacements, and among velocities, still counts as much as the scale itself.
const SMALLEST_SCALE: f64 = 1e-3;

impl Problem {
    /// A model from its start to `span` [s], compared at `samples` equal intervals.
    pub fn of(text: &str, span: f64, samples: u32) -> Problem {
        let (train, settings) = loaded(text);
        let simulation = started(&train, &settings, 1e-8);
        let interval = |index: u32| span * f64::from(index) / f64::from(samples);
        let mut problem = Problem {
            equations: Equations::of(&train, simulation.model(), &torques(&train)),
            start: state(&simulation),
            times: (1..=samples).map(interval).collect(),
            scale: Vec::new(),
        };
        problem.scale = scale(simulation, &problem.times);
        problem
    }

    /// Mesh forces from the states that `advance` reaches at the times; takes the wall time of all of it.
    pub fn run(&self, mut advance: impl FnMut(&mut Vec<f64>, [f64; 2]) -> u64) -> Run {
        let meshes = self.equations.mesh_forces(0.0, &self.start).count();
        let mut forces = Vec::with_capacity(meshes * self.times.len());
        let (mut x, mut time, mut steps) = (self.start.clone(), 0.0, 0);
        let clock = Instant::now();
        for &until in &self.times {
            steps += advance(&mut x, [time, until]);
            time = until;
            forces.extend(self.equations.mesh_forces(time, &x));
        }
        Run {
            forces,
            seconds: clock.elapsed().as_secs_f64(),
            steps,
        }
    }

    /// How far forces are from converged ones: RMS of the difference relative to the RMS of the alternating part, that
    /// of the worst mesh.
    pub fn error(&self, forces: &[f64], converged: &[f64]) -> f64 {
        let meshes = converged.len() / self.times.len();
        let column = |values: &[f64], mesh: usize| -> Vec<f64> {
            values.iter().skip(mesh).step_by(meshes).copied().collect()
        };
        series::worst((0..meshes).map(|mesh| {
            let (found, right) = (column(forces, mesh), column(converged, mesh));
            series::difference(&found, &right) / series::alternating(&right)
        }))
    }
}

/// A valid model file.
pub fn loaded(text: &str) -> (GearTrain, config::Simulation) {
    let loaded = load(text).unwrap_or_else(|problems| panic!("{problems:#?}"));
    (loaded.train, loaded.config.simulation)
}

/// The torques of the file.
pub fn torques(train: &GearTrain) -> Vec<f64> {
    let torques = train.rotors.iter().flat_map(|rotor| &rotor.torques);
    torques.map(|torque| torque.value).collect()
}

/// The simulation that a file describes, with another tolerance.
pub fn started(train: &GearTrain, settings: &config::Simulation, tolerance: f64) -> Simulation {
    let settings = config::Simulation {
        tolerance,
        ..settings.clone()
    };
    let model = ModalModel::assemble(train, None).expect("the model has modes");
    let inputs = model.inputs_at_rest(&torques(train));
    Simulation::start(model, inputs, &settings, 0.0).expect("the model has an equilibrium")
}

/// x of a simulation.
fn state(simulation: &Simulation) -> Vec<f64> {
    let state = simulation.motion().state;
    [state.position(), state.velocity()].concat()
}

/// The RMS of every coordinate of x; those that hardly move count as if they moved a little.
fn scale(mut simulation: Simulation, times: &[f64]) -> Vec<f64> {
    let mut squares = vec![0.0; state(&simulation).len()];
    for &time in times {
        simulation.advance_to(time).expect("the model is stable");
        for (sum, value) in squares.iter_mut().zip(state(&simulation)) {
            *sum += value * value / times.len() as f64;
        }
    }
    let half = squares.len() / 2;
    for part in squares.chunks_mut(half) {
        let largest = part.iter().copied().fold(0.0, f64::max).sqrt();
        for value in part {
            *value = value.sqrt().max(SMALLEST_SCALE * largest);
        }
    }
    squares
}
