//! From the text of a model file and a compiled library to the parts of an FMU.
//!
//! The roof of the house: everything below is used once, in order. Writing the zip file is the business of
//! the crate `fmu-build`.

use core::fmt;

use crate::config::{Files, Problem};
use crate::description::{documentation_page, model_description};
use crate::fmi2::payload::{ImplantError, implant};
use crate::interface::Interface;
use crate::model::{ModalModel, equilibrium};
use crate::rotor::ReductionError;
use crate::train::{GearTrain, Loaded, load_beside};

/// The parts of an FMU that depend on the model.
#[derive(Debug, Clone)]
pub struct Package {
    /// FMI modelIdentifier.
    pub model_identifier: String,
    /// modelDescription.xml.
    pub model_description: String,
    /// `documentation/index.html`.
    pub documentation: String,
    /// What is allowed but probably not meant.
    pub warnings: Vec<Problem>,
    /// The files that the model file names, by their paths from it.
    pub named_files: Vec<String>,
    /// The model in the form that the library carries.
    model: Vec<u8>,
}

/// Why a model file cannot be packed.
#[derive(Debug)]
pub enum PackageError {
    /// The file breaks rules; all of them.
    Invalid(Vec<Problem>),
    /// A rotor cannot be reduced to modes.
    Irreducible(ReductionError),
}

impl Package {
    /// Reads, validates and describes a model; `files` gives the texts of files that it names.
    pub fn of(text: &str, files: Files<'_>) -> Result<Package, PackageError> {
        let Loaded {
            config,
            train,
            mut warnings,
            lines,
        } = load_beside(text, files).map_err(PackageError::Invalid)?;
        let model = ModalModel::assemble(&train, None).map_err(PackageError::Irreducible)?;
        let interface = Interface::of(&config, &train, &model);
        let doubtful = contradicting_flanks(&train, &model).into_iter();
        warnings.extend(doubtful.map(|warning| Problem {
            spot: lines.find(None, &warning.key),
            ..warning
        }));
        let housing = config.housing.iter();
        let named = housing.flat_map(|housing| housing.file.iter().chain(&housing.modes_file));
        Ok(Package {
            named_files: named.cloned().collect(),
            model_description: model_description(&config, &train, &model, &interface),
            documentation: documentation_page(&config, &train, &model, &interface),
            warnings,
            model: config.to_bytes(),
            model_identifier: config.name,
        })
    }

    /// The library with the model in it.
    pub fn implant(&self, mut library: Vec<u8>) -> Result<Vec<u8>, ImplantError> {
        implant(&mut library, &self.model)?;
        Ok(library)
    }
}

/// Meshes that the torques pull apart, and trains that cannot start in equilibrium.
fn contradicting_flanks(train: &GearTrain, model: &ModalModel) -> Vec<Problem> {
    let torques = train.rotors.iter().flat_map(|rotor| &rotor.torques);
    let torques: Vec<f64> = torques.map(|torque| torque.value).collect();
    let inputs = model.inputs_at_rest(&torques);
    let problem = |key: String, place: String, message: String| Problem {
        file: None,
        spot: None,
        key,
        place,
        message,
    };
    let forces = match equilibrium(model, &inputs) {
        Ok(equilibrium) => equilibrium.mesh_forces,
        Err(error) => {
            let place = "simulation".to_string();
            return vec![problem(
                "simulation.start".to_string(),
                place,
                format!("start: {error}"),
            )];
        }
    };
    let mut warnings = Vec::new();
    for (index, (mesh, force)) in train.meshes.iter().zip(forces).enumerate() {
        // A flank that can part simply leaves the load to the other one.
        if force < 0.0 && mesh.backlash.is_none() {
            let message = format!(
                "flank: the torques give a static mesh force of {force:.3} N, which pulls this flank apart; \
                 with bilateral contact the mesh works as if glued, the other flank is probably meant"
            );
            let key = format!("mesh[{}].flank", index + 1);
            warnings.push(problem(key, format!("mesh \"{}\"", mesh.name), message));
        }
    }
    warnings
}

impl fmt::Display for PackageError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            PackageError::Invalid(problems) => {
                let lines: Vec<String> = problems.iter().map(ToString::to_string).collect();
                f.write_str(&lines.join("\n"))
            }
            PackageError::Irreducible(error) => error.fmt(f),
        }
    }
}
