//! The dependencies of modelDescription.xml against what changes when something is changed.

#![allow(missing_docs)]

mod support;

use geartrain::config::Config;
use geartrain::interface::{Causality, Interface, Unit};
use geartrain::slave::Slave;
use support::slave::{initializing, read, references};
use support::{case_four, compound, model_file, valid};

/// Bearings with tables over the speed, some of them without a word on cross-coupling.
fn journal() -> String {
    model_file("journal.toml")
}

/// Balls, rollers and rubber: radial forces beside springs without cross-coupling.
fn rolling() -> String {
    model_file("rolling.toml")
}

/// A housing alone, one that knows bearings, and a train in it with a bearing on the ground: forces act on a foot of it.
fn housings() -> [String; 3] {
    ["box.toml", "known_box.toml", "boxed.toml"].map(model_file)
}

fn starting(text: &str) -> (Slave, Interface, Config) {
    let (slave, interface) = initializing(text, 1e-6);
    (slave, interface, valid(text).config)
}

/// Makes every coefficient of every bearing that is a parameter count, also those that are zero in the file.
fn let_every_coefficient_count(slave: &mut Slave, interface: &Interface) {
    for (name, reference) in interface.variables.iter().map(|one| &one.name).zip(0..) {
        if name.contains(".stiffness.") || name.contains(".damping.") {
            let [value] = read(slave, &[reference])[..] else {
                unreachable!()
            };
            slave.set_real(&[reference], &[value + 3e3]).unwrap();
        }
    }
}

#[test]
fn outputs_depend_on_the_inputs_that_the_table_names_and_on_no_others() {
    for text in [case_four(), journal(), rolling()]
        .into_iter()
        .chain(housings())
    {
        let (mut slave, interface, config) = starting(&text);
        let_every_coefficient_count(&mut slave, &interface);
        slave.exit_initialization().unwrap();
        slave.do_step(0.0, 1.2e-3).unwrap(); // everything touches
        let outputs = references(&interface, Causality::Output);
        for known in references(&interface, Causality::Input) {
            let mut found = vec![0.0; outputs.len()];
            slave
                .directional_derivative(&outputs, (&[known], &[1.0]), &mut found)
                .unwrap();
            for (&output, derivative) in outputs.iter().zip(found) {
                let variable = &interface.variables[output as usize];
                let named = interface.feed_through(&config, variable);
                let input = &interface.variables[known as usize].name;
                assert_eq!(
                    derivative != 0.0,
                    named.contains(&(known as usize)),
                    "{} of {input}",
                    variable.name
                );
            }
        }
    }
}

/// A value that makes a difference wherever the variable makes one.
fn another(unit: Unit, value: f64) -> f64 {
    match unit {
        Unit::Meter => value + 1e-6,
        Unit::NewtonPerMeter | Unit::NewtonSecondPerMeter => value + 1e6,
        _ => 1.01 * value + 1e-4,
    }
}

#[test]
fn calculated_parameters_follow_from_the_variables_that_the_table_names_and_from_no_others() {
    for text in [case_four(), journal(), compound()] {
        let (mut slave, interface, config) = starting(&text);
        let calculated = references(&interface, Causality::CalculatedParameter);
        let before = read(&mut slave, &calculated);
        let mut knowns = references(&interface, Causality::Parameter);
        knowns.extend(references(&interface, Causality::Input));
        for known in knowns {
            let changed = &interface.variables[known as usize];
            let [value] = read(&mut slave, &[known])[..] else {
                unreachable!()
            };
            let other = another(changed.unit, value);
            slave.set_real(&[known], &[other]).unwrap();
            let after = read(&mut slave, &calculated);
            slave.set_real(&[known], &[value]).unwrap();
            for ((&one, before), after) in calculated.iter().zip(&before).zip(after) {
                let variable = &interface.variables[one as usize];
                let origin = interface.origin(&config, variable).expect("a list");
                assert_eq!(
                    after != *before,
                    origin.contains(&(known as usize)),
                    "{} of {}",
                    variable.name,
                    changed.name
                );
            }
        }
        assert_eq!(read(&mut slave, &calculated), before);
    }
}
