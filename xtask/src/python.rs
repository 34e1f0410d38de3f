//! A Python environment of the project's own, under `target/`.

use std::path::{Path, PathBuf};
use std::process::Command;

use crate::{shell, workspace};

/// A Python environment with the packages of a requirements file.
pub struct Environment {
    folder: PathBuf,
}

impl Environment {
    /// Makes the environment `target/<name>` unless it has the packages of `requirements` already.
    pub fn prepare(name: &str, requirements: &Path) -> Result<Environment, String> {
        let folder = workspace().join("target").join(name);
        let wanted = shell::read(&workspace().join(requirements))?;
        let stamp = folder.join("requirements.installed");
        let environment = Environment { folder };
        if std::fs::read_to_string(&stamp).is_ok_and(|installed| installed == wanted) {
            return Ok(environment);
        }
        println!(
            "making a Python environment in {} ...",
            environment.folder.display()
        );
        shell::run(
            Command::new("python3")
                .args(["-m", "venv", "--clear"])
                .arg(&environment.folder),
        )
        .map_err(|error| format!("{error}\nPython 3.11 or newer with venv is needed"))?;
        shell::run(
            environment
                .python()
                .args([
                    "-m",
                    "pip",
                    "install",
                    "--quiet",
                    "--disable-pip-version-check",
                    "-r",
                ])
                .arg(requirements),
        )?;
        shell::write(&stamp, wanted.as_bytes())?;
        Ok(environment)
    }

    /// The environment's interpreter, to be given arguments.
    pub fn python(&self) -> Command {
        Command::new(self.programs().join("python"))
    }

    /// The folder of the environment's programs.
    pub fn programs(&self) -> PathBuf {
        self.folder
            .join(if cfg!(windows) { "Scripts" } else { "bin" })
    }

    /// Where the environment's packages are.
    pub fn site_packages(&self) -> Result<PathBuf, String> {
        let output = self
            .python()
            .args([
                "-c",
                "import sysconfig; print(sysconfig.get_paths()['purelib'])",
            ])
            .output()
            .map_err(|error| format!("python cannot be started: {error}"))?;
        Ok(PathBuf::from(
            String::from_utf8_lossy(&output.stdout).trim(),
        ))
    }
}
