//! The 34 functions of an FMI 2.0 co-simulation slave, as a host finds them in a library.
#![allow(unsafe_code)] // symbols of a foreign library have the type that we say they have

use geartrain::fmi2::abi::{
    Boolean, Byte, CString, CallbackFunctions, Component, FmuState, Integer, Real, Status,
    StatusKind, Type, ValueReference,
};
use libloading::Library;

/// A function with no argument but the component.
pub type Plain = unsafe extern "C" fn(Component) -> Status;
/// fmi2GetReal and its kin.
pub type Get<T> = unsafe extern "C" fn(Component, *const ValueReference, usize, *mut T) -> Status;
/// fmi2SetReal and its kin.
pub type Set<T> = unsafe extern "C" fn(Component, *const ValueReference, usize, *const T) -> Status;
/// fmi2GetRealStatus and its kin.
pub type GetStatus<T> = unsafe extern "C" fn(Component, StatusKind, *mut T) -> Status;
/// A text without arguments.
pub type Text = unsafe extern "C" fn() -> CString;
/// fmi2Instantiate.
pub type Instantiate = unsafe extern "C" fn(
    CString,
    Type,
    CString,
    CString,
    *const CallbackFunctions,
    Boolean,
    Boolean,
) -> Component;
/// fmi2SetupExperiment.
pub type SetupExperiment =
    unsafe extern "C" fn(Component, Boolean, Real, Real, Boolean, Real) -> Status;
/// fmi2GetDirectionalDerivative.
pub type GetDirectionalDerivative = unsafe extern "C" fn(
    Component,
    *const ValueReference,
    usize,
    *const ValueReference,
    usize,
    *const Real,
    *mut Real,
) -> Status;
/// fmi2SetRealInputDerivatives.
pub type SetDerivatives = unsafe extern "C" fn(
    Component,
    *const ValueReference,
    usize,
    *const Integer,
    *const Real,
) -> Status;
/// fmi2GetRealOutputDerivatives.
pub type GetDerivatives = unsafe extern "C" fn(
    Component,
    *const ValueReference,
    usize,
    *const Integer,
    *mut Real,
) -> Status;

/// The functions, one field each.
#[expect(missing_docs, reason = "the fields are named after the functions")]
#[derive(Debug, Clone, Copy)]
pub struct Functions {
    pub get_types_platform: Text,
    pub get_version: Text,
    pub set_debug_logging:
        unsafe extern "C" fn(Component, Boolean, usize, *const CString) -> Status,
    pub instantiate: Instantiate,
    pub free_instance: unsafe extern "C" fn(Component),
    pub setup_experiment: SetupExperiment,
    pub enter_initialization_mode: Plain,
    pub exit_initialization_mode: Plain,
    pub terminate: Plain,
    pub reset: Plain,
    pub get_real: Get<Real>,
    pub get_integer: Get<Integer>,
    pub get_boolean: Get<Boolean>,
    pub get_string: Get<CString>,
    pub set_real: Set<Real>,
    pub set_integer: Set<Integer>,
    pub set_boolean: Set<Boolean>,
    pub set_string: Set<CString>,
    pub get_state: unsafe extern "C" fn(Component, *mut FmuState) -> Status,
    pub set_state: unsafe extern "C" fn(Component, FmuState) -> Status,
    pub free_state: unsafe extern "C" fn(Component, *mut FmuState) -> Status,
    pub serialized_size: unsafe extern "C" fn(Component, FmuState, *mut usize) -> Status,
    pub serialize: unsafe extern "C" fn(Component, FmuState, *mut Byte, usize) -> Status,
    pub deserialize: unsafe extern "C" fn(Component, *const Byte, usize, *mut FmuState) -> Status,
    pub get_directional_derivative: GetDirectionalDerivative,
    pub set_real_input_derivatives: SetDerivatives,
    pub get_real_output_derivatives: GetDerivatives,
    pub do_step: unsafe extern "C" fn(Component, Real, Real, Boolean) -> Status,
    pub cancel_step: Plain,
    pub get_status: GetStatus<Status>,
    pub get_real_status: GetStatus<Real>,
    pub get_integer_status: GetStatus<Integer>,
    pub get_boolean_status: GetStatus<Boolean>,
    pub get_string_status: GetStatus<CString>,
}

impl Functions {
    /// The functions of a library.
    ///
    /// # Safety
    /// The library is an FMI 2.0 co-simulation slave: its functions have the standard's signatures. They are
    /// not called after the library was unloaded.
    pub unsafe fn of(library: &Library) -> Functions {
        // SAFETY: the caller's promise; `tests/abi.rs` compares the signatures with the standard's headers.
        unsafe {
            Functions {
                get_types_platform: symbol(library, "fmi2GetTypesPlatform"),
                get_version: symbol(library, "fmi2GetVersion"),
                set_debug_logging: symbol(library, "fmi2SetDebugLogging"),
                instantiate: symbol(library, "fmi2Instantiate"),
                free_instance: symbol(library, "fmi2FreeInstance"),
                setup_experiment: symbol(library, "fmi2SetupExperiment"),
                enter_initialization_mode: symbol(library, "fmi2EnterInitializationMode"),
                exit_initialization_mode: symbol(library, "fmi2ExitInitializationMode"),
                terminate: symbol(library, "fmi2Terminate"),
                reset: symbol(library, "fmi2Reset"),
                get_real: symbol(library, "fmi2GetReal"),
                get_integer: symbol(library, "fmi2GetInteger"),
                get_boolean: symbol(library, "fmi2GetBoolean"),
                get_string: symbol(library, "fmi2GetString"),
                set_real: symbol(library, "fmi2SetReal"),
                set_integer: symbol(library, "fmi2SetInteger"),
                set_boolean: symbol(library, "fmi2SetBoolean"),
                set_string: symbol(library, "fmi2SetString"),
                get_state: symbol(library, "fmi2GetFMUstate"),
                set_state: symbol(library, "fmi2SetFMUstate"),
                free_state: symbol(library, "fmi2FreeFMUstate"),
                serialized_size: symbol(library, "fmi2SerializedFMUstateSize"),
                serialize: symbol(library, "fmi2SerializeFMUstate"),
                deserialize: symbol(library, "fmi2DeSerializeFMUstate"),
                get_directional_derivative: symbol(library, "fmi2GetDirectionalDerivative"),
                set_real_input_derivatives: symbol(library, "fmi2SetRealInputDerivatives"),
                get_real_output_derivatives: symbol(library, "fmi2GetRealOutputDerivatives"),
                do_step: symbol(library, "fmi2DoStep"),
                cancel_step: symbol(library, "fmi2CancelStep"),
                get_status: symbol(library, "fmi2GetStatus"),
                get_real_status: symbol(library, "fmi2GetRealStatus"),
                get_integer_status: symbol(library, "fmi2GetIntegerStatus"),
                get_boolean_status: symbol(library, "fmi2GetBooleanStatus"),
                get_string_status: symbol(library, "fmi2GetStringStatus"),
            }
        }
    }
}

/// # Safety
/// The symbol is a function of type `F`.
unsafe fn symbol<F: Copy>(library: &Library, name: &str) -> F {
    // SAFETY: the caller's promise.
    let found = unsafe { library.get::<F>(name.as_bytes()) };
    *found.unwrap_or_else(|error| panic!("{name}: {error}"))
}
