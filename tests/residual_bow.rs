//! Residual bow: the force it gives, slow roll, and amplification through resonance.
//!
//! Authority: closed form. Beam deflections: Timoshenko, Strength of Materials I; bowed Jeffcott rotor: Nicholas,
//! Gunter, Allaire, J. Eng. Power 98 (1976), and Genta, Dynamics of Rotating Systems, 2.6.

#![allow(clippy::disallowed_methods)] // tests compare with tolerances: the platform's sin will do

mod support;

use std::f64::consts::{PI, TAU};

use geartrain::config::BasisModes;
use geartrain::rotor::ModalRotor;
use geartrain::train::Basis;
use nalgebra::{Complex, DMatrix, DVector, Normed};
use support::valid;

const E: f64 = 2.1e11;
const NU: f64 = 0.3;

/// A uniform shaft, 0.8 m long and 30 mm thick, with `extra` on it.
fn shaft(speed: f64, density: f64, extra: &str, basis: &Basis) -> ModalRotor {
    let text = format!(
        "kind = \"gear_train\"\nname = \"bowed\"\n\
         [material.default]\nyoungs_modulus = {E}\npoisson_ratio = {NU}\ndensity = {density}\n\
         [[rotor]]\nname = \"r\"\nspeed = {speed}\nmax_element_length = 0.1\nlateral_damping_ratio = 0.02\n\
         [[rotor.segment]]\nlength = 0.8\nouter_diameter = 0.03\n{extra}"
    );
    ModalRotor::reduce(&valid(&text).train.rotors[0], basis, None).unwrap()
}

fn modes(lateral_modes: usize) -> Basis {
    Basis {
        modes: BasisModes::Counts {
            lateral_modes,
            torsional_modes: 1,
        },
        static_shapes: false,
    }
}

fn bow(positions: &str, amplitudes: &str) -> String {
    format!("[[rotor.bow]]\npositions = [{positions}]\namplitudes = [{amplitudes}]\n")
}

fn bearings(stiffness: f64, positions: [f64; 2]) -> String {
    let one = |(index, position): (usize, &f64)| {
        format!(
            "[[rotor.bearing]]\nname = \"b{index}\"\nposition = {position}\nstiffness = {{ xx = {stiffness} }}\n"
        )
    };
    positions.iter().enumerate().map(one).collect()
}

/// Modal load of point forces [N] at positions [m].
fn point_loads(rotor: &ModalRotor, forces: &[(f64, f64)]) -> DVector<f64> {
    let one =
        |&(position, force): &(f64, f64)| DVector::from_vec(rotor.lateral_row(position)) * force;
    forces.iter().map(one).sum()
}

/// Displacement at a position under a static modal load in x.
fn deflection(rotor: &ModalRotor, load: &DVector<f64>, position: f64) -> f64 {
    let n = rotor.counts().lateral;
    let q = rotor
        .lateral_stiffness
        .view((0, 0), (n, n))
        .into_owned()
        .lu()
        .solve(load)
        .unwrap();
    DVector::from_vec(rotor.lateral_row(position)).dot(&q)
}

#[test]
fn an_offset_between_two_others_gives_the_force_of_a_beam_on_two_supports() {
    // Three offsets, the middle one a = 0.2 mm: force P at the middle, -P/2 at the ends,
    // a = P (L^3 / 48 E I + L / 4 kappa G A).
    let (length, d, a) = (0.8_f64, 0.03_f64, 2e-4);
    let ei = E * PI / 64.0 * d.powi(4);
    let shear = 6.0 * (1.0 + NU) / (7.0 + 6.0 * NU) * E / (2.0 * (1.0 + NU)) * PI / 4.0 * d * d;
    let force = a / (length.powi(3) / (48.0 * ei) + length / (4.0 * shear));
    // The same bow on a tilted and shifted line, and with its positions in another order.
    for (positions, amplitudes) in [
        ("0.0, 0.4, 0.8", "0.0, 2e-4, 0.0"),
        ("0.0, 0.4, 0.8", "1e-3, 3.2e-3, 5e-3"),
        ("0.4, 0.8, 0.0", "2e-4, 0.0, 0.0"),
    ] {
        let text = bearings(1e8, [0.0, 0.8]) + &bow(positions, amplitudes);
        let rotor = shaft(0.0, 7800.0, &text, &modes(12));
        let exact = point_loads(
            &rotor,
            &[(0.0, -force / 2.0), (0.4, force), (0.8, -force / 2.0)],
        );
        let found = DVector::from_row_slice(&rotor.bows[0].load);
        // 1e-9: rounding of the stiffness matrix, 1e-16 x 1e9 N/m x 5 mm of 200 N.
        assert!(
            (found - &exact).amax() < 1e-9 * exact.amax(),
            "{amplitudes}"
        );
    }
}

#[test]
fn straight_lines_give_no_force() {
    for (positions, amplitudes) in [
        ("0.1, 0.4, 0.5, 0.8", "1e-3, 1e-3, 1e-3, 1e-3"),
        ("0.1, 0.7", "1e-3, -2e-3"),
        ("0.3", "1e-3"),
    ] {
        let text = bearings(1e8, [0.0, 0.8]) + &bow(positions, amplitudes);
        let rotor = shaft(0.0, 7800.0, &text, &modes(12));
        assert!(
            rotor.bows[0].load.iter().all(|&load| load == 0.0),
            "exactly, {positions}"
        );
    }
    let tilted = bearings(1e8, [0.0, 0.8]) + &bow("0.1, 0.4, 0.7", "1e-3, 2e-3, 3e-3");
    let rotor = shaft(0.0, 7800.0, &tilted, &modes(12));
    // 1 mm of bow at these places would give 1e3 N; 1e-19 m of rounding is left.
    let most = DVector::from_row_slice(&rotor.bows[0].load).amax();
    assert!(most < 1e-12 * 1e3, "{most:e}");
}

#[test]
fn at_low_speed_the_shaft_follows_its_bow_and_loads_no_bearing() {
    // With every mode, the static answer is the shape of the bow itself, seen from the line through the bearings,
    // soft or stiff: the force of a bow balances itself.
    for stiffness in [1e5, 1e9] {
        let text = bearings(stiffness, [0.1, 0.7])
            + &bow("0.1, 0.3, 0.5, 0.7, 0.8", "1e-4, 3e-4, -2e-4, 2e-4, 5e-4");
        let rotor = shaft(0.0, 7800.0, &text, &modes(18));
        let load = DVector::from_row_slice(&rotor.bows[0].load);
        let line = |z: f64| 1e-4 + (z - 0.1) / 0.6 * 1e-4;
        for (position, offset) in [
            (0.1, 1e-4),
            (0.3, 3e-4),
            (0.5, -2e-4),
            (0.7, 2e-4),
            (0.8, 5e-4),
        ] {
            let found = deflection(&rotor, &load, position);
            // 1e-9 of the largest offset: rounding of the highest modes.
            assert!(
                (found - offset + line(position)).abs() < 5e-13,
                "{stiffness}, {position}: {found}"
            );
        }
    }
}

#[test]
fn a_bowed_jeffcott_rotor_is_amplified_through_resonance() {
    // A disk in the middle of a light shaft, bowed by a there and turning: x + i y = z exp(i Om t),
    // z = a / (1 - r^2 + 2 i zeta r), r = Om / w; at r -> 0 the bow itself.
    let (a, zeta) = (3e-4, 0.02);
    let text = "[[rotor.disk]]\nposition = 0.4\nmass = 10.0\npolar_inertia = 1e-9\ndiametral_inertia = 1e-9\n"
        .to_string()
        + &bearings(1e15, [0.0, 0.8])
        + &bow("0.0, 0.4, 0.8", &format!("0.0, {a:?}, 0.0"))
        + "phase = 0.7\n";
    let critical = shaft(0.0, 1e-6, &text, &modes(1)).lateral_frequencies[0] * TAU;
    for ratio in [1e-4, 0.3, 0.9, 1.0, 1.1, 3.0] {
        let speed = ratio * critical;
        let rotor = shaft(speed, 1e-6, &text, &modes(1));
        let n = rotor.counts().lateral;
        // Load cos(Om t + psi) on A and sin(Om t + psi) on B: complex amplitudes exp(i psi) and -i exp(i psi).
        let bow = &rotor.bows[0];
        let turn = Complex::new(bow.phase.cos(), bow.phase.sin());
        let load = DVector::from_fn(2 * n, |i, _| {
            bow.load[i % n]
                * turn
                * if i < n {
                    Complex::new(1.0, 0.0)
                } else {
                    -Complex::i()
                }
        });
        let dynamic = DMatrix::from_fn(2 * n, 2 * n, |i, j| {
            let inertia = if i == j { speed * speed } else { 0.0 };
            let (k, d) = (&rotor.lateral_stiffness, &rotor.lateral_damping);
            Complex::new(k[(i, j)] - inertia, speed * d[(i, j)])
        });
        let q = dynamic.lu().solve(&load).unwrap();
        let found: Complex<f64> = rotor
            .lateral_row(0.4)
            .iter()
            .zip(q.iter())
            .map(|(&row, &q)| q * row)
            .sum();
        let exact = a * turn / Complex::new(1.0 - ratio * ratio, 2.0 * zeta * ratio);
        assert!(
            (found - exact).norm() < 1e-6 * exact.norm(),
            "r = {ratio}: {found} against {exact}"
        );
    }
}
