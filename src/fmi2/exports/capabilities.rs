//! Optional capabilities (FMI 2.0.4, 2.1.8, 2.1.9, 4.2.1): exported, not declared, refused in words.

use crate::fmi2::abi::{Byte, Component, FmuState, Integer, Real, Status, ValueReference};
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
