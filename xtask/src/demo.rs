//! `cargo xtask demo`: the main job on a fresh machine, from nothing to pictures.

use std::path::Path;

use crate::python::Environment;
use crate::{pack, shell, workspace};

/// Packs the example and runs the paper's four cases through FMPy.
pub fn command() -> Result<(), String> {
    let workspace = workspace();
    println!("packing examples/three_stage.toml ...");
    let model = workspace.join("examples/three_stage.toml");
    let fmus = pack::pack(&[model], &workspace.join("target/fmu"))?;
    let environment = Environment::prepare("python", Path::new("examples/requirements.txt"))?;
    let out = workspace.join("target/demo");
    shell::run(
        environment
            .python()
            .arg("examples/paper_cases.py")
            .args(&fmus)
            .arg(&out),
    )
}
