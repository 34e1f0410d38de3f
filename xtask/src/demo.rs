//! `cargo xtask demo`: the main job on a fresh machine, from nothing to pictures.

use std::path::Path;

use crate::python::Environment;
use crate::{inspect, pack, shell, workspace};

/// Packs the example, runs the paper's four cases through FMPy and draws the paper's figures.
pub fn command() -> Result<(), String> {
    let workspace = workspace();
    println!("packing examples/three_stage.toml ...");
    let model = workspace.join("examples/three_stage.toml");
    let out = workspace.join("target/demo");
    let inspection = out.join("inspection.json");
    shell::write(&inspection, inspect::as_json(&model)?.as_bytes())?;
    let fmus = pack::pack(&[model], &workspace.join("target/fmu"), &[])?;
    let environment = Environment::prepare("python", Path::new("examples/requirements.txt"))?;
    shell::run(
        environment
            .python()
            .arg("examples/paper_cases.py")
            .args(&fmus)
            .args([&inspection, &out]),
    )
}
