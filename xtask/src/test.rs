//! `cargo xtask test`: everything that has to hold, cheapest first.

use std::path::{Path, PathBuf};
use std::process::Command;

use crate::python::Environment;
use crate::{pack, shell, workspace};

/// Formatting, lints, Rust tests, then packed FMUs through importers written by others.
pub fn command() -> Result<(), String> {
    step("formatting");
    shell::cargo(&["fmt", "--all", "--check"])?;
    step("lints");
    shell::cargo(&[
        "clippy",
        "--quiet",
        "--all-targets",
        "--",
        "--deny",
        "warnings",
    ])?;
    step("documentation");
    let mut doc = Command::new("cargo");
    doc.args(["doc", "--quiet", "--no-deps"])
        .env("RUSTDOCFLAGS", "--deny warnings");
    shell::run(&mut doc)?;
    step("Rust tests");
    shell::cargo(&["test", "--quiet"])?;

    step("packed FMUs");
    let workspace = workspace();
    let fmus = workspace.join("target/fmu");
    pack::pack(&models(&workspace)?, &fmus)?;
    let environment =
        Environment::prepare("test-python", Path::new("tests/importers/requirements.txt"))?;
    step("Rust importers");
    for arguments in [
        &[
            "clippy",
            "--quiet",
            "--package",
            "importers",
            "--all-targets",
            "--",
            "--deny",
            "warnings",
        ][..],
        &["test", "--quiet", "--package", "importers"][..],
    ] {
        let mut importers = Command::new("cargo");
        importers
            .args(arguments)
            .env(
                "LIBCLANG_PATH",
                environment.site_packages()?.join("clang/native"),
            )
            .env("BINDGEN_EXTRA_CLANG_ARGS", compiler_headers())
            .env("GEARTRAIN_FMUS", &fmus);
        shell::run(&mut importers)?;
    }
    step("Python importers");
    shell::run(
        environment
            .python()
            .args([
                "-m",
                "pytest",
                "-q",
                "-p",
                "no:cacheprovider",
                "tests/importers",
            ])
            .env("GEARTRAIN_FMUS", &fmus)
            .env("PYTHONDONTWRITEBYTECODE", "1"),
    )
}

fn step(name: &str) {
    println!("== {name}");
}

/// The model files that the importers run.
fn models(workspace: &Path) -> Result<Vec<PathBuf>, String> {
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
