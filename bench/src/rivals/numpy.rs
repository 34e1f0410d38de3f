//! The classical Runge-Kutta method as a loop in Python, with the equations in numpy arrays.

use std::io::Write;
use std::process::{Command, Stdio};

use serde_json::{Value, json};

use crate::problem::{Problem, Run};

/// The interpreter that has numpy, if there is one.
pub const PYTHON: &str = "GEARTRAIN_PYTHON";
const PROGRAM: &str = include_str!("numpy_rk4.py");
/// Points over a tooth pitch that the stiffness is interpolated between: its error is then below 1e-7.
const POINTS: u32 = 1 << 15;

/// As [`super::rk4::run`]; words for why it cannot be run.
pub fn run(problem: &Problem, steps: u64) -> Result<Run, String> {
    let python = std::env::var_os(PYTHON).ok_or_else(|| format!("{PYTHON} is not set"))?;
    let mut child = Command::new(python)
        .args(["-c", PROGRAM])
        // One thread, as all others.
        .env("OPENBLAS_NUM_THREADS", "1")
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .spawn()
        .map_err(|error| error.to_string())?;
    let mut description = problem.equations.to_json(POINTS);
    description["start"] = json!(problem.start);
    description["times"] = json!(problem.times);
    description["steps"] = json!(steps);
    let mut input = child.stdin.take().ok_or("no standard input")?;
    let sent = input.write_all(description.to_string().as_bytes());
    drop(input);
    let output = child
        .wait_with_output()
        .map_err(|error| error.to_string())?;
    sent.map_err(|error| error.to_string())?;
    let answer: Value =
        serde_json::from_slice(&output.stdout).map_err(|error| error.to_string())?;
    let forces = answer["forces"].as_array().ok_or("no forces")?;
    Ok(Run {
        forces: forces.iter().filter_map(Value::as_f64).collect(),
        seconds: answer["seconds"].as_f64().ok_or("no time")?,
        steps: steps * problem.times.len() as u64,
    })
}
