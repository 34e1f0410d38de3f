//! Derivatives of the outputs against differences: along every input, and along time.

#![allow(missing_docs)]

mod support;

use geartrain::interface::{Causality, Interface, Quantity};
use geartrain::slave::Slave;
use support::slave::{initializing, read, references, stepping};
use support::{case_four, model_file, three_stage};

/// Tolerance of the runs: differences show the solution, not its errors.
const TIGHT: f64 = 1e-10;

/// Free spin, contact that parts, a radial bearing, transmission error: everything that changes outputs.
fn everything() -> String {
    let nonlinear =
        "[rotor.bearing.nonlinear]\nlaw = \"hertz\"\ncoefficient = 4e9\n\n[[rotor.basis_support]]";
    let text = three_stage();
    let (others, last) = text.split_at(text.rfind("[[rotor.basis_support]]").unwrap());
    format!(
        "{others}{}",
        last.replacen("[[rotor.basis_support]]", nonlinear, 1)
    )
    .replace("speed = \"prescribed\"", "speed = \"free\"")
    .replace(
        "contact = \"bilateral\"",
        "contact = \"unilateral\"\nbacklash = 5e-5",
    )
    .replace("amplitude_x = 0.0", "amplitude_x = 5e-6")
        + "\n[[mesh.transmission_error]]\norder = 1\namplitude = 1e-6\n"
}

fn models() -> [String; 4] {
    // The transmission error belongs to the last mesh: in front of the vibration, which follows it.
    let text = everything();
    let (head, error) = text.split_at(text.rfind("\n[[mesh.transmission_error]]").unwrap());
    let at = head.find("[gearbox_vibration]").unwrap();
    [
        case_four(),
        format!("{}{error}\n{}", &head[..at], &head[at..]),
        model_file("box.toml"),
        model_file("boxed.toml"),
    ]
}

/// A step by which an input may change without leaving the neighbourhood.
fn small(quantity: Quantity) -> f64 {
    match quantity {
        Quantity::Torque { .. } | Quantity::PointForce { .. } => 0.2,
        Quantity::BaseDisplacement { .. } => 1e-9,
        _ => 1e-6,
    }
}

/// Lets forces act on a housing, so that it moves at all.
fn push(slave: &mut Slave, interface: &Interface) {
    let force = |input: &u32| {
        let quantity = interface.variables[*input as usize].quantity;
        matches!(quantity, Quantity::PointForce { .. })
    };
    let mut forces = references(interface, Causality::Input);
    forces.retain(force);
    let values: Vec<f64> = (1..=forces.len())
        .map(|number| 40.0 * number as f64)
        .collect();
    slave.set_real(&forces, &values).unwrap();
}

/// The largest value among outputs with the unit of one of them.
fn largest(interface: &Interface, outputs: &[u32], values: &[f64], like: u32) -> f64 {
    let unit = |output: u32| interface.variables[output as usize].unit.name();
    let same = outputs
        .iter()
        .zip(values)
        .filter(|(output, _)| unit(**output) == unit(like));
    same.map(|(_, value)| value.abs()).fold(0.0, f64::max)
}

/// Compares the directional derivatives along every input with central differences.
fn check_inputs(slave: &mut Slave, interface: &Interface) {
    let outputs = references(interface, Causality::Output);
    for known in references(interface, Causality::Input) {
        let step = small(interface.variables[known as usize].quantity);
        let mut found = vec![0.0; outputs.len()];
        slave
            .directional_derivative(&outputs, (&[known], &[1.0]), &mut found)
            .unwrap();
        let [value] = read(slave, &[known])[..] else {
            unreachable!()
        };
        let mut at = |input: f64| {
            slave.set_real(&[known], &[input]).unwrap();
            read(slave, &outputs)
        };
        let (before, after, base) = (at(value - step), at(value + step), at(value));
        for (index, &output) in outputs.iter().enumerate() {
            let difference = (after[index] - before[index]) / (2.0 * step);
            // 1e-6, rounding of outputs of this unit in the difference, and of accelerations in equilibrium, whose parts cancel.
            let rounding = 1e-13 * largest(interface, &outputs, &base, output) / step + 1e-13;
            let error = (found[index] - difference).abs();
            let [name, input] = [output, known].map(|one| &interface.variables[one as usize].name);
            assert!(
                error <= 1e-6 * difference.abs() + rounding,
                "{name} along {input}: {} found, {difference} by difference",
                found[index]
            );
        }
    }
}

#[test]
fn directional_derivatives_are_the_differences_at_the_start_and_later() {
    for text in models() {
        let (mut slave, interface) = initializing(&text, TIGHT);
        push(&mut slave, &interface);
        check_inputs(&mut slave, &interface);
        slave.exit_initialization().unwrap();
        slave.do_step(0.0, 3.1e-4).unwrap();
        check_inputs(&mut slave, &interface);
    }
}

#[test]
fn forces_of_bearings_on_the_housing_are_stiffness_and_damping_exactly() {
    let (mut slave, interface) = stepping(&case_four(), TIGHT);
    let named = |name: &str| {
        let place = interface.variables.iter().position(|one| one.name == name);
        u32::try_from(place.unwrap()).unwrap()
    };
    let mut found = [0.0; 2];
    for (input, expected) in [("x", -1e8), ("vx", -2000.0)] {
        let known = named(&format!("stage1.b1.housing.{input}"));
        let unknowns = ["stage1.b1.force_x", "stage1.b1.force_y"].map(named);
        slave
            .directional_derivative(&unknowns, (&[known], &[1.0]), &mut found)
            .unwrap();
        assert_eq!(found, [expected, 0.0]);
    }
}

/// Lets every input change so fast that it passes [`small`] in 1e-4 s.
fn let_inputs_change(slave: &mut Slave, interface: &Interface) {
    let inputs = references(interface, Causality::Input);
    let rate = |&input: &u32| 1e4 * small(interface.variables[input as usize].quantity);
    let rates: Vec<f64> = inputs.iter().map(rate).collect();
    let orders = vec![1; inputs.len()];
    slave
        .set_input_derivatives(&inputs, &orders, &rates)
        .unwrap();
}

#[test]
fn output_derivatives_are_the_differences_along_time() {
    for (text, inputs_change) in models()
        .iter()
        .flat_map(|text| [(text, false), (text, true)])
    {
        let (mut slave, interface) = stepping(text, TIGHT);
        push(&mut slave, &interface);
        let outputs = references(&interface, Causality::Output);
        let prepare = |slave: &mut Slave| {
            if inputs_change {
                let_inputs_change(slave, &interface);
            }
        };
        // A time at which no law is near its ends.
        let (time, step) = (3.13e-4, 1e-8);
        slave.do_step(0.0, time - step).unwrap();
        let before = read(&mut slave, &outputs);
        prepare(&mut slave);
        slave.do_step(time - step, step).unwrap();
        prepare(&mut slave);
        let mut found = vec![0.0; outputs.len()];
        let orders = vec![1; outputs.len()];
        slave
            .output_derivatives(&outputs, &orders, &mut found)
            .unwrap();
        slave.do_step(time, step).unwrap();
        let after = read(&mut slave, &outputs);
        for (index, &output) in outputs.iter().enumerate() {
            let variable = &interface.variables[output as usize];
            let difference = (after[index] - before[index]) / (2.0 * step);
            // 1e-5 of what changes fastest in the same unit: (w h)^2 of the fastest mode, and rounding in 2 h.
            let fastest = largest(&interface, &outputs, &found, output);
            let bound = 1e-5 * fastest + 1e-12 * after[index].abs() / step;
            let error = (found[index] - difference).abs();
            assert!(
                error <= bound,
                "{}: {} found, {difference}",
                variable.name,
                found[index]
            );
        }
    }
}
