//! Our own solvers, called as the FMU calls them.

use std::time::Instant;

use geartrain::config::SolverChoice;

use crate::problem::{Problem, Run, loaded, started};

/// The model `text` with one of our solvers, to the problem's times.
pub fn run(problem: &Problem, text: &str, solver: SolverChoice, tolerance: f64) -> Run {
    let (train, mut settings) = loaded(text);
    settings.solver = solver;
    let mut simulation = started(&train, &settings, tolerance);
    let mut forces = Vec::with_capacity(train.meshes.len() * problem.times.len());
    let clock = Instant::now();
    for &time in &problem.times {
        simulation.advance_to(time).expect("the model is stable");
        let motion = simulation.motion();
        forces.extend((0..train.meshes.len()).map(|mesh| motion.mesh_force(mesh)));
    }
    Run {
        forces,
        seconds: clock.elapsed().as_secs_f64(),
        steps: simulation.counts().steps,
    }
}
