//! Rivals in a process of their own: they read a problem on standard input and answer in JSON.

use std::io::Write;
use std::process::{Command, Stdio};

use serde_json::Value;

use crate::problem::Run;

/// What a program answers to an input; words for why it does not.
pub fn ask(program: &mut Command, input: &str) -> Result<Run, String> {
    let words = |error: &dyn core::fmt::Display| error.to_string();
    let mut child = program
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .map_err(|error| words(&error))?;
    let mut pipe = child.stdin.take().ok_or("no standard input")?;
    let sent = pipe.write_all(input.as_bytes());
    drop(pipe);
    let output = child.wait_with_output().map_err(|error| words(&error))?;
    if !output.status.success() {
        let said = String::from_utf8_lossy(&output.stderr);
        return Err(said.lines().last().unwrap_or("failed").to_string());
    }
    sent.map_err(|error| words(&error))?;
    let answer: Value = serde_json::from_slice(&output.stdout).map_err(|error| words(&error))?;
    let forces = answer["forces"].as_array().ok_or("no forces")?;
    let number = |force: &Value| force.as_f64().unwrap_or(f64::NAN);
    Ok(Run {
        forces: forces.iter().map(number).collect(),
        seconds: answer["seconds"].as_f64().ok_or("no time")?,
        steps: answer["steps"].as_u64().ok_or("no steps")?,
    })
}
