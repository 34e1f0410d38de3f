//! Our own solvers, called as the FMU calls them.

use std::time::Instant;

use geartrain::config::SolverChoice;
use geartrain::simulation::Simulation;

use crate::problem::{Problem, Run, loaded, started};

/// The model `text` with one of our solvers, to the problem's times.
pub fn run(problem: &Problem, text: &str, solver: SolverChoice, tolerance: f64) -> Run {
    follow(&mut started_with(text, solver, tolerance), problem, 0.0)
}

/// The same, but time and steps are those of a second stretch as long as the first: coefficients of step lengths are kept.
pub fn run_on(problem: &Problem, text: &str, solver: SolverChoice, tolerance: f64) -> Run {
    let mut simulation = started_with(text, solver, tolerance);
    let first = follow(&mut simulation, problem, 0.0);
    let since = simulation.time();
    Run {
        forces: first.forces,
        ..follow(&mut simulation, problem, since)
    }
}

fn started_with(text: &str, solver: SolverChoice, tolerance: f64) -> Simulation {
    let (train, mut settings) = loaded(text);
    settings.solver = solver;
    started(&train, &settings, tolerance)
}

/// To the problem's times, counted from `since`.
fn follow(simulation: &mut Simulation, problem: &Problem, since: f64) -> Run {
    let meshes = simulation.model().meshes.len();
    let before = simulation.counts().steps;
    let mut forces = Vec::with_capacity(meshes * problem.times.len());
    let clock = Instant::now();
    for &time in &problem.times {
        simulation
            .advance_to(since + time)
            .expect("the model is stable");
        let motion = simulation.motion();
        forces.extend((0..meshes).map(|mesh| motion.mesh_force(mesh)));
    }
    Run {
        forces,
        seconds: clock.elapsed().as_secs_f64(),
        steps: simulation.counts().steps - before,
    }
}
