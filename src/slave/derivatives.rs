//! Derivatives of the outputs: along the inputs, and along time.

use super::{Error, LifeCycle, Slave};
use crate::interface::{Causality, OUTPUT_DERIVATIVE_ORDER, Quantity, Variable};
use crate::model::{BaseMotion, Change, Inputs};

impl Slave {
    /// fmi2GetDirectionalDerivative: overwrites `result`, one number per unknown. In initialization mode the static
    /// solution follows the inputs; later the state is fixed, and only what feeds through directly changes.
    pub fn directional_derivative(
        &mut self,
        unknowns: &[u32],
        (knowns, seed): (&[u32], &[f64]),
        result: &mut [f64],
    ) -> Result<(), Error> {
        let unknowns = self.quantities(unknowns, |variable| match variable.causality() {
            Causality::Output | Causality::Local => None,
            _ => Some("is no output"),
        })?;
        let knowns = self.quantities(knowns, |variable| match variable.causality() {
            Causality::Input => None,
            _ => Some("is no input"),
        })?;
        let mut direction = self.no_inputs();
        for (known, &seed) in knowns.iter().zip(seed) {
            if !seed.is_finite() {
                return Err(Error::new(format!("the seed must be finite, found {seed}")));
            }
            if let Some(input) = known.input(&mut direction) {
                *input += seed;
            }
        }
        let starting = self.life_cycle == LifeCycle::Initialization;
        let start = self.config.simulation.start;
        let simulation = self.started()?;
        let still = vec![0.0; simulation.model().system.size];
        let position = if starting {
            let change = simulation.start_change(start, &direction);
            change.map_err(|error| Error::new(format!("the simulation cannot start: {error}")))?
        } else {
            still.clone()
        };
        let change = Change {
            motion: simulation.motion(),
            position: &position,
            velocity: &still,
            inputs: &direction,
            time: 0.0,
        };
        for (unknown, result) in unknowns.iter().zip(result) {
            *result = unknown.change(&change);
        }
        Ok(())
    }

    /// fmi2GetRealOutputDerivatives: overwrites `result`, one number per reference, with the time derivatives at the
    /// present communication point.
    pub fn output_derivatives(
        &mut self,
        references: &[u32],
        orders: &[i32],
        result: &mut [f64],
    ) -> Result<(), Error> {
        let outputs = self.quantities(references, |variable| match variable.causality() {
            Causality::Output | Causality::Local => None,
            _ => Some("is no output"),
        })?;
        if let Some(order) = orders
            .iter()
            .find(|&&order| order != OUTPUT_DERIVATIVE_ORDER)
        {
            return Err(Error::new(format!(
                "the order of an output derivative must be {OUTPUT_DERIVATIVE_ORDER}, found {order}"
            )));
        }
        let still = self.no_inputs();
        let simulation = self.started()?;
        let acceleration = simulation.acceleration();
        let motion = simulation.motion();
        let change = Change {
            motion,
            position: &motion.state.velocity,
            velocity: &acceleration,
            inputs: &still,
            time: 1.0,
        };
        for (output, result) in outputs.iter().zip(result) {
            *result = output.change(&change);
        }
        Ok(())
    }

    /// What variables stand for; `refuse` says what is wrong with one.
    fn quantities(
        &self,
        references: &[u32],
        refuse: impl Fn(&Variable) -> Option<&'static str>,
    ) -> Result<Vec<Quantity>, Error> {
        let quantity = |&reference: &u32| {
            let variable = self.design.variable(reference)?;
            match refuse(variable) {
                None => Ok(variable.quantity),
                Some(why) => Err(Error::new(format!("{} {why}", variable.name))),
            }
        };
        references.iter().map(quantity).collect()
    }

    fn no_inputs(&self) -> Inputs {
        Inputs {
            torques: vec![0.0; self.design.torques.len()],
            bases: vec![BaseMotion::default(); self.design.bearings],
        }
    }
}
