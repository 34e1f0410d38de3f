//! `cargo xtask merge` and the platforms of `cargo xtask fmu`, as typed.

mod support;

use std::path::Path;
use std::process::Output;

use fmu_build::Archive;
use support::{folder, xtask};

fn error(output: &Output) -> String {
    assert!(!output.status.success(), "{output:?}");
    String::from_utf8_lossy(&output.stderr).into_owned()
}

/// Writes an FMU that consists of its guid and a library.
fn write(path: &Path, guid: &str, library: &str) {
    let mut fmu = Archive::new(format!("<fmiModelDescription guid=\"{guid}\"/>"));
    fmu.files.insert(library.to_string(), vec![1, 2, 3]);
    std::fs::write(path, fmu.to_bytes().unwrap()).unwrap();
}

#[test]
fn files_from_two_machines_become_one_with_the_name_of_the_first() {
    let folder = folder("merge");
    write(&folder.join("m.fmu"), "{1}", "binaries/linux64/m.so");
    write(&folder.join("other.fmu"), "{1}", "binaries/win64/m.dll");
    let output = xtask(
        &folder,
        &["merge", "m.fmu", "other.fmu", "--out", "together"],
    );
    assert!(output.status.success(), "{output:?}");
    let bytes = std::fs::read(folder.join("together/m.fmu")).unwrap();
    let paths: Vec<String> = Archive::from_bytes(&bytes)
        .unwrap()
        .files
        .into_keys()
        .collect();
    assert_eq!(paths, ["binaries/linux64/m.so", "binaries/win64/m.dll"]);
}

#[test]
fn what_cannot_be_merged_is_named() {
    let folder = folder("merge_refused");
    write(&folder.join("a.fmu"), "{1}", "binaries/linux64/m.so");
    write(&folder.join("b.fmu"), "{2}", "binaries/win64/m.dll");
    std::fs::write(folder.join("text.fmu"), "text").unwrap();
    let different = error(&xtask(&folder, &["merge", "a.fmu", "b.fmu"]));
    assert!(
        different.starts_with("a.fmu and b.fmu: the guids {1} and {2} differ"),
        "{different}"
    );
    let broken = error(&xtask(&folder, &["merge", "a.fmu", "text.fmu"]));
    assert!(broken.starts_with("text.fmu: not a readable"), "{broken}");
    error(&xtask(&folder, &["merge"]));
}

#[test]
fn unknown_platforms_are_refused_with_those_that_are_known() {
    let folder = folder("platforms");
    let words = ["fmu", "m.toml", "--platform", "linux64,win32"];
    let said = error(&xtask(&folder, &words));
    let expected = "--platform: \"win32\" is none of linux64, win64, darwin64, aarch64-linux\n";
    assert_eq!(said, expected);
    error(&xtask(&folder, &["fmu", "m.toml", "--platform"]));
}
