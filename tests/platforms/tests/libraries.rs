//! What the libraries of a packed FMU export and need, on every platform. Those for macOS are looked at here and not run.

use std::collections::BTreeSet;

use fmu_build::{OLDEST_GLIBC, Platform};
use object::Architecture;
use platforms::{Packed, library};
use sha2::{Digest, Sha256};

/// Every library in the example with what it is for.
fn libraries(fmu: &Packed) -> Vec<(String, &[u8])> {
    let mut libraries = Vec::new();
    for platform in Platform::ALL {
        let bytes = fmu.library(platform);
        if platform == Platform::Darwin64 {
            for (processor, slice) in library::slices(bytes) {
                libraries.push((format!("darwin64 {processor:?}"), slice));
            }
        } else {
            libraries.push((platform.folder().to_string(), bytes));
        }
    }
    libraries
}

/// The names in the header of the C interface.
fn functions_of_fmi() -> Vec<String> {
    let header = include_str!("../../importers/c/fmi2.h");
    let rows = header.lines().filter_map(|line| {
        let row = line.strip_prefix("    X(")?;
        row.split(", ").nth(1)
    });
    let mut names: Vec<String> = rows.map(|name| format!("fmi2{name}")).collect();
    names.sort();
    names
}

#[test]
fn every_library_exports_the_34_functions_and_nothing_else() {
    let expected = functions_of_fmi();
    assert_eq!(expected.len(), 34);
    let fmu = Packed::read("three_stage");
    for (what, bytes) in libraries(&fmu) {
        assert_eq!(library::exports(bytes), expected, "{what}");
    }
}

#[test]
fn linux_libraries_ask_for_nothing_newer_than_glibc_2_17() {
    let fmu = Packed::read("three_stage");
    for platform in [Platform::Linux64, Platform::Aarch64Linux] {
        let versions = library::glibc_versions(fmu.library(platform));
        let highest = versions.last().expect("it uses glibc");
        assert!(*highest <= library::numbers(OLDEST_GLIBC), "{highest:?}");
    }
}

#[test]
fn libraries_need_nothing_but_their_systems_own_libraries() {
    let fmu = Packed::read("three_stage");
    for (what, bytes) in libraries(&fmu) {
        let own: &[&str] = match what.as_str() {
            // All of them are parts of glibc.
            "linux64" => &[
                "libc.so.6",
                "libm.so.6",
                "libdl.so.2",
                "libpthread.so.0",
                "ld-linux-x86-64.so.2",
            ],
            "aarch64-linux" => &[
                "libc.so.6",
                "libm.so.6",
                "libdl.so.2",
                "libpthread.so.0",
                "ld-linux-aarch64.so.1",
            ],
            // Windows 7 with its updates has all of them. Rust's randomly seeded maps would add bcryptprimitives.dll.
            "win64" => &[
                "KERNEL32.dll",
                "msvcrt.dll",
                "ntdll.dll",
                "api-ms-win-core-synch-l1-2-0.dll",
            ],
            _ => &["/usr/lib/libSystem.B.dylib", "/usr/lib/libiconv.2.dylib"],
        };
        let own: BTreeSet<String> = own.iter().map(ToString::to_string).collect();
        let needed = library::needed(bytes);
        let foreign: Vec<&String> = needed.difference(&own).collect();
        assert!(foreign.is_empty(), "{what}: {foreign:?}");
        assert!(!needed.is_empty(), "{what}");
    }
}

#[test]
fn the_library_for_macos_is_for_both_processors() {
    let fmu = Packed::read("three_stage");
    let slices = library::slices(fmu.library(Platform::Darwin64)).into_iter();
    let processors: Vec<Architecture> = slices.map(|(processor, _)| processor).collect();
    assert_eq!(processors, [Architecture::X86_64, Architecture::Aarch64]);
}

/// The model is written into the library after the linker signed it; macOS on ARM would kill the host.
#[test]
fn pages_of_the_library_for_macos_on_arm_have_the_sums_that_its_signature_says() {
    let fmu = Packed::read("three_stage");
    let slices = library::slices(fmu.library(Platform::Darwin64));
    let (_, arm) = slices[1];
    // The code directory is found by its mark, not by the way in which packing finds it.
    let mark = [0xfa, 0xde, 0x0c, 0x02];
    let found = arm.windows(4).rposition(|window| window == mark);
    let directory = &arm[found.expect("a code directory")..];
    let field = |at: usize| {
        let bytes = directory[at..at + 4].try_into().expect("four bytes");
        u32::from_be_bytes(bytes) as usize
    };
    let (sums, count, end, page) = (field(16), field(28), field(32), 1 << directory[39]);
    assert_eq!(count, end.div_ceil(page));
    for (index, bytes) in arm[..end].chunks(page).enumerate() {
        let sum = &directory[sums + 32 * index..][..32];
        assert_eq!(sum, &Sha256::digest(bytes)[..], "page {index}");
    }
}
