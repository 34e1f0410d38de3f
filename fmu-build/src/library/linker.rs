//! Who links a library for a platform, and what it has to be told.
//!
//! ```text
//!   linux64, aarch64-linux   zig, against glibc 2.17, so that nothing newer is asked for
//!   win64                    MinGW
//!   darwin64                 Apple's linker on macOS; elsewhere LLVM's, which comes with Rust, against the list of macOS'
//!                            functions that comes with zig (zig's own linker exports more than it is told)
//! ```

use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::process::Command;

use super::BuildError;
use crate::metadata::{cargo, output};
use crate::platform::Platform;

/// The oldest glibc that portable libraries for Linux run on: that of 2012, which manylinux2014 is built on.
pub const OLDEST_GLIBC: &str = "2.17";

/// Who links.
#[derive(Debug)]
pub enum Linker {
    /// What rustc takes by itself.
    Own,
    /// cargo-zigbuild in this folder.
    Zig(PathBuf),
    /// LLVM's linker for macOS.
    Lld {
        /// rust-lld.
        program: PathBuf,
        /// A folder in the form of Apple's SDK.
        sdk: PathBuf,
    },
}

impl Linker {
    /// Whose result runs on every machine of the platform. `folder` is where files for it may be written.
    pub fn portable(
        platform: Platform,
        zig: Option<&Path>,
        folder: &Path,
    ) -> Result<Linker, BuildError> {
        let zig = || {
            zig.ok_or_else(|| BuildError::Missing {
                what: "zig".to_string(),
                packages: "cargo-zigbuild and ziglang of the Python registry bring it".to_string(),
            })
        };
        match platform {
            Platform::Linux64 | Platform::Aarch64Linux => Ok(Linker::Zig(zig()?.to_path_buf())),
            Platform::Win64 => {
                require_mingw()?;
                Ok(Linker::Own)
            }
            Platform::Darwin64 if cfg!(target_os = "macos") => Ok(Linker::Own),
            Platform::Darwin64 => Ok(Linker::Lld {
                program: rust_lld()?,
                sdk: sdk(zig()?, folder)?,
            }),
        }
    }

    /// `cargo rustc` for the target, to be given further arguments.
    pub fn cargo(&self, target: &str) -> Command {
        let mut command = cargo();
        match self {
            Linker::Own => {
                command.args(["rustc", "--target", target]);
            }
            Linker::Zig(folder) => {
                command = Command::new(folder.join("cargo-zigbuild"));
                command.env("PATH", before_path(folder)).args([
                    "rustc",
                    "--target",
                    &format!("{target}.{OLDEST_GLIBC}"),
                ]);
            }
            Linker::Lld { program, sdk } => {
                let variable = target.to_uppercase().replace('-', "_");
                command
                    .args(["rustc", "--target", target])
                    .env(format!("CARGO_TARGET_{variable}_LINKER"), program)
                    .env("SDKROOT", sdk)
                    // The linker leaves local symbols away; not every toolchain has the program that would do it later.
                    .env("CARGO_PROFILE_RELEASE_STRIP", "none");
            }
        }
        command
    }

    /// Flags of the compiler.
    pub fn flags(&self, target: &str, package: &str) -> Vec<String> {
        // Otherwise the library carries the path of the folder it was linked in.
        let name = format!("-Clink-arg=@rpath/{package}.dylib");
        let flags: &[&str] = match self {
            // The time of linking is not part of the library.
            Linker::Own if target.ends_with("windows-gnu") => {
                &["-Clink-arg=-Wl,--no-insert-timestamp"]
            }
            // Not every machine has Microsoft's runtime library.
            Linker::Own if target.ends_with("windows-msvc") => &["-Ctarget-feature=+crt-static"],
            Linker::Own if target.ends_with("apple-darwin") => &["-Clink-arg=-install_name", &name],
            Linker::Own | Linker::Zig(_) => &[],
            Linker::Lld { .. } => &[
                "-Clinker-flavor=ld64.lld",
                "-Clink-arg=-install_name",
                &name,
                "-Clink-arg=-x",
                "-Clink-arg=-S",
            ],
        };
        flags.iter().map(ToString::to_string).collect()
    }
}

fn before_path(folder: &Path) -> OsString {
    let path = std::env::var_os("PATH").unwrap_or_default();
    let folders = std::iter::once(folder.to_path_buf()).chain(std::env::split_paths(&path));
    // Only a folder with a separator in its name cannot be joined; then cargo-zigbuild says that it finds no zig.
    std::env::join_paths(folders).unwrap_or(path)
}

fn require_mingw() -> Result<(), BuildError> {
    let linker = output(Command::new("x86_64-w64-mingw32-gcc").arg("--version"));
    linker.map(|_| ()).map_err(|_| BuildError::Missing {
        what: "x86_64-w64-mingw32-gcc".to_string(),
        packages: "Debian's gcc-mingw-w64-x86-64-posix brings it".to_string(),
    })
}

fn rust_lld() -> Result<PathBuf, BuildError> {
    let missing = || BuildError::Missing {
        what: "rust-lld".to_string(),
        packages: "the toolchains that rustup installs have it".to_string(),
    };
    let libraries = output(Command::new("rustc").args(["--print", "target-libdir"]));
    let libraries = libraries.map_err(|_| missing())?;
    let program = Path::new(&libraries).with_file_name("bin").join("rust-lld");
    program.is_file().then_some(program).ok_or_else(missing)
}

/// A folder in which the linker finds the functions of macOS' only library as if it were Apple's SDK.
fn sdk(zig: &Path, folder: &Path) -> Result<PathBuf, BuildError> {
    let mut python = Command::new(zig.join("python"));
    python.args(["-c", "import ziglang; print(ziglang.__path__[0])"]);
    let package = output(&mut python).map_err(BuildError::Packages)?;
    let list = Path::new(&package).join("lib/libc/darwin/libSystem.tbd");
    let (sdk, libraries) = (folder.join("sdk"), folder.join("sdk/usr/lib"));
    let failed = |error| BuildError::Sdk(list.clone(), error);
    let functions = std::fs::read_to_string(&list).map_err(failed)?;
    // The list names the ARM of Apple's own programs only; there is the same library for all others.
    let functions = functions.replace("arm64e.x1-", "arm64-");
    let functions = functions.replace("arm64e-", "arm64-");
    std::fs::create_dir_all(&libraries).map_err(failed)?;
    // The crate libc asks for libiconv and uses nothing of it; what it used would be missed here.
    for name in ["libSystem", "libc", "libm", "libiconv"] {
        let copy = libraries.join(format!("{name}.tbd"));
        std::fs::write(copy, &functions).map_err(failed)?;
    }
    Ok(sdk)
}
