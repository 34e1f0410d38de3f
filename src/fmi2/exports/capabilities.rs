//! Optional capabilities (FMI 2.0.4, 2.1.8, 2.1.9, 4.2.1): exported, not declared, refused in words.

use crate::fmi2::abi::{Component, Integer, Real, Status, ValueReference};
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
