//! Whirl speeds of the rotor of Nelson and McVaugh.
//!
//! Authority: literature.
//!
//! Nelson, McVaugh, The Dynamics of Rotor-Bearing Systems Using Finite Elements, ASME J. Eng. Ind. 98 (1976), pp. 598-600,
//! 18 shaft elements, a disk and two bearings. Data and published speeds as handed down in the verification manual of
//! ANSYS Mechanical APDL, cases VM247 (isotropic bearings, whirl ratios 1 and 4) and VM254 (cross-coupled bearings); the paper
//! itself was not at hand.
//!
//! The paper's shaft has rotary inertia and no shear deformation. Ours has shear always, but Cowper's coefficient times G is
//! 3 E / (7 + 6 nu) for a solid shaft: nine times stiffer at nu = -1 than at nu = 0.3. What is left lowers the speeds by 0.1 %;
//! ordinary steel lowers them by up to 1.2 %.

mod support;

use support::{assembled, parts};

/// Nodes and diameters [cm].
const NODES: [f64; 19] = [
    0.0, 1.27, 5.08, 7.62, 8.89, 10.16, 10.67, 11.43, 12.7, 13.46, 16.51, 19.05, 22.86, 26.67,
    28.7, 30.48, 31.5, 34.54, 35.5,
];
const OUTER: [f64; 18] = [
    1.02, 2.04, 1.52, 4.06, 4.06, 6.6, 6.6, 5.08, 5.08, 2.54, 2.54, 3.04, 3.04, 2.54, 2.54, 7.62,
    4.06, 4.06,
];
/// Element and inner diameter [cm].
const HOLLOW: [(usize, f64); 3] = [(6, 3.04), (7, 3.56), (17, 3.04)];

/// The rotor at a speed [1/min], both bearings alike.
fn rotor(speed: f64, direct: f64, cross: f64) -> String {
    let speed = speed / 60.0 * std::f64::consts::TAU;
    let mut text = format!(
        "kind = \"gear_train\"\nname = \"nelson\"\n[basis]\nlateral_modes = 20\ntorsional_modes = 1\n\
         [material.default]\nyoungs_modulus = 2.078e11\npoisson_ratio = -0.9999\ndensity = 7806.0\n\
         [[rotor]]\nname = \"rotor\"\nspeed = {speed}\nmax_element_length = 1.0\n"
    );
    for (element, outer) in OUTER.into_iter().enumerate() {
        let hollow = HOLLOW.iter().find(|hollow| hollow.0 == element);
        let inner = hollow.map_or(0.0, |hollow| hollow.1);
        text += &format!(
            "[[rotor.segment]]\nlength = {}\nouter_diameter = {}\ninner_diameter = {}\n",
            (NODES[element + 1] - NODES[element]) / 100.0,
            outer / 100.0,
            inner / 100.0
        );
    }
    text += &parts::disk(0.0889, 1.401, 0.002, 0.00136);
    for (name, position) in [("left", 0.1651), ("right", 0.287)] {
        text += &format!(
            "[[rotor.bearing]]\nname = \"{name}\"\nposition = {position}\n\
             stiffness = {{ xx = {direct:e}, xy = {cross:e}, yx = {cross:e} }}\n"
        );
    }
    text
}

/// Whirl speeds [1/min], ascending, without the rigid rotation.
fn whirl_speeds(text: &str) -> Vec<f64> {
    let vibrations = assembled(text).natural_vibrations().unwrap();
    let all = vibrations.iter().map(|one| 60.0 * one.damped_frequency);
    all.filter(|&speed| speed > 60.0).collect()
}

#[track_caller]
fn close(found: f64, published: f64, tolerance: f64) {
    assert!(
        (found / published - 1.0).abs() < tolerance,
        "{found} / min, published {published} / min"
    );
}

#[test]
fn critical_speeds_on_isotropic_bearings_are_the_published_ones() {
    // Backward and forward in turn; the rotor turns with the whirl, or at a quarter of it.
    let ratio_one = [15470.0, 17159.0, 46612.0, 49983.0, 64752.0, 96457.0];
    let ratio_four = [16060.0, 16481.0, 47957.0, 48800.0, 72737.0, 80649.0];
    for (ratio, published) in [(1.0, ratio_one), (4.0, ratio_four)] {
        for (order, speed) in published.into_iter().enumerate() {
            let found = whirl_speeds(&rotor(speed / ratio, 4.378e7, 0.0));
            // 0.7 %: measured 0.25 %, the highest forward one 0.6 %; the dimensions are rounded to 0.1 mm and more, and
            // the paper's own elements are other ones.
            close(found[order], speed, 7e-3);
        }
    }
}

#[test]
fn cross_coupled_bearings_whirl_at_the_published_speeds() {
    let found = whirl_speeds(&rotor(100_000.0, 3.503e7, -8.756e6));
    for (found, published) in found.into_iter().zip([10747.0, 19665.0, 39077.0, 47549.0]) {
        // 0.7 %, as above; measured 0.5 %.
        close(found, published, 7e-3);
    }
}
