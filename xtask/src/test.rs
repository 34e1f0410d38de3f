//! `cargo xtask test`: everything that has to hold, cheapest first.

use std::process::Command;

use crate::importers::Importers;
use crate::shell;

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
    let importers = Importers::prepare()?;
    step("Rust importers");
    for arguments in [
        &[
            "clippy",
            "--quiet",
            "--package",
            "importers",
            "--package",
            "platforms",
            "--all-targets",
            "--",
            "--deny",
            "warnings",
        ][..],
        &["test", "--quiet", "--package", "importers"][..],
    ] {
        shell::run(&mut importers.cargo(arguments)?)?;
    }
    step("Python importers");
    shell::run(
        importers
            .environment
            .python()
            .args([
                "-m",
                "pytest",
                "-q",
                "-p",
                "no:cacheprovider",
                "tests/importers",
            ])
            .env("GEARTRAIN_FMUS", &importers.fmus)
            .env("PYTHONDONTWRITEBYTECODE", "1"),
    )
}

fn step(name: &str) {
    println!("== {name}");
}
