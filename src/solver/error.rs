//! Why a step cannot be taken.

use core::fmt;

/// Why an advance failed; the state is then the one before it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum StepError {
    /// The error bound would need steps that no longer change the time.
    StepTooSmall {
        /// Where [s].
        time: f64,
        /// The step asked for [s].
        step: f64,
    },
    /// The call asks for more work than one call should do.
    TooManySteps {
        /// How far it came [s].
        time: f64,
        /// Steps taken.
        steps: u64,
    },
    /// The solution left the range of numbers, as that of an unstable system does in the end.
    NotFinite {
        /// Where [s].
        time: f64,
    },
    /// The step's equations have no unique solution.
    Singular {
        /// Where [s].
        time: f64,
        /// The step [s].
        step: f64,
    },
}

impl fmt::Display for StepError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            StepError::StepTooSmall { time, step } => write!(
                f,
                "at time {time} s the tolerance asks for a step of {step:e} s, too small to be taken; \
                 a larger tolerance may help"
            ),
            StepError::TooManySteps { time, steps } => write!(
                f,
                "after {steps} steps only time {time} s is reached; use smaller communication steps"
            ),
            StepError::NotFinite { time } => write!(
                f,
                "the solution grew beyond all numbers at time {time} s; the system is probably unstable"
            ),
            StepError::Singular { time, step } => write!(
                f,
                "the equations of the step of {step:e} s at time {time} s have no unique solution"
            ),
        }
    }
}
