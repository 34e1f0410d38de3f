//! `cargo xtask bench`: measures, with what the rivals need as far as it can be had here.

use std::ffi::OsString;
use std::path::Path;
use std::process::Command;

use crate::python::Environment;
use crate::{shell, workspace};

/// Runs the parts named in the arguments; all of them when there are none. The benchmark says which rivals are missing.
pub fn command(parts: &[&str]) -> Result<(), String> {
    let mut bench = Command::new(std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
    bench.args(["run", "--quiet", "--release", "--package", "bench", "--"]);
    bench.args(parts);
    if parts.is_empty() || parts.contains(&"solvers") {
        for (variable, rival) in [
            ("GEARTRAIN_BENCH_PYTHON", python()),
            ("GEARTRAIN_BENCH_DIFFSOL", diffsol()),
        ] {
            match rival {
                Ok(path) => drop(bench.env(variable, path)),
                Err(error) => eprintln!("{error}"),
            }
        }
    }
    shell::run(&mut bench)
}

/// An interpreter with numpy.
fn python() -> Result<OsString, String> {
    let environment = Environment::prepare("bench-python", Path::new("bench/requirements.txt"))?;
    Ok(environment.python().get_program().to_os_string())
}

/// The program in `bench/diffsol`.
fn diffsol() -> Result<OsString, String> {
    let target = workspace().join("target/bench-diffsol");
    let folder = target.display().to_string();
    let manifest = "bench/diffsol/Cargo.toml";
    shell::cargo(&[
        "build",
        "--quiet",
        "--release",
        "--manifest-path",
        manifest,
        "--target-dir",
        &folder,
    ])?;
    let name = format!("diffsol-rival{}", std::env::consts::EXE_SUFFIX);
    Ok(target.join("release").join(name).into_os_string())
}
