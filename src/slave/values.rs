//! Values in and out: what references stand for, and which of them may be set when.

use super::{Error, LifeCycle, Slave};
use crate::config::Config;
use crate::interface::{Causality, Parameter, Place, Quantity};
use crate::simulation::Simulation;

impl Slave {
    /// fmi2GetReal: overwrites `values`, one per reference. Parameters and inputs are readable from the
    /// start, everything else from initialization on.
    pub fn get_real(&mut self, references: &[u32], values: &mut [f64]) -> Result<(), Error> {
        if self.simulation.is_none() || self.life_cycle == LifeCycle::Instantiated {
            self.check_readable(references)?;
        }
        let running = self.simulation.as_ref();
        let (mut bearing_forces, mut motion) = (None, None); // looked at when first asked for
        for (&reference, value) in references.iter().zip(values) {
            *value = match (self.design.place(reference), running) {
                (Place::Input(place), _) => self.inputs.values()[place as usize],
                (Place::BearingForce(place), Some(running)) => {
                    let forces = || running.bearing_forces().as_flattened();
                    bearing_forces.get_or_insert_with(forces)[place as usize]
                }
                _ => {
                    let quantity = self.design.variable(reference)?.quantity;
                    match (given(quantity, &mut self.config), running) {
                        (Some(given), _) => given,
                        (None, Some(running)) => {
                            quantity.evaluate(motion.get_or_insert_with(|| running.motion()))
                        }
                        (None, None) => f64::NAN,
                    }
                }
            };
        }
        Ok(())
    }

    /// Refuses unknown references, and those of what is not there yet; starts the simulation where they ask for it.
    fn check_readable(&mut self, references: &[u32]) -> Result<(), Error> {
        let mut computed = false;
        for &reference in references {
            let variable = self.design.variable(reference)?;
            let given = variable.quantity.is_given();
            if !given && self.life_cycle == LifeCycle::Instantiated {
                return Err(Error::new(format!(
                    "{} can be read from initialization mode on",
                    variable.name
                )));
            }
            computed |= !given;
        }
        if computed {
            self.started()?;
        }
        Ok(())
    }

    /// fmi2SetReal: all or nothing.
    pub fn set_real(&mut self, references: &[u32], values: &[f64]) -> Result<(), Error> {
        self.inputs_before.overwrite(&self.inputs);
        if !self.put_inputs(references, values) {
            self.inputs.overwrite(&self.inputs_before);
            self.put_checked(references, values)?;
        }
        if self.life_cycle != LifeCycle::Stepping && !references.is_empty() {
            self.simulation = None; // the equilibrium depends on parameters and inputs
        }
        if let Some(running) = self.simulation.as_mut().map(Simulation::inputs_mut) {
            running.overwrite(&self.inputs); // also those that the last step continued there
        }
        Ok(())
    }

    /// Puts values where all of them are numbers for inputs, as in every step; otherwise gives `false` when some may be put.
    fn put_inputs(&mut self, references: &[u32], values: &[f64]) -> bool {
        let inputs = self.inputs.values_mut();
        let mut pairs = references.iter().zip(values);
        pairs.all(|(&reference, &value)| match self.design.place(reference) {
            Place::Input(place) if value.is_finite() => {
                inputs[place as usize] = value;
                true
            }
            _ => false,
        })
    }

    /// Puts values of inputs and parameters, or none of them and says what is wrong.
    fn put_checked(&mut self, references: &[u32], values: &[f64]) -> Result<(), Error> {
        for (&reference, &value) in references.iter().zip(values) {
            self.check_settable(reference, value)?;
        }
        for (&reference, &value) in references.iter().zip(values) {
            match self.design.place(reference) {
                Place::Input(place) => self.inputs.values_mut()[place as usize] = value,
                _ => self.set_parameter(reference, value)?,
            }
        }
        Ok(())
    }

    /// Refuses references of a base type that has no variables here.
    pub fn no_variables_of_type(&self, base_type: &str, references: &[u32]) -> Result<(), Error> {
        match references.first() {
            None => Ok(()),
            Some(reference) => Err(Error::new(format!(
                "value reference {reference} is unknown: this FMU has no {base_type} variables"
            ))),
        }
    }

    fn check_settable(&self, reference: u32, value: f64) -> Result<(), Error> {
        let variable = self.design.variable(reference)?;
        let name = &variable.name;
        match variable.causality() {
            Causality::Input => {}
            Causality::Parameter if self.life_cycle != LifeCycle::Stepping => {}
            Causality::Parameter => {
                return Err(Error::new(format!(
                    "parameter {name} can only be set until initialization ends"
                )));
            }
            _ => {
                return Err(Error::new(format!(
                    "{name} is neither an input nor a parameter and cannot be set"
                )));
            }
        }
        if !value.is_finite() {
            return Err(Error::new(format!(
                "{name} must be a finite number, found {value}"
            )));
        }
        Ok(())
    }

    fn set_parameter(&mut self, reference: u32, value: f64) -> Result<(), Error> {
        if let Quantity::Parameter(parameter) = self.design.variable(reference)?.quantity {
            self.design.write(&mut self.config, parameter, value);
            self.tolerance_set |= parameter == Parameter::Tolerance;
        }
        Ok(())
    }
}

/// What is a parameter or follows from some alone; `None` for inputs and what is computed.
fn given(quantity: Quantity, config: &mut Config) -> Option<f64> {
    match quantity {
        Quantity::Parameter(parameter) => Some(*parameter.slot(config)),
        Quantity::DerivedSpeed { rotor, .. } => Some(config.rotors[rotor].speed),
        _ => None,
    }
}
