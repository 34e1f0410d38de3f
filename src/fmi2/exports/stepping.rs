//! Steps and their status (FMI 2.0.4, 4.2.1 to 4.2.3).

use crate::fmi2::abi::{
    Boolean, CString, Component, FALSE, Integer, LAST_SUCCESSFUL_TIME, Real, Status, StatusKind,
    TERMINATED,
};
use crate::fmi2::arguments::store;
use crate::fmi2::guard::call;
use crate::slave::{Call, Error};

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
