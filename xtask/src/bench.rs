//! `cargo xtask bench`: measures, with what the rivals need as far as it can be had here.

use std::ffi::OsString;
use std::path::Path;
use std::process::{Command, Stdio};

use crate::python::Environment;
use crate::{shell, workspace};

/// The page with the latest tables, which follow this line.
const PAGE: &str = "docs/performance.md";
const MARK: &str = "## Latest\n";

/// Runs the parts named in the arguments, all of them when there are none. The benchmark says which rivals are missing.
pub fn command(arguments: &[&str]) -> Result<(), String> {
    let (record, parts): (Vec<&str>, Vec<&str>) =
        arguments.iter().partition(|&&word| word == "--record");
    if !record.is_empty() && !parts.is_empty() {
        return Err("--record is for all parts".to_string());
    }
    let mut bench = Command::new(std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
    bench.args(["run", "--quiet", "--release", "--package", "bench", "--"]);
    bench.args(&parts);
    if parts.is_empty() || parts.contains(&"solvers") {
        let rivals = [
            ("GEARTRAIN_BENCH_PYTHON", python()),
            ("GEARTRAIN_BENCH_DIFFSOL", diffsol()),
        ];
        for (variable, rival) in rivals {
            match rival {
                Ok(path) => drop(bench.env(variable, path)),
                Err(error) => eprintln!("{error}"),
            }
        }
    }
    if record.is_empty() {
        shell::run(&mut bench)
    } else {
        keep(&mut bench)
    }
}

/// Puts what the benchmark prints into the page.
fn keep(bench: &mut Command) -> Result<(), String> {
    println!("measuring for some minutes ...");
    bench.current_dir(workspace()).stderr(Stdio::inherit());
    let output = bench.output().map_err(|error| error.to_string())?;
    if !output.status.success() {
        return Err("the benchmark failed".to_string());
    }
    let tables = String::from_utf8_lossy(&output.stdout);
    let path = workspace().join(PAGE);
    let page = shell::read(&path)?;
    let (text, _) = page
        .split_once(MARK)
        .ok_or_else(|| format!("{PAGE} has no line {MARK}"))?;
    let page = format!("{text}{MARK}\n```text\n{}\n```\n", tables.trim_end());
    shell::write(&path, page.as_bytes())
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
