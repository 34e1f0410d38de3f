//! Inputs that change linearly in a step.
//!
//! Authority: closed form, and the same gearbox vibration given in the model file, which the solvers take exactly.

#![allow(clippy::disallowed_methods)] // tests compare with tolerances: the platform's sin will do

mod support;

use core::f64::consts::TAU;

use geartrain::config::SolverChoice;
use geartrain::interface::{Causality, Interface, Quantity, Variable};
use geartrain::model::{BaseMotion, Inputs};
use geartrain::slave::{SavedState, Slave};
use support::run::{RigidPair, Run, rigid_pair};
use support::slave::{initializing, read, references, stepping};
use support::{assembled, file_inputs, gear_pair, rms, rms_difference, three_stage};

const LAW: &str = "law = \"constant\"\nmean = 1e8";
const SOLVERS: [SolverChoice; 2] = [SolverChoice::Exponential, SolverChoice::Newmark];

#[test]
fn teeth_follow_a_torque_that_grows_linearly() {
    // m delta'' + k delta = f t with f = m T' R_a / J_a:   delta = (f/k) (t - sin(w t)/w).
    let text = rigid_pair(
        "start = \"rest\"",
        0.0,
        [(0.0, 0.0), (0.0, 0.0)],
        "damping_ratio = 0.0",
        LAW,
    );
    let (rate, end) = (1e5, 2e-3);
    let mass = RigidPair::mass();
    let frequency = (1e8 / mass).sqrt();
    let force = mass * rate * RigidPair::RADIUS[0] / RigidPair::INERTIA[0];
    let exact = force / 1e8 * (end - (frequency * end).sin() / frequency);
    for solver in SOLVERS {
        let mut run = Run::new(assembled(&text), &[0.0, 0.0], solver, 1e-8);
        let ramp = run.model.inputs_at_rest(&[rate, 0.0]);
        run.advance_along(end, Some(&ramp));
        let found = run.motion().mesh_deflection(0);
        // 1e-6: the tolerance over the 1.2 vibrations of the run, and margin.
        assert!(
            (found / exact - 1.0).abs() < 1e-6,
            "{solver:?}: {found}, exact {exact}"
        );
    }
}

#[test]
fn a_rotor_turns_faster_with_the_square_of_time_under_a_growing_torque() {
    // Om = Om_0 + T' t^2 / (2 J_reduced), once the teeth have stopped ringing; a shift of T'/(k R^2..) stays below 1e-5.
    let text = rigid_pair(
        "speed = \"free\"\nstart = \"rest\"",
        0.0,
        [(0.0, 0.0), (0.0, 0.0)],
        "damping_ratio = 0.2",
        LAW,
    );
    let [one, two] = RigidPair::INERTIA;
    let reduced = one + 0.25 * two;
    for solver in SOLVERS {
        let mut run = Run::new(assembled(&text), &[0.0, 0.0], solver, 1e-7);
        let ramp = run.model.inputs_at_rest(&[200.0, 0.0]);
        run.advance_along(0.25, Some(&ramp));
        let exact = 200.0 * 0.25 * 0.25 / (2.0 * reduced);
        let found = run.motion().speed(0);
        assert!(
            (found / exact - 1.0).abs() < 1e-4,
            "{solver:?}: {found}, exact {exact}"
        );
    }
}

/// A gearbox vibration of 1200 Hz, 20 um, in x and y.
const VIBRATION: (f64, f64) = (1200.0, 2e-5);

fn base_at(time: f64) -> BaseMotion {
    let (frequency, amplitude) = VIBRATION;
    let w = TAU * frequency;
    let (sine, cosine) = (w * time).sin_cos();
    BaseMotion {
        displacement: [amplitude * sine; 2],
        velocity: [amplitude * w * cosine; 2],
    }
}

fn times(base: BaseMotion, factor: f64) -> BaseMotion {
    BaseMotion {
        displacement: base.displacement.map(|value| factor * value),
        velocity: base.velocity.map(|value| factor * value),
    }
}

/// How the inputs get from one motion of the gearbox to the next.
fn secant(from: BaseMotion, to: BaseMotion, step: f64) -> BaseMotion {
    let difference = |to: [f64; 2], from: [f64; 2]| [to[0] - from[0], to[1] - from[1]];
    let change = BaseMotion {
        displacement: difference(to.displacement, from.displacement),
        velocity: difference(to.velocity, from.velocity),
    };
    times(change, 1.0 / step)
}

/// Mesh and bearing forces at the communication points of 0.03 s, under the vibration as inputs, held or linear, or in the
/// file.
fn forces(solver: SolverChoice, step: f64, linear: Option<bool>) -> [Vec<f64>; 2] {
    let mut text = three_stage().replace("phase_y = 1.5707963267948966", "phase_y = 0.0");
    if linear.is_none() {
        text = text.replace("amplitude_x = 0.0", "amplitude_x = 2e-5");
        text = text.replace("amplitude_y = 0.0", "amplitude_y = 2e-5");
    }
    let model = assembled(&text);
    let mut run = Run::new(model, file_inputs(&text).torques(), solver, 1e-7);
    let bearings = run.inputs.bases().len();
    let torques = run.inputs.torques().to_vec();
    let count = (0.03 / step).round() as usize;
    let mut found = [Vec::new(), Vec::new()];
    for index in 0..count {
        let [now, next] = [index, index + 1].map(|index| base_at(step * index as f64));
        if linear.is_some() {
            run.inputs = Inputs::new(&torques, &vec![now; bearings], &[]);
        }
        let moving = vec![secant(now, next, step); bearings];
        let rate = Inputs::new(&vec![0.0; torques.len()], &moving, &[]);
        let rate = (linear == Some(true)).then_some(&rate);
        run.advance_along(step * (index + 1) as f64, rate);
        if linear.is_some() {
            run.inputs = Inputs::new(&torques, &vec![next; bearings], &[]);
        }
        let motion = run.motion();
        found[0].push(motion.mesh_force(0));
        let bearing = &motion.model.rotors[1].bearings[0];
        let input = motion.model.rotors[0].bearings.len();
        found[1].push(motion.bearing_force(1, bearing, input)[0]);
    }
    found
}

#[test]
fn linear_inputs_follow_a_vibration_of_the_gearbox_in_second_order() {
    let error = |step: f64, linear: bool| {
        let solver = SolverChoice::Exponential;
        let (exact, found) = (
            forces(solver, step, None),
            forces(solver, step, Some(linear)),
        );
        [0, 1].map(|i| {
            let mean = exact[i].iter().sum::<f64>() / exact[i].len() as f64;
            let alternating: Vec<f64> = exact[i].iter().map(|value| value - mean).collect();
            rms_difference(&exact[i], &found[i]) / rms(&alternating)
        })
    };
    let (held, linear, finer) = (error(2e-5, false), error(2e-5, true), error(1e-5, true));
    for i in 0..2 {
        // A chord misses a sine by (w h)^2/12 = 1.9e-3 at the most, a held value by w h/2 = 7.5e-2.
        assert!(
            linear[i] < 3e-3 && held[i] > 10.0 * linear[i],
            "{held:?} {linear:?}"
        );
        let order = (linear[i] / finer[i]).log2();
        assert!((order - 2.0).abs() < 0.2, "order {order}");
    }
}

#[test]
fn both_solvers_agree_on_linear_inputs() {
    let [one, two] = SOLVERS.map(|solver| forces(solver, 5e-5, Some(true)));
    for i in 0..2 {
        // Their tolerance is 1e-7; that of newmark is an estimate (docs/model-file.md).
        assert!(rms_difference(&one[i], &two[i]) < 1e-5 * rms(&one[i]));
    }
}

/// Reference and rate of an input of the three-stage example: the first torque.
fn torque_of(interface: &Interface) -> u32 {
    let is_torque = |variable: &Variable| variable.quantity == Quantity::Torque { torque: 0 };
    let place = interface.variables.iter().position(is_torque);
    u32::try_from(place.expect("the example has torques")).unwrap()
}

#[test]
fn an_input_has_its_last_value_after_the_step_and_is_held_from_then_on() {
    let (mut slave, interface) = stepping(&three_stage(), 1e-4);
    let torque = torque_of(&interface);
    let value = |slave: &mut Slave| read(slave, &[torque])[0];
    let first = value(&mut slave);
    slave
        .set_input_derivatives(&[torque], &[1], &[1e6])
        .unwrap();
    slave.do_step(0.0, 2e-5).unwrap();
    assert_eq!(value(&mut slave), first + 2e-5 * 1e6);
    slave.do_step(2e-5, 2e-5).unwrap();
    assert_eq!(value(&mut slave), first + 2e-5 * 1e6);
    slave.reset();
    assert_eq!(value(&mut slave), first);
}

#[test]
fn derivatives_of_inputs_are_part_of_the_state() {
    let (mut slave, interface) = stepping(&three_stage(), 1e-4);
    let torque = torque_of(&interface);
    slave
        .set_input_derivatives(&[torque], &[1], &[1e6])
        .unwrap();
    let saved = SavedState::from_bytes(&slave.save().to_bytes()).unwrap();
    slave.do_step(0.0, 2e-5).unwrap();
    let expected = slave.save();
    let (mut other, _) = stepping(&three_stage(), 1e-4);
    other.restore(&saved).unwrap();
    other.do_step(0.0, 2e-5).unwrap();
    assert_eq!(other.save(), expected);
    // Without them the same step leads elsewhere.
    let (mut held, _) = stepping(&three_stage(), 1e-4);
    held.do_step(0.0, 2e-5).unwrap();
    assert_ne!(held.save(), expected);
}

#[test]
fn derivatives_of_inputs_are_refused_with_reasons_and_then_none_is_kept() {
    let (mut slave, interface) = stepping(&three_stage(), 1e-4);
    let torque = torque_of(&interface);
    let output = references(&interface, Causality::Output)[0];
    let before = slave.save();
    for (reference, order, value, words) in [
        (torque, 0, 1.0, "order"),
        (torque, 2, 1.0, "order"),
        (torque, 1, f64::NAN, "finite"),
        (torque, 1, f64::INFINITY, "finite"),
        (output, 1, 1.0, "no input"),
        (u32::MAX, 1, 1.0, "unknown"),
    ] {
        let result = slave.set_input_derivatives(&[torque, reference], &[1, order], &[1.0, value]);
        let message = result.unwrap_err().to_string();
        assert!(message.contains(words), "{message}");
        assert_eq!(slave.save(), before);
    }
}

/// What a slave finds for a bearing force while its housing shakes at 400 Hz, sampled every 20 us; with `extrapolate` its
/// inputs are continued, with `derivatives` the master gives those of the next step.
fn shaken(extrapolate: f64, derivatives: bool) -> Vec<f64> {
    let (mut slave, interface) =
        initializing(&gear_pair(4, "law = \"constant\"\nmean = 4e8", ""), 1e-8);
    let named = |name: &str| {
        let place = interface.variables.iter().position(|one| one.name == name);
        u32::try_from(place.unwrap()).unwrap()
    };
    slave
        .set_real(&[named("simulation.input_extrapolation")], &[extrapolate])
        .unwrap();
    slave.exit_initialization().unwrap();
    let inputs = ["one.left.housing.x", "one.left.housing.vx"].map(named);
    let force = named("one.left.force_x");
    let (step, w) = (2e-5, TAU * 400.0);
    let motion = |time: f64| [1e-5 * (w * time).sin(), 1e-5 * w * (w * time).cos()];
    let mut forces = Vec::new();
    for index in 0..500 {
        let time = step * f64::from(index);
        let (now, next) = (motion(time), motion(time + step));
        slave.set_real(&inputs, &now).unwrap();
        forces.push(read(&mut slave, &[force])[0]);
        if derivatives {
            let rates = [0, 1].map(|i| (next[i] - now[i]) / step);
            slave
                .set_input_derivatives(&inputs, &[1, 1], &rates)
                .unwrap();
        }
        slave.do_step(time, step).unwrap();
        let kept = if derivatives { next[0] } else { now[0] };
        // 1e-19 m: rounding of now + rate h.
        assert!((read(&mut slave, &inputs[..1])[0] - kept).abs() < 1e-19);
    }
    forces
}

#[test]
fn inputs_that_the_slave_continues_itself_are_nearly_as_good_as_derivatives() {
    let exact = shaken(0.0, true);
    let error = |found: &[f64]| rms_difference(&exact, found) / rms(&exact);
    let (held, continued) = (error(&shaken(0.0, false)), error(&shaken(1.0, false)));
    // Held inputs lag by w h / 2 = 2.5 %; continued ones err in second order, (w h)^2 = 0.25 %, through a rotor near resonance.
    assert!(
        held > 1e-2 && continued < 0.2 * held,
        "{held:e} {continued:e}"
    );
}
