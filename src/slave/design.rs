//! The model as it was packed, and as it becomes with other parameters.

use super::Error;
use crate::config::{Config, Problem};
use crate::interface::{Interface, Parameter, Place, Quantity, Variable};
use crate::model::{Inputs, ModalModel};
use crate::rotor::ModeCounts;
use crate::train::{SpeedRatio, speed_ratios, validate};

/// What never changes: the model as it was packed.
#[derive(Debug, Clone)]
pub(super) struct Design {
    pub(super) config: Config,
    pub(super) interface: Interface,
    /// Where the values of the variables stand ready.
    places: Vec<Place>,
    pub(super) guid: String,
    /// Kept when parameters change, because the variables of the modes are fixed.
    pub(super) mode_counts: Vec<ModeCounts>,
    pub(super) ratios: Vec<SpeedRatio>,
    pub(super) torques: Vec<f64>,
    pub(super) model: ModalModel,
}

impl Design {
    pub(super) fn of(config: Config) -> Result<Design, Error> {
        let (train, _) = validate(&config).map_err(|problems| joined(&problems))?;
        let model =
            ModalModel::assemble(&train, None).map_err(|error| Error::new(error.to_string()))?;
        let interface = Interface::of(&config, &train, &model);
        let torques = train.rotors.iter().flat_map(|rotor| &rotor.torques);
        let torques: Vec<f64> = torques.map(|torque| torque.value).collect();
        let inputs = model.inputs_at_rest(&torques);
        let variables = interface.variables.iter();
        let places = variables.map(|variable| variable.quantity.place(&inputs));
        Ok(Design {
            guid: interface.fingerprint(&config),
            places: places.collect(),
            mode_counts: model.counts(),
            ratios: speed_ratios(&train),
            torques,
            interface,
            config,
            model,
        })
    }

    #[inline]
    pub(super) fn variable(&self, reference: u32) -> Result<&Variable, Error> {
        let index = usize::try_from(reference).unwrap_or(usize::MAX);
        let variables = self.interface.variables.as_slice();
        variables.get(index).ok_or_else(|| unknown(reference))
    }

    /// Where the value of a variable stands ready; nowhere for unknown ones, too.
    #[inline]
    pub(super) fn place(&self, reference: u32) -> Place {
        let index = usize::try_from(reference).unwrap_or(usize::MAX);
        self.places.get(index).copied().unwrap_or(Place::Nowhere)
    }

    /// These torques, and nothing else from outside.
    pub(super) fn inputs(&self, torques: &[f64]) -> Inputs {
        self.model.inputs_at_rest(torques)
    }

    /// All parameters in the order of the table.
    pub(super) fn parameters(&self) -> impl Iterator<Item = Parameter> {
        let variables = self.interface.variables.iter();
        variables.filter_map(|variable| match variable.quantity {
            Quantity::Parameter(parameter) => Some(parameter),
            _ => None,
        })
    }

    /// Writes a parameter into a configuration of this model; the speeds of meshed rotors follow their leader's. At the
    /// packed value they are the packed ones to the bit, however they were rounded in the file.
    pub(super) fn write(&self, config: &mut Config, parameter: Parameter, value: f64) {
        *parameter.slot(config) = value;
        let packed = &self.config.rotors;
        for (index, (rotor, ratio)) in config.rotors.iter_mut().zip(&self.ratios).enumerate() {
            let leading = Parameter::MeanSpeed {
                rotor: ratio.leader,
            };
            if parameter == leading {
                rotor.speed = if value == packed[ratio.leader].speed {
                    packed[index].speed
                } else {
                    value * ratio.ratio
                };
            }
        }
    }

    /// The model under these parameters; the packed one when nothing that it depends on was changed.
    pub(super) fn assemble(&self, config: &Config) -> Result<ModalModel, Error> {
        let (train, _) = validate(config).map_err(|problems| joined(&problems))?;
        let mut comparable = config.clone();
        comparable.simulation.clone_from(&self.config.simulation);
        comparable.simulation.known_bearings = config.simulation.known_bearings;
        if comparable == self.config {
            return Ok(self.model.clone());
        }
        ModalModel::assemble(&train, Some(&self.mode_counts))
            .map_err(|error| Error::new(error.to_string()))
    }
}

#[cold]
fn unknown(reference: u32) -> Error {
    Error::new(format!(
        "value reference {reference} is unknown to this FMU"
    ))
}

fn joined(problems: &[Problem]) -> Error {
    let sentences: Vec<String> = problems.iter().map(ToString::to_string).collect();
    Error::new(format!("the model is not valid: {}", sentences.join("; ")))
}
