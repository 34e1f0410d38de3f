//! Nothing is allocated inside a step.

#![allow(unsafe_code)] // a counting allocator cannot be written without

mod support;

use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;

use geartrain::config::SolverChoice;
use geartrain::simulation::Simulation;
use support::{assembled, case_four, file_inputs, started, valid};

struct Counting;

thread_local! {
    static ALLOCATIONS: Cell<u64> = const { Cell::new(0) };
}

// SAFETY: every call is handed on unchanged to the system's allocator.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        ALLOCATIONS.set(ALLOCATIONS.get() + 1);
        // SAFETY: the caller's promise.
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        // SAFETY: the caller's promise.
        unsafe { System.dealloc(pointer, layout) }
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

#[test]
fn steps_inputs_and_outputs_allocate_nothing() {
    let mut simulation = started(&case_four(), 1e-4);
    let before = ALLOCATIONS.get();
    let mut sum = 0.0;
    // Communication steps of many lengths: new step operators are computed in place, too.
    for index in 1..=200 {
        simulation.inputs_mut().torques_mut()[0] += 1.0;
        let end = 2e-5 * f64::from(index) + 1e-6 * f64::from(index % 7);
        simulation.advance_to(end).unwrap();
        let motion = simulation.motion();
        // Displacements are put together when asked for.
        sum += motion.mesh_force(0) + motion.state.position()[0];
    }
    assert_eq!(ALLOCATIONS.get() - before, 0);
    assert!(sum.is_finite() && simulation.counts().factorizations > 10);
}

#[test]
fn steps_of_a_housing_that_knows_its_bearings_allocate_nothing() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/models/known_box.toml");
    let mut simulation = started(&std::fs::read_to_string(path).unwrap(), 1e-4);
    let mut rate = simulation.inputs().clone();
    rate.forces_mut()[0] = [2e4, -3e4];
    simulation.advance_to(1e-5).unwrap();
    let before = ALLOCATIONS.get();
    for index in 1..=100 {
        simulation.inputs_mut().forces_mut()[1][0] += 3.0;
        let end = 2e-5 * f64::from(index);
        simulation.advance_along(end, Some(&rate)).unwrap();
        assert!(simulation.motion().point_acceleration(0)[0].abs() > 0.0);
        assert!(simulation.carried().forces()[0][0].is_finite());
    }
    assert_eq!(ALLOCATIONS.get() - before, 0);
}

#[test]
fn impacts_free_rotation_and_radial_forces_allocate_nothing_either() {
    let names = [
        "rattle",
        "coast_down",
        "run_up",
        "rolling",
        "boxed",
        "boxed_journal",
    ];
    for name in names {
        let path = format!("{}/tests/models/{name}.toml", env!("CARGO_MANIFEST_DIR"));
        let text = std::fs::read_to_string(path).unwrap();
        for solver in [SolverChoice::Exponential, SolverChoice::Newmark] {
            let mut settings = valid(&text).config.simulation;
            (settings.solver, settings.tolerance) = (solver, 1e-4);
            let inputs = file_inputs(&text);
            let mut simulation =
                Simulation::start(assembled(&text), inputs, &settings, 0.0).unwrap();
            simulation.advance_to(1e-5).unwrap();
            let mut quiet = 0;
            for index in 1..=200 {
                let (before, refreshes) = (ALLOCATIONS.get(), simulation.counts().refreshes);
                simulation.advance_to(2e-5 * f64::from(index)).unwrap();
                assert!(simulation.motion().mesh_force(0).is_finite());
                if simulation.model().housing.is_some() {
                    assert!(simulation.motion().point_acceleration(0)[0].is_finite());
                }
                // Where the blocks follow the speed of a free rotation, they are taken apart anew before the step.
                if simulation.counts().refreshes == refreshes {
                    assert_eq!(ALLOCATIONS.get() - before, 0, "{name}, {solver:?}");
                    quiet += 1;
                }
            }
            assert!(quiet > 150, "{name}, {solver:?}: {quiet} of 200 calls");
        }
    }
}
