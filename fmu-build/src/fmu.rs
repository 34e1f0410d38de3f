//! The parts of an FMU and where they stand in it (FMI 2.0.4, section 2.3).

use crate::archive::Archive;
use crate::binary::Binary;

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

impl Fmu {
    /// The files of the FMU.
    pub fn into_archive(self) -> Archive {
        let mut archive = Archive::new(self.model_description);
        for binary in self.binaries {
            let (folder, extension) = (
                binary.platform.folder(),
                binary.platform.library_extension(),
            );
            let path = format!("binaries/{folder}/{}.{extension}", self.model_identifier);
            archive.files.insert(path, binary.bytes);
        }
        archive.files.extend(self.documents);
        archive
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Platform;

    #[test]
    fn libraries_stand_where_the_standard_wants_them() {
        let binary = |platform| Binary {
            platform,
            bytes: vec![7; 50],
        };
        let fmu = Fmu {
            model_identifier: "m".to_string(),
            model_description: "<fmiModelDescription/>".to_string(),
            binaries: Platform::ALL.map(binary).to_vec(),
            documents: vec![("documentation/index.html".to_string(), b"<html/>".to_vec())],
        };
        let paths: Vec<String> = fmu.into_archive().files.into_keys().collect();
        let expected = [
            "binaries/aarch64-linux/m.so",
            "binaries/darwin64/m.dylib",
            "binaries/linux64/m.so",
            "binaries/win64/m.dll",
            "documentation/index.html",
        ];
        assert_eq!(paths, expected);
    }
}
