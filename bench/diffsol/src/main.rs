//! The benchmark's equations of motion through the ODE crate diffsol.
//!
//! `diffsol-rival METHOD TOLERANCE SPAN SAMPLES` reads the text of a model file on standard input and writes mesh forces, steps and
//! wall time as JSON.

use std::io::Read;
use std::time::Instant;

use bench::problem::Problem;
use diffsol::{
    DiffsolError, NalgebraLU, NalgebraMat, NalgebraVec, OdeBuilder, OdeEquationsImplicit,
    OdeSolverMethod, Vector,
};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let [method, tolerance, span, samples] = words.as_slice() else {
        return Err("wanted: METHOD TOLERANCE SPAN SAMPLES".into());
    };
    let mut text = String::new();
    std::io::stdin().read_to_string(&mut text)?;
    let problem = Problem::of(&text, span.parse()?, samples.parse()?);
    let tolerance: f64 = tolerance.parse()?;
    let (equations, start) = (&problem.equations, &problem.start);
    let ode = OdeBuilder::<NalgebraMat<f64>>::new()
        .rtol(tolerance)
        .atol(problem.scale.iter().map(|scale| tolerance * scale))
        .h0(1e-7)
        .rhs_implicit(
            |x, _, time, derivative| equations.evaluate(time, x, derivative),
            |_, _, time, direction, change| equations.apply_jacobian(time, direction, change),
        )
        .init(|_, _, x| x.copy_from_slice(start), start.len())
        .build()?;
    let (seconds, forces, steps) = match method.as_str() {
        "bdf" => solve(&problem, || ode.bdf::<NalgebraLU<f64>>())?,
        "tr_bdf2" => solve(&problem, || ode.tr_bdf2::<NalgebraLU<f64>>())?,
        "tsit45" => solve(&problem, || ode.tsit45())?,
        other => return Err(format!("unknown method {other}").into()),
    };
    let answer = serde_json::json!({ "seconds": seconds, "steps": steps, "forces": forces });
    println!("{answer}");
    Ok(())
}

/// Steps through the problem's times, which the method interpolates to.
fn solve<'a, E, S>(
    problem: &Problem,
    make: impl FnOnce() -> Result<S, DiffsolError>,
) -> Result<(f64, Vec<f64>, usize), DiffsolError>
where
    E: OdeEquationsImplicit<T = f64, V = NalgebraVec<f64>, M = NalgebraMat<f64>> + 'a,
    S: OdeSolverMethod<'a, E>,
{
    let clock = Instant::now();
    let mut solver = make()?;
    let (mut forces, mut steps) = (Vec::new(), 0);
    for &time in &problem.times {
        while solver.state().t < time {
            solver.step()?;
            steps += 1;
        }
        let x = solver.interpolate(time)?.clone_as_vec();
        forces.extend(problem.equations.mesh_forces(time, &x));
    }
    Ok((clock.elapsed().as_secs_f64(), forces, steps))
}
