//! The classical Runge-Kutta method as a loop in Python, with the equations in numpy arrays.

use std::process::Command;

use serde_json::json;

use super::elsewhere::ask;
use crate::problem::{Problem, Run};

/// The variable that names the interpreter.
pub const PYTHON: &str = "GEARTRAIN_BENCH_PYTHON";
const PROGRAM: &str = include_str!("numpy_rk4.py");
/// Points over a tooth pitch that the stiffness is interpolated between: its error is then below 1e-7.
const POINTS: u32 = 1 << 15;

/// As [`super::rk4::run`]; words for why it cannot be run.
pub fn run(problem: &Problem, steps: u64) -> Result<Run, String> {
    let python = std::env::var_os(PYTHON).ok_or("skipped: no Python with numpy")?;
    let mut description = problem.equations.to_json(POINTS);
    description["start"] = json!(problem.start);
    description["times"] = json!(problem.times);
    description["steps"] = json!(steps);
    let mut program = Command::new(python);
    // One thread, as all others.
    program
        .args(["-c", PROGRAM])
        .env("OPENBLAS_NUM_THREADS", "1");
    ask(&mut program, &description.to_string())
}
