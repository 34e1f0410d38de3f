//! Values in and out: what references stand for, and which of them may be set when.

use super::{Error, LifeCycle, Slave};
use crate::interface::{Causality, Parameter, Quantity};
use crate::simulation::Simulation;

impl Slave {
    /// fmi2GetReal: overwrites `values`, one per reference. Parameters and inputs are readable from the
    /// start, everything else from initialization on.
    pub fn get_real(&mut self, references: &[u32], values: &mut [f64]) -> Result<(), Error> {
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
        let motion = self.simulation.as_ref().map(Simulation::motion);
        // Both components of a bearing's force follow from the same motion, and masters read them one after the other.
        let mut latest = (usize::MAX, [0.0; 2]);
        for (&reference, value) in references.iter().zip(values) {
            let quantity = &self.design.variable(reference)?.quantity;
            *value = match (quantity, &motion) {
                (&Quantity::BearingForce { input, axis, .. }, Some(motion)) => {
                    if latest.0 != input {
                        latest = (input, quantity.bearing_force(motion));
                    }
                    latest.1[axis]
                }
                (Quantity::Parameter(parameter), _) => *parameter.slot(&mut self.config),
                (&Quantity::DerivedSpeed { rotor, .. }, _) => self.config.rotors[rotor].speed,
                (quantity, motion) => match (self.design.input(reference), motion) {
                    (Some(place), _) => self.inputs.at(place),
                    (None, Some(motion)) => quantity.evaluate(motion),
                    (None, None) => f64::NAN,
                },
            };
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
        let mut pairs = references.iter().zip(values);
        pairs.all(|(&reference, &value)| match self.design.input(reference) {
            Some(place) if value.is_finite() => {
                self.inputs.put(place, value);
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
            match self.design.input(reference) {
                Some(place) => self.inputs.put(place, value),
                None => self.set_parameter(reference, value)?,
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
