//! Finite elements, modes and coupling against closed forms.
//!
//! Authority: textbooks. Euler and Timoshenko beams: Timoshenko, Young, Weaver, Vibration Problems in
//! Engineering, 4th ed., 5.10-5.12; Jeffcott rotor and gyroscopic disk: Genta, Dynamics of Rotating
//! Systems, chapters 2 and 5.

#![allow(clippy::disallowed_methods)] // tests compare with tolerances: the platform's sin will do

mod support;

use std::f64::consts::{PI, TAU};

use geartrain::linalg::natural_modes;
use geartrain::rotor::FiniteElements;
use nalgebra::{DMatrix, Normed};
use support::{assembled, gear_pair, head, star, valid};

const E: f64 = 2.1e11;
const NU: f64 = 0.3;
const RHO: f64 = 7800.0;

fn shaft(length: f64, diameter: f64, elements: usize) -> FiniteElements {
    let text = format!(
        "{}[[rotor]]\nname = \"shaft\"\nspeed = 0.0\nmax_element_length = {}\n\
         [[rotor.segment]]\nlength = {length}\nouter_diameter = {diameter}\n",
        head(1, 1),
        length / elements as f64
    );
    FiniteElements::assemble(&valid(&text).train.rotors[0])
}

/// Natural circular frequencies of a plane with the ends' displacements held.
fn pinned(elements: &FiniteElements) -> Vec<f64> {
    let last = elements.mass.nrows() - 2;
    let held = |matrix: &DMatrix<f64>| {
        matrix
            .clone()
            .remove_columns_at(&[0, last])
            .remove_rows_at(&[0, last])
    };
    let modes = natural_modes(&held(&elements.shaft_stiffness), &held(&elements.mass)).unwrap();
    modes
        .squared_frequencies
        .iter()
        .map(|w2| w2.sqrt())
        .collect()
}

/// Circular frequency of mode n of a pinned Timoshenko beam: the lower root of
/// a w^4 - b w^2 + c = 0 with beta = n pi / L.
fn pinned_timoshenko(length: f64, diameter: f64, n: f64) -> f64 {
    let area = PI / 4.0 * diameter * diameter;
    let inertia = PI / 64.0 * diameter.powi(4);
    let shear = 6.0 * (1.0 + NU) / (7.0 + 6.0 * NU) * E / (2.0 * (1.0 + NU));
    let beta = n * PI / length;
    let a = RHO * RHO * inertia / shear;
    let b = RHO * area + RHO * inertia * (1.0 + E / shear) * beta * beta;
    let c = E * inertia * beta.powi(4);
    (2.0 * c / (b + (b * b - 4.0 * a * c).sqrt())).sqrt()
}

#[test]
fn pinned_timoshenko_beam_converges_with_the_square_of_the_element_length_or_better() {
    let (length, diameter) = (1.0, 0.1);
    for n in 1..=3 {
        let exact = pinned_timoshenko(length, diameter, f64::from(n));
        let error = |elements| {
            (pinned(&shaft(length, diameter, elements))[n as usize - 1] / exact - 1.0).abs()
        };
        let (coarse, fine) = (error(10), error(40));
        // Measured 1e-5 to 3e-4 at 40 elements; a factor of 4 in length must give 4^2 less two tenths.
        assert!(
            fine < 1e-3 && coarse / fine > 12.0,
            "mode {n}: {coarse:e} -> {fine:e}"
        );
    }
}

#[test]
fn slender_pinned_beam_has_eulers_frequencies() {
    let (length, diameter) = (1.0, 0.004);
    let stiffness = (E * diameter * diameter / (16.0 * RHO)).sqrt(); // sqrt(E I / rho A)
    for (n, found) in (1..=4).zip(pinned(&shaft(length, diameter, 40))) {
        let exact = f64::from(n * n) * PI * PI * stiffness;
        // 2e-4: shear and rotary inertia of a beam with d/L = 1/250, (n pi d / L)^2 (E/kG + 1) / 32.
        assert!(
            (found / exact - 1.0).abs() < 2e-4 * f64::from(n * n),
            "mode {n}"
        );
    }
}

#[test]
fn free_slender_beam_has_two_rigid_modes_and_eulers_elastic_frequencies() {
    let (length, diameter) = (1.0, 0.004);
    let elements = shaft(length, diameter, 40);
    let modes = natural_modes(&elements.shaft_stiffness, &elements.mass).unwrap();
    assert_eq!(modes.squared_frequencies[..2], [0.0, 0.0]);
    let stiffness = (E * diameter * diameter / (16.0 * RHO)).sqrt();
    // Roots of cos x cosh x = 1.
    for (root, w2) in [4.730_040_744_862_704, 7.853_204_624_095_838]
        .into_iter()
        .zip(&modes.squared_frequencies[2..])
    {
        let exact = root * root * stiffness / (length * length);
        assert!(
            (w2.sqrt() / exact - 1.0).abs() < 1e-3,
            "1e-3: shear and rotary inertia as above"
        );
    }
}

#[test]
fn free_rod_twists_at_multiples_of_half_a_wave() {
    let (length, elements) = (1.0, 40);
    let rod = shaft(length, 0.05, elements);
    let modes = natural_modes(&rod.torsional_stiffness, &rod.inertia).unwrap();
    assert_eq!(modes.squared_frequencies[0], 0.0);
    let wave_speed = (E / (2.0 * (1.0 + NU)) / RHO).sqrt();
    for n in 1..=4_i32 {
        let exact = f64::from(n) * PI * wave_speed / length;
        let found = modes.squared_frequencies[n as usize].sqrt();
        // Consistent linear elements: + (n pi / elements)^2 / 24.
        let predicted = (f64::from(n) * PI / elements as f64).powi(2) / 24.0;
        assert!(
            (found / exact - 1.0 - predicted).abs() < 0.02 * predicted,
            "mode {n}"
        );
    }
}

#[test]
fn two_disks_on_a_light_shaft_twist_at_their_closed_form_frequency() {
    // w^2 = k (1/J1 + 1/J2); the shaft's own inertia is 1e-12 of the disks'.
    let (j1, j2, d, length) = (0.3, 0.7, 0.01_f64, 0.5);
    let text = format!(
        "kind = \"gear_train\"\nname = \"m\"\n[basis]\nlateral_modes = 2\ntorsional_modes = 2\n\
         [material.default]\nyoungs_modulus = {E}\npoisson_ratio = {NU}\ndensity = 1e-6\n\
         [[rotor]]\nname = \"r\"\nspeed = 0.0\n\
         [[rotor.segment]]\nlength = {length}\nouter_diameter = {d}\n\
         [[rotor.disk]]\nposition = 0.0\nmass = 1.0\npolar_inertia = {j1}\ndiametral_inertia = 0.1\n\
         [[rotor.disk]]\nposition = {length}\nmass = 1.0\npolar_inertia = {j2}\ndiametral_inertia = 0.1\n\
         [[rotor.bearing]]\nname = \"b1\"\nposition = 0.0\nstiffness = {{ xx = 1e8 }}\n\
         [[rotor.bearing]]\nname = \"b2\"\nposition = {length}\nstiffness = {{ xx = 1e8 }}\n"
    );
    let k = E / (2.0 * (1.0 + NU)) * PI / 32.0 * d.powi(4) / length;
    let exact = (k * (1.0 / j1 + 1.0 / j2)).sqrt() / TAU;
    let found = assembled(&text).rotors[0].torsional_frequencies[1];
    assert!(
        (found / exact - 1.0).abs() < 1e-9,
        "{found} Hz, exact {exact} Hz"
    );
}

/// Two rotors so rigid and so well held that only the gears turn against the mesh.
fn rigid_gear_pair(stiffness: f64) -> String {
    let rotor = |name: &str, speed: f64, radius: f64, teeth: u32, inertia: f64| {
        format!(
            "[[rotor]]\nname = \"{name}\"\nspeed = {speed}\n\
             [[rotor.segment]]\nlength = 0.1\nouter_diameter = 0.3\nmaterial = \"rigid\"\n\
             [[rotor.gear]]\nname = \"g\"\nposition = 0.05\nteeth = {teeth}\nbase_radius = {radius}\n\
             mass = 1e11\npolar_inertia = {inertia}\ndiametral_inertia = 1e9\n\
             [[rotor.bearing]]\nname = \"b1\"\nposition = 0.0\nstiffness = {{ xx = 1e12 }}\n\
             [[rotor.bearing]]\nname = \"b2\"\nposition = 0.1\nstiffness = {{ xx = 1e12 }}\n"
        )
    };
    format!(
        "{}[material.rigid]\nyoungs_modulus = 1e18\npoisson_ratio = 0.3\ndensity = 1e-9\n{}{}\
         [[mesh]]\nname = \"m\"\ngears = [\"a.g\", \"b.g\"]\ncenter_angle = 0.0\npressure_angle = 0.35\n\
         [mesh.stiffness]\nlaw = \"constant\"\nmean = {stiffness}\n",
        head(2, 1),
        rotor("a", 100.0, 0.1, 20, 0.02),
        rotor("b", -50.0, 0.2, 40, 0.3)
    )
}

#[test]
fn undamped_gear_pair_rings_at_its_closed_form_frequency() {
    let k = 3e8;
    let exact = (k * (0.1_f64.powi(2) / 0.02 + 0.2_f64.powi(2) / 0.3)).sqrt() / TAU;
    let external = rigid_gear_pair(k);
    let internal = external
        .replace("-50", "50")
        .replace("center_angle = 0.0", "internal = true\ncenter_angle = 0.0");
    for text in [external, internal] {
        let vibrations = assembled(&text).natural_vibrations().unwrap();
        let error = |found: f64| (found / exact - 1.0).abs();
        let nearest = vibrations
            .iter()
            .map(|one| error(one.frequency))
            .fold(f64::INFINITY, f64::min);
        // Gears of 1e11 kg hardly move sideways: (2/m) / (R_a^2/J_a + R_b^2/J_b) / 2 = 2e-11.
        assert!(nearest < 1e-9, "{nearest:e}");
    }
}

#[test]
fn mean_matrices_of_a_consistent_train_are_symmetric() {
    for text in [gear_pair(6, "law = \"constant\"\nmean = 4e8", ""), star()] {
        let (stiffness, _) = assembled(&text).mean_matrices();
        // 1e-12: rounding of sums in another order.
        assert!((&stiffness - stiffness.transpose()).amax() < 1e-12 * stiffness.amax());
    }
}

/// A disk in the middle of a light shaft on stiff bearings: one mass on one spring.
fn jeffcott(speed: f64) -> String {
    format!(
        "kind = \"gear_train\"\nname = \"jeffcott\"\n[basis]\nlateral_modes = 1\ntorsional_modes = 1\n\
         [material.default]\nyoungs_modulus = {E}\npoisson_ratio = {NU}\ndensity = 1e-6\n\
         [[rotor]]\nname = \"r\"\nspeed = {speed}\nmax_element_length = 0.1\nlateral_damping_ratio = 0.02\n\
         [[rotor.segment]]\nlength = 0.8\nouter_diameter = 0.02\n\
         [[rotor.disk]]\nposition = 0.4\nmass = 10.0\npolar_inertia = 1e-9\ndiametral_inertia = 1e-9\n\
         [[rotor.unbalance]]\nname = \"u\"\nposition = 0.4\nmoment = 1e-4\n\
         [[rotor.probe]]\nname = \"disk\"\nposition = 0.4\n\
         [[rotor.bearing]]\nname = \"b1\"\nposition = 0.0\nstiffness = {{ xx = 1e15 }}\n\
         [[rotor.bearing]]\nname = \"b2\"\nposition = 0.8\nstiffness = {{ xx = 1e15 }}\n"
    )
}

#[test]
fn jeffcott_rotor_answers_unbalance_through_resonance() {
    let (mass, moment, zeta) = (10.0, 1e-4, 0.02);
    let critical = assembled(&jeffcott(1.0)).rotors[0].lateral_frequencies[0] * TAU;
    for ratio in [0.3, 0.9, 1.0, 1.1, 3.0] {
        let speed = ratio * critical;
        let model = assembled(&jeffcott(speed));
        // F_x = m e Om^2 cos(Om t), F_y = m e Om^2 sin(Om t) at the disk.
        let force = moment * speed * speed;
        let disk = &model.rotors[0].probes[0];
        let cosine = disk
            .x
            .to_dense(model.system.size)
            .iter()
            .map(|row| row * force)
            .collect::<Vec<_>>();
        let sine = disk
            .y
            .to_dense(model.system.size)
            .iter()
            .map(|row| row * force)
            .collect::<Vec<_>>();
        let amplitude = support::steady_amplitude(&model, speed, &cosine, &sine);
        let found = disk
            .x
            .to_dense(model.system.size)
            .iter()
            .zip(amplitude.iter())
            .map(|(&w, &q)| q * w)
            .sum::<nalgebra::Complex<f64>>();
        // x = e r^2 / (1 - r^2 + 2 i zeta r)
        let exact = nalgebra::Complex::new(moment / mass * ratio * ratio, 0.0)
            / nalgebra::Complex::new(1.0 - ratio * ratio, 2.0 * zeta * ratio);
        assert!(
            (found - exact).norm() < 1e-6 * exact.norm(),
            "r = {ratio}: {found} against {exact}"
        );
    }
}

#[test]
fn overhung_disk_whirls_forward_and_backward_as_closed_form_says() {
    // A rigid carrier in two stiff bearings clamps the shaft; a light shaft has the disk's two modes only.
    let (length, d, mass, jd, jp, speed) = (0.3_f64, 0.03_f64, 8.0, 0.05, 0.1, 500.0);
    let text = format!(
        "kind = \"gear_train\"\nname = \"overhung\"\n[basis]\nlateral_modes = 2\ntorsional_modes = 1\n\
         [material.default]\nyoungs_modulus = {E}\npoisson_ratio = {NU}\ndensity = 1e-6\n\
         [material.rigid]\nyoungs_modulus = 1e17\npoisson_ratio = 0.3\ndensity = 1e-6\n\
         [[rotor]]\nname = \"r\"\nspeed = {speed}\nmax_element_length = 0.3\n\
         [[rotor.segment]]\nlength = 0.1\nouter_diameter = 0.1\nmaterial = \"rigid\"\n\
         [[rotor.segment]]\nlength = {length}\nouter_diameter = {d}\n\
         [[rotor.disk]]\nposition = {}\nmass = {mass}\npolar_inertia = {jp}\ndiametral_inertia = {jd}\n\
         [[rotor.bearing]]\nname = \"b1\"\nposition = 0.0\nstiffness = {{ xx = 1e14 }}\n\
         [[rotor.bearing]]\nname = \"b2\"\nposition = 0.1\nstiffness = {{ xx = 1e14 }}\n",
        0.1 + length
    );
    // Cantilever: k = inverse of [[L^3/3EI + L/kGA, L^2/2EI], [L^2/2EI, L/EI]].
    let inertia = PI / 64.0 * d.powi(4);
    let shear = 6.0 * (1.0 + NU) / (7.0 + 6.0 * NU) * E / (2.0 * (1.0 + NU)) * PI / 4.0 * d * d;
    let ei = E * inertia;
    let flexibility = nalgebra::Matrix2::new(
        length.powi(3) / (3.0 * ei) + length / shear,
        length * length / (2.0 * ei),
        length * length / (2.0 * ei),
        length / ei,
    );
    let k = flexibility.try_inverse().unwrap();
    // Circular whirl x + i y ~ exp(i w t): det [[k11 - m w^2, k12], [k12, k22 - jd w^2 + jp Om w]] = 0.
    let determinant = |w: f64| {
        (k[(0, 0)] - mass * w * w) * (k[(1, 1)] - jd * w * w + jp * speed * w)
            - k[(0, 1)] * k[(1, 0)]
    };
    let vibrations = assembled(&text).natural_vibrations().unwrap();
    let lateral: Vec<_> = vibrations
        .iter()
        .filter(|one| one.frequency > 1.0)
        .collect();
    assert_eq!(lateral.len(), 4, "two forward and two backward whirls");
    for vibration in lateral {
        let w = vibration.frequency * TAU;
        // A root of the determinant for forward (+w) or backward (-w) whirl, within 1e-6.
        let crosses = |sign: f64| {
            determinant(sign * w * (1.0 - 1e-6)) * determinant(sign * w * (1.0 + 1e-6)) < 0.0
        };
        assert!(
            crosses(1.0) || crosses(-1.0),
            "{} Hz is no whirl speed",
            vibration.frequency
        );
    }
}
