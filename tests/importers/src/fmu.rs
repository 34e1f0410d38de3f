//! A packed FMU, unpacked by the crate `fmi`.

use std::path::{Path, PathBuf};

use fmi::fmi2::import::Fmi2Import;
use fmi::schema::fmi2::{Causality, CoSimulation, Fmi2ModelDescription, ScalarVariable};
use fmi::traits::FmiImport;

/// An unpacked FMU; its folder is deleted when it is dropped.
#[derive(Debug)]
pub struct Fmu {
    import: Fmi2Import,
}

impl Fmu {
    /// Unpacks `<name>.fmu` of the folder that `GEARTRAIN_FMUS` names.
    pub fn unpack(name: &str) -> Fmu {
        let path = fmu_path(name);
        let import = fmi::import::from_path(&path);
        let import = import.unwrap_or_else(|error| panic!("{}: {error}", path.display()));
        Fmu { import }
    }

    /// The FMU as the crate `fmi` sees it.
    pub fn import(&self) -> &Fmi2Import {
        &self.import
    }

    /// modelDescription.xml.
    pub fn description(&self) -> &Fmi2ModelDescription {
        self.import.model_description()
    }

    /// The element CoSimulation of modelDescription.xml.
    pub fn co_simulation(&self) -> &CoSimulation {
        let element = self.description().co_simulation.as_ref();
        element.expect("the FMU is for co-simulation")
    }

    /// Where the FMU was unpacked.
    pub fn folder(&self) -> &Path {
        self.import.archive_path()
    }

    /// The library in the folder.
    pub fn library(&self) -> PathBuf {
        let library = self
            .import
            .shared_lib_path(&self.co_simulation().model_identifier);
        self.folder()
            .join(library.expect("the platform has a name in FMI 2.0"))
    }

    /// Value reference of a variable.
    pub fn reference(&self, variable: &str) -> u32 {
        let found = self.description().model_variable_by_name(variable);
        found
            .unwrap_or_else(|error| panic!("{variable}: {error}"))
            .value_reference
    }

    /// Start value of a variable.
    pub fn start(&self, variable: &str) -> f64 {
        let found = self.description().model_variable_by_name(variable);
        let found = found.unwrap_or_else(|error| panic!("{variable}: {error}"));
        let fmi::schema::fmi2::ScalarVariableElement::Real(real) = &found.elem else {
            panic!("{variable} is not a Real");
        };
        real.start
            .unwrap_or_else(|| panic!("{variable} has no start value"))
    }

    /// Start value of a variable by its reference, where it has one.
    pub fn start_of(&self, reference: u32) -> Option<f64> {
        let mut variables = self.description().get_model_variables();
        let found = variables.find(|variable| variable.value_reference == reference)?;
        match &found.elem {
            fmi::schema::fmi2::ScalarVariableElement::Real(real) => real.start,
            _ => None,
        }
    }

    /// How many variables there are; value references count from 0.
    pub fn variable_count(&self) -> usize {
        self.description().get_model_variables().count()
    }

    /// Value references of all variables of a causality.
    pub fn references(&self, causality: &Causality) -> Vec<u32> {
        let of_causality = |variable: &&ScalarVariable| &variable.causality == causality;
        let variables = self
            .description()
            .get_model_variables()
            .filter(of_causality);
        variables.map(|variable| variable.value_reference).collect()
    }
}

fn fmu_path(name: &str) -> PathBuf {
    let folder = std::env::var_os("GEARTRAIN_FMUS");
    let folder =
        folder.expect("GEARTRAIN_FMUS is not set: run these tests with `cargo xtask test`");
    PathBuf::from(folder).join(format!("{name}.fmu"))
}
