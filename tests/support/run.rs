//! A model that moves from any state, by either solver; and one whose motion is known in closed form.

use geartrain::config::SolverChoice;
use geartrain::model::{Course, Excitation, Inputs, ModalModel, Motion};
use geartrain::solver::{Counts, Integrator, Ramp, State};

use super::head;

/// A model with its state: like a simulation, but the state is the test's to choose.
pub struct Run {
    pub model: ModalModel,
    pub inputs: Inputs,
    pub state: State,
    pub tolerance: f64,
    solver: Integrator,
}

impl Run {
    /// Starts at time 0 with the torques and no gearbox motion, without deformation, the rotors at their first speeds.
    pub fn new(model: ModalModel, torques: &[f64], solver: SolverChoice, tolerance: f64) -> Run {
        let solver = match solver {
            SolverChoice::Exponential => Integrator::exponential(&model.system, model.harmonics()),
            SolverChoice::Newmark => Integrator::newmark(&model.system),
        };
        let position = vec![0.0; model.system.size];
        let state = solver.state_at(&model.system, 0.0, position, model.rigid_velocity());
        Run {
            inputs: model.inputs_at_rest(torques),
            state,
            tolerance,
            solver,
            model,
        }
    }

    /// Continues from here with these displacements and velocities.
    pub fn put(&mut self, position: Vec<f64>, velocity: Vec<f64>) {
        let time = self.state.time;
        self.state = self
            .solver
            .state_at(&self.model.system, time, position, velocity);
    }

    pub fn advance_to(&mut self, time: f64) {
        self.advance_along(time, None);
    }

    /// With inputs that change by `rate` per second from their values now; they keep these afterwards.
    pub fn advance_along(&mut self, time: f64, rate: Option<&Inputs>) {
        let system = &self.model.system;
        let course = Course {
            first: &self.inputs,
            rate,
            since: self.state.time,
        };
        let mut loads = vec![Ramp::default(); system.loads.len()];
        course.loads_into(&self.model, &mut loads);
        let forcing = Excitation::new(&self.model, course, &loads);
        self.solver
            .advance_to(system, &forcing, &mut self.state, time, self.tolerance)
            .expect("the step can be taken");
    }

    pub fn motion(&self) -> Motion<'_> {
        Motion::new(&self.model, &self.state, &self.inputs)
    }

    pub fn counts(&self) -> Counts {
        self.solver.counts()
    }
}

/// The load of held inputs on the coordinates.
pub fn held_load(model: &ModalModel, inputs: &Inputs) -> Vec<f64> {
    let course = Course {
        first: inputs,
        rate: None,
        since: 0.0,
    };
    let mut loads = vec![Ramp::default(); model.system.loads.len()];
    course.loads_into(model, &mut loads);
    let mut load = vec![0.0; model.system.size];
    for (column, ramp) in model.system.loads.iter().zip(&loads) {
        column.add_to(ramp.first, &mut load);
    }
    load
}

/// The numbers of [`rigid_pair`].
pub struct RigidPair;

impl RigidPair {
    /// Base radii [m].
    pub const RADIUS: [f64; 2] = [0.1, 0.2];
    /// Polar moments of inertia [kg m^2].
    pub const INERTIA: [f64; 2] = [0.02, 0.3];

    /// Mass that moves along the line of action [kg]: 1/m = R_a^2/J_a + R_b^2/J_b.
    pub fn mass() -> f64 {
        let [a, b] = [0, 1].map(|i| Self::RADIUS[i] * Self::RADIUS[i] / Self::INERTIA[i]);
        1.0 / (a + b)
    }
}

/// Two gears on shafts that do not twist, too heavy (1e11 kg) to move sideways: what is left are two rotations. 20 and 40 teeth;
/// `simulation` and `mesh` are further lines of those tables, `law` is the body of `[mesh.stiffness]`, `ports` the
/// values and slopes of the two torques.
pub fn rigid_pair(
    simulation: &str,
    speed: f64,
    ports: [(f64, f64); 2],
    mesh: &str,
    law: &str,
) -> String {
    let rotor = |index: usize, name: &str, speed: f64, teeth: u32| {
        let (radius, inertia) = (RigidPair::RADIUS[index], RigidPair::INERTIA[index]);
        let (value, slope) = ports[index];
        format!(
            "[[rotor]]\nname = \"{name}\"\nspeed = {speed}\n\
             [[rotor.segment]]\nlength = 0.1\nouter_diameter = 0.3\nmaterial = \"rigid\"\n\
             [[rotor.gear]]\nname = \"g\"\nposition = 0.05\nteeth = {teeth}\nbase_radius = {radius}\n\
             mass = 1e11\npolar_inertia = {inertia}\ndiametral_inertia = 1e9\n\
             [[rotor.bearing]]\nname = \"b1\"\nposition = 0.0\nstiffness = {{ xx = 1e12 }}\n\
             [[rotor.bearing]]\nname = \"b2\"\nposition = 0.1\nstiffness = {{ xx = 1e12 }}\n\
             [[rotor.torque]]\nname = \"port\"\nposition = 0.05\nvalue = {value}\nslope = {slope}\n"
        )
    };
    format!(
        "{}[material.rigid]\nyoungs_modulus = 1e18\npoisson_ratio = 0.3\ndensity = 1e-9\n\
         [simulation]\n{simulation}\n{}{}\
         [[mesh]]\nname = \"m\"\ngears = [\"a.g\", \"b.g\"]\ncenter_angle = 0.0\npressure_angle = 0.35\n{mesh}\n\
         [mesh.stiffness]\n{law}\n",
        head(1, 1),
        rotor(0, "a", speed, 20),
        rotor(1, "b", -0.5 * speed, 40)
    )
}
