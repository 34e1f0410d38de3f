//! The FMI 2.0 co-simulation slave in safe Rust: life cycle, parameters, inputs, steps.
//!
//! ```text
//!   instantiate -> Instantiated -> Initialization -> Stepping -> Terminated
//!                                                       └-> Failed        (reset leads back from anywhere)
//! ```
//!
//! A parameter is written into the configuration; the model is assembled anew when something that needs
//! it is asked for, at the latest on leaving initialization. A rejected call changes nothing. The only
//! module that knows FMI's modes; knows no pointers.

mod calls;
mod continuation;
mod derivatives;
mod design;
mod error;
mod saved;
mod values;

use serde::{Deserialize, Serialize};

use crate::config::{self, Config};
use crate::model::Inputs;
use crate::simulation::Simulation;

use continuation::Continuation;
use design::Design;

pub use calls::{Call, LifeCycle};
pub use error::{Error, Kind};
pub use saved::SavedState;

/// One instance of an FMU.
#[derive(Debug, Clone)]
pub struct Slave {
    design: Design,
    /// The configuration with the parameters set so far.
    config: Config,
    inputs: Inputs,
    /// What they were before a call that may be refused.
    inputs_before: Inputs,
    /// How the inputs change in the next step, when the master says so.
    rate: Option<Inputs>,
    /// How they went on before, where it says nothing.
    continuation: Continuation,
    life_cycle: LifeCycle,
    experiment: Option<Experiment>,
    /// Whether the master set `simulation.tolerance` itself.
    tolerance_set: bool,
    /// The model under the present parameters, started under the present inputs; `None` when either changed
    /// before step mode.
    simulation: Option<Simulation>,
}

/// What fmi2SetupExperiment says.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Experiment {
    /// Relative tolerance, when the master gives one.
    pub tolerance: Option<f64>,
    /// Start time [s].
    pub start: f64,
    /// Stop time [s], when the master gives one.
    pub stop: Option<f64>,
}

/// Communication points may differ from the slave's time by this part of the step, and this part of
/// the time itself: masters add up steps in floating point.
const TIME_SLACK: (f64, f64) = (1e-3, 1e-9);

/// Steps that lead no further than this time [s], or this part of the time itself, do nothing: masters lose as much by
/// rounding, and no solver can divide it.
const NOTHING: (f64, f64) = (1e-15, 32.0 * f64::EPSILON);

/// The last step may pass the stop time by this part of the run, and this part of the time itself: what ten thousand steps add up.
const STOP_SLACK: (f64, f64) = (1e-9, 1e-12);

/// Communication steps beyond this [s] are mistakes.
const LONGEST_STEP: f64 = 1e9;

impl Slave {
    /// An instance of a packed model (see [`Config::to_bytes`]).
    pub fn new(model: &[u8]) -> Result<Slave, Error> {
        let config = Config::from_bytes(model).ok_or_else(|| {
            Error::new("the model inside this library cannot be read; the file is damaged")
        })?;
        let design = Design::of(config)?;
        let inputs = design.inputs(&design.torques);
        Ok(Slave {
            config: design.config.clone(),
            continuation: Continuation::new(&inputs),
            inputs_before: inputs.clone(),
            inputs,
            rate: None,
            life_cycle: LifeCycle::Instantiated,
            experiment: None,
            tolerance_set: false,
            simulation: None,
            design,
        })
    }

    /// The fingerprint of interface and model that modelDescription.xml carries.
    pub fn guid(&self) -> &str {
        &self.design.guid
    }

    /// Refuses a call that is not legal now.
    pub fn permit(&self, call: Call) -> Result<(), Error> {
        if call.legal_in().contains(&self.life_cycle) {
            return Ok(());
        }
        Err(Error::new(format!(
            "this call is not allowed in {}",
            self.life_cycle.words()
        )))
    }

    /// fmi2SetupExperiment.
    pub fn setup_experiment(&mut self, experiment: Experiment) -> Result<(), Error> {
        let Experiment {
            tolerance,
            start,
            stop,
        } = experiment;
        if !start.is_finite() {
            return Err(Error::new(format!(
                "the start time must be a finite number, found {start}"
            )));
        }
        if let Some(stop) = stop.filter(|&stop| stop.is_nan() || stop < start) {
            let rule = format!("the stop time must not be before the start time {start} s");
            return Err(Error::new(format!("{rule}, found {stop}")));
        }
        if let Some(tolerance) = tolerance.filter(|&value| value.is_nan() || value <= 0.0) {
            return Err(Error::new(format!(
                "the tolerance must be greater than 0, found {tolerance}"
            )));
        }
        self.experiment = Some(experiment);
        self.simulation = None;
        Ok(())
    }

    /// fmi2EnterInitializationMode.
    pub fn enter_initialization(&mut self) -> Result<(), Error> {
        if self.experiment.is_none() {
            return Err(Error::new(
                "fmi2SetupExperiment must be called before initialization",
            ));
        }
        self.life_cycle = LifeCycle::Initialization;
        Ok(())
    }

    /// fmi2ExitInitializationMode: assembles the model with all parameters set.
    pub fn exit_initialization(&mut self) -> Result<(), Error> {
        self.started()?;
        self.life_cycle = LifeCycle::Stepping;
        Ok(())
    }

    /// fmi2Terminate.
    pub fn terminate(&mut self) {
        self.life_cycle = LifeCycle::Terminated;
    }

    /// fmi2Reset: as after instantiation.
    pub fn reset(&mut self) {
        self.config.clone_from(&self.design.config);
        self.inputs = self.design.inputs(&self.design.torques);
        self.rate = None;
        self.continuation = Continuation::new(&self.inputs);
        self.life_cycle = LifeCycle::Instantiated;
        self.experiment = None;
        self.tolerance_set = false;
        self.simulation = None;
    }

    /// fmi2DoStep: from the communication point `time` to exactly `time + step`. Input derivatives hold for this step.
    pub fn do_step(&mut self, time: f64, step: f64) -> Result<(), Error> {
        let Some(simulation) = &mut self.simulation else {
            return Err(Error::new("the simulation has not been started"));
        };
        if step.is_nan() || step <= 0.0 || step > LONGEST_STEP {
            return Err(Error::new(format!(
                "the communication step must be greater than 0 and at most {LONGEST_STEP:?} s, found {step:?} s"
            )));
        }
        let (now, end) = (simulation.time(), time + step);
        let nothing = NOTHING.0.max(NOTHING.1 * now.abs());
        let slack = TIME_SLACK.0 * step + TIME_SLACK.1 * now.abs() + nothing;
        if (time - now).is_nan() || (time - now).abs() > slack {
            return Err(Error::new(format!(
                "the step starts at {time:?} s, but the slave is at {now:?} s"
            )));
        }
        if end - now <= nothing {
            self.rate = None;
            return Ok(());
        }
        let stop = self
            .experiment
            .and_then(|experiment| Some((experiment.start, experiment.stop?)));
        let too_far = |&(start, stop): &(f64, f64)| {
            end > stop + STOP_SLACK.0 * (stop - start) + STOP_SLACK.1 * stop.abs()
        };
        if let Some((start, stop)) = stop.filter(too_far) {
            return Err(Error::new(format!(
                "the step from {time:?} s by {step:?} s ends after the stop time {stop:?} s (start {start:?} s)"
            )));
        }
        let length = end - now;
        let share = self.config.simulation.input_extrapolation;
        take_back_continued(simulation, share, &self.inputs);
        let advanced = if let Some(rate) = &self.rate {
            simulation.advance_along(end, Some(rate))
        } else if share > 0.0 {
            let rate = self.continuation.rate(simulation.carried(), length, share);
            simulation.advance_carrying(end, Some(rate))
        } else {
            simulation.advance_carrying(end, None)
        };
        if let Err(error) = advanced {
            self.life_cycle = LifeCycle::Failed;
            let step = format!("the step from {time:?} s by {step:?} s");
            return Err(Error::new(format!("{step} failed: {error}")));
        }
        if share > 0.0 {
            let began_with = simulation.carried_last().unwrap_or(&self.inputs);
            self.continuation.note(began_with, length);
        }
        if let Some(rate) = self.rate.take() {
            self.inputs.add_change(&rate, length);
        }
        Ok(())
    }

    /// End of the last successful step [s].
    pub fn last_successful_time(&self) -> f64 {
        self.simulation.as_ref().map_or(0.0, Simulation::time)
    }

    /// The simulation under the present parameters and inputs, started if need be.
    fn started(&mut self) -> Result<&mut Simulation, Error> {
        if self.simulation.is_none() {
            self.simulation = Some(self.start()?);
        }
        self.simulation
            .as_mut()
            .ok_or_else(|| Error::new("the simulation has not been started"))
    }

    fn start(&self) -> Result<Simulation, Error> {
        let experiment = self.experiment.unwrap_or(Experiment {
            tolerance: None,
            start: 0.0,
            stop: None,
        });
        let settings = settings(&self.config, Some(experiment), self.tolerance_set);
        let model = self.design.assemble(&self.config)?;
        Simulation::start(model, self.inputs.clone(), &settings, experiment.start)
            .map_err(|error| Error::new(format!("the simulation cannot start: {error}")))
    }
}

/// Outputs are read with the inputs as the last step continued them, until some are set or the next step begins with all that were.
fn take_back_continued(simulation: &mut Simulation, share: f64, inputs: &Inputs) {
    if share > 0.0 || simulation.model().knows_bearings() {
        simulation.inputs_mut().overwrite(inputs);
    }
}

/// The settings of a run: the master's tolerance goes before the file's, unless it set the parameter itself.
fn settings(
    config: &Config,
    experiment: Option<Experiment>,
    tolerance_set: bool,
) -> config::Simulation {
    let mut settings = config.simulation.clone();
    let asked = experiment.and_then(|experiment| experiment.tolerance);
    if let (Some(tolerance), false) = (asked, tolerance_set) {
        settings.tolerance = tolerance.clamp(1e-12, 0.1);
    }
    settings
}
