//! Bearings whose coefficients depend on the speed.
//!
//! Authority: the same model with the coefficients of that speed written down.

mod support;

use geartrain::config::Config;
use geartrain::interface::Interface;
use geartrain::model::ModalModel;
use geartrain::rotor::ModalRotor;
use geartrain::slave::{Experiment, Slave};
use geartrain::train::Rotor;
use nalgebra::DMatrix;
use support::{assembled, gear_pair, valid};

const LAW: &str = "law = \"constant\"\nmean = 4e8";
const CONSTANT: &str = "stiffness = { xx = 8e7, yy = 6e7 }\ndamping = { xx = 900.0 }\n";

/// The gear pair with the left bearing of the first rotor as given.
fn pair(bearing: &str) -> String {
    let text = gear_pair(4, LAW, "");
    assert!(text.contains(CONSTANT));
    text.replacen(CONSTANT, bearing, 1)
}

/// Straight lines over the speed, so that what stands between is known.
fn table(outside: &str) -> String {
    let point = |speed: f64| {
        format!(
            "[[rotor.bearing.at_speed]]\nspeed = {speed:?}\n\
             stiffness = {{ xx = {:?}, yy = {:?}, xy = {:?}, yx = {:?} }}\ndamping = {{ xx = {:?} }}\n",
            5e7 + 2e5 * speed,
            9e7 - 2e5 * speed,
            1e4 * speed,
            -2e4 * speed,
            600.0 + 2.0 * speed
        )
    };
    format!(
        "outside_speeds = \"{outside}\"\n{}{}{}",
        point(100.0),
        point(140.0),
        point(200.0)
    )
}

/// The coefficients of that table at one speed.
fn written_down(speed: f64) -> String {
    format!(
        "stiffness = {{ xx = {:?}, yy = {:?}, xy = {:?}, yx = {:?} }}\ndamping = {{ xx = {:?} }}\n",
        5e7 + 2e5 * speed,
        9e7 - 2e5 * speed,
        1e4 * speed,
        -2e4 * speed,
        600.0 + 2.0 * speed
    )
}

fn first_rotor(text: &str) -> (Rotor, ModalRotor) {
    let train = valid(text).train;
    let modal = ModalRotor::reduce(&train.rotors[0], &train.basis, None).unwrap();
    (train.rotors[0].clone(), modal)
}

#[track_caller]
fn equal(one: &DMatrix<f64>, other: &DMatrix<f64>) {
    // 1e-12: rounding of straight lines through the table.
    assert!((one - other).amax() < 1e-12 * one.amax(), "{one} {other}");
}

#[test]
fn at_prescribed_speed_the_model_is_that_with_the_coefficients_of_the_speed() {
    let (found, exact) = (
        assembled(&pair(&table("refuse"))),
        assembled(&pair(&written_down(150.0))),
    );
    let ((k, d), (k_exact, d_exact)) = (found.mean_matrices(), exact.mean_matrices());
    equal(&k, &k_exact);
    equal(&d, &d_exact);
    for (one, other) in found.bearings().zip(exact.bearings()) {
        assert!((one.stiffness.yx - other.stiffness.yx).abs() < 1e-12 * 3e6);
        assert!((one.damping.yy - other.damping.yy).abs() < 1e-12 * 900.0);
    }
}

#[test]
fn a_rotor_turning_the_other_way_has_the_same_coefficients() {
    // Rotor two turns at -150 rad/s; its second bearing gets the table.
    let text = gear_pair(4, LAW, "");
    let place = text.rfind(CONSTANT).unwrap();
    let with = |bearing: &str| {
        format!(
            "{}{bearing}{}",
            &text[..place],
            &text[place + CONSTANT.len()..]
        )
    };
    let (found, exact) = (
        assembled(&with(&table("refuse"))),
        assembled(&with(&written_down(150.0))),
    );
    equal(&found.mean_matrices().0, &exact.mean_matrices().0);
}

#[test]
fn at_other_speeds_the_matrices_on_the_same_basis_follow_the_table() {
    let (rotor, modal) = first_rotor(&pair(&table("hold")));
    let n = modal.counts().lateral;
    let row = nalgebra::DVector::from_vec(modal.lateral_row(0.05));
    let outer = &row * row.transpose();
    let (mut k, mut d) = (DMatrix::zeros(2 * n, 2 * n), DMatrix::zeros(2 * n, 2 * n));
    modal.lateral_at(rotor.speed, &mut k, &mut d);
    assert_eq!((&k, &d), (&modal.lateral_stiffness, &modal.lateral_damping));
    // 180 inside the table, 250 and -20 outside it.
    for (speed, held) in [(180.0, 180.0), (250.0, 200.0), (-20.0, 100.0)] {
        modal.lateral_at(speed, &mut k, &mut d);
        let step = held - 150.0;
        let mut k_exact = modal.lateral_stiffness.clone();
        let mut d_exact = modal.lateral_damping.clone();
        for (corner, slope) in [((0, 0), 2e5), ((n, n), -2e5), ((0, n), 1e4), ((n, 0), -2e4)] {
            let mut block = k_exact.view_mut(corner, (n, n));
            block += step * slope * &outer;
        }
        for (corner, factor) in [((0, 0), 2.0 * step), ((n, n), 2.0 * step)] {
            let mut block = d_exact.view_mut(corner, (n, n));
            block += factor * &outer;
        }
        let turned = (speed - 150.0) * modal.gyroscopic();
        let mut block = d_exact.view_mut((0, n), (n, n));
        block += &turned;
        let mut block = d_exact.view_mut((n, 0), (n, n));
        block -= &turned;
        equal(&k, &k_exact);
        equal(&d, &d_exact);
    }
}

fn interface(text: &str) -> (Config, Interface) {
    let loaded = valid(text);
    let model = ModalModel::assemble(&loaded.train, None).unwrap();
    let interface = Interface::of(&loaded.config, &loaded.train, &model);
    (loaded.config, interface)
}

#[test]
fn only_constant_coefficients_are_parameters() {
    let names = |text: &str| -> Vec<String> {
        let starts = |name: &String| {
            name.starts_with("one.left.stiffness") || name.starts_with("one.left.damping")
        };
        let variables = interface(text).1.variables.into_iter();
        variables
            .map(|variable| variable.name)
            .filter(starts)
            .collect()
    };
    assert_eq!(names(&pair(CONSTANT)).len(), 8);
    assert_eq!(names(&pair(&table("hold"))), Vec::<String>::new());
}

#[test]
fn another_mean_speed_takes_other_coefficients_or_is_refused() {
    let (config, interface) = interface(&pair(&table("refuse")));
    let reference = |name: &str| {
        let index = interface.variables.iter().position(|one| one.name == name);
        u32::try_from(index.unwrap()).unwrap()
    };
    let (speed, frequency) = (
        reference("one.mean_speed"),
        reference("one.lateral_frequency[1]"),
    );
    let mut slave = Slave::new(&config.to_bytes()).unwrap();
    let experiment = Experiment {
        tolerance: None,
        start: 0.0,
        stop: None,
    };
    slave.setup_experiment(experiment).unwrap();
    slave.enter_initialization().unwrap();
    let mut found = [0.0];
    slave.set_real(&[speed], &[180.0]).unwrap();
    slave.get_real(&[frequency], &mut found).unwrap();
    let exact = first_rotor(&pair(&written_down(180.0)))
        .1
        .lateral_frequencies[0];
    assert!(
        (found[0] / exact - 1.0).abs() < 1e-12,
        "{} Hz, exact {exact} Hz",
        found[0]
    );
    slave.set_real(&[speed], &[250.0]).unwrap();
    let refusal = slave
        .get_real(&[frequency], &mut found)
        .unwrap_err()
        .to_string();
    for words in [
        "rotor \"one\", bearing \"left\"",
        "100 to 200 rad/s",
        "250 rad/s",
    ] {
        assert!(refusal.contains(words), "`{words}` is not in: {refusal}");
    }
}
