//! A packed FMU with binaries for every platform.

use std::path::PathBuf;

use fmu_build::{Archive, Platform};

use crate::named;

/// A packed FMU.
#[derive(Debug)]
pub struct Packed {
    /// modelIdentifier and stem of the file.
    pub name: String,
    archive: Archive,
}

impl Packed {
    /// The FMU `<name>.fmu` of the folder that `GEARTRAIN_PLATFORMS` names.
    pub fn read(name: &str) -> Packed {
        let path = path(name);
        let bytes = std::fs::read(&path);
        let bytes = bytes.unwrap_or_else(|error| panic!("{}: {error}", path.display()));
        let archive = Archive::from_bytes(&bytes);
        let archive = archive.unwrap_or_else(|error| panic!("{}: {error}", path.display()));
        Packed {
            name: name.to_string(),
            archive,
        }
    }

    /// All FMUs of the folder.
    pub fn all() -> Vec<Packed> {
        let entries = std::fs::read_dir(named("GEARTRAIN_PLATFORMS")).expect("the folder");
        let paths = entries.map(|entry| entry.expect("an entry").path());
        let fmus = paths.filter(|path| path.extension().is_some_and(|ending| ending == "fmu"));
        let mut names: Vec<String> = fmus
            .filter_map(|path| Some(path.file_stem()?.to_string_lossy().into_owned()))
            .collect();
        names.sort();
        names.iter().map(|name| Packed::read(name)).collect()
    }

    /// The file.
    pub fn path(&self) -> PathBuf {
        path(&self.name)
    }

    /// The library for a platform.
    pub fn library(&self, platform: Platform) -> &[u8] {
        let (folder, extension) = (platform.folder(), platform.library_extension());
        let path = format!("binaries/{folder}/{}.{extension}", self.name);
        let library = self.archive.files.get(&path);
        library.unwrap_or_else(|| panic!("{} has no {path}", self.name))
    }

    /// The guid.
    pub fn guid(&self) -> String {
        attribute(&self.archive.model_description, "guid").expect("a guid")
    }

    /// Value references of inputs that may move by micrometres or forces as small: all but torques.
    pub fn moving_inputs(&self) -> Vec<String> {
        self.references(|variable| {
            variable.contains("causality=\"input\"") && !variable.contains(".torque\"")
        })
    }

    /// Value references of all variables.
    pub fn variables(&self) -> Vec<String> {
        self.references(|_| true)
    }

    fn references(&self, wanted: impl Fn(&str) -> bool) -> Vec<String> {
        let lines = self.archive.model_description.lines();
        let variables = lines.filter(|line| line.contains("<ScalarVariable ") && wanted(line));
        variables
            .filter_map(|line| attribute(line, "valueReference"))
            .collect()
    }
}

fn path(name: &str) -> PathBuf {
    named("GEARTRAIN_PLATFORMS").join(format!("{name}.fmu"))
}

/// The value of the first attribute of this name.
fn attribute(text: &str, name: &str) -> Option<String> {
    let (_, rest) = text.split_once(&format!(" {name}=\""))?;
    let (value, _) = rest.split_once('"')?;
    Some(value.to_string())
}
