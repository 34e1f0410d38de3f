//! Every function that takes a component, with arguments that are harmless where the call is legal.
//!
//! The states are those of FMI 2.0.4, section 4.2.4 (figure 11), without those of asynchronous steps. `Failed`
//! is the state after an fmi2Error of fmi2DoStep; there we hold the slave to what a master can rely on: values,
//! saved states and statuses can be read, reset and free work.
#![allow(unsafe_code)] // calls the library

use core::ptr;

use fmi::schema::fmi2::Causality;
use geartrain::fmi2::abi::{Component, FmuState, LAST_SUCCESSFUL_TIME, Status, TERMINATED};

use State::{Failed, Initialization, Instantiated, Stepping, Terminated};

use crate::STEP;
use crate::fmu::Fmu;
use crate::functions::Functions;

/// Where a slave is in its life.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[expect(missing_docs, reason = "the standard's names")]
pub enum State {
    Instantiated,
    Initialization,
    Stepping,
    Terminated,
    Failed,
}

impl State {
    /// All of them.
    pub const ALL: [State; 5] = [Instantiated, Initialization, Stepping, Terminated, Failed];
}

/// A function with arguments that are harmless in the states where it is legal.
#[derive(Debug, Clone, Copy)]
pub struct Call {
    /// The function's name.
    pub name: &'static str,
    /// Where the standard allows it.
    pub legal: &'static [State],
    /// What it answers there.
    pub answer: Answer,
}

/// What a legal call answers.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Answer {
    /// fmi2OK.
    Ok,
    /// fmi2OK if modelDescription.xml declares this capability, else fmi2Error with its name.
    IfDeclared(&'static str),
    /// fmi2Discard: the information does not exist in a synchronous slave.
    Discard,
}

/// What the calls are made with.
#[derive(Debug)]
pub struct Arguments {
    parameter: u32,
    input: u32,
    output: u32,
    time: f64,
    states: bool,
    serialization: bool,
}

impl Call {
    /// Harmless arguments for this FMU; fmi2DoStep starts at `time`.
    pub fn arguments(&self, fmu: &Fmu, time: f64) -> Arguments {
        let co_simulation = fmu.co_simulation();
        Arguments {
            parameter: fmu.reference("simulation.input_extrapolation"),
            input: fmu.references(&Causality::Input)[0],
            output: fmu.references(&Causality::Output)[0],
            time,
            states: co_simulation.can_get_and_set_fmu_state == Some(true),
            serialization: co_simulation.can_serialize_fmu_state == Some(true),
        }
    }

    /// # Safety
    /// The component is NULL or alive, and of the FMU that functions and arguments belong to.
    pub unsafe fn run(
        &self,
        functions: &Functions,
        component: Component,
        with: &Arguments,
    ) -> Status {
        // SAFETY: the caller's promise.
        let common = unsafe { run_common(self.name, functions, component, with) };
        // SAFETY: the caller's promise.
        common.unwrap_or_else(|| unsafe { run_stepping(self.name, functions, component, with) })
    }
}

/// Whether modelDescription.xml declares a capability.
pub fn declared(fmu: &Fmu, capability: &str) -> bool {
    let element = fmu.co_simulation();
    match capability {
        "canGetAndSetFMUstate" => element.can_get_and_set_fmu_state == Some(true),
        "canSerializeFMUstate" => element.can_serialize_fmu_state == Some(true),
        "providesDirectionalDerivative" => element.provides_directional_derivative == Some(true),
        "canInterpolateInputs" => element.can_interpolate_inputs == Some(true),
        "maxOutputDerivativeOrder" => element.max_output_derivative_order.unwrap_or(0) > 0,
        unknown => panic!("{unknown} is no capability of a co-simulation slave"),
    }
}

const ANYWHERE: &[State] = &State::ALL;
const BEFORE_THE_END: &[State] = &[Instantiated, Initialization, Stepping];
const AFTER_A_STEP: &[State] = &[Stepping, Terminated, Failed];
const STATE: Answer = Answer::IfDeclared("canGetAndSetFMUstate");
const BYTES: Answer = Answer::IfDeclared("canSerializeFMUstate");

/// The calls: all functions but fmi2GetTypesPlatform, fmi2GetVersion, fmi2Instantiate and fmi2FreeInstance.
pub const CALLS: [Call; 30] = [
    call("fmi2SetDebugLogging", ANYWHERE, Answer::Ok),
    call("fmi2SetupExperiment", &[Instantiated], Answer::Ok),
    call("fmi2EnterInitializationMode", &[Instantiated], Answer::Ok),
    call("fmi2ExitInitializationMode", &[Initialization], Answer::Ok),
    call("fmi2Terminate", &[Stepping], Answer::Ok),
    call("fmi2Reset", ANYWHERE, Answer::Ok),
    call("fmi2GetReal", ANYWHERE, Answer::Ok),
    call("fmi2GetInteger", ANYWHERE, Answer::Ok),
    call("fmi2GetBoolean", ANYWHERE, Answer::Ok),
    call("fmi2GetString", ANYWHERE, Answer::Ok),
    call("fmi2SetReal", BEFORE_THE_END, Answer::Ok),
    call("fmi2SetInteger", BEFORE_THE_END, Answer::Ok),
    call("fmi2SetBoolean", BEFORE_THE_END, Answer::Ok),
    call("fmi2SetString", BEFORE_THE_END, Answer::Ok),
    call("fmi2GetFMUstate", ANYWHERE, STATE),
    call("fmi2SetFMUstate", ANYWHERE, STATE),
    call("fmi2FreeFMUstate", ANYWHERE, Answer::Ok),
    call("fmi2SerializedFMUstateSize", ANYWHERE, BYTES),
    call("fmi2SerializeFMUstate", ANYWHERE, BYTES),
    call("fmi2DeSerializeFMUstate", ANYWHERE, BYTES),
    call(
        "fmi2GetDirectionalDerivative",
        &[Initialization, Stepping, Terminated, Failed],
        Answer::IfDeclared("providesDirectionalDerivative"),
    ),
    call(
        "fmi2SetRealInputDerivatives",
        BEFORE_THE_END,
        Answer::IfDeclared("canInterpolateInputs"),
    ),
    call(
        "fmi2GetRealOutputDerivatives",
        AFTER_A_STEP,
        Answer::IfDeclared("maxOutputDerivativeOrder"),
    ),
    call("fmi2DoStep", &[Stepping], Answer::Ok),
    call("fmi2CancelStep", &[], Answer::Ok), // only during an asynchronous step
    call("fmi2GetStatus", AFTER_A_STEP, Answer::Discard),
    call("fmi2GetRealStatus", AFTER_A_STEP, Answer::Ok),
    call("fmi2GetIntegerStatus", AFTER_A_STEP, Answer::Discard),
    call("fmi2GetBooleanStatus", AFTER_A_STEP, Answer::Ok),
    call("fmi2GetStringStatus", AFTER_A_STEP, Answer::Discard),
];

const fn call(name: &'static str, legal: &'static [State], answer: Answer) -> Call {
    Call {
        name,
        legal,
        answer,
    }
}

/// The functions that model exchange has too.
///
/// # Safety
/// As [`Call::run`].
unsafe fn run_common(
    name: &str,
    f: &Functions,
    component: Component,
    with: &Arguments,
) -> Option<Status> {
    let (mut real, mut integer, mut string) = (0.0, 0, ptr::null());
    let input = &raw const with.input;
    // SAFETY: the caller's promise; arrays have one element or are announced with none.
    Some(unsafe {
        match name {
            "fmi2SetDebugLogging" => (f.set_debug_logging)(component, 1, 0, ptr::null()),
            "fmi2SetupExperiment" => (f.setup_experiment)(component, 0, 0.0, 0.0, 0, 0.0),
            "fmi2EnterInitializationMode" => (f.enter_initialization_mode)(component),
            "fmi2ExitInitializationMode" => (f.exit_initialization_mode)(component),
            "fmi2Terminate" => (f.terminate)(component),
            "fmi2Reset" => (f.reset)(component),
            "fmi2GetReal" => (f.get_real)(component, &raw const with.parameter, 1, &raw mut real),
            "fmi2GetInteger" => (f.get_integer)(component, input, 0, &raw mut integer),
            "fmi2GetBoolean" => (f.get_boolean)(component, input, 0, &raw mut integer),
            "fmi2GetString" => (f.get_string)(component, input, 0, &raw mut string),
            "fmi2SetReal" => (f.set_real)(component, input, 1, &raw const real),
            "fmi2SetInteger" => (f.set_integer)(component, input, 0, &raw const integer),
            "fmi2SetBoolean" => (f.set_boolean)(component, input, 0, &raw const integer),
            "fmi2SetString" => (f.set_string)(component, input, 0, &raw const string),
            "fmi2GetDirectionalDerivative" => (f.get_directional_derivative)(
                component,
                &raw const with.output,
                1,
                input,
                1,
                &raw const real,
                &raw mut real,
            ),
            _ if name.contains("FMUstate") => run_on_state(name, f, component, with),
            _ => return None,
        }
    })
}

/// The functions of co-simulation.
///
/// # Safety
/// As [`Call::run`].
unsafe fn run_stepping(
    name: &str,
    f: &Functions,
    component: Component,
    with: &Arguments,
) -> Status {
    let (mut real, mut integer, mut string, mut status) = (0.0, 0, ptr::null(), Status::Ok);
    let (input, output, order) = (&raw const with.input, &raw const with.output, 1);
    // SAFETY: the caller's promise; arrays have one element.
    unsafe {
        match name {
            "fmi2SetRealInputDerivatives" => (f.set_real_input_derivatives)(
                component,
                input,
                1,
                &raw const order,
                &raw const real,
            ),
            "fmi2GetRealOutputDerivatives" => (f.get_real_output_derivatives)(
                component,
                output,
                1,
                &raw const order,
                &raw mut real,
            ),
            "fmi2DoStep" => (f.do_step)(component, with.time, STEP, 1),
            "fmi2CancelStep" => (f.cancel_step)(component),
            "fmi2GetStatus" => (f.get_status)(component, 0, &raw mut status),
            "fmi2GetRealStatus" => {
                (f.get_real_status)(component, LAST_SUCCESSFUL_TIME, &raw mut real)
            }
            "fmi2GetIntegerStatus" => (f.get_integer_status)(component, 0, &raw mut integer),
            "fmi2GetBooleanStatus" => {
                (f.get_boolean_status)(component, TERMINATED, &raw mut integer)
            }
            "fmi2GetStringStatus" => (f.get_string_status)(component, 1, &raw mut string),
            unknown => unreachable!("{unknown} is not in the table"),
        }
    }
}

/// The functions for saved states, on a state just saved where the FMU can do that.
///
/// # Safety
/// As [`Call::run`].
unsafe fn run_on_state(
    name: &str,
    f: &Functions,
    component: Component,
    with: &Arguments,
) -> Status {
    let mut state: FmuState = ptr::null_mut();
    let mut size = 0;
    // SAFETY: the caller's promise; states are NULL or saved here, the bytes are as many as announced.
    unsafe {
        if with.states && !component.is_null() && name != "fmi2GetFMUstate" {
            assert_eq!((f.get_state)(component, &raw mut state), Status::Ok);
        }
        if with.serialization && !state.is_null() && name != "fmi2SerializedFMUstateSize" {
            assert_eq!(
                (f.serialized_size)(component, state, &raw mut size),
                Status::Ok
            );
        }
        let mut bytes = vec![0; size];
        let status = match name {
            "fmi2GetFMUstate" => (f.get_state)(component, &raw mut state),
            "fmi2SetFMUstate" => (f.set_state)(component, state),
            "fmi2FreeFMUstate" => (f.free_state)(component, &raw mut state),
            "fmi2SerializedFMUstateSize" => (f.serialized_size)(component, state, &raw mut size),
            "fmi2SerializeFMUstate" => (f.serialize)(component, state, bytes.as_mut_ptr(), size),
            _ => deserialize(f, component, state, &mut bytes),
        };
        if !state.is_null() {
            (f.free_state)(component, &raw mut state);
        }
        status
    }
}

/// fmi2DeSerializeFMUstate of what fmi2SerializeFMUstate wrote.
///
/// # Safety
/// As [`Call::run`]; the state is NULL or saved, and as large as `bytes`.
unsafe fn deserialize(
    f: &Functions,
    component: Component,
    state: FmuState,
    bytes: &mut [core::ffi::c_char],
) -> Status {
    let mut copy: FmuState = ptr::null_mut();
    // SAFETY: the caller's promise.
    unsafe {
        if !state.is_null() {
            let written = (f.serialize)(component, state, bytes.as_mut_ptr(), bytes.len());
            assert_eq!(written, Status::Ok);
        }
        let status = (f.deserialize)(component, bytes.as_ptr(), bytes.len(), &raw mut copy);
        if !copy.is_null() {
            (f.free_state)(component, &raw mut copy);
        }
        status
    }
}
