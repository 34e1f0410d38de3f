//! The same commit, checked out somewhere else, packs the same FMU byte for byte.

use std::path::Path;
use std::process::Command;

use fmu_build::Platform;
use platforms::named;

#[test]
fn another_folder_gives_the_same_fmu() {
    let packed = named("GEARTRAIN_PLATFORMS");
    let workspace = Path::new(env!("CARGO_MANIFEST_DIR"))
        .ancestors()
        .nth(2)
        .expect("workspace");
    let elsewhere = packed.join("another folder of a longer name");
    copy(workspace, &elsewhere);

    let platforms = Platform::ALL.map(Platform::folder).join(",");
    let status = Command::new("cargo")
        .current_dir(&elsewhere)
        .env_remove("CARGO_TARGET_DIR")
        .args([
            "xtask",
            "fmu",
            "examples/three_stage.toml",
            "--platform",
            &platforms,
        ])
        .status();
    assert!(status.expect("cargo").success());
    let read = |path: &Path| std::fs::read(path).expect("an FMU");
    let there = read(&elsewhere.join("target/fmu/three_stage.fmu"));
    let here = read(&packed.join("three_stage.fmu"));
    assert!(
        there == here,
        "other bytes: {} and {}",
        there.len(),
        here.len()
    );
}

/// Copies what git tracks, as it is now.
fn copy(from: &Path, to: &Path) {
    let list = Command::new("git")
        .current_dir(from)
        .args(["ls-files", "-z"])
        .output();
    let list = list.expect("git").stdout;
    let paths = String::from_utf8(list).expect("names in UTF-8");
    for path in paths.split_terminator('\0') {
        let (source, copy) = (from.join(path), to.join(path));
        // What is removed and not yet committed is tracked, but not there.
        let Ok(bytes) = std::fs::read(source) else {
            continue;
        };
        // Copying it again would make cargo compile it again.
        if std::fs::read(&copy).ok().as_ref() != Some(&bytes) {
            std::fs::create_dir_all(copy.parent().expect("a folder")).expect("a folder");
            std::fs::write(copy, bytes).expect("a copy");
        }
    }
}
