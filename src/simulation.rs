//! A model that moves: state, inputs and solver together.
//!
//! [`Simulation::advance_to`] lands exactly on the time asked for; [`Simulation::motion`] shows what the
//! outside sees, evaluated with the inputs as they are now. A [`Snapshot`] is everything that influences a
//! later step. Knows no FMI.

use serde::{Deserialize, Serialize};

use crate::config::{self, SolverChoice, Start};
use crate::model::{
    Course, Excitation, Inputs, ModalModel, Motion, NoEquilibrium, equilibrium, equilibrium_change,
};
use crate::solver::{Counts, Integrator, Ramp, State, StepError};

/// A running simulation.
#[derive(Debug, Clone)]
pub struct Simulation {
    model: ModalModel,
    state: State,
    inputs: Inputs,
    /// What the inputs exert in a step.
    loads: Vec<Ramp>,
    solver: Integrator,
    tolerance: f64,
}

/// Everything that influences a later step of the same model.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Snapshot {
    state: State,
    inputs: Inputs,
}

impl Simulation {
    /// Starts at `time` as `settings` say: from the static solution under the inputs, or from rest; in free spin
    /// the rotors turn with their first speeds.
    pub fn start(
        model: ModalModel,
        inputs: Inputs,
        settings: &config::Simulation,
        time: f64,
    ) -> Result<Simulation, NoEquilibrium> {
        let position = match settings.start {
            Start::Rest => vec![0.0; model.system.size],
            Start::Equilibrium => equilibrium(&model, &inputs)?.position,
        };
        let mut simulation = Simulation::at_rest(model, inputs, settings);
        let velocity = simulation.model.rigid_velocity();
        let system = &simulation.model.system;
        simulation.state = simulation.solver.state_at(system, time, position, velocity);
        Ok(simulation)
    }

    /// At time 0 without deformation and rotation, for a solution to be put in: see [`Simulation::restore`].
    pub fn at_rest(model: ModalModel, inputs: Inputs, settings: &config::Simulation) -> Simulation {
        let solver = match settings.solver {
            SolverChoice::Exponential => Integrator::exponential(&model.system, model.harmonics()),
            SolverChoice::Newmark => Integrator::newmark(&model.system),
        };
        let zeros = || vec![0.0; model.system.size];
        let state = solver.state_at(&model.system, 0.0, zeros(), zeros());
        Simulation {
            loads: vec![Ramp::default(); model.system.loads.len()],
            state,
            inputs,
            solver,
            tolerance: settings.tolerance,
            model,
        }
    }

    /// Integrates to exactly `time` with the inputs held. After an error the simulation is as before.
    pub fn advance_to(&mut self, time: f64) -> Result<(), StepError> {
        self.advance_along(time, None)
    }

    /// Integrates to exactly `time` with the inputs changing by `rate` per second, where given, from their values now to those
    /// that they have afterwards. After an error the simulation is as before.
    pub fn advance_along(&mut self, time: f64, rate: Option<&Inputs>) -> Result<(), StepError> {
        let since = self.state.time;
        let course = Course {
            first: &self.inputs,
            rate,
            since,
        };
        course.loads_into(&self.model, &mut self.loads);
        let excitation = Excitation::new(&self.model, course, &self.loads);
        let system = &self.model.system;
        self.solver
            .advance_to(system, &excitation, &mut self.state, time, self.tolerance)?;
        if let Some(rate) = rate {
            self.inputs.add_change(rate, time - since);
        }
        Ok(())
    }

    /// The inputs that hold from now on, to be changed.
    pub fn inputs_mut(&mut self) -> &mut Inputs {
        &mut self.inputs
    }

    /// The inputs as they are now.
    pub fn inputs(&self) -> &Inputs {
        &self.inputs
    }

    /// What the outside sees now.
    pub fn motion(&self) -> Motion<'_> {
        Motion::new(&self.model, &self.state, &self.inputs)
    }

    /// q'' under the inputs as they are now.
    pub fn acceleration(&self) -> Vec<f64> {
        let system = &self.model.system;
        let course = Course {
            first: &self.inputs,
            rate: None,
            since: self.state.time,
        };
        let mut loads = vec![Ramp::default(); system.loads.len()];
        course.loads_into(&self.model, &mut loads);
        let excitation = Excitation::new(&self.model, course, &loads);
        system.acceleration(&excitation, &self.state)
    }

    /// How the static displacement a simulation starts from changes with the inputs; nothing where it starts from rest.
    pub fn start_change(
        &self,
        start: Start,
        direction: &Inputs,
    ) -> Result<Vec<f64>, NoEquilibrium> {
        match start {
            Start::Rest => Ok(vec![0.0; self.model.system.size]),
            Start::Equilibrium => {
                equilibrium_change(&self.model, &self.inputs, self.state.position(), direction)
            }
        }
    }

    /// Present time [s].
    pub fn time(&self) -> f64 {
        self.state.time
    }

    /// The assembled model.
    pub fn model(&self) -> &ModalModel {
        &self.model
    }

    /// Work done so far.
    pub fn counts(&self) -> Counts {
        self.solver.counts()
    }

    /// Saves everything that influences a later step.
    pub fn snapshot(&self) -> Snapshot {
        Snapshot {
            state: self.state.clone(),
            inputs: self.inputs.clone(),
        }
    }

    /// Continues from a snapshot of the same model, to the bit. One of another shape, or with numbers that are none,
    /// gives `false` and changes nothing.
    #[must_use]
    pub fn restore(&mut self, snapshot: &Snapshot) -> bool {
        let fits = snapshot.inputs.is_like(&self.inputs) && snapshot.inputs.is_finite();
        if !(fits && snapshot.state.is_like(&self.state)) {
            return false;
        }
        self.state.copy_from(&snapshot.state);
        self.inputs.clone_from(&snapshot.inputs);
        true
    }
}
