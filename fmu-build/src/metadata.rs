//! What cargo knows about the packages of a workspace.

use std::path::{Path, PathBuf};
use std::process::Command;

use serde_json::Value;

/// A package, of the workspace or from a registry.
#[derive(Debug)]
pub struct Package {
    /// Its name.
    pub name: String,
    /// Its version.
    pub version: String,
    /// Its licence as an SPDX expression.
    pub license: Option<String>,
    /// Where its sources are.
    pub folder: PathBuf,
    /// Whether it comes from a registry.
    pub foreign: bool,
}

/// All packages that the workspace may need, on whatever platform.
pub fn packages(workspace: &Path) -> Result<Vec<Package>, String> {
    let mut command = cargo();
    command
        .current_dir(workspace)
        .args(["metadata", "--locked", "--format-version", "1"]);
    let metadata: Value =
        serde_json::from_str(&output(&mut command)?).map_err(|error| error.to_string())?;
    let packages = metadata["packages"].as_array().into_iter().flatten();
    let text = |value: &Value| value.as_str().map(ToString::to_string);
    let package = |package: &Value| {
        Some(Package {
            name: text(&package["name"])?,
            version: text(&package["version"])?,
            license: text(&package["license"]),
            folder: Path::new(package["manifest_path"].as_str()?)
                .parent()?
                .to_path_buf(),
            foreign: !package["source"].is_null(),
        })
    };
    let packages: Option<Vec<Package>> = packages.map(package).collect();
    packages.ok_or("cargo metadata: a package without name, version or path".to_string())
}

/// What a program prints; its own words when it fails.
pub fn output(command: &mut Command) -> Result<String, String> {
    let program = command.get_program().to_string_lossy().into_owned();
    let output = command.output();
    let output = output.map_err(|error| format!("{program} cannot be started: {error}"))?;
    if output.status.success() {
        Ok(String::from_utf8_lossy(&output.stdout).trim().to_string())
    } else {
        let said = String::from_utf8_lossy(&output.stderr);
        Err(format!("{program} failed: {}", said.trim()))
    }
}

/// The cargo that runs this program, or the one in the path.
pub fn cargo() -> Command {
    Command::new(std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into()))
}
