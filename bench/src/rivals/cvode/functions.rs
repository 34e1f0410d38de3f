//! The functions of SUNDIALS 6 that are used, from the prototypes of its manual: double precision and 64-bit indices, its defaults.

use core::ffi::{c_int, c_long, c_void};

use libloading::Library;

/// The library that has all of them (Debian: package libsundials-cvode6).
const LIBRARY: &str = "libsundials_cvode.so.6";

/// N_Vector, SUNMatrix, SUNLinearSolver, SUNNonlinearSolver, SUNContext and CVODE's memory alike.
pub type Handle = *mut c_void;
/// CVRhsFn
pub type Derivative = unsafe extern "C" fn(f64, Handle, Handle, *mut c_void) -> c_int;
/// CVLsJacFn
pub type Jacobian =
    unsafe extern "C" fn(f64, Handle, Handle, Handle, *mut c_void, Handle, Handle, Handle) -> c_int;

macro_rules! functions {
    ($($field:ident = $symbol:literal ($($argument:ty),*) $(-> $result:ty)?;)*) => {
        /// The functions, and what keeps them callable.
        pub struct Functions {
            $(pub $field: unsafe extern "C" fn($($argument),*) $(-> $result)?,)*
            _library: Library,
        }

        impl Functions {
            /// Loads the library; words where it is not there.
            pub fn load() -> Result<Functions, String> {
                // SAFETY: loading SUNDIALS runs nothing of ours.
                let library = unsafe { Library::new(LIBRARY) };
                let library = library.map_err(|_| format!("skipped: no {LIBRARY}"))?;
                // SAFETY: the types are those of the manual.
                unsafe {
                    Ok(Functions {
                        $($field: *library.get($symbol).map_err(|error| error.to_string())?,)*
                        _library: library,
                    })
                }
            }
        }
    };
}

functions! {
    context = b"SUNContext_Create" (*mut c_void, *mut Handle) -> c_int;
    vector = b"N_VNew_Serial" (i64, Handle) -> Handle;
    entries = b"N_VGetArrayPointer" (Handle) -> *mut f64;
    matrix = b"SUNDenseMatrix" (i64, i64, Handle) -> Handle;
    column = b"SUNDenseMatrix_Column" (Handle, i64) -> *mut f64;
    linear_solver = b"SUNLinSol_Dense" (Handle, Handle, Handle) -> Handle;
    fixed_point = b"SUNNonlinSol_FixedPoint" (Handle, c_int, Handle) -> Handle;
    create = b"CVodeCreate" (c_int, Handle) -> Handle;
    init = b"CVodeInit" (Handle, Derivative, f64, Handle) -> c_int;
    set_tolerances = b"CVodeSVtolerances" (Handle, f64, Handle) -> c_int;
    set_user_data = b"CVodeSetUserData" (Handle, *mut c_void) -> c_int;
    set_most_steps = b"CVodeSetMaxNumSteps" (Handle, c_long) -> c_int;
    set_linear_solver = b"CVodeSetLinearSolver" (Handle, Handle, Handle) -> c_int;
    set_jacobian = b"CVodeSetJacFn" (Handle, Jacobian) -> c_int;
    set_nonlinear_solver = b"CVodeSetNonlinearSolver" (Handle, Handle) -> c_int;
    advance = b"CVode" (Handle, f64, Handle, *mut f64, c_int) -> c_int;
    steps = b"CVodeGetNumSteps" (Handle, *mut c_long) -> c_int;
    free = b"CVodeFree" (*mut Handle);
    free_vector = b"N_VDestroy" (Handle);
    free_matrix = b"SUNMatDestroy" (Handle);
    free_linear_solver = b"SUNLinSolFree" (Handle) -> c_int;
    free_nonlinear_solver = b"SUNNonlinSolFree" (Handle) -> c_int;
    free_context = b"SUNContext_Free" (*mut Handle) -> c_int;
}
