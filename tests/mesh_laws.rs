//! One stiffness written in different laws gives one motion, and trains of every kind run.
//!
//! Authority: closed form (the laws are equal on paper).

mod support;

use geartrain::train::speed_ratios;
use support::{gear_pair, rms, rms_difference, star, started, valid};

/// Mesh force of a gear pair with this law at communication points of 20 us. On flank -1 the phase runs backwards.
fn forces(law: &str, flank: &str, tolerance: f64) -> Vec<f64> {
    let text = gear_pair(4, law, "damping_ratio = 0.05").replace("flank = 1", flank);
    let mut simulation = started(&text, tolerance);
    (1..=500)
        .map(|index| {
            simulation.advance_to(2e-5 * f64::from(index)).unwrap();
            simulation.motion().mesh_force(0)
        })
        .collect()
}

#[track_caller]
fn agree(one: &str, other: &str, bound: f64) {
    for flank in ["flank = 1", "flank = -1"] {
        let [one, other] = [one, other].map(|law| forces(law, flank, 1e-6));
        let deviation = rms_difference(&one, &other) / rms(&one);
        assert!(deviation < bound, "{flank}: {deviation:e}");
    }
}

#[test]
fn a_table_with_two_jumps_is_the_rectangular_law() {
    let rectangular = "law = \"rectangular\"\nsingle = 2e8\ndouble = 3e8\ncontact_ratio = 1.6";
    let table = "law = \"table\"\nphase = [0.0, 0.0, 0.6, 0.6]\nvalue = [2e8, 3e8, 3e8, 2e8]";
    agree(rectangular, table, 1e-9); // the same steps: rounding
}

#[test]
fn harmonics_that_vanish_are_a_constant() {
    let fourier = "law = \"fourier\"\nmean = 4e8\nsine = [0.0]";
    agree("law = \"constant\"\nmean = 4e8", fourier, 1e-9); // the same steps: rounding
}

#[test]
fn harmonics_are_the_limit_of_their_table() {
    let k = |phase: f64| {
        let angle = core::f64::consts::TAU * phase;
        4e8 * (1.0 + 0.2 * libm::cos(angle) - 0.1 * libm::sin(2.0 * angle))
    };
    let phases: Vec<f64> = (0..100).map(|i| f64::from(i) / 100.0).collect();
    let values: Vec<f64> = phases.iter().map(|&phase| k(phase)).collect();
    let table = format!("law = \"table\"\nphase = {phases:?}\nvalue = {values:?}");
    let fourier = "law = \"fourier\"\nmean = 4e8\ncosine = [0.2]\nsine = [0.0, -0.1]";
    // Straight lines miss k by up to h^2 k''/8 = 1.25e-5 (2 pi)^2 (0.2 + 4 x 0.1) = 3e-4 of the mean.
    agree(fourier, &table, 3e-4);
}

#[test]
fn a_star_gear_keeps_its_symmetry_in_time() {
    // Planets opposite each other on equal bearings: the phases of the sun's meshes differ by ten pitches, so
    // both loops of meshes carry the same forces all the time.
    let text = star();
    let ratios: Vec<f64> = speed_ratios(&valid(&text).train)
        .iter()
        .map(|one| one.ratio)
        .collect();
    let expected = [1.0, -0.8, -0.8, -20.0 / 70.0];
    assert!(
        ratios
            .iter()
            .zip(expected)
            .all(|(one, other)| (one - other).abs() < 1e-15),
        "{ratios:?}"
    );
    let mut simulation = started(&text, 1e-5);
    for index in 1..=200 {
        simulation.advance_to(2e-5 * f64::from(index)).unwrap();
        let force = |mesh: usize| simulation.motion().mesh_force(mesh);
        for pair in [[0, 1], [2, 3]] {
            let [one, other] = pair.map(force);
            // 1e-9: rounding over 1e4 steps of equal length.
            assert!((one / other - 1.0).abs() < 1e-9, "{one} N and {other} N");
        }
    }
}
