//! The same FMU gives the same bits on every machine.

use platforms::{Machine, Packed};

/// Communication step of the examples [ns].
const STEP: usize = 20_000;

/// Compares all machines with this one.
#[track_caller]
fn same_on_all_machines(fmu: &Packed, steps: usize) {
    let expected = Machine::Linux.run(fmu, STEP, steps);
    let numbers = expected.len() / 8;
    assert!(
        numbers > fmu.variables().len() * steps / 16,
        "everything was written"
    );
    for machine in Machine::ALL {
        let found = machine.run(fmu, STEP, steps);
        assert_eq!(found.len(), expected.len(), "{}: {machine:?}", fmu.name);
        let first = found.iter().zip(&expected).position(|(a, b)| a != b);
        assert_eq!(
            first, None,
            "{}: first different byte on {machine:?}",
            fmu.name
        );
    }
}

/// The example's whole experiment, 0.2 s.
#[test]
fn the_whole_example_has_the_same_bits_on_every_machine() {
    same_on_all_machines(&Packed::read("three_stage"), 10_000);
}

/// Contact, free spin, bearings by tables, internal gears: every law there is; and saved states.
#[test]
fn every_model_has_the_same_bits_on_every_machine() {
    for fmu in Packed::all() {
        same_on_all_machines(&fmu, 500);
    }
}
