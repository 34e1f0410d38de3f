//! Nothing is allocated inside a step.

#![allow(unsafe_code)] // a counting allocator cannot be written without

mod support;

use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;

use support::{case_four, started};

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
        simulation.inputs_mut().torques[0] += 1.0;
        let end = 2e-5 * f64::from(index) + 1e-6 * f64::from(index % 7);
        simulation.advance_to(end).unwrap();
        sum += simulation.motion().mesh_force(0);
    }
    assert_eq!(ALLOCATIONS.get() - before, 0);
    assert!(sum.is_finite() && simulation.counts().factorizations > 10);
}
