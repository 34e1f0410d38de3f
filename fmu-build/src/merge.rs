//! FMUs of the same model, packed on different machines, become one.

use std::fmt;

use crate::archive::Archive;

/// Why two FMUs are not the same model.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum MergeError {
    /// Their guids differ.
    Guid(String, String),
    /// Their descriptions differ first in this line.
    Description {
        /// Counted from 1.
        line: usize,
    },
    /// Both have this file, with different contents.
    File(String),
}

/// Adds what `more` has and `fmu` has not. Both must have the same guid and description, and agree on every file
/// that both have.
pub fn merge(mut fmu: Archive, more: Archive) -> Result<Archive, MergeError> {
    let (ours, theirs) = (&fmu.model_description, &more.model_description);
    let (our_guid, their_guid) = (guid(ours), guid(theirs));
    if our_guid != their_guid {
        return Err(MergeError::Guid(our_guid.into(), their_guid.into()));
    }
    if ours != theirs {
        let same = ours.lines().zip(theirs.lines()).take_while(|(a, b)| a == b);
        return Err(MergeError::Description {
            line: same.count() + 1,
        });
    }
    for (path, bytes) in more.files {
        match fmu.files.get(&path) {
            Some(ours) if *ours != bytes => return Err(MergeError::File(path)),
            Some(_) => {}
            None => {
                fmu.files.insert(path, bytes);
            }
        }
    }
    Ok(fmu)
}

/// The guid of a description; empty where it has none.
fn guid(description: &str) -> &str {
    let behind = description.split_once(" guid=\"");
    let value = behind.and_then(|(_, rest)| rest.split_once('"'));
    value.map_or("", |(guid, _)| guid)
}

impl fmt::Display for MergeError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            MergeError::Guid(ours, theirs) => write!(
                f,
                "the guids {ours} and {theirs} differ: they are not the same model, or were packed by different versions"
            ),
            MergeError::Description { line } => {
                write!(f, "modelDescription.xml differs in line {line}")
            }
            MergeError::File(path) => write!(f, "both contain {path}, and not the same"),
        }
    }
}

impl std::error::Error for MergeError {}

#[cfg(test)]
mod tests {
    use super::*;

    const DESCRIPTION: &str = "<fmiModelDescription guid=\"{1}\">\n<a/>\n</fmiModelDescription>";

    fn fmu(description: &str, files: &[(&str, &[u8])]) -> Archive {
        let mut archive = Archive::new(description.to_string());
        let files = files.iter();
        let files = files.map(|(path, bytes)| (path.to_string(), bytes.to_vec()));
        archive.files.extend(files);
        archive
    }

    #[test]
    fn binaries_of_both_stand_beside_each_other_in_either_order() {
        let page = ("documentation/index.html", &b"page"[..]);
        let linux = || fmu(DESCRIPTION, &[("binaries/linux64/m.so", b"elf"), page]);
        let windows = || fmu(DESCRIPTION, &[("binaries/win64/m.dll", b"pe"), page]);
        let merged = merge(linux(), windows()).unwrap();
        let paths: Vec<&str> = merged.files.keys().map(String::as_str).collect();
        let expected = [
            "binaries/linux64/m.so",
            "binaries/win64/m.dll",
            "documentation/index.html",
        ];
        assert_eq!(paths, expected);
        assert_eq!(merge(windows(), linux()).unwrap(), merged);
        // Once more adds nothing.
        assert_eq!(merge(merged.clone(), linux()).unwrap(), merged);
    }

    #[test]
    fn another_model_is_refused_by_its_guid() {
        let other = DESCRIPTION.replace("{1}", "{2}");
        let error = merge(fmu(DESCRIPTION, &[]), fmu(&other, &[])).unwrap_err();
        assert_eq!(error, MergeError::Guid("{1}".into(), "{2}".into()));
    }

    #[test]
    fn another_description_with_the_same_guid_is_refused_with_the_line() {
        let other = DESCRIPTION.replace("<a/>", "<b/>");
        let error = merge(fmu(DESCRIPTION, &[]), fmu(&other, &[])).unwrap_err();
        assert_eq!(error, MergeError::Description { line: 2 });
    }

    #[test]
    fn two_different_libraries_for_one_platform_are_refused() {
        let path = "binaries/linux64/m.so";
        let (a, b) = (
            fmu(DESCRIPTION, &[(path, b"1")]),
            fmu(DESCRIPTION, &[(path, b"2")]),
        );
        assert_eq!(merge(a, b), Err(MergeError::File(path.to_string())));
    }
}
