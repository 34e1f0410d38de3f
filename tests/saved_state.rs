//! A saved state continues to the bit: in the same instance, in another one, and through its bytes.

#![allow(missing_docs)]

mod support;

use geartrain::interface::Causality;
use geartrain::slave::{Experiment, SavedState, Slave};
use support::slave::{born, read, references, stepping};
use support::{case_four, model_file, three_stage};

/// Contact losses, back flanks, changing speed: every kind of memory a solution can have.
fn free_and_rattling() -> String {
    three_stage()
        .replace("speed = \"prescribed\"", "speed = \"free\"")
        .replace(
            "contact = \"bilateral\"",
            "contact = \"unilateral\"\nbacklash = 2e-5",
        )
        .replace("slope = 0.5", "slope = 3.0")
}

fn newmark(text: &str) -> String {
    text.replace("[simulation]", "[simulation]\nsolver = \"newmark\"")
}

fn models() -> [String; 9] {
    [
        case_four(),
        free_and_rattling(),
        newmark(&case_four()),
        newmark(&free_and_rattling()),
        model_file("box.toml"),
        model_file("known_box.toml"),
        model_file("known_box.toml").replace(
            "known_bearings",
            "input_extrapolation = true\nknown_bearings",
        ),
        model_file("boxed.toml"),
        model_file("boxed_journal.toml"),
    ]
}

/// A slave in step mode; a housing is pushed, so that it moves.
fn running(text: &str) -> Slave {
    let (mut slave, interface) = stepping(text, 1e-4);
    let pushed = |input: &u32| {
        interface.variables[*input as usize]
            .name
            .ends_with(".force_x")
    };
    let mut forces = references(&interface, Causality::Input);
    forces.retain(pushed);
    slave.set_real(&forces, &vec![70.0; forces.len()]).unwrap();
    slave
}

/// The bits of all variables after each of the next steps.
fn steps(slave: &mut Slave, from: u32, count: u32) -> Vec<u64> {
    // As many as there are, up to 200.
    let exists = |reference: &u32| slave.get_real(&[*reference], &mut [0.0]).is_ok();
    let references: Vec<u32> = (0..200).take_while(exists).collect();
    let mut values = vec![0.0; references.len()];
    let mut bits = Vec::new();
    for index in from..from + count {
        slave.do_step(2e-5 * f64::from(index), 2e-5).unwrap();
        slave.get_real(&references, &mut values).unwrap();
        bits.extend(values.iter().map(|value| value.to_bits()));
    }
    bits
}

#[test]
fn a_saved_state_continues_to_the_bit_wherever_it_is_restored() {
    for text in models() {
        let mut slave = running(&text);
        steps(&mut slave, 0, 40);
        let saved = slave.save();
        let expected = steps(&mut slave, 40, 30);
        let end = slave.save();
        slave.restore(&saved).unwrap();
        assert_eq!(steps(&mut slave, 40, 30), expected, "in the same instance");
        assert_eq!(slave.save(), end);

        let bytes = saved.to_bytes();
        let mut other = born(&text);
        other
            .restore(&SavedState::from_bytes(&bytes).unwrap())
            .unwrap();
        assert_eq!(steps(&mut other, 40, 30), expected, "in another instance");
        assert_eq!(other.save(), end);
    }
}

#[test]
fn a_state_saved_right_before_an_event_continues_to_the_bit() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/models/rattle.toml");
    let rattle = std::fs::read_to_string(path).unwrap();
    for text in [newmark(&rattle), rattle] {
        let mut slave = running(&text);
        // So short that in some steps the first thing that happens is that teeth part or meet.
        let step = 1.7e-6;
        for index in 0..800 {
            let mut other = born(&text);
            other.restore(&slave.save()).unwrap();
            for one in [&mut slave, &mut other] {
                one.do_step(step * f64::from(index), step).unwrap();
            }
            assert_eq!(slave.save(), other.save(), "step {index}");
        }
    }
}

#[test]
fn speeds_that_follow_from_others_come_back_as_they_were_in_the_file() {
    // 420 x 23/71 = 136.05633802816902 as a number; the file says 136.056338028169.
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/models/reducer.toml");
    let text = std::fs::read_to_string(path).unwrap();
    let (mut slave, interface) = stepping(&text, 1e-4);
    let derived = |variable: &&geartrain::interface::Variable| {
        matches!(
            variable.quantity,
            geartrain::interface::Quantity::DerivedSpeed { .. }
        )
    };
    assert!(interface.variables.iter().find(derived).is_some());
    let all: Vec<u32> = (0..u32::try_from(interface.variables.len()).unwrap()).collect();
    let before = read(&mut slave, &all);
    let saved = slave.save();
    let mut other = born(&text);
    other.restore(&saved).unwrap();
    let bits = |values: &[f64]| {
        values
            .iter()
            .map(|value| value.to_bits())
            .collect::<Vec<_>>()
    };
    assert_eq!(bits(&read(&mut other, &all)), bits(&before));
}

#[test]
fn what_is_read_leaves_no_trace_in_a_saved_state() {
    for text in models() {
        let (mut curious, mut blind) = (running(&text), running(&text));
        let expected = steps(&mut curious, 0, 40);
        for index in 0..39 {
            blind.do_step(2e-5 * f64::from(index), 2e-5).unwrap();
        }
        assert_eq!(
            steps(&mut blind, 39, 1),
            expected[expected.len() / 40 * 39..]
        );
        // Neither of what is put together when asked for, nor of when that was.
        blind.do_step(2e-5 * 40.0, 2e-5).unwrap();
        steps(&mut curious, 40, 1);
        assert_eq!(blind.save().to_bytes(), curious.save().to_bytes());
    }
}

#[test]
fn what_was_restored_in_between_leaves_no_trace() {
    for text in models() {
        let mut slave = running(&text);
        let start = slave.save();
        steps(&mut slave, 0, 400); // so long that free rotors have changed their blocks
        let later = slave.save();
        slave.restore(&start).unwrap();
        let expected = steps(&mut running(&text), 0, 20);
        assert_eq!(steps(&mut slave, 0, 20), expected);
        slave.restore(&later).unwrap();
        steps(&mut slave, 400, 3);
        slave.restore(&start).unwrap();
        assert_eq!(steps(&mut slave, 0, 20), expected);
    }
}

#[test]
fn parameters_inputs_and_the_state_of_life_come_back() {
    let text = case_four();
    let mut slave = born(&text);
    let fresh = slave.save();
    let mut changed = running(&text);
    steps(&mut changed, 0, 5);
    changed.terminate();
    let terminated = changed.save();
    changed.restore(&fresh).unwrap();
    assert_eq!(changed.save(), fresh);
    // A fresh instance can be initialized and gives what a new one gives.
    let experiment = Experiment {
        tolerance: Some(1e-4),
        start: 0.0,
        stop: None,
    };
    changed.setup_experiment(experiment).unwrap();
    changed.enter_initialization().unwrap();
    changed.exit_initialization().unwrap();
    assert_eq!(steps(&mut changed, 0, 5), steps(&mut running(&text), 0, 5));
    changed.restore(&terminated).unwrap();
    assert!(changed.permit(geartrain::slave::Call::DoStep).is_err());
}

#[test]
fn a_state_of_another_model_changes_nothing() {
    let (mut slave, mut other) = (running(&case_four()), running(&free_and_rattling()));
    steps(&mut slave, 0, 3);
    let before = slave.save();
    assert!(slave.restore(&other.save()).is_err());
    assert_eq!(slave.save(), before);
}
