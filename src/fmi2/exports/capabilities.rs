//! Derivatives (FMI 2.0.4, 2.1.9, 4.2.1).

use crate::fmi2::abi::{Component, Integer, Real, Status, ValueReference};
use crate::fmi2::arguments::{slice, slice_mut};
use crate::fmi2::guard::call;
use crate::slave::Call;

/// How outputs change with inputs.
///
/// # Safety
/// The arrays are as long as announced, unless their length is 0.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetDirectionalDerivative(
    component: Component,
    unknowns: *const ValueReference,
    unknown_count: usize,
    knowns: *const ValueReference,
    known_count: usize,
    seed: *const Real,
    sensitivity: *mut Real,
) -> Status {
    let (function, needs) = (
        "fmi2GetDirectionalDerivative",
        Call::GetDirectionalDerivative,
    );
    call(component, function, needs, |instance| {
        // SAFETY: the caller's promise.
        let unknowns = unsafe { slice(unknowns, unknown_count) }?;
        // SAFETY: the caller's promise.
        let knowns = unsafe { (slice(knowns, known_count)?, slice(seed, known_count)?) };
        // SAFETY: the caller's promise.
        let result = unsafe { slice_mut(sensitivity, unknown_count) }?;
        instance
            .slave
            .directional_derivative(unknowns, knowns, result)
    })
}

/// How inputs change in the next step.
///
/// # Safety
/// The arrays are as long as announced, unless their length is 0.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SetRealInputDerivatives(
    component: Component,
    references: *const ValueReference,
    count: usize,
    orders: *const Integer,
    values: *const Real,
) -> Status {
    let (function, needs) = ("fmi2SetRealInputDerivatives", Call::SetInputDerivatives);
    call(component, function, needs, |instance| {
        // SAFETY: the caller's promise.
        let (references, orders) = unsafe { (slice(references, count)?, slice(orders, count)?) };
        // SAFETY: the caller's promise.
        let values = unsafe { slice(values, count) }?;
        instance
            .slave
            .set_input_derivatives(references, orders, values)
    })
}

/// How outputs change with time.
///
/// # Safety
/// The arrays are as long as announced, unless their length is 0.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetRealOutputDerivatives(
    component: Component,
    references: *const ValueReference,
    count: usize,
    orders: *const Integer,
    values: *mut Real,
) -> Status {
    let (function, needs) = ("fmi2GetRealOutputDerivatives", Call::GetOutputDerivatives);
    call(component, function, needs, |instance| {
        // SAFETY: the caller's promise.
        let (references, orders) = unsafe { (slice(references, count)?, slice(orders, count)?) };
        // SAFETY: the caller's promise.
        let result = unsafe { slice_mut(values, count) }?;
        instance
            .slave
            .output_derivatives(references, orders, result)
    })
}
