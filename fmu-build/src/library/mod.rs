//! A shared library for a platform, built by cargo: the same commit gives the same bytes in every folder.
//!
//! ```text
//!   native     the machine's own compiler and linker; what `cargo build` needs
//!   portable   what is given away: Linux against an old glibc, Windows, macOS (linker.rs says with what)
//! ```
//!
//! Names of folders get into a library with the places where it may panic; they are replaced (paths.rs). Each platform
//! is built in a folder of its own below `target/libraries`, so that builds with different linkers cannot mix.

mod linker;
mod paths;
mod toolchain;

use std::fmt;
use std::io;
use std::path::{Path, PathBuf};

use crate::platform::Platform;
use paths::replacements;
use toolchain::Toolchain;

pub use linker::OLDEST_GLIBC;

/// Builds the shared library of a package of a workspace.
#[derive(Debug, Clone, Copy)]
pub struct Builder<'a> {
    /// The folder of the workspace.
    pub workspace: &'a Path,
    /// The name of the package.
    pub package: &'a str,
    /// The folder with the programs `cargo-zigbuild` and `python3`, which finds zig; needed where
    /// [`Platform::needs_zig`].
    pub zig: Option<&'a Path>,
}

/// A shared library for a platform as it was built: one file for each processor.
#[derive(Debug, Clone)]
pub struct Library {
    /// What it runs on.
    pub platform: Platform,
    /// The files.
    pub files: Vec<PathBuf>,
}

/// Why the library could not be built.
#[derive(Debug)]
pub enum BuildError {
    /// cargo could not be started.
    Cargo(io::Error),
    /// Nothing is known about this machine, or nothing can be built for it.
    UnknownMachine,
    /// Something has to be installed first.
    Missing {
        /// What is missing.
        what: String,
        /// What brings it.
        packages: String,
    },
    /// cargo said no; its own words are above.
    Failed(&'static str),
    /// The list of macOS' functions cannot be copied from here.
    Sdk(PathBuf, io::Error),
    /// cargo does not know the packages of the workspace, or Python not its own.
    Packages(String),
    /// The library is not where it should be.
    NotThere(PathBuf),
}

impl Builder<'_> {
    /// For this machine, with what every build here needs.
    pub fn native(&self) -> Result<Library, BuildError> {
        let platform = Platform::native().ok_or(BuildError::UnknownMachine)?;
        let file = self.build(platform, "native", &Toolchain::native()?)?;
        Ok(Library {
            platform,
            files: vec![file],
        })
    }

    /// For a platform, so that it runs wherever that platform is.
    pub fn portable(&self, platform: Platform) -> Result<Library, BuildError> {
        // What is missing is said before the first build, which takes minutes.
        let folder = self.folder(platform.folder());
        let toolchains = platform.targets().iter();
        let toolchains = toolchains
            .map(|target| Toolchain::portable(platform, target, self.zig, &folder))
            .collect::<Result<Vec<Toolchain>, _>>()?;
        let files = toolchains.iter();
        let files = files.map(|toolchain| self.build(platform, platform.folder(), toolchain));
        Ok(Library {
            platform,
            files: files.collect::<Result<_, _>>()?,
        })
    }

    fn build(
        &self,
        platform: Platform,
        folder: &str,
        toolchain: &Toolchain,
    ) -> Result<PathBuf, BuildError> {
        let target = self.folder(folder);
        // One crate type is asked for, because cargo drops link-time optimization for two.
        let mut cargo = toolchain.cargo();
        cargo
            .current_dir(self.workspace)
            .args([
                "--quiet",
                "--locked",
                "--release",
                "--lib",
                "--crate-type",
                "cdylib",
            ])
            .args(["--package", self.package, "--target-dir"])
            .arg(&target);
        // Flags from the outside would change the bytes.
        let flags = replacements(self.workspace, self.package).map_err(BuildError::Packages)?;
        let flags: Vec<String> = flags
            .into_iter()
            .chain(toolchain.flags(self.package))
            .collect();
        cargo
            .env("CARGO_ENCODED_RUSTFLAGS", flags.join("\x1f"))
            .env_remove("RUSTFLAGS");
        let status = cargo.status().map_err(BuildError::Cargo)?;
        if !status.success() {
            return Err(BuildError::Failed(platform.folder()));
        }
        let (prefix, extension) = (platform.library_prefix(), platform.library_extension());
        let stem = self.package.replace('-', "_");
        let library = target
            .join(&toolchain.target)
            .join("release")
            .join(format!("{prefix}{stem}.{extension}"));
        if library.is_file() {
            Ok(library)
        } else {
            Err(BuildError::NotThere(library))
        }
    }

    fn folder(&self, name: &str) -> PathBuf {
        self.workspace.join("target/libraries").join(name)
    }
}

impl Library {
    /// The contents of the files.
    pub fn read(&self) -> io::Result<Vec<Vec<u8>>> {
        self.files.iter().map(std::fs::read).collect()
    }
}

impl fmt::Display for BuildError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            BuildError::Cargo(error) => write!(f, "cargo cannot be started: {error}"),
            BuildError::UnknownMachine => {
                write!(f, "FMUs cannot be packed for the machine this runs on")
            }
            BuildError::Missing { what, packages } => write!(f, "{what} is missing: {packages}"),
            BuildError::Failed(platform) => {
                write!(f, "the library does not build for {platform}, see above")
            }
            BuildError::Sdk(list, error) => {
                write!(f, "{} cannot be copied: {error}", list.display())
            }
            BuildError::Packages(error) => f.write_str(error),
            BuildError::NotThere(path) => write!(f, "cargo built no library at {}", path.display()),
        }
    }
}

impl std::error::Error for BuildError {}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_missing_is_named_with_what_brings_it() {
        let builder = Builder {
            workspace: Path::new("no workspace"),
            package: "m",
            zig: None,
        };
        let missing = builder.portable(Platform::Linux64).unwrap_err().to_string();
        let expected = "zig is missing: cargo-zigbuild and ziglang of the Python registry bring it";
        assert_eq!(missing, expected);
    }
}
