//! Which FMI call is legal in which state: FMI 2.0.4, section 4.2.4, as data.

use serde::{Deserialize, Serialize};

/// Where a slave is in its life.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub enum LifeCycle {
    /// After instantiate or reset: parameters and start values may be set.
    Instantiated,
    /// Between fmi2EnterInitializationMode and fmi2ExitInitializationMode.
    Initialization,
    /// Ready for the next step.
    Stepping,
    /// After fmi2Terminate.
    Terminated,
    /// A step failed; the state is that before the step.
    Failed,
}

/// The calls that depend on the state.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Call {
    /// fmi2SetDebugLogging
    SetDebugLogging,
    /// fmi2SetupExperiment
    SetupExperiment,
    /// fmi2EnterInitializationMode
    EnterInitializationMode,
    /// fmi2ExitInitializationMode
    ExitInitializationMode,
    /// fmi2Terminate
    Terminate,
    /// fmi2Reset
    Reset,
    /// fmi2GetReal, fmi2GetInteger, fmi2GetBoolean, fmi2GetString
    Get,
    /// fmi2SetReal, fmi2SetInteger, fmi2SetBoolean, fmi2SetString
    Set,
    /// fmi2GetFMUstate
    GetState,
    /// fmi2SetFMUstate, fmi2FreeFMUstate, fmi2SerializedFMUstateSize, fmi2SerializeFMUstate,
    /// fmi2DeSerializeFMUstate
    UseState,
    /// fmi2GetDirectionalDerivative
    GetDirectionalDerivative,
    /// fmi2SetRealInputDerivatives
    SetInputDerivatives,
    /// fmi2GetRealOutputDerivatives
    GetOutputDerivatives,
    /// fmi2DoStep
    DoStep,
    /// fmi2CancelStep
    CancelStep,
    /// fmi2GetStatus, fmi2GetRealStatus, fmi2GetIntegerStatus, fmi2GetBooleanStatus,
    /// fmi2GetStringStatus
    GetStatus,
}

use LifeCycle::{Failed, Initialization, Instantiated, Stepping, Terminated};

const ANYWHERE: &[LifeCycle] = &[Instantiated, Initialization, Stepping, Terminated, Failed];

impl Call {
    /// The states in which the call is legal.
    pub fn legal_in(self) -> &'static [LifeCycle] {
        match self {
            Call::SetDebugLogging | Call::Reset | Call::Get | Call::GetState | Call::UseState => {
                ANYWHERE
            }
            Call::SetupExperiment | Call::EnterInitializationMode => &[Instantiated],
            Call::ExitInitializationMode => &[Initialization],
            Call::Terminate | Call::DoStep => &[Stepping],
            Call::Set | Call::SetInputDerivatives => &[Instantiated, Initialization, Stepping],
            Call::GetDirectionalDerivative => &[Initialization, Stepping, Terminated, Failed],
            Call::GetOutputDerivatives => &[Stepping, Terminated, Failed],
            Call::CancelStep => &[], // only while an asynchronous step is under way: never
            Call::GetStatus => &[Stepping, Terminated, Failed],
        }
    }
}

impl LifeCycle {
    /// The state in words, as the standard calls it.
    pub fn words(self) -> &'static str {
        match self {
            Instantiated => {
                "the state after instantiation (fmi2EnterInitializationMode has not been called)"
            }
            Initialization => "initialization mode",
            Stepping => "step mode",
            Terminated => "the terminated state",
            Failed => "the error state after a failed step",
        }
    }
}
