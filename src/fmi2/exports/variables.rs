//! Getting and setting variables (FMI 2.0.4, 2.1.7). All variables are Real.

use crate::fmi2::abi::{Boolean, CString, Component, Integer, Real, Status, ValueReference};
use crate::fmi2::arguments::{slice, slice_mut};
use crate::fmi2::guard::call;
use crate::slave::Call;

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
