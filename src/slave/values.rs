//! Values in and out: what references stand for, and which of them may be set when.

use super::{Error, LifeCycle, Slave};
use crate::interface::{Causality, Parameter, Quantity};
use crate::model::{Inputs, Place};
use crate::simulation::Simulation;

impl Slave {
    /// fmi2GetReal: overwrites `values`, one per reference. Parameters and inputs are readable from the
    /// start, everything else from initialization on.
    pub fn get_real(&mut self, references: &[u32], values: &mut [f64]) -> Result<(), Error> {
        for &reference in references {
            self.design.variable(reference)?;
        }
        // Both components of a bearing's force follow from the same motion, and masters read them one after the other.
        let mut latest: Option<(usize, [f64; 2])> = None;
        for (&reference, value) in references.iter().zip(values) {
            let quantity = self.design.variable(reference)?.quantity;
            *value = match (quantity, latest) {
                (Quantity::BearingForce { input, axis, .. }, Some((known, force)))
                    if input == known =>
                {
                    force[axis]
                }
                (Quantity::BearingForce { input, axis, .. }, _)
                    if self.life_cycle == LifeCycle::Stepping =>
                {
                    let force = quantity.bearing_force(&self.started()?.motion());
                    latest = Some((input, force));
                    force[axis]
                }
                _ => self.read(reference)?,
            };
        }
        Ok(())
    }

    /// fmi2SetReal: all or nothing.
    pub fn set_real(&mut self, references: &[u32], values: &[f64]) -> Result<(), Error> {
        for (&reference, &value) in references.iter().zip(values) {
            if self.design.input(reference).is_none() || !value.is_finite() {
                self.check_settable(reference, value)?;
            }
        }
        if self.life_cycle != LifeCycle::Stepping && !references.is_empty() {
            self.simulation = None; // the equilibrium depends on parameters and inputs
        }
        for (&reference, &value) in references.iter().zip(values) {
            match self.design.input(reference) {
                Some(place) => put(&mut self.inputs, place, value),
                None => self.set_parameter(reference, value)?,
            }
        }
        let Some(running) = self.simulation.as_mut().map(Simulation::inputs_mut) else {
            return Ok(());
        };
        if self.config.simulation.input_extrapolation == 0.0 {
            running.overwrite(&self.inputs);
        } else {
            // The other inputs may have been continued there.
            for (&reference, &value) in references.iter().zip(values) {
                if let Some(place) = self.design.input(reference) {
                    put(running, place, value);
                }
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

    fn read(&mut self, reference: u32) -> Result<f64, Error> {
        let place = self.design.input(reference);
        if let Some(input) = place.and_then(|place| self.inputs.at_mut(place)) {
            return Ok(*input);
        }
        let quantity = self.design.variable(reference)?.quantity;
        match quantity {
            Quantity::Parameter(parameter) => Ok(*parameter.slot(&mut self.config)),
            Quantity::DerivedSpeed { rotor, .. } => Ok(self.config.rotors[rotor].speed),
            _ if self.life_cycle == LifeCycle::Instantiated => {
                let name = &self.design.variable(reference)?.name;
                Err(Error::new(format!(
                    "{name} can be read from initialization mode on"
                )))
            }
            _ => Ok(quantity.evaluate(&self.started()?.motion())),
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

fn put(inputs: &mut Inputs, place: Place, value: f64) {
    if let Some(input) = inputs.at_mut(place) {
        *input = value;
    }
}
