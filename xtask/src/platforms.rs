//! `cargo xtask platforms`: packed FMUs on old Linux, Windows and ARM, as far as these can be played on this machine.

use std::path::{Path, PathBuf};
use std::process::Command;

use fmu_build::Platform;

use crate::python::Environment;
use crate::{importers, pack, shell, workspace};

/// What has to be installed, with Debian's package that brings it.
const TOOLS: [(&str, &str); 6] = [
    ("/usr/bin/wine", "wine wine64"),
    ("/usr/bin/qemu-aarch64", "qemu-user"),
    ("/usr/aarch64-linux-gnu/lib/libc.so.6", "libc6-arm64-cross"),
    ("/usr/sbin/debootstrap", "debootstrap"),
    (
        "/usr/bin/x86_64-w64-mingw32-gcc",
        "gcc-mingw-w64-x86-64-posix",
    ),
    (
        "/usr/lib/rustlib/src/rust/library/Cargo.lock",
        "rustc-web rust-web-src",
    ),
];

/// Packs all models for all platforms and runs the tests of `tests/platforms`.
pub fn command() -> Result<(), String> {
    require_tools()?;
    let folder = workspace().join("target/platforms");
    println!("== FMUs for all platforms");
    pack::pack(&importers::models(&workspace())?, &folder, &Platform::ALL)?;
    println!("== FMUs for one platform each");
    let example = [workspace().join("examples/three_stage.toml")];
    for platform in Platform::ALL {
        pack::pack(&example, &folder.join(platform.folder()), &[platform])?;
    }
    println!("== the files of a Debian 11");
    let old_linux = old_linux()?;
    println!("== tests");
    let zig = Environment::prepare("zig-python", Path::new(pack::ZIG))?.programs();
    let python = Environment::prepare("test-python", Path::new(importers::REQUIREMENTS))?;
    shell::run(
        Command::new("cargo")
            .args(["test", "--package", "platforms"])
            .env("GEARTRAIN_PLATFORMS", &folder)
            .env("GEARTRAIN_ZIG", zig)
            .env("GEARTRAIN_OLD_LINUX", old_linux)
            .env("GEARTRAIN_PYTHON", python.python().get_program())
            .env("GEARTRAIN_WINE", workspace().join("target/wine")),
    )
}

fn require_tools() -> Result<(), String> {
    let missing = TOOLS.iter().filter(|(file, _)| !Path::new(file).exists());
    let missing: Vec<&str> = missing.map(|(_, packages)| *packages).collect();
    if missing.is_empty() {
        Ok(())
    } else {
        Err(format!(
            "missing Debian packages: apt-get install --no-install-recommends {}",
            missing.join(" ")
        ))
    }
}

/// The files of a Debian 11, fetched once: it was released in 2021 with glibc 2.31.
fn old_linux() -> Result<PathBuf, String> {
    let root = workspace().join("target/debian11");
    let complete = root.join("complete");
    if !complete.exists() {
        let mut fetch = Command::new("debootstrap");
        fetch.args(["--variant=minbase", "bullseye"]).arg(&root);
        shell::run(&mut fetch)?;
        shell::write(&complete, b"")?;
    }
    Ok(root)
}
