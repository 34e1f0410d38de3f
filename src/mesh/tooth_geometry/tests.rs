//! Claims about whole pairs. Authorities: closed form, ISO 6336-1, a public implementation.

use core::f64::consts::PI;

use super::*;

const DEGREES: f64 = PI / 180.0;

/// A standard steel gear whose bore is half of its root circle.
pub(super) fn gear(teeth: f64) -> SpurGear {
    SpurGear {
        teeth,
        addendum: 1.0,
        dedendum: 1.25,
        profile_shift: 0.0,
        bore_radius: 0.5 * 3e-3 * (0.5 * teeth - 1.25),
        youngs_modulus: 2.06e11,
        poisson_ratio: 0.3,
    }
}

/// Standard gears at their standard distance, module 3 mm, face width 25 mm.
fn standard(teeth_a: f64, teeth_b: f64) -> SpurPair {
    SpurPair {
        module: 3e-3,
        rack_pressure_angle: 20.0 * DEGREES,
        pressure_angle: 20.0 * DEGREES,
        face_width: 0.025,
        gears: [gear(teeth_a), gear(teeth_b)],
    }
}

/// The pair, and others at the edges of what can mesh.
pub(super) fn pairs() -> Vec<SpurPair> {
    let shifted = |a: f64, b: f64, x_a: f64, x_b: f64, degrees: f64| {
        let mut pair = standard(a, b);
        pair.gears[0].profile_shift = x_a;
        pair.gears[1].profile_shift = x_b;
        pair.pressure_angle = degrees * DEGREES;
        pair
    };
    let mut high_contact_ratio = standard(60.0, 70.0);
    for gear in &mut high_contact_ratio.gears {
        (gear.addendum, gear.dedendum) = (1.3, 1.6);
    }
    let mut steep = standard(12.0, 30.0);
    steep.rack_pressure_angle = 25.0 * DEGREES;
    steep.pressure_angle = 25.0 * DEGREES;
    vec![
        standard(17.0, 43.0),
        standard(19.0, 48.0),
        standard(30.0, 30.0),
        standard(55.0, 75.0),
        standard(25.0, 400.0),
        shifted(12.0, 40.0, 0.5, 0.1, 22.5),
        shifted(20.0, 25.0, 0.6, 0.5, 25.5),
        steep,
        high_contact_ratio,
        shifted(12.0, 40.0, 0.72, 0.1, 24.0), // tip 0.095 modules thick
    ]
}

fn close(found: f64, expected: f64, tolerance: f64) {
    assert!(
        (found / expected - 1.0).abs() < tolerance,
        "{found}, expected {expected}"
    );
}

#[test]
fn iso_stiffness_of_17_and_43_teeth_is_the_standards() {
    // The figures, in N/(mm um), rounded to their last digit.
    let (pair, unit) = (standard(17.0, 43.0), 1e9);
    close(pair.path_of_contact().contact_ratio(), 1.6211, 0.5e-4 / 1.6);
    let iso = pair.iso6336();
    close(iso.theoretical_single, 16.03 * unit, 0.005 / 16.0);
    close(iso.single, 12.505 * unit, 0.0005 / 12.5);
    close(iso.mesh, 18.33 * unit, 0.005 / 18.3);
    // The order of the gears does not matter; aluminium counts with its modulus.
    assert_eq!(standard(43.0, 17.0).iso6336().single, iso.single);
    let mut light = pair;
    light
        .gears
        .iter_mut()
        .for_each(|gear| gear.youngs_modulus = 7e10);
    close(light.iso6336().mesh / iso.mesh, 7.0 / 20.6, 1e-14);
}

fn value(series: &PairStiffness, x: f64) -> f64 {
    let [value] = series.values([x]);
    value
}

#[test]
fn the_series_is_the_integral() {
    for pair in pairs() {
        let series = PairStiffness::of(&pair);
        for step in 0..=1000 {
            let x = series.contact_ratio() * f64::from(step) / 1000.0;
            close(value(&series, x), pair.pair_stiffness(x), 1e-9);
        }
        // Midpoint rule: O(h^2) at h = 1e-4, times a curvature of about 4.
        let samples = 10_000;
        let sum: f64 = (0..samples)
            .map(|i| {
                value(
                    &series,
                    series.contact_ratio() * (f64::from(i) + 0.5) / f64::from(samples),
                )
            })
            .sum();
        close(
            series.contact_ratio() * sum / f64::from(samples),
            series.integral(),
            1e-8,
        );
    }
}

#[test]
fn equal_gears_are_symmetric_and_swapping_gears_turns_the_contact_round() {
    let equal = standard(30.0, 30.0);
    let eps = equal.path_of_contact().contact_ratio();
    for pair in pairs() {
        let mut swapped = pair;
        swapped.gears.swap(0, 1);
        let eps = pair.path_of_contact().contact_ratio();
        for step in 0..=10 {
            let x = eps * f64::from(step) / 10.0;
            // 1e-12: rounding of x and eps - x.
            close(
                pair.pair_stiffness(x),
                swapped.pair_stiffness(eps - x),
                1e-12,
            );
        }
    }
    close(
        equal.pair_stiffness(0.1),
        equal.pair_stiffness(eps - 0.1),
        1e-12,
    );
}

#[test]
fn stiffness_grows_with_modulus_and_face_width_and_not_with_size() {
    let pair = standard(19.0, 48.0);
    let k = pair.pair_stiffness(0.4);
    let mut other = pair;
    other.face_width *= 3.0;
    other
        .gears
        .iter_mut()
        .for_each(|gear| gear.youngs_modulus *= 0.5);
    close(other.pair_stiffness(0.4), 1.5 * k, 1e-14);
    let mut larger = pair;
    larger.module *= 10.0;
    larger
        .gears
        .iter_mut()
        .for_each(|gear| gear.bore_radius *= 10.0);
    close(larger.pair_stiffness(0.4), k, 1e-12);
}

#[test]
fn root_circles_inside_and_outside_the_base_circle_meet() {
    // The dedendum decides which is larger. Both descriptions of the foot must agree in between.
    let mut pair = standard(40.0, 40.0);
    let k = |pair: &mut SpurPair, beyond: f64| {
        for gear in &mut pair.gears {
            gear.dedendum = 20.0 * (1.0 - libm::cos(20.0 * DEGREES)) + beyond;
        }
        pair.pair_stiffness(0.3)
    };
    let (inside, outside) = (k(&mut pair, 1e-7), k(&mut pair, -1e-7));
    // 1e-6: the foot moves by 2e-7 modules.
    close(inside, outside, 1e-6);
}

#[test]
fn stiffness_is_near_that_of_the_standard() {
    // ISO 6336-1 rests on measurements, this on beams. For solid gears of ordinary shape the means lie within
    // 15 % of each other; 17/43 teeth, 6 % below: 17.24 against 18.33 N/(mm um).
    for pair in pairs() {
        let iso = pair.iso6336();
        let series = PairStiffness::of(&pair);
        close(series.integral() / pair.face_width, iso.mesh, 0.15);
        let greatest = value(&series, 0.5 * series.contact_ratio());
        close(greatest / pair.face_width, iso.single, 0.15);
    }
}

#[test]
fn a_thicker_body_is_softer_and_a_titanium_wheel_lies_between() {
    let pair = standard(19.0, 48.0);
    let mean = |pair: &SpurPair| PairStiffness::of(pair).integral();
    let mut small_bore = pair;
    small_bore.gears[1].bore_radius *= 0.5;
    assert!(mean(&small_bore) < mean(&pair));
    let titanium = |pair: SpurPair, sides: &[usize]| {
        let mut pair = pair;
        for &side in sides {
            pair.gears[side].youngs_modulus = 1.14e11;
        }
        mean(&pair)
    };
    let mixed = titanium(pair, &[1]);
    assert!(titanium(pair, &[0, 1]) < mixed && mixed < mean(&pair));
}

#[test]
fn a_public_implementation_with_fillets_is_a_little_stiffer() {
    // ROSS, `ross/tests/test_gear_element.py` (2026): two gears of 62 teeth, module 2 mm, face width 20 mm, bore radius
    // 17.5 mm, E 206 GPa, nu 0.3, by the same method with the true curve of the fillet (Ma, Song, Pang, Wen, Eng. Fail.
    // Anal. 44, 2014). No published measurement: another program.
    let mut pair = standard(62.0, 62.0);
    (pair.module, pair.face_width) = (2e-3, 0.02);
    pair.gears
        .iter_mut()
        .for_each(|gear| gear.bore_radius = 0.0175);
    // The same formulas: rounding.
    let eps = pair.path_of_contact().contact_ratio();
    close(eps, 1.789_779_866_833_045_8, 1e-14);
    let contact = pair.face_width / compliance::contact(&pair.gears);
    close(contact, 3_555_868_607.909_326_6, 1e-14);
    // Two pairs at the start of contact, and where they are stiffest.
    let mesh = |x: f64| pair.pair_stiffness(x) + pair.pair_stiffness(x + 1.0);
    let greatest = (0..=100)
        .map(|i| mesh((eps - 1.0) * f64::from(i) / 100.0))
        .fold(0.0, f64::max);
    for (found, ross) in [(mesh(0.0), 396_622_921.4), (greatest, 4.096_607e8)] {
        // Teeth without fillets are 3 to 6 % softer here.
        let ratio = found / ross;
        assert!(
            (0.94..0.97).contains(&ratio),
            "{found} N/m, ROSS {ross} N/m"
        );
    }
}
