//! What the tests of `tests/importers` need from the outside: packed models, Python, and libclang for bindings.

use std::path::{Path, PathBuf};
use std::process::Command;

use crate::python::Environment;
use crate::{pack, workspace};

/// The importers' packages.
pub const REQUIREMENTS: &str = "tests/importers/requirements.txt";

/// Packed models and the Python environment.
pub struct Importers {
    /// The folder of the packed models.
    pub fmus: PathBuf,
    /// Python with the importers' packages.
    pub environment: Environment,
}

impl Importers {
    /// Packs all models and installs what is missing.
    pub fn prepare() -> Result<Importers, String> {
        let workspace = workspace();
        let fmus = workspace.join("target/fmu");
        pack::pack(&models(&workspace)?, &fmus, &[])?;
        let environment = Environment::prepare("test-python", Path::new(REQUIREMENTS))?;
        Ok(Importers { fmus, environment })
    }

    /// Cargo, so that it can build and run the crate.
    pub fn cargo(&self, arguments: &[&str]) -> Result<Command, String> {
        let libclang = self.environment.site_packages()?.join("clang/native");
        let mut cargo = Command::new("cargo");
        cargo
            .args(arguments)
            .env("LIBCLANG_PATH", libclang)
            .env("BINDGEN_EXTRA_CLANG_ARGS", compiler_headers())
            .env("GEARTRAIN_FMUS", &self.fmus);
        Ok(cargo)
    }
}

/// The model files that the importers run.
pub fn models(workspace: &Path) -> Result<Vec<PathBuf>, String> {
    let mut models = Vec::new();
    for folder in ["examples", "tests/models"] {
        let folder = workspace.join(folder);
        let entries =
            std::fs::read_dir(&folder).map_err(|error| format!("{}: {error}", folder.display()))?;
        let paths = entries.filter_map(|entry| entry.ok().map(|entry| entry.path()));
        models.extend(paths.filter(|path| path.extension().is_some_and(|ending| ending == "toml")));
    }
    models.sort();
    Ok(models)
}

/// libclang from PyPI brings no headers of its own: the C compiler's are used.
fn compiler_headers() -> String {
    let output = Command::new("gcc").arg("-print-file-name=include").output();
    let folder = output.map(|output| String::from_utf8_lossy(&output.stdout).trim().to_string());
    folder
        .map(|folder| format!("-I{folder}"))
        .unwrap_or_default()
}
