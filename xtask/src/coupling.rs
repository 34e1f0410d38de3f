//! `cargo xtask coupling`: measures how exact and how stable ways to couple train and housing are.

use std::path::Path;

use crate::python::Environment;
use crate::{couple, shell, workspace};

/// The pair that is measured.
const PAIR: [&str; 2] = ["examples/three_stage.toml", "examples/gearbox_housing.toml"];

/// Writes the tables and the picture of `docs/coupling.md`.
pub fn command() -> Result<(), String> {
    let folder = workspace().join("target/coupling");
    let [train, housing] = PAIR.map(|model| workspace().join(model).display().to_string());
    let out = folder.display().to_string();
    couple::command(&[&train, &housing, "--out", &out])?;
    let environment = Environment::prepare("python", Path::new("examples/requirements.txt"))?;
    shell::run(
        environment
            .python()
            .arg("validation/coupling/study.py")
            .arg(&folder)
            .arg("docs/coupling.md"),
    )?;
    println!("docs/coupling.md: review its diff before committing");
    Ok(())
}
