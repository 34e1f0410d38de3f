//! Derivatives: of the outputs along the inputs and along time, and of the inputs along time.

use super::{Error, LifeCycle, Slave};
use crate::interface::{
    Causality, INPUT_DERIVATIVE_ORDER, OUTPUT_DERIVATIVE_ORDER, Place, Quantity, Variable,
};
use crate::model::{Change, Inputs};

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
        let knowns = self.inputs_among(knowns)?;
        let mut direction = self.no_inputs();
        for (known, &seed) in knowns.iter().zip(seed) {
            if !seed.is_finite() {
                return Err(Error::new(format!("the seed must be finite, found {seed}")));
            }
            direction.values_mut()[*known] += seed;
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
        check_orders(orders, OUTPUT_DERIVATIVE_ORDER, "an output")?;
        let (known, held) = (self.rate.clone(), self.no_inputs());
        let simulation = self.started()?;
        let acceleration = simulation.acceleration();
        let motion = simulation.motion();
        let rate = known.unwrap_or_else(|| {
            let mut rate = held;
            motion.add_known_force_rates(-1.0, &mut rate);
            rate
        });
        let change = Change {
            motion,
            position: motion.state.velocity(),
            velocity: &acceleration,
            inputs: &rate,
            time: 1.0,
        };
        for (output, result) in outputs.iter().zip(result) {
            *result = output.change(&change);
        }
        Ok(())
    }

    /// fmi2SetRealInputDerivatives: how inputs change per second in the next step, from the values they have at its start. All
    /// or nothing.
    pub fn set_input_derivatives(
        &mut self,
        references: &[u32],
        orders: &[i32],
        values: &[f64],
    ) -> Result<(), Error> {
        let inputs = self.inputs_among(references)?;
        check_orders(orders, INPUT_DERIVATIVE_ORDER, "an input")?;
        if let Some(value) = values.iter().find(|value| !value.is_finite()) {
            return Err(Error::new(format!(
                "the derivative of an input must be a finite number, found {value}"
            )));
        }
        let mut rate = self.rate.take().unwrap_or_else(|| self.no_inputs());
        for (input, &value) in inputs.into_iter().zip(values) {
            rate.values_mut()[input] = value;
        }
        self.rate = Some(rate);
        Ok(())
    }

    /// Where inputs are in their list.
    fn inputs_among(&self, references: &[u32]) -> Result<Vec<usize>, Error> {
        self.quantities(references, |variable| match variable.causality() {
            Causality::Input => None,
            _ => Some("is no input"),
        })?;
        let places = references.iter().map(|one| self.design.place(*one));
        let inputs = places.filter_map(|place| match place {
            Place::Input(place) => Some(place as usize),
            _ => None,
        });
        Ok(inputs.collect())
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
        self.design.inputs(&vec![0.0; self.design.torques.len()])
    }
}

/// Refuses orders of derivatives other than the one there is.
fn check_orders(orders: &[i32], only: i32, of: &str) -> Result<(), Error> {
    match orders.iter().find(|&&order| order != only) {
        None => Ok(()),
        Some(order) => Err(Error::new(format!(
            "the order of the derivative of {of} must be {only}, found {order}"
        ))),
    }
}
