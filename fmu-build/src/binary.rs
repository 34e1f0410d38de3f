//! The shared library of one platform as it stands in the FMU.

use std::fmt;

use crate::macho;
use crate::platform::Platform;

/// A shared library for one platform.
#[derive(Debug, Clone)]
pub struct Binary {
    /// What it runs on.
    pub platform: Platform,
    /// The file.
    pub bytes: Vec<u8>,
}

/// Why what was built cannot be packed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum BinaryError {
    /// A library for macOS is not what macOS loads.
    Macos(macho::Malformed),
    /// There is no library.
    Empty,
}

impl Binary {
    /// One file from what was built for each processor, changed since or not.
    pub fn of(platform: Platform, mut slices: Vec<Vec<u8>>) -> Result<Binary, BinaryError> {
        if platform == Platform::Darwin64 {
            for slice in &mut slices {
                macho::sign(slice).map_err(BinaryError::Macos)?;
            }
        }
        let bytes = if slices.len() > 1 {
            macho::universal(&slices).map_err(BinaryError::Macos)?
        } else {
            slices.pop().ok_or(BinaryError::Empty)?
        };
        Ok(Binary { platform, bytes })
    }
}

impl fmt::Display for BinaryError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            BinaryError::Macos(malformed) => malformed.fmt(f),
            BinaryError::Empty => write!(f, "nothing was built"),
        }
    }
}

impl std::error::Error for BinaryError {}
