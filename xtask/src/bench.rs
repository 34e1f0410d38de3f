//! `cargo xtask bench`: measures, with a Python that has what the rivals in Python need.

use std::path::Path;
use std::process::Command;

use crate::python::Environment;
use crate::{shell, workspace};

/// Runs the parts named in the arguments; all of them when there are none.
pub fn command(parts: &[&str]) -> Result<(), String> {
    let mut bench = Command::new(std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
    bench.args(["run", "--quiet", "--release", "--package", "bench", "--"]);
    bench.args(parts);
    match Environment::prepare("bench-python", Path::new("bench/requirements.txt")) {
        Ok(environment) => {
            bench.env(
                "GEARTRAIN_PYTHON",
                workspace().join(environment.python().get_program()),
            );
        }
        // The benchmark says which lines are missing.
        Err(error) => eprintln!("without Python: {error}"),
    }
    shell::run(&mut bench)
}
