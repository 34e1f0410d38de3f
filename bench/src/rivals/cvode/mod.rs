//! CVODE of SUNDIALS, where it is installed: BDF with Newton's method, dense matrices and the exact Jacobian, and Adams with
//! fixed-point iteration, as its manual recommends for stiff problems and for others.

#![allow(unsafe_code)] // calls a C library

mod functions;

use core::ffi::{c_int, c_long, c_void};
use core::ptr;
use core::slice::from_raw_parts_mut;
use std::time::Instant;

use crate::equations::Equations;
use crate::problem::{Problem, Run};
use functions::{Functions, Handle};

/// itask: return at the time asked for, interpolated.
const NORMAL: c_int = 1;
/// Most internal steps between two times.
const MOST_STEPS: c_long = 10_000_000;

/// The family of formulas, with SUNDIALS' numbers.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Formulas {
    /// Adams-Moulton.
    Adams = 1,
    /// Backward differentiation.
    Bdf = 2,
}

/// What the callbacks get.
struct Callback<'a> {
    equations: &'a Equations,
    functions: &'a Functions,
}

/// A solver with everything that it points to; freed when dropped.
struct Solver<'a> {
    functions: &'a Functions,
    context: Handle,
    memory: Handle,
    x: Handle,
    bounds: Handle,
    matrix: Handle,
    linear: Handle,
    nonlinear: Handle,
}

/// Steps such that the estimated error of each stays below `tolerance` times the size of x; words for why not.
pub fn run(problem: &Problem, formulas: Formulas, tolerance: f64) -> Result<Run, String> {
    let functions = Functions::load()?;
    let equations = &problem.equations;
    let callback = Callback {
        equations,
        functions: &functions,
    };
    let clock = Instant::now();
    let solver = Solver::new(&callback, problem, formulas, tolerance)?;
    let mut forces = Vec::new();
    for &time in &problem.times {
        let mut reached = 0.0;
        // SAFETY: the solver's handles are alive, and so is the callback.
        let flag =
            unsafe { (functions.advance)(solver.memory, time, solver.x, &raw mut reached, NORMAL) };
        done("CVode", flag)?;
        // SAFETY: the vector is alive, and nobody writes to it here.
        let x = unsafe { entries(&functions, solver.x, equations.order()) };
        forces.extend(equations.mesh_forces(time, x));
    }
    let seconds = clock.elapsed().as_secs_f64();
    let mut steps = 0;
    // SAFETY: the solver is alive.
    let flag = unsafe { (functions.steps)(solver.memory, &raw mut steps) };
    done("CVodeGetNumSteps", flag)?;
    Ok(Run {
        forces,
        seconds,
        steps: steps.unsigned_abs(),
    })
}

impl<'a> Solver<'a> {
    fn new(
        callback: &'a Callback<'a>,
        problem: &Problem,
        formulas: Formulas,
        tolerance: f64,
    ) -> Result<Solver<'a>, String> {
        let f = callback.functions;
        let (size, none) = (problem.start.len(), ptr::null_mut());
        let length = size as i64;
        let mut context = none;
        // SAFETY: handles come from the library itself and live as long as the solver made of them; so does what the
        // callback points to.
        unsafe {
            done("SUNContext_Create", (f.context)(none, &raw mut context))?;
            let [x, bounds] = [(); 2].map(|()| (f.vector)(length, context));
            let solver = Solver {
                functions: f,
                context,
                memory: (f.create)(formulas as c_int, context),
                x,
                bounds,
                matrix: if formulas == Formulas::Bdf {
                    (f.matrix)(length, length, context)
                } else {
                    none
                },
                linear: none,
                nonlinear: none,
            };
            entries(f, x, size).copy_from_slice(&problem.start);
            for (bound, scale) in entries(f, bounds, size).iter_mut().zip(&problem.scale) {
                *bound = tolerance * scale;
            }
            let memory = solver.memory;
            let data = ptr::from_ref(callback).cast_mut().cast();
            done("CVodeInit", (f.init)(memory, derivative, 0.0, x))?;
            done(
                "CVodeSVtolerances",
                (f.set_tolerances)(memory, tolerance, bounds),
            )?;
            done("CVodeSetUserData", (f.set_user_data)(memory, data))?;
            done(
                "CVodeSetMaxNumSteps",
                (f.set_most_steps)(memory, MOST_STEPS),
            )?;
            solver.with_iteration(formulas)
        }
    }

    /// # Safety
    /// The solver's handles are alive.
    unsafe fn with_iteration(mut self, formulas: Formulas) -> Result<Solver<'a>, String> {
        let f = self.functions;
        // SAFETY: the caller's promise.
        unsafe {
            match formulas {
                Formulas::Bdf => {
                    self.linear = (f.linear_solver)(self.x, self.matrix, self.context);
                    let flag = (f.set_linear_solver)(self.memory, self.linear, self.matrix);
                    done("CVodeSetLinearSolver", flag)?;
                    done("CVodeSetJacFn", (f.set_jacobian)(self.memory, jacobian))?;
                }
                Formulas::Adams => {
                    self.nonlinear = (f.fixed_point)(self.x, 0, self.context);
                    let flag = (f.set_nonlinear_solver)(self.memory, self.nonlinear);
                    done("CVodeSetNonlinearSolver", flag)?;
                }
            }
        }
        Ok(self)
    }
}

impl Drop for Solver<'_> {
    fn drop(&mut self) {
        let f = self.functions;
        // SAFETY: the handles are alive or NULL, and this is the last use of each.
        unsafe {
            (f.free)(&raw mut self.memory);
            if !self.linear.is_null() {
                (f.free_linear_solver)(self.linear);
                (f.free_matrix)(self.matrix);
            }
            if !self.nonlinear.is_null() {
                (f.free_nonlinear_solver)(self.nonlinear);
            }
            (f.free_vector)(self.x);
            (f.free_vector)(self.bounds);
            (f.free_context)(&raw mut self.context);
        }
    }
}

/// The entries of a vector.
///
/// # Safety
/// The vector is alive, has so many entries, and nobody else uses them meanwhile.
unsafe fn entries<'v>(functions: &Functions, vector: Handle, size: usize) -> &'v mut [f64] {
    // SAFETY: the caller's promise.
    unsafe { from_raw_parts_mut((functions.entries)(vector), size) }
}

/// f(t, x).
///
/// # Safety
/// Called by CVODE: vectors are alive and different, the data is the callback.
unsafe extern "C" fn derivative(time: f64, x: Handle, result: Handle, data: *mut c_void) -> c_int {
    // SAFETY: the caller's promise.
    unsafe {
        let Callback {
            equations,
            functions,
        } = &*data.cast::<Callback<'_>>();
        let x = entries(functions, x, equations.order());
        equations.evaluate(time, x, entries(functions, result, equations.order()));
    }
    0
}

/// df/dx.
///
/// # Safety
/// As [`derivative`]; the matrix is dense.
unsafe extern "C" fn jacobian(
    time: f64,
    _x: Handle,
    _derivative: Handle,
    matrix: Handle,
    data: *mut c_void,
    _: Handle,
    _: Handle,
    _: Handle,
) -> c_int {
    // SAFETY: the caller's promise.
    unsafe {
        let Callback {
            equations,
            functions,
        } = &*data.cast::<Callback<'_>>();
        for column in 0..equations.order() {
            let target = (functions.column)(matrix, column as i64);
            let target = from_raw_parts_mut(target, equations.order());
            target.copy_from_slice(&equations.jacobian_column(time, column));
        }
    }
    0
}

/// An error for a flag that is negative.
fn done(call: &str, flag: c_int) -> Result<(), String> {
    if flag < 0 {
        Err(format!("{call} gives {flag}"))
    } else {
        Ok(())
    }
}
