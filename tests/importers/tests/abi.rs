//! Our ABI types against bindings that bindgen made from the standard's headers (`fmi-sys`).

use core::any::{type_name, type_name_of_val};
use core::mem::{align_of, offset_of, size_of};

use fmi::fmi2::binding;
use geartrain::fmi2::abi;
use geartrain::fmi2::exports::{capabilities::*, common::*, state::*, stepping::*, variables::*};
use importers::functions::Functions;

/// The exported functions: that this compiles is the proof that the raw host calls them by their types.
const EXPORTED: Functions = Functions {
    get_types_platform: fmi2GetTypesPlatform,
    get_version: fmi2GetVersion,
    set_debug_logging: fmi2SetDebugLogging,
    instantiate: fmi2Instantiate,
    free_instance: fmi2FreeInstance,
    setup_experiment: fmi2SetupExperiment,
    enter_initialization_mode: fmi2EnterInitializationMode,
    exit_initialization_mode: fmi2ExitInitializationMode,
    terminate: fmi2Terminate,
    reset: fmi2Reset,
    get_real: fmi2GetReal,
    get_integer: fmi2GetInteger,
    get_boolean: fmi2GetBoolean,
    get_string: fmi2GetString,
    set_real: fmi2SetReal,
    set_integer: fmi2SetInteger,
    set_boolean: fmi2SetBoolean,
    set_string: fmi2SetString,
    get_state: fmi2GetFMUstate,
    set_state: fmi2SetFMUstate,
    free_state: fmi2FreeFMUstate,
    serialized_size: fmi2SerializedFMUstateSize,
    serialize: fmi2SerializeFMUstate,
    deserialize: fmi2DeSerializeFMUstate,
    get_directional_derivative: fmi2GetDirectionalDerivative,
    set_real_input_derivatives: fmi2SetRealInputDerivatives,
    get_real_output_derivatives: fmi2GetRealOutputDerivatives,
    do_step: fmi2DoStep,
    cancel_step: fmi2CancelStep,
    get_status: fmi2GetStatus,
    get_real_status: fmi2GetRealStatus,
    get_integer_status: fmi2GetIntegerStatus,
    get_boolean_status: fmi2GetBooleanStatus,
    get_string_status: fmi2GetStringStatus,
};

/// A signature in words that do not depend on who declares it.
fn normalized(signature: &str) -> String {
    let option = "core::option::Option<";
    let bare = signature
        .strip_prefix(option)
        .and_then(|rest| rest.strip_suffix('>'));
    bare.unwrap_or(signature)
        .replace("geartrain::fmi2::abi::CallbackFunctions", "Callbacks")
        .replace("fmi_sys::fmi2::fmi2CallbackFunctions", "Callbacks")
        // The signedness of enumerations is the compiler's choice in C and makes no difference in a call.
        .replace("geartrain::fmi2::abi::Status", "i32")
        .replace("u32", "i32")
}

/// Compares the standard's type of a function with ours.
#[track_caller]
fn same<Standard, Ours>(ours: &Ours) {
    let ours = normalized(type_name_of_val(ours));
    assert_eq!(ours, normalized(type_name::<Standard>()));
    assert!(ours.contains("extern \"C\" fn("), "{ours}");
}

#[test]
fn functions_have_the_signatures_of_the_standard() {
    use binding::*;
    same::<fmi2GetTypesPlatformTYPE, _>(&EXPORTED.get_types_platform);
    same::<fmi2GetVersionTYPE, _>(&EXPORTED.get_version);
    same::<fmi2SetDebugLoggingTYPE, _>(&EXPORTED.set_debug_logging);
    same::<fmi2InstantiateTYPE, _>(&EXPORTED.instantiate);
    same::<fmi2FreeInstanceTYPE, _>(&EXPORTED.free_instance);
    same::<fmi2SetupExperimentTYPE, _>(&EXPORTED.setup_experiment);
    same::<fmi2EnterInitializationModeTYPE, _>(&EXPORTED.enter_initialization_mode);
    same::<fmi2ExitInitializationModeTYPE, _>(&EXPORTED.exit_initialization_mode);
    same::<fmi2TerminateTYPE, _>(&EXPORTED.terminate);
    same::<fmi2ResetTYPE, _>(&EXPORTED.reset);
    same::<fmi2GetRealTYPE, _>(&EXPORTED.get_real);
    same::<fmi2GetIntegerTYPE, _>(&EXPORTED.get_integer);
    same::<fmi2GetBooleanTYPE, _>(&EXPORTED.get_boolean);
    same::<fmi2GetStringTYPE, _>(&EXPORTED.get_string);
    same::<fmi2SetRealTYPE, _>(&EXPORTED.set_real);
    same::<fmi2SetIntegerTYPE, _>(&EXPORTED.set_integer);
    same::<fmi2SetBooleanTYPE, _>(&EXPORTED.set_boolean);
    same::<fmi2SetStringTYPE, _>(&EXPORTED.set_string);
    same::<fmi2GetFMUstateTYPE, _>(&EXPORTED.get_state);
    same::<fmi2SetFMUstateTYPE, _>(&EXPORTED.set_state);
    same::<fmi2FreeFMUstateTYPE, _>(&EXPORTED.free_state);
    same::<fmi2SerializedFMUstateSizeTYPE, _>(&EXPORTED.serialized_size);
    same::<fmi2SerializeFMUstateTYPE, _>(&EXPORTED.serialize);
    same::<fmi2DeSerializeFMUstateTYPE, _>(&EXPORTED.deserialize);
    same::<fmi2GetDirectionalDerivativeTYPE, _>(&EXPORTED.get_directional_derivative);
    same::<fmi2SetRealInputDerivativesTYPE, _>(&EXPORTED.set_real_input_derivatives);
    same::<fmi2GetRealOutputDerivativesTYPE, _>(&EXPORTED.get_real_output_derivatives);
    same::<fmi2DoStepTYPE, _>(&EXPORTED.do_step);
    same::<fmi2CancelStepTYPE, _>(&EXPORTED.cancel_step);
    same::<fmi2GetStatusTYPE, _>(&EXPORTED.get_status);
    same::<fmi2GetRealStatusTYPE, _>(&EXPORTED.get_real_status);
    same::<fmi2GetIntegerStatusTYPE, _>(&EXPORTED.get_integer_status);
    same::<fmi2GetBooleanStatusTYPE, _>(&EXPORTED.get_boolean_status);
    same::<fmi2GetStringStatusTYPE, _>(&EXPORTED.get_string_status);
}

#[test]
fn callbacks_have_the_signatures_of_the_standard() {
    same::<binding::fmi2CallbackLogger, _>(&None::<abi::Logger>);
    same::<binding::fmi2CallbackAllocateMemory, _>(&None::<abi::AllocateMemory>);
    same::<binding::fmi2CallbackFreeMemory, _>(&None::<abi::FreeMemory>);
    same::<binding::fmi2StepFinished, _>(&None::<abi::StepFinished>);
}

fn layout<T>() -> (usize, usize) {
    (size_of::<T>(), align_of::<T>())
}

#[test]
fn types_have_the_size_and_alignment_of_the_standard() {
    assert_eq!(
        layout::<abi::Component>(),
        layout::<binding::fmi2Component>()
    );
    assert_eq!(
        layout::<abi::ComponentEnvironment>(),
        layout::<binding::fmi2ComponentEnvironment>()
    );
    assert_eq!(layout::<abi::FmuState>(), layout::<binding::fmi2FMUstate>());
    assert_eq!(
        layout::<abi::ValueReference>(),
        layout::<binding::fmi2ValueReference>()
    );
    assert_eq!(layout::<abi::Real>(), layout::<binding::fmi2Real>());
    assert_eq!(layout::<abi::Integer>(), layout::<binding::fmi2Integer>());
    assert_eq!(layout::<abi::Boolean>(), layout::<binding::fmi2Boolean>());
    assert_eq!(layout::<abi::CString>(), layout::<binding::fmi2String>());
    assert_eq!(layout::<abi::Byte>(), layout::<binding::fmi2Byte>());
    assert_eq!(layout::<abi::Type>(), layout::<binding::fmi2Type>());
    assert_eq!(layout::<abi::Status>(), layout::<binding::fmi2Status>());
    assert_eq!(
        layout::<abi::StatusKind>(),
        layout::<binding::fmi2StatusKind>()
    );
}

#[test]
fn the_callbacks_struct_is_laid_out_as_in_the_standard() {
    type Ours = abi::CallbackFunctions;
    type Standard = binding::fmi2CallbackFunctions;
    assert_eq!(layout::<Ours>(), layout::<Standard>());
    assert_eq!(offset_of!(Ours, logger), offset_of!(Standard, logger));
    assert_eq!(
        offset_of!(Ours, allocate_memory),
        offset_of!(Standard, allocateMemory)
    );
    assert_eq!(
        offset_of!(Ours, free_memory),
        offset_of!(Standard, freeMemory)
    );
    assert_eq!(
        offset_of!(Ours, step_finished),
        offset_of!(Standard, stepFinished)
    );
    assert_eq!(
        offset_of!(Ours, component_environment),
        offset_of!(Standard, componentEnvironment)
    );
}

#[test]
fn constants_and_enumerations_have_the_values_of_the_standard() {
    let same = |ours: i32, standard: u32| assert_eq!(u32::try_from(ours), Ok(standard));
    same(abi::TRUE, binding::fmi2True);
    same(abi::FALSE, binding::fmi2False);
    same(abi::CO_SIMULATION, binding::fmi2Type_fmi2CoSimulation);
    same(
        abi::LAST_SUCCESSFUL_TIME,
        binding::fmi2StatusKind_fmi2LastSuccessfulTime,
    );
    same(abi::TERMINATED, binding::fmi2StatusKind_fmi2Terminated);
    same(abi::Status::Ok as i32, binding::fmi2Status_fmi2OK);
    same(abi::Status::Warning as i32, binding::fmi2Status_fmi2Warning);
    same(abi::Status::Discard as i32, binding::fmi2Status_fmi2Discard);
    same(abi::Status::Error as i32, binding::fmi2Status_fmi2Error);
    same(abi::Status::Fatal as i32, binding::fmi2Status_fmi2Fatal);
    same(abi::Status::Pending as i32, binding::fmi2Status_fmi2Pending);
}
