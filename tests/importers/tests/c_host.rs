//! A master in C that does everything wrong (`c/host.c`), watched by sanitizers and by valgrind: no leak, no invalid access.
//!
//! The address sanitizer watches the host and all memory; what the library itself reads and writes, only valgrind sees. Miri,
//! which would see more, cannot call foreign code, and the toolchain cannot be extended where this was written.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use importers::Fmu;

/// Compiles the host for one of the tests.
fn compiled(name: &str, flags: &[&str]) -> PathBuf {
    let host = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    let output = Command::new("cc")
        .args(["-std=c11", "-Wall", "-Wextra", "-Werror", "-g", "-O1"])
        .args(flags)
        .arg(concat!(env!("CARGO_MANIFEST_DIR"), "/c/host.c"))
        .arg("-o")
        .arg(&host)
        .arg("-ldl")
        .output();
    succeeded(&output.expect("a C compiler"));
    host
}

/// The host's arguments: the library, its guid, how many instances, a seed, an input, an output and a parameter.
fn arguments(fmu: &Fmu, instances: u32, seed: u32) -> Vec<String> {
    let mut arguments = vec![
        fmu.library().display().to_string(),
        fmu.description().guid.clone(),
        instances.to_string(),
        seed.to_string(),
    ];
    let variables = [
        "pinion_shaft.left.housing.x",
        "mesh.force",
        "pinion_shaft.left.stiffness.xx",
    ];
    arguments.extend(variables.map(|name| fmu.reference(name).to_string()));
    arguments
}

#[track_caller]
fn succeeded(output: &Output) {
    let told = String::from_utf8_lossy(&output.stderr);
    assert!(
        output.status.success() && told.is_empty(),
        "{}\n{told}",
        output.status
    );
}

#[test]
#[cfg_attr(
    not(target_os = "linux"),
    ignore = "the host is for Linux and its tools"
)]
fn a_thousand_instances_under_address_and_leak_sanitizer() {
    let fmu = Fmu::unpack("reducer");
    let host = compiled("sanitized_host", &["-fsanitize=address,undefined"]);
    let output = Command::new(host)
        .args(arguments(&fmu, 1000, 1))
        .env("ASAN_OPTIONS", "detect_leaks=1")
        .output();
    succeeded(&output.expect("the host"));
}

#[test]
#[cfg_attr(
    not(target_os = "linux"),
    ignore = "the host is for Linux and its tools"
)]
fn every_access_of_the_library_under_valgrind() {
    let fmu = Fmu::unpack("reducer");
    let host = compiled("plain_host", &[]);
    // Each instance takes valgrind 50 times as long: fewer of them, with another seed.
    let output = Command::new("valgrind")
        .args(["--quiet", "--error-exitcode=99", "--leak-check=full"])
        .arg(host)
        .args(arguments(&fmu, 150, 2))
        .output();
    succeeded(&output.expect("valgrind"));
}
