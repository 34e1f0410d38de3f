//! With what a library is built for a platform: a linker and Rust's standard library for the target.
//!
//! The standard library is the toolchain's own (`rustup target add`). Where a toolchain has none for the target but has
//! its source, as Debian's rustc-web with rust-web-src, it is compiled along.

use std::path::{Path, PathBuf};
use std::process::Command;

use super::BuildError;
use super::linker::Linker;
use crate::metadata::output;
use crate::platform::Platform;

/// Programs and flags for one target.
#[derive(Debug)]
pub struct Toolchain {
    /// The compiler's name for what it builds for.
    pub target: String,
    linker: Linker,
    standard: Standard,
}

/// Rust's standard library.
#[derive(Debug)]
enum Standard {
    /// That of the compiler in use.
    Own,
    /// To be compiled, by this compiler from its own source.
    Source(PathBuf),
}

impl Toolchain {
    /// What every build on this machine uses.
    pub fn native() -> Result<Toolchain, BuildError> {
        let version = output(Command::new(rustc()).arg("-vV")).unwrap_or_default();
        let host = version.lines().find_map(|line| line.strip_prefix("host: "));
        Ok(Toolchain {
            target: host.ok_or(BuildError::UnknownMachine)?.to_string(),
            linker: Linker::Own,
            standard: Standard::Own,
        })
    }

    /// What makes a library that runs on every machine of the platform. `folder` is where files for it may be written.
    pub fn portable(
        platform: Platform,
        target: &str,
        zig: Option<&Path>,
        folder: &Path,
    ) -> Result<Toolchain, BuildError> {
        Ok(Toolchain {
            target: target.to_string(),
            linker: Linker::portable(platform, zig, folder)?,
            standard: standard(target)?,
        })
    }

    /// `cargo rustc` for the target, to be given further arguments.
    pub fn cargo(&self) -> Command {
        let mut command = self.linker.cargo(&self.target);
        if let Standard::Source(rustc) = &self.standard {
            // Compiling the standard library is not a stable feature; nothing else uses one.
            command
                .env("RUSTC", rustc)
                .env("RUSTC_BOOTSTRAP", "1")
                .arg("-Zbuild-std=std,panic_unwind");
        }
        command
    }

    /// Flags of the compiler.
    pub fn flags(&self, package: &str) -> Vec<String> {
        self.linker.flags(&self.target, package)
    }
}

/// The standard library of the compiler in use, or the first source of one.
fn standard(target: &str) -> Result<Standard, BuildError> {
    if has_standard(&rustc(), target) {
        return Ok(Standard::Own);
    }
    let mut compilers = [rustc(), PathBuf::from("/usr/bin/rustc")].into_iter();
    let source = compilers.find(|rustc| has_source(rustc));
    source.map(Standard::Source).ok_or_else(|| BuildError::Missing {
        what: format!("Rust's standard library for {target}"),
        packages: format!(
            "`rustup target add {target}` brings it, or Debian's rustc-web and rust-web-src (1.96 or \
             newer), with which it is compiled along"
        ),
    })
}

fn has_standard(rustc: &Path, target: &str) -> bool {
    let mut command = Command::new(rustc);
    command.args(["--print", "target-libdir", "--target", target]);
    output(&mut command).is_ok_and(|folder| Path::new(&folder).is_dir())
}

fn has_source(rustc: &Path) -> bool {
    let sysroot = output(Command::new(rustc).args(["--print", "sysroot"]));
    let source = |sysroot: String| Path::new(&sysroot).join("lib/rustlib/src/rust/library");
    sysroot.is_ok_and(|sysroot| source(sysroot).join("Cargo.lock").is_file())
}

/// The compiler in use.
fn rustc() -> PathBuf {
    std::env::var_os("RUSTC")
        .unwrap_or_else(|| "rustc".into())
        .into()
}
