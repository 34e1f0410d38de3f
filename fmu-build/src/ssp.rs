//! Several FMUs and how they are connected, in one file (System Structure and Parameterization 1.0, section 4).

use crate::archive::{ArchiveError, zipped};

/// The parts of an `.ssp` file.
#[derive(Debug, Clone)]
pub struct Ssp {
    /// SystemStructure.ssd.
    pub structure: String,
    /// The FMUs by their file names, in `resources/`.
    pub fmus: Vec<(String, Vec<u8>)>,
}

impl Ssp {
    /// The bytes of the `.ssp` file.
    pub fn to_bytes(&self) -> Result<Vec<u8>, ArchiveError> {
        let structure = ("SystemStructure.ssd".to_string(), self.structure.as_bytes());
        let fmus = self.fmus.iter();
        let fmus = fmus.map(|(name, bytes)| (format!("resources/{name}"), bytes.as_slice()));
        zipped(std::iter::once(structure).chain(fmus))
    }
}
