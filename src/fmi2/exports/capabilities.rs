//! Derivatives (FMI 2.0.4, 2.1.9, 4.2.1). Those of inputs are exported, not declared, and refused in words.

use crate::fmi2::abi::{Component, Integer, Real, Status, ValueReference};
use crate::fmi2::arguments::{slice, slice_mut};
use crate::fmi2::guard::call;
use crate::slave::{Call, Error};

/// Refuses a capability that modelDescription.xml does not declare.
fn unsupported(component: Component, function: &'static str, needs: Call, flag: &str) -> Status {
    call(component, function, needs, |_| {
        Err(Error::new(format!(
            "not supported: modelDescription.xml does not declare {flag}"
        )))
    })
}

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
