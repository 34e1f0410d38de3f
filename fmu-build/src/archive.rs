//! The zip file: the same files give the same bytes.
//!
//! Entries in a fixed order, no clock, names in ASCII with forward slashes, deflate only.

use std::collections::BTreeMap;
use std::fmt;
use std::io::{Cursor, Read, Write};

use zip::result::ZipError;
use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, DateTime, ZipArchive, ZipWriter};

const DESCRIPTION: &str = "modelDescription.xml";

/// The files of an FMU.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Archive {
    /// modelDescription.xml.
    pub model_description: String,
    /// Everything else by its path.
    pub files: BTreeMap<String, Vec<u8>>,
}

/// Why a file cannot be read as an FMU, or not be written.
#[derive(Debug)]
pub enum ArchiveError {
    /// It is not a zip file, or a broken one.
    Zip(ZipError),
    /// It has no modelDescription.xml in UTF-8.
    NoDescription,
}

impl Archive {
    /// An FMU that consists of its description.
    pub fn new(model_description: String) -> Archive {
        Archive {
            model_description,
            files: BTreeMap::new(),
        }
    }

    /// The files in a `.fmu` file.
    pub fn from_bytes(bytes: &[u8]) -> Result<Archive, ArchiveError> {
        let mut zip = ZipArchive::new(Cursor::new(bytes))?;
        let mut files = BTreeMap::new();
        for index in 0..zip.len() {
            let mut entry = zip.by_index(index)?;
            if entry.is_dir() {
                continue;
            }
            let path = entry.name()?.to_string();
            let mut content = Vec::new();
            entry.read_to_end(&mut content).map_err(ZipError::Io)?;
            files.insert(path, content);
        }
        let description = files.remove(DESCRIPTION).map(String::from_utf8);
        let Some(Ok(model_description)) = description else {
            return Err(ArchiveError::NoDescription);
        };
        Ok(Archive {
            model_description,
            files,
        })
    }

    /// The bytes of the `.fmu` file.
    pub fn to_bytes(&self) -> Result<Vec<u8>, ArchiveError> {
        // The description comes first, as readers that stream expect; the rest is sorted.
        let description = (DESCRIPTION.to_string(), self.model_description.as_bytes());
        let files = self.files.iter();
        let files = files.map(|(path, bytes)| (path.clone(), bytes.as_slice()));
        zipped(std::iter::once(description).chain(files))
    }
}

/// A zip file of these entries in their order.
pub(crate) fn zipped<'f>(
    entries: impl Iterator<Item = (String, &'f [u8])>,
) -> Result<Vec<u8>, ArchiveError> {
    let options = SimpleFileOptions::default()
        .compression_method(CompressionMethod::Deflated)
        .last_modified_time(DateTime::default())
        .unix_permissions(0o644);
    let mut zip = ZipWriter::new(Cursor::new(Vec::new()));
    for (path, bytes) in entries {
        zip.start_file(path, options)?;
        zip.write_all(bytes).map_err(ZipError::Io)?;
    }
    Ok(zip.finish()?.into_inner())
}

impl From<ZipError> for ArchiveError {
    fn from(error: ZipError) -> ArchiveError {
        ArchiveError::Zip(error)
    }
}

impl fmt::Display for ArchiveError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            ArchiveError::Zip(error) => write!(f, "not a readable zip file: {error}"),
            ArchiveError::NoDescription => write!(f, "not an FMU: no {DESCRIPTION}"),
        }
    }
}

impl std::error::Error for ArchiveError {}

#[cfg(test)]
mod tests {
    use super::*;

    fn sample() -> Archive {
        let mut archive = Archive::new("<fmiModelDescription/>".to_string());
        let mut add = |path: &str, bytes: &[u8]| archive.files.insert(path.into(), bytes.into());
        add("documentation/index.html", b"<html/>");
        add("binaries/linux64/m.so", &[7; 5000]);
        archive
    }

    #[test]
    fn the_description_comes_first_and_the_rest_is_sorted() {
        let bytes = sample().to_bytes().unwrap();
        let mut zip = ZipArchive::new(Cursor::new(bytes)).unwrap();
        let names: Vec<String> = (0..zip.len())
            .map(|index| zip.by_index(index).unwrap().name().unwrap().to_string())
            .collect();
        let expected = [
            "modelDescription.xml",
            "binaries/linux64/m.so",
            "documentation/index.html",
        ];
        assert_eq!(names, expected);
    }

    #[test]
    fn the_same_files_give_the_same_bytes_and_come_back() {
        let bytes = sample().to_bytes().unwrap();
        assert_eq!(bytes, sample().to_bytes().unwrap());
        assert_eq!(Archive::from_bytes(&bytes).unwrap(), sample());
    }

    #[test]
    fn entries_carry_no_date_but_the_first_one_a_zip_file_can_hold() {
        let bytes = sample().to_bytes().unwrap();
        let mut zip = ZipArchive::new(Cursor::new(bytes)).unwrap();
        for index in 0..zip.len() {
            let date = zip.by_index(index).unwrap().last_modified();
            assert_eq!(date, Some(DateTime::default()));
        }
    }

    #[test]
    fn what_is_not_an_fmu_is_refused() {
        let text = Archive::from_bytes(b"text").unwrap_err();
        assert!(text.to_string().starts_with("not a readable zip file"));
        let mut zip = ZipWriter::new(Cursor::new(Vec::new()));
        zip.start_file("a.txt", SimpleFileOptions::default())
            .unwrap();
        let empty = Archive::from_bytes(&zip.finish().unwrap().into_inner()).unwrap_err();
        assert_eq!(empty.to_string(), "not an FMU: no modelDescription.xml");
    }
}
