//! The 34 functions of an FMI 2.0 co-simulation slave. Each is a guard call and one method call; arguments
//! are turned into slices and strings by `arguments`.

use super::abi::{
    Boolean, Byte, CString, CallbackFunctions, Component, FALSE, FmuState, Integer,
    LAST_SUCCESSFUL_TIME, Real, Status, StatusKind, TERMINATED, Type, ValueReference,
};
use super::arguments::{slice, slice_mut, store, strings};
use super::guard::call;
use super::life;
use crate::slave::{Call, Error, Experiment};

/// The platform types that the ABI module is written for.
#[unsafe(no_mangle)]
pub extern "C" fn fmi2GetTypesPlatform() -> CString {
    c"default".as_ptr()
}

/// The version of the standard.
#[unsafe(no_mangle)]
pub extern "C" fn fmi2GetVersion() -> CString {
    c"2.0".as_ptr()
}

/// # Safety
/// `categories` points to `count` strings, or `count` is 0.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SetDebugLogging(
    component: Component,
    logging_on: Boolean,
    count: usize,
    categories: *const CString,
) -> Status {
    call(
        component,
        "fmi2SetDebugLogging",
        Call::SetDebugLogging,
        |instance| {
            // SAFETY: the caller's promise.
            let names = unsafe { strings(categories, count) }?;
            instance.messages.enable(logging_on != FALSE, &names);
            Ok(())
        },
    )
}

/// # Safety
/// Strings are NUL-terminated or NULL; `functions` points to the callbacks or is NULL.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2Instantiate(
    instance_name: CString,
    fmu_type: Type,
    guid: CString,
    _resource_location: CString,
    functions: *const CallbackFunctions,
    _visible: Boolean,
    logging_on: Boolean,
) -> Component {
    // SAFETY: the caller's promise.
    unsafe {
        life::instantiate(
            instance_name,
            fmu_type,
            guid,
            functions,
            logging_on != FALSE,
        )
    }
}

/// # Safety
/// `component` is NULL or was made by [`fmi2Instantiate`] and not freed yet.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2FreeInstance(component: Component) {
    // SAFETY: the caller's promise.
    unsafe { life::free(component) }
}

/// See the standard; the flags say whether tolerance and stop time are meant.
#[unsafe(no_mangle)]
pub extern "C" fn fmi2SetupExperiment(
    component: Component,
    tolerance_defined: Boolean,
    tolerance: Real,
    start_time: Real,
    stop_time_defined: Boolean,
    stop_time: Real,
) -> Status {
    call(
        component,
        "fmi2SetupExperiment",
        Call::SetupExperiment,
        |instance| {
            instance.slave.setup_experiment(Experiment {
                tolerance: (tolerance_defined != FALSE).then_some(tolerance),
                start: start_time,
                stop: (stop_time_defined != FALSE).then_some(stop_time),
            })
        },
    )
}

/// See the standard.
#[unsafe(no_mangle)]
pub extern "C" fn fmi2EnterInitializationMode(component: Component) -> Status {
    call(
        component,
        "fmi2EnterInitializationMode",
        Call::EnterInitializationMode,
        |instance| instance.slave.enter_initialization(),
    )
}

/// See the standard.
#[unsafe(no_mangle)]
pub extern "C" fn fmi2ExitInitializationMode(component: Component) -> Status {
    call(
        component,
        "fmi2ExitInitializationMode",
        Call::ExitInitializationMode,
        |instance| instance.slave.exit_initialization(),
    )
}

/// See the standard.
#[unsafe(no_mangle)]
pub extern "C" fn fmi2Terminate(component: Component) -> Status {
    call(component, "fmi2Terminate", Call::Terminate, |instance| {
        instance.slave.terminate();
        Ok(())
    })
}

/// See the standard.
#[unsafe(no_mangle)]
pub extern "C" fn fmi2Reset(component: Component) -> Status {
    call(component, "fmi2Reset", Call::Reset, |instance| {
        instance.slave.reset();
        Ok(())
    })
}

/// # Safety
/// `references` and `values` point to `count` elements each, or `count` is 0.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetReal(
    component: Component,
    references: *const ValueReference,
    count: usize,
    values: *mut Real,
) -> Status {
    call(component, "fmi2GetReal", Call::Get, |instance| {
        // SAFETY: the caller's promise.
        let (references, values) =
            unsafe { (slice(references, count)?, slice_mut(values, count)?) };
        instance.slave.get_real(references, values)
    })
}

/// # Safety
/// `references` and `values` point to `count` elements each, or `count` is 0.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SetReal(
    component: Component,
    references: *const ValueReference,
    count: usize,
    values: *const Real,
) -> Status {
    call(component, "fmi2SetReal", Call::Set, |instance| {
        // SAFETY: the caller's promise.
        let (references, values) = unsafe { (slice(references, count)?, slice(values, count)?) };
        instance.slave.set_real(references, values)
    })
}

/// # Safety
/// `references` points to `count` elements, or `count` is 0.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetInteger(
    component: Component,
    references: *const ValueReference,
    count: usize,
    _values: *mut Integer,
) -> Status {
    call(component, "fmi2GetInteger", Call::Get, |instance| {
        // SAFETY: the caller's promise.
        let references = unsafe { slice(references, count) }?;
        instance.slave.no_variables_of_type("Integer", references)
    })
}

/// # Safety
/// `references` points to `count` elements, or `count` is 0.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SetInteger(
    component: Component,
    references: *const ValueReference,
    count: usize,
    _values: *const Integer,
) -> Status {
    call(component, "fmi2SetInteger", Call::Set, |instance| {
        // SAFETY: the caller's promise.
        let references = unsafe { slice(references, count) }?;
        instance.slave.no_variables_of_type("Integer", references)
    })
}

/// # Safety
/// `references` points to `count` elements, or `count` is 0.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetBoolean(
    component: Component,
    references: *const ValueReference,
    count: usize,
    _values: *mut Boolean,
) -> Status {
    call(component, "fmi2GetBoolean", Call::Get, |instance| {
        // SAFETY: the caller's promise.
        let references = unsafe { slice(references, count) }?;
        instance.slave.no_variables_of_type("Boolean", references)
    })
}

/// # Safety
/// `references` points to `count` elements, or `count` is 0.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SetBoolean(
    component: Component,
    references: *const ValueReference,
    count: usize,
    _values: *const Boolean,
) -> Status {
    call(component, "fmi2SetBoolean", Call::Set, |instance| {
        // SAFETY: the caller's promise.
        let references = unsafe { slice(references, count) }?;
        instance.slave.no_variables_of_type("Boolean", references)
    })
}

/// # Safety
/// `references` points to `count` elements, or `count` is 0.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetString(
    component: Component,
    references: *const ValueReference,
    count: usize,
    _values: *mut CString,
) -> Status {
    call(component, "fmi2GetString", Call::Get, |instance| {
        // SAFETY: the caller's promise.
        let references = unsafe { slice(references, count) }?;
        instance.slave.no_variables_of_type("String", references)
    })
}

/// # Safety
/// `references` points to `count` elements, or `count` is 0.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SetString(
    component: Component,
    references: *const ValueReference,
    count: usize,
    _values: *const CString,
) -> Status {
    call(component, "fmi2SetString", Call::Set, |instance| {
        // SAFETY: the caller's promise.
        let references = unsafe { slice(references, count) }?;
        instance.slave.no_variables_of_type("String", references)
    })
}

/// Refuses a capability that modelDescription.xml does not declare.
fn unsupported(component: Component, function: &'static str, needs: Call, flag: &str) -> Status {
    call(component, function, needs, |_| {
        Err(Error::new(format!(
            "not supported: modelDescription.xml does not declare {flag}"
        )))
    })
}

/// Not supported yet.
#[unsafe(no_mangle)]
pub extern "C" fn fmi2GetFMUstate(component: Component, _state: *mut FmuState) -> Status {
    unsupported(
        component,
        "fmi2GetFMUstate",
        Call::GetState,
        "canGetAndSetFMUstate",
    )
}

/// Not supported yet.
#[unsafe(no_mangle)]
pub extern "C" fn fmi2SetFMUstate(component: Component, _state: FmuState) -> Status {
    unsupported(
        component,
        "fmi2SetFMUstate",
        Call::UseState,
        "canGetAndSetFMUstate",
    )
}

/// No state was ever given out, so that only NULL can be freed.
///
/// # Safety
/// `state` is NULL or points to an fmi2FMUstate.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2FreeFMUstate(component: Component, state: *mut FmuState) -> Status {
    // SAFETY: the caller's promise.
    if unsafe { state.as_ref() }.is_none_or(|state| state.is_null()) {
        return call(component, "fmi2FreeFMUstate", Call::UseState, |_| Ok(()));
    }
    unsupported(
        component,
        "fmi2FreeFMUstate",
        Call::UseState,
        "canGetAndSetFMUstate",
    )
}

/// Not supported yet.
#[unsafe(no_mangle)]
pub extern "C" fn fmi2SerializedFMUstateSize(
    component: Component,
    _state: FmuState,
    _size: *mut usize,
) -> Status {
    let flag = "canSerializeFMUstate";
    unsupported(
        component,
        "fmi2SerializedFMUstateSize",
        Call::UseState,
        flag,
    )
}

/// Not supported yet.
#[unsafe(no_mangle)]
pub extern "C" fn fmi2SerializeFMUstate(
    component: Component,
    _state: FmuState,
    _bytes: *mut Byte,
    _size: usize,
) -> Status {
    unsupported(
        component,
        "fmi2SerializeFMUstate",
        Call::UseState,
        "canSerializeFMUstate",
    )
}

/// Not supported yet.
#[unsafe(no_mangle)]
pub extern "C" fn fmi2DeSerializeFMUstate(
    component: Component,
    _bytes: *const Byte,
    _size: usize,
    _state: *mut FmuState,
) -> Status {
    unsupported(
        component,
        "fmi2DeSerializeFMUstate",
        Call::UseState,
        "canSerializeFMUstate",
    )
}

/// Not supported yet.
#[unsafe(no_mangle)]
pub extern "C" fn fmi2GetDirectionalDerivative(
    component: Component,
    _unknowns: *const ValueReference,
    _unknown_count: usize,
    _knowns: *const ValueReference,
    _known_count: usize,
    _seed: *const Real,
    _sensitivity: *mut Real,
) -> Status {
    let (function, needs) = (
        "fmi2GetDirectionalDerivative",
        Call::GetDirectionalDerivative,
    );
    unsupported(component, function, needs, "providesDirectionalDerivative")
}

/// Not supported yet.
#[unsafe(no_mangle)]
pub extern "C" fn fmi2SetRealInputDerivatives(
    component: Component,
    _references: *const ValueReference,
    _count: usize,
    _orders: *const Integer,
    _values: *const Real,
) -> Status {
    let (function, needs) = ("fmi2SetRealInputDerivatives", Call::SetInputDerivatives);
    unsupported(component, function, needs, "canInterpolateInputs")
}

/// Not supported yet.
#[unsafe(no_mangle)]
pub extern "C" fn fmi2GetRealOutputDerivatives(
    component: Component,
    _references: *const ValueReference,
    _count: usize,
    _orders: *const Integer,
    _values: *mut Real,
) -> Status {
    let (function, needs) = ("fmi2GetRealOutputDerivatives", Call::GetOutputDerivatives);
    unsupported(component, function, needs, "maxOutputDerivativeOrder")
}

/// See the standard.
#[unsafe(no_mangle)]
pub extern "C" fn fmi2DoStep(
    component: Component,
    current_communication_point: Real,
    communication_step_size: Real,
    _no_set_state_prior: Boolean,
) -> Status {
    call(component, "fmi2DoStep", Call::DoStep, |instance| {
        instance
            .slave
            .do_step(current_communication_point, communication_step_size)
    })
}

/// Steps are synchronous: there is never one to cancel.
#[unsafe(no_mangle)]
pub extern "C" fn fmi2CancelStep(component: Component) -> Status {
    call(component, "fmi2CancelStep", Call::CancelStep, |_| Ok(()))
}

/// Refuses information that only asynchronous slaves have.
fn no_status(component: Component, function: &'static str, kind: StatusKind) -> Status {
    call(component, function, Call::GetStatus, |_| {
        Err(Error::discard(format!(
            "status kind {kind} is not available: steps are synchronous"
        )))
    })
}

/// Only asynchronous slaves have one.
#[unsafe(no_mangle)]
pub extern "C" fn fmi2GetStatus(
    component: Component,
    kind: StatusKind,
    _value: *mut Status,
) -> Status {
    no_status(component, "fmi2GetStatus", kind)
}

/// Answers fmi2LastSuccessfulTime.
///
/// # Safety
/// `value` points to a number or is NULL.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetRealStatus(
    component: Component,
    kind: StatusKind,
    value: *mut Real,
) -> Status {
    if kind != LAST_SUCCESSFUL_TIME {
        return no_status(component, "fmi2GetRealStatus", kind);
    }
    call(
        component,
        "fmi2GetRealStatus",
        Call::GetStatus,
        |instance| {
            // SAFETY: the caller's promise.
            unsafe { store(value, instance.slave.last_successful_time()) }
        },
    )
}

/// No status of this type exists.
#[unsafe(no_mangle)]
pub extern "C" fn fmi2GetIntegerStatus(
    component: Component,
    kind: StatusKind,
    _value: *mut Integer,
) -> Status {
    no_status(component, "fmi2GetIntegerStatus", kind)
}

/// Answers fmi2Terminated: the slave never ends a simulation by itself.
///
/// # Safety
/// `value` points to a number or is NULL.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetBooleanStatus(
    component: Component,
    kind: StatusKind,
    value: *mut Boolean,
) -> Status {
    if kind != TERMINATED {
        return no_status(component, "fmi2GetBooleanStatus", kind);
    }
    call(component, "fmi2GetBooleanStatus", Call::GetStatus, |_| {
        // SAFETY: the caller's promise.
        unsafe { store(value, FALSE) }
    })
}

/// Only asynchronous slaves have one.
#[unsafe(no_mangle)]
pub extern "C" fn fmi2GetStringStatus(
    component: Component,
    kind: StatusKind,
    _value: *mut CString,
) -> Status {
    no_status(component, "fmi2GetStringStatus", kind)
}
