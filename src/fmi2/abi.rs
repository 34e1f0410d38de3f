//! The types of the FMI 2.0 C interface that this slave uses (fmi2TypesPlatform.h, fmi2FunctionTypes.h),
//! written from the standard's tables. `tests/importers` compares them with an independent binding.

use core::ffi::{c_char, c_int, c_uint, c_void};

/// fmi2Component: what the master holds of an instance.
pub type Component = *mut c_void;
/// fmi2ComponentEnvironment: belongs to the master, handed back to it unread.
pub type ComponentEnvironment = *mut c_void;
/// fmi2FMUstate.
pub type FmuState = *mut c_void;
/// fmi2ValueReference.
pub type ValueReference = c_uint;
/// fmi2Real.
pub type Real = f64;
/// fmi2Integer.
pub type Integer = c_int;
/// fmi2Boolean: zero is false, everything else true.
pub type Boolean = c_int;
/// fmi2String.
pub type CString = *const c_char;
/// fmi2Byte.
pub type Byte = c_char;

/// fmi2True.
pub const TRUE: Boolean = 1;
/// fmi2False.
pub const FALSE: Boolean = 0;

/// fmi2Type.
pub type Type = c_int;
/// fmi2CoSimulation.
pub const CO_SIMULATION: Type = 1;

/// fmi2Status.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(C)]
pub enum Status {
    /// fmi2OK
    Ok = 0,
    /// fmi2Warning
    Warning = 1,
    /// fmi2Discard
    Discard = 2,
    /// fmi2Error
    Error = 3,
    /// fmi2Fatal
    Fatal = 4,
    /// fmi2Pending
    Pending = 5,
}

/// fmi2StatusKind, as the number that the master sends.
pub type StatusKind = c_int;
/// fmi2LastSuccessfulTime.
pub const LAST_SUCCESSFUL_TIME: StatusKind = 2;
/// fmi2Terminated.
pub const TERMINATED: StatusKind = 3;

/// fmi2CallbackLogger.
pub type Logger = unsafe extern "C" fn(
    environment: ComponentEnvironment,
    instance_name: CString,
    status: Status,
    category: CString,
    message: CString,
    ...
);
/// fmi2CallbackAllocateMemory; never called.
pub type AllocateMemory = unsafe extern "C" fn(count: usize, size: usize) -> *mut c_void;
/// fmi2CallbackFreeMemory; never called.
pub type FreeMemory = unsafe extern "C" fn(memory: *mut c_void);
/// fmi2StepFinished; never called, steps are synchronous.
pub type StepFinished = unsafe extern "C" fn(environment: ComponentEnvironment, status: Status);

/// fmi2CallbackFunctions.
#[derive(Debug, Clone, Copy)]
#[repr(C)]
pub struct CallbackFunctions {
    /// Takes messages; may be NULL.
    pub logger: Option<Logger>,
    /// May be NULL.
    pub allocate_memory: Option<AllocateMemory>,
    /// May be NULL.
    pub free_memory: Option<FreeMemory>,
    /// May be NULL.
    pub step_finished: Option<StepFinished>,
    /// May be NULL.
    pub component_environment: ComponentEnvironment,
}
