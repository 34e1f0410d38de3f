//! One packed FMU on several machines: the host `c/run.c` and where it runs.
//!
//! ```text
//!   Packed     an FMU with binaries for every platform
//!   Machine    this Linux, a Debian 11 by its own glibc, Windows by wine, ARM by qemu
//!   library    what a binary exports and needs, read from its bytes
//! ```
//!
//! `cargo xtask platforms` packs the FMUs, installs what is missing or names it, and runs these tests.

pub mod library;
mod machine;
mod packed;

pub use machine::Machine;
pub use packed::Packed;

use std::path::PathBuf;

/// A folder or program that `cargo xtask platforms` names in the environment.
///
/// # Panics
///
/// Panics where it is not named.
pub fn named(variable: &str) -> PathBuf {
    let value = std::env::var_os(variable);
    value
        .unwrap_or_else(|| {
            panic!("{variable} is not set: run these tests with `cargo xtask platforms`")
        })
        .into()
}
