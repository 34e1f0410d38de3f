//! Packs an FMU: knows files and folders, not gears.
//!
//! An FMU is a zip file with a fixed layout (FMI 2.0.4, section 2.3). The same parts give the same bytes:
//! entries in a fixed order, no clock, names in ASCII with forward slashes, deflate only.

use std::fmt;
use std::io::{self, Cursor, Write};
use std::path::{Path, PathBuf};
use std::process::Command;

use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, DateTime, ZipWriter};

/// The parts of an FMU.
#[derive(Debug, Clone)]
pub struct Fmu {
    /// modelIdentifier: the file stem of the libraries.
    pub model_identifier: String,
    /// modelDescription.xml.
    pub model_description: String,
    /// The shared library for each platform.
    pub binaries: Vec<Binary>,
    /// Further files by their path inside the FMU, such as `documentation/index.html`.
    pub documents: Vec<(String, Vec<u8>)>,
}

/// A shared library for one platform.
#[derive(Debug, Clone)]
pub struct Binary {
    /// What it runs on.
    pub platform: Platform,
    /// The file.
    pub bytes: Vec<u8>,
}

/// A platform with FMI 2.0's name for it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Platform {
    /// x86-64 Linux.
    Linux64,
    /// x86-64 Windows.
    Win64,
    /// x86-64 macOS.
    Darwin64,
}

impl Platform {
    /// The platform this program runs on, where FMI 2.0 has a name for it.
    pub fn native() -> Option<Platform> {
        match (std::env::consts::OS, std::env::consts::ARCH) {
            ("linux", "x86_64") => Some(Platform::Linux64),
            ("windows", "x86_64") => Some(Platform::Win64),
            ("macos", "x86_64") => Some(Platform::Darwin64),
            _ => None,
        }
    }

    /// The folder under `binaries/`.
    pub fn folder(self) -> &'static str {
        match self {
            Platform::Linux64 => "linux64",
            Platform::Win64 => "win64",
            Platform::Darwin64 => "darwin64",
        }
    }

    /// The ending of a shared library's file name.
    pub fn library_extension(self) -> &'static str {
        match self {
            Platform::Linux64 => "so",
            Platform::Win64 => "dll",
            Platform::Darwin64 => "dylib",
        }
    }

    fn library_prefix(self) -> &'static str {
        if self == Platform::Win64 { "" } else { "lib" }
    }
}

impl Fmu {
    /// The bytes of the `.fmu` file.
    pub fn to_bytes(&self) -> io::Result<Vec<u8>> {
        let mut entries = vec![(
            "modelDescription.xml".to_string(),
            self.model_description.as_bytes(),
        )];
        for binary in &self.binaries {
            let (folder, extension) = (
                binary.platform.folder(),
                binary.platform.library_extension(),
            );
            let path = format!("binaries/{folder}/{}.{extension}", self.model_identifier);
            entries.push((path, &binary.bytes));
        }
        entries.extend(
            self.documents
                .iter()
                .map(|(path, bytes)| (path.clone(), bytes.as_slice())),
        );
        // The description comes first, as readers that stream expect; the rest is sorted.
        entries[1..].sort();

        let options = SimpleFileOptions::default()
            .compression_method(CompressionMethod::Deflated)
            .last_modified_time(DateTime::default())
            .unix_permissions(0o644);
        let mut archive = ZipWriter::new(Cursor::new(Vec::new()));
        for (path, bytes) in entries {
            archive.start_file(path, options)?;
            archive.write_all(bytes)?;
        }
        Ok(archive.finish()?.into_inner())
    }
}

/// Why the library could not be built.
#[derive(Debug)]
pub enum BuildError {
    /// cargo could not be started.
    Cargo(io::Error),
    /// cargo said no; its own words are above.
    Failed,
    /// The library is not where it should be.
    Missing(PathBuf),
}

/// Builds the release library of `package` in this workspace for the native platform and gives its path.
///
/// One crate type is asked for, because cargo drops link-time optimization for two.
pub fn build_native_library(workspace: &Path, package: &str) -> Result<PathBuf, BuildError> {
    let cargo = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    let target = workspace.join("target");
    let status = Command::new(cargo)
        .current_dir(workspace)
        .args([
            "rustc",
            "--quiet",
            "--release",
            "--lib",
            "--crate-type",
            "cdylib",
        ])
        .args(["--package", package, "--target-dir"])
        .arg(&target)
        .status()
        .map_err(BuildError::Cargo)?;
    if !status.success() {
        return Err(BuildError::Failed);
    }
    let platform = Platform::native().unwrap_or(Platform::Linux64);
    let (prefix, extension) = (platform.library_prefix(), platform.library_extension());
    let stem = package.replace('-', "_");
    let library = target
        .join("release")
        .join(format!("{prefix}{stem}.{extension}"));
    if library.is_file() {
        Ok(library)
    } else {
        Err(BuildError::Missing(library))
    }
}

impl fmt::Display for BuildError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            BuildError::Cargo(error) => write!(f, "cargo cannot be started: {error}"),
            BuildError::Failed => write!(f, "the library does not build, see above"),
            BuildError::Missing(path) => write!(f, "cargo built no library at {}", path.display()),
        }
    }
}

impl std::error::Error for BuildError {}

#[cfg(test)]
mod tests {
    use super::*;

    fn sample() -> Fmu {
        Fmu {
            model_identifier: "m".to_string(),
            model_description: "<fmiModelDescription/>".to_string(),
            binaries: vec![Binary {
                platform: Platform::Linux64,
                bytes: vec![7; 5000],
            }],
            documents: vec![("documentation/index.html".to_string(), b"<html/>".to_vec())],
        }
    }

    #[test]
    fn entries_stand_where_the_standard_wants_them() {
        let bytes = sample().to_bytes().unwrap();
        let mut archive = zip::ZipArchive::new(Cursor::new(bytes)).unwrap();
        let names: Vec<String> = (0..archive.len())
            .map(|index| archive.by_index(index).unwrap().name().unwrap().to_string())
            .collect();
        let expected = [
            "modelDescription.xml",
            "binaries/linux64/m.so",
            "documentation/index.html",
        ];
        assert_eq!(names, expected);
    }

    #[test]
    fn the_same_parts_give_the_same_bytes() {
        assert_eq!(sample().to_bytes().unwrap(), sample().to_bytes().unwrap());
    }
}
