//! Versions, logging, and the life of an instance (FMI 2.0.4, 2.1.4 to 2.1.6).

use crate::fmi2::abi::{Boolean, CString, CallbackFunctions, Component, FALSE, Real, Status, Type};
use crate::fmi2::arguments::strings;
use crate::fmi2::guard::call;
use crate::fmi2::life;
use crate::slave::{Call, Experiment};

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
