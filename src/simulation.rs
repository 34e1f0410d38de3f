//! A model that moves: state, inputs and solver together.
//!
//! [`Simulation::advance_to`] lands exactly on the time asked for; [`Simulation::motion`] shows what the
//! outside sees, evaluated with the inputs as they are now. A [`Snapshot`] is everything that influences a
//! later step. Knows no FMI.

use core::cell::{OnceCell, RefCell};

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
    /// Room for [`Simulation::carried`] and how it changes per second.
    carried: Inputs,
    carried_rate: Inputs,
    /// What the inputs exert in a step.
    loads: Vec<Ramp>,
    /// The forces of all bearings, once asked for, and room for them until then.
    bearing_forces: OnceCell<Vec<[f64; 2]>>,
    room: RefCell<Vec<[f64; 2]>>,
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
        let system = simulation.model.system_in_steps();
        simulation.state = simulation.solver.state_at(system, time, position, velocity);
        Ok(simulation)
    }

    /// At time 0 without deformation and rotation, for a solution to be put in: see [`Simulation::restore`].
    pub fn at_rest(model: ModalModel, inputs: Inputs, settings: &config::Simulation) -> Simulation {
        let system = model.system_in_steps();
        let solver = match settings.solver {
            SolverChoice::Exponential => Integrator::exponential(system, model.harmonics()),
            SolverChoice::Newmark => Integrator::newmark(system),
        };
        let zeros = || vec![0.0; system.size];
        let state = solver.state_at(system, 0.0, zeros(), zeros());
        Simulation {
            loads: vec![Ramp::default(); system.loads.len()],
            bearing_forces: OnceCell::new(),
            room: RefCell::new(vec![[0.0; 2]; model.bearings().count()]),
            state,
            carried: inputs.clone(),
            carried_rate: inputs.clone(),
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
    /// that they have afterwards; forces of known bearings begin so and follow the motion. After an error the simulation is as
    /// before.
    pub fn advance_along(&mut self, time: f64, rate: Option<&Inputs>) -> Result<(), StepError> {
        let Some(known) = rate.filter(|_| self.model.knows_bearings()) else {
            return self.advance_carrying(time, rate);
        };
        let mut carried_rate = core::mem::take(&mut self.carried_rate);
        carried_rate.overwrite(known);
        self.motion().add_known_force_rates(1.0, &mut carried_rate);
        let result = self.advance_carrying(time, Some(&carried_rate));
        self.carried_rate = carried_rate;
        result
    }

    /// The inputs less what the motion now makes of the forces of known bearings: what a step holds, or takes along a rate.
    pub fn carried(&mut self) -> &Inputs {
        if !self.model.knows_bearings() {
            return &self.inputs;
        }
        let mut carried = core::mem::take(&mut self.carried);
        carried.overwrite(&self.inputs);
        self.motion().add_known_forces(1.0, &mut carried);
        self.carried = carried;
        &self.carried
    }

    /// The same as [`Simulation::advance_along`] with a rate of [`Simulation::carried`].
    pub fn advance_carrying(&mut self, time: f64, rate: Option<&Inputs>) -> Result<(), StepError> {
        self.moves();
        let since = self.state.time;
        self.carried();
        let knows_bearings = self.model.knows_bearings();
        let course = Course {
            first: if knows_bearings {
                &self.carried
            } else {
                &self.inputs
            },
            rate,
            since,
        };
        course.loads_into(&self.model, &mut self.loads);
        let excitation = Excitation::new(&self.model, course, &self.loads);
        let system = self.model.system_in_steps();
        self.solver
            .advance_to(system, &excitation, &mut self.state, time, self.tolerance)?;
        if knows_bearings {
            let mut inputs = core::mem::take(&mut self.inputs);
            inputs.overwrite(&self.carried);
            self.motion().add_known_forces(-1.0, &mut inputs);
            self.inputs = inputs;
        }
        if let Some(rate) = rate {
            self.inputs.add_change(rate, time - since);
        }
        Ok(())
    }

    /// [`Simulation::carried`] at the start of the last step; `None` where no bearings are known, and it was the inputs.
    pub fn carried_last(&self) -> Option<&Inputs> {
        self.model.knows_bearings().then_some(&self.carried)
    }

    /// The inputs that hold from now on, to be changed.
    pub fn inputs_mut(&mut self) -> &mut Inputs {
        self.moves();
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

    /// The forces of all bearings in the order of the inputs, in x and y [N]: those of [`Motion::bearing_force`], worked out when
    /// first asked for.
    #[inline]
    pub fn bearing_forces(&self) -> &[[f64; 2]] {
        self.bearing_forces.get_or_init(|| {
            let mut forces = self.room.take();
            self.motion().bearing_forces_into(&mut forces);
            forces
        })
    }

    /// State or inputs are about to change: what was worked out from them does not hold any more.
    fn moves(&mut self) {
        if let Some(forces) = self.bearing_forces.take() {
            self.room.replace(forces);
        }
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
        self.moves();
        self.state.copy_from(&snapshot.state);
        self.inputs.clone_from(&snapshot.inputs);
        true
    }
}
