//! Everything that influences a later call, saved: what fmi2GetFMUstate hands out.
//!
//! ```text
//!   parameters · inputs and their derivatives · experiment · life cycle · solution        (nothing of the model itself)
//!   serialized: magic | version | guid of the model | length | SHA-256 | postcard bytes
//! ```
//!
//! Continuing from a saved state gives the same bits, also in another instance or another process of the same build.

use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};

use super::continuation::Continuation;
use super::{Error, Experiment, LifeCycle, Slave, settings};
use crate::config::Config;
use crate::model::Inputs;
use crate::simulation::{Simulation, Snapshot};

/// A saved state.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SavedState {
    /// Fingerprint of the model it belongs to.
    pub(super) guid: String,
    /// All parameters in the order of the table.
    pub(super) parameters: Vec<f64>,
    pub(super) tolerance_set: bool,
    pub(super) inputs: Inputs,
    pub(super) rate: Option<Inputs>,
    pub(super) continuation: Continuation,
    pub(super) experiment: Option<Experiment>,
    pub(super) life_cycle: LifeCycle,
    /// The solution, once it runs.
    pub(super) solution: Option<Snapshot>,
}

const MAGIC: &[u8; 16] = b"geartrain state\0";
/// Changes whenever the content of a saved state does.
const VERSION: u32 = 8;
/// Magic, version, length, checksum.
const HEADER: usize = 16 + 4 + 8 + 32;

impl SavedState {
    /// The serialized form.
    pub fn to_bytes(&self) -> Vec<u8> {
        let content = postcard::to_allocvec(self).expect("plain data in memory always serializes");
        let mut bytes = Vec::with_capacity(HEADER + content.len());
        bytes.extend_from_slice(MAGIC);
        bytes.extend_from_slice(&VERSION.to_le_bytes());
        bytes.extend_from_slice(&(content.len() as u64).to_le_bytes());
        bytes.extend_from_slice(&Sha256::digest(&content));
        bytes.extend_from_slice(&content);
        bytes
    }

    /// Reads the serialized form. Whether it fits a model, only the slave can say.
    pub fn from_bytes(bytes: &[u8]) -> Result<SavedState, Error> {
        let refused =
            |why: &str| Error::new(format!("these bytes are no state of this FMU: {why}"));
        let Some((header, content)) = bytes.split_at_checked(HEADER) else {
            return Err(refused("they are too few"));
        };
        let (magic, rest) = header.split_at(MAGIC.len());
        let (version, rest) = rest.split_at(4);
        let (length, checksum) = rest.split_at(8);
        if magic != MAGIC {
            return Err(refused("they were not made by fmi2SerializeFMUstate"));
        }
        if version != VERSION.to_le_bytes() {
            return Err(refused("another version of geartrain made them"));
        }
        if length != (content.len() as u64).to_le_bytes() {
            return Err(refused("their number is not the one they were made with"));
        }
        if checksum != Sha256::digest(content).as_slice() {
            return Err(refused("they have been changed"));
        }
        match postcard::take_from_bytes(content) {
            Ok((state, [])) => Ok(state),
            _ => Err(refused("their content cannot be read")),
        }
    }
}

impl Slave {
    /// fmi2GetFMUstate: everything that influences a later call.
    pub fn save(&mut self) -> SavedState {
        let parameters = self
            .design
            .parameters()
            .map(|one| *one.slot(&mut self.config))
            .collect();
        // Before step mode the solution follows from parameters and inputs.
        let runs = self.life_cycle > LifeCycle::Initialization;
        SavedState {
            guid: self.design.guid.clone(),
            parameters,
            tolerance_set: self.tolerance_set,
            inputs: self.inputs.clone(),
            rate: self.rate.clone(),
            continuation: self.continuation.clone(),
            experiment: self.experiment,
            life_cycle: self.life_cycle,
            solution: self
                .simulation
                .as_ref()
                .filter(|_| runs)
                .map(Simulation::snapshot),
        }
    }

    /// fmi2SetFMUstate: as it was when the state was saved. A state that does not fit changes nothing.
    pub fn restore(&mut self, saved: &SavedState) -> Result<(), Error> {
        self.check_fits(saved)?;
        let mut config = self.design.config.clone();
        for (parameter, &value) in self.design.parameters().zip(&saved.parameters) {
            self.design.write(&mut config, parameter, value);
        }
        match &saved.solution {
            None => self.simulation = None,
            Some(solution) => self.resume(&config, saved, solution)?,
        }
        self.config = config;
        self.inputs.clone_from(&saved.inputs);
        self.rate.clone_from(&saved.rate);
        self.continuation.clone_from(&saved.continuation);
        self.life_cycle = saved.life_cycle;
        self.experiment = saved.experiment;
        self.tolerance_set = saved.tolerance_set;
        Ok(())
    }

    /// Whether a state, which may come from outside, is one of this model.
    pub fn check_fits(&self, saved: &SavedState) -> Result<(), Error> {
        let mut inputs = [&saved.inputs].into_iter().chain(&saved.rate);
        let fits = saved.guid == self.design.guid
            && saved.parameters.len() == self.design.parameters().count()
            && saved.parameters.iter().all(|value| value.is_finite())
            && saved.continuation.fits(&self.inputs)
            && inputs.all(|inputs| inputs.is_like(&self.inputs) && inputs.is_finite());
        if fits { Ok(()) } else { Err(misfit()) }
    }

    /// Puts a saved solution into the simulation: the present one where its parameters are the same.
    fn resume(
        &mut self,
        config: &Config,
        saved: &SavedState,
        solution: &Snapshot,
    ) -> Result<(), Error> {
        let same = *config == self.config
            && saved.experiment == self.experiment
            && saved.tolerance_set == self.tolerance_set;
        if let Some(simulation) = self.simulation.as_mut().filter(|_| same) {
            return if simulation.restore(solution) {
                Ok(())
            } else {
                Err(misfit())
            };
        }
        let settings = settings(config, saved.experiment, saved.tolerance_set);
        let model = self.design.assemble(config)?;
        let mut simulation = Simulation::at_rest(model, saved.inputs.clone(), &settings);
        if !simulation.restore(solution) {
            return Err(misfit());
        }
        self.simulation = Some(simulation);
        Ok(())
    }
}

fn misfit() -> Error {
    Error::new("the state belongs to another model or another build of it")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::BaseMotion;

    fn sample() -> SavedState {
        let inputs = Inputs::new(&[3.0], &[BaseMotion::default(); 2], &[[0.5, -1.0]]);
        SavedState {
            guid: "{a}".to_string(),
            parameters: vec![1.0, -2.5],
            tolerance_set: true,
            continuation: Continuation::new(&inputs),
            inputs,
            rate: None,
            experiment: None,
            life_cycle: LifeCycle::Instantiated,
            solution: None,
        }
    }

    #[test]
    fn a_state_survives_its_serialized_form() {
        assert_eq!(SavedState::from_bytes(&sample().to_bytes()), Ok(sample()));
    }

    #[test]
    fn every_truncation_and_every_changed_byte_is_refused() {
        let bytes = sample().to_bytes();
        for length in 0..bytes.len() {
            assert!(SavedState::from_bytes(&bytes[..length]).is_err());
        }
        for index in 0..bytes.len() {
            let mut changed = bytes.clone();
            changed[index] ^= 0x10;
            assert!(SavedState::from_bytes(&changed).is_err(), "byte {index}");
        }
        let longer = [bytes.as_slice(), &[0]].concat();
        assert!(SavedState::from_bytes(&longer).is_err());
    }
}
