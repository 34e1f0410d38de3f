//! Stepped and hollow shafts of several materials, and where their stations are.
//!
//! Authority: closed form. Bars and beams in series: Timoshenko, Strength of Materials I; hollow Timoshenko beam:
//! Timoshenko, Young, Weaver, Vibration Problems in Engineering, 4th ed., 5.12, with Cowper's shear coefficient.

#![allow(clippy::disallowed_methods)] // tests compare with tolerances: the platform's sin will do

mod support;

use std::f64::consts::PI;

use geartrain::linalg::natural_modes;
use geartrain::rotor::FiniteElements;
use nalgebra::{DMatrix, DVector};
use support::valid;

/// One cylindrical piece: length, outer and inner diameter, and a material.
#[derive(Clone, Copy)]
struct Piece {
    length: f64,
    outer: f64,
    inner: f64,
    youngs_modulus: f64,
    poisson_ratio: f64,
    density: f64,
}

impl Piece {
    fn area(&self) -> f64 {
        PI / 4.0 * (self.outer.powi(2) - self.inner.powi(2))
    }

    fn second_moment(&self) -> f64 {
        PI / 64.0 * (self.outer.powi(4) - self.inner.powi(4))
    }

    fn shear_modulus(&self) -> f64 {
        self.youngs_modulus / (2.0 * (1.0 + self.poisson_ratio))
    }

    /// kappa G A, kappa of a ring after Cowper (1966).
    fn shear_stiffness(&self) -> f64 {
        let (nu, m2) = (self.poisson_ratio, (self.inner / self.outer).powi(2));
        let sum = (1.0 + m2).powi(2);
        let kappa = 6.0 * (1.0 + nu) * sum / ((7.0 + 6.0 * nu) * sum + (20.0 + 12.0 * nu) * m2);
        kappa * self.shear_modulus() * self.area()
    }
}

const STEEL: Piece = Piece {
    length: 0.4,
    outer: 0.06,
    inner: 0.02,
    youngs_modulus: 2.1e11,
    poisson_ratio: 0.3,
    density: 7800.0,
};
const TITANIUM: Piece = Piece {
    length: 0.3,
    outer: 0.05,
    inner: 0.035,
    youngs_modulus: 1.1e11,
    poisson_ratio: 0.34,
    density: 4430.0,
};
const BRONZE: Piece = Piece {
    length: 0.25,
    outer: 0.09,
    inner: 0.0,
    youngs_modulus: 1.03e11,
    poisson_ratio: 0.35,
    density: 8800.0,
};

fn elements(pieces: &[Piece], longest: f64, extra: &str) -> FiniteElements {
    let mut text = "kind = \"gear_train\"\nname = \"m\"\n".to_string();
    for (index, piece) in pieces.iter().enumerate() {
        text += &format!(
            "[material.m{index}]\nyoungs_modulus = {}\npoisson_ratio = {}\ndensity = {}\n",
            piece.youngs_modulus, piece.poisson_ratio, piece.density
        );
    }
    text += &format!("[[rotor]]\nname = \"r\"\nspeed = 0.0\nmax_element_length = {longest}\n");
    for (index, piece) in pieces.iter().enumerate() {
        text += &format!(
            "[[rotor.segment]]\nlength = {}\nouter_diameter = {}\ninner_diameter = {}\nmaterial = \"m{index}\"\n",
            piece.length, piece.outer, piece.inner
        );
    }
    FiniteElements::assemble(&valid(&(text + extra)).train.rotors[0])
}

/// Deflection under one load with the first `held` degrees of freedom fixed.
fn clamped(stiffness: &DMatrix<f64>, held: usize, load: usize) -> DVector<f64> {
    let n = stiffness.nrows() - held;
    let mut force = DVector::zeros(n);
    force[load - held] = 1.0;
    let free = stiffness.view((held, held), (n, n)).into_owned();
    free.cholesky().unwrap().solve(&force)
}

#[test]
fn a_stepped_bar_twists_by_the_sum_of_its_parts() {
    let pieces = [STEEL, TITANIUM, BRONZE];
    let bar = elements(&pieces, 0.03, "");
    let last = bar.stations.count() - 1;
    let twist = clamped(&bar.torsional_stiffness, 1, last)[last - 1];
    let exact: f64 = pieces
        .iter()
        .map(|piece| piece.length / (piece.shear_modulus() * 2.0 * piece.second_moment()))
        .sum();
    // 1e-12: linear elements are exact for end torques.
    assert!(
        (twist / exact - 1.0).abs() < 1e-12,
        "{twist} rad, exact {exact} rad"
    );
}

#[test]
fn a_stepped_cantilever_bends_and_shears_by_the_sum_of_its_parts() {
    let pieces = [STEEL, TITANIUM, BRONZE];
    let beam = elements(&pieces, 0.03, "");
    let last = beam.mass.nrows() - 2;
    let tip = clamped(&beam.shaft_stiffness, 2, last)[last - 2];
    // Moment P (L - z): integral of (L - z)^2 / E I, and of 1 / kappa G A.
    let length: f64 = pieces.iter().map(|piece| piece.length).sum();
    let (mut start, mut exact) = (0.0, 0.0);
    for piece in pieces {
        let (left, right) = (length - start, length - start - piece.length);
        let bending = piece.youngs_modulus * piece.second_moment();
        exact += (left.powi(3) - right.powi(3)) / (3.0 * bending)
            + piece.length / piece.shear_stiffness();
        start += piece.length;
    }
    // 1e-10: elements are exact for end loads; 32 of them have a condition of 1e6.
    assert!(
        (tip / exact - 1.0).abs() < 1e-10,
        "{tip} m, exact {exact} m"
    );
}

#[test]
fn a_stepped_free_bar_has_the_torsional_frequencies_of_its_impedances() {
    // Two bars joined, ends free: Z_1 tan(w L_1 / c_1) + Z_2 tan(w L_2 / c_2) = 0, Z = J_p sqrt(G rho).
    let pieces = [STEEL, BRONZE];
    let wave = |piece: &Piece, w: f64| {
        let (g, rho) = (piece.shear_modulus(), piece.density);
        let impedance = 2.0 * piece.second_moment() * (g * rho).sqrt();
        impedance * (w * piece.length * (rho / g).sqrt()).tan()
    };
    let residual = |w: f64| pieces.iter().map(|piece| wave(piece, w)).sum::<f64>();
    let frequencies = |longest: f64| -> Vec<f64> {
        let bar = elements(&pieces, longest, "");
        let modes = natural_modes(&bar.torsional_stiffness, &bar.inertia).unwrap();
        modes.squared_frequencies[1..3]
            .iter()
            .map(|w2| w2.sqrt())
            .collect()
    };
    let (coarse, fine) = (frequencies(0.025), frequencies(0.0125));
    for (coarse, fine) in coarse.iter().zip(fine) {
        // Lengths halved everywhere, second order: a third of the difference takes the error to fourth order.
        let limit = fine - (coarse - fine) / 3.0;
        let (below, above) = (
            residual(limit * (1.0 - 1e-6)),
            residual(limit * (1.0 + 1e-6)),
        );
        // A root of the rising residual, not a pole of a tangent, where it falls.
        assert!(
            below < 0.0 && above > 0.0,
            "{limit} rad/s: {below}, {above}"
        );
    }
}

#[test]
fn a_hollow_pinned_beam_has_timoshenkos_frequencies() {
    let piece = Piece {
        length: 1.0,
        ..TITANIUM
    };
    let exact = |n: f64| {
        let (area, inertia, beta) = (piece.area(), piece.second_moment(), n * PI / piece.length);
        let (e, rho) = (piece.youngs_modulus, piece.density);
        let shear = piece.shear_stiffness() / area; // kappa G
        let a = rho * rho * inertia / shear;
        let b = rho * area + rho * inertia * (1.0 + e / shear) * beta * beta;
        let c = e * inertia * beta.powi(4);
        (2.0 * c / (b + (b * b - 4.0 * a * c).sqrt())).sqrt()
    };
    let frequencies = |count: f64| -> Vec<f64> {
        let beam = elements(&[piece], 1.0 / count, "");
        let last = beam.mass.nrows() - 2;
        let held = |matrix: &DMatrix<f64>| {
            let columns = matrix.clone().remove_columns_at(&[0, last]);
            columns.remove_rows_at(&[0, last])
        };
        let modes = natural_modes(&held(&beam.shaft_stiffness), &held(&beam.mass)).unwrap();
        modes.squared_frequencies[..3]
            .iter()
            .map(|w2| w2.sqrt())
            .collect()
    };
    let (coarse, fine) = (frequencies(20.0), frequencies(40.0));
    for (index, (coarse, fine)) in coarse.iter().zip(fine).enumerate() {
        let limit = fine - (coarse - fine) / 3.0;
        let exact = exact(index as f64 + 1.0);
        // 1e-5: fourth order after extrapolation; 1e-3 without it in the third mode.
        assert!(
            (limit / exact - 1.0).abs() < 1e-5,
            "mode {index}: {limit}, exact {exact}"
        );
    }
}

#[test]
fn masses_and_inertias_of_the_pieces_add_up() {
    let pieces = [BRONZE, TITANIUM, STEEL, TITANIUM];
    let shaft = elements(&pieces, 0.07, "");
    let shift = DVector::from_fn(
        shaft.mass.nrows(),
        |i, _| if i % 2 == 0 { 1.0 } else { 0.0 },
    );
    let mass: f64 = pieces
        .iter()
        .map(|piece| piece.density * piece.area() * piece.length)
        .sum();
    let polar: f64 = pieces
        .iter()
        .map(|piece| piece.density * 2.0 * piece.second_moment() * piece.length)
        .sum();
    // 1e-12: rounding of sums.
    assert!((shift.dot(&(&shaft.mass * &shift)) / mass - 1.0).abs() < 1e-12);
    assert!((shaft.inertia.sum() / polar - 1.0).abs() < 1e-12);
}

#[test]
fn stations_are_the_named_places_and_equal_spans_between() {
    let probe = |name: &str, position: &str| {
        format!("[[rotor.probe]]\nname = \"{name}\"\nposition = {position}\n")
    };
    // On a step, on it but for rounding, at both ends (0.4 + 0.3 + 0.25 carries rounding), and a bow.
    let extra = probe("a", "0.4")
        + &probe("b", "0.4000000000000001")
        + &probe("c", "0.0")
        + &probe("d", "0.95")
        + "[[rotor.bow]]\npositions = [0.4, 0.55, 0.95]\namplitudes = [0.0, 1e-4, 0.0]\n";
    let shaft = elements(&[STEEL, TITANIUM, BRONZE], 0.1, &extra);
    let exact = [
        0.0,
        0.1,
        0.2,
        0.3,
        0.4,
        0.475,
        0.55,
        0.625,
        0.7,
        0.7 + 0.25 / 3.0,
        0.7 + 0.5 / 3.0,
        0.95,
    ];
    let found = shaft.stations.positions();
    assert_eq!(found.len(), exact.len(), "{found:?}");
    for (found, exact) in found.iter().zip(exact) {
        assert!(
            (found - exact).abs() < 1e-12,
            "{found} m, expected {exact} m"
        );
    }
    for position in [0.4, 0.400_000_000_000_000_1, 0.55, 0.95] {
        assert!((found[shaft.stations.at(position)] - position).abs() < 1e-12);
    }
}

#[test]
fn a_disk_on_a_step_and_one_just_beside_it_are_both_there() {
    let disk = |position: &str| {
        format!(
            "[[rotor.disk]]\nposition = {position}\nmass = 2.0\npolar_inertia = 0.1\ndiametral_inertia = 0.05\n"
        )
    };
    let extra = disk("0.4") + &disk("0.4") + &disk("0.4000001");
    let (plain, loaded) = (
        elements(&[STEEL, TITANIUM], 0.1, ""),
        elements(&[STEEL, TITANIUM], 0.1, &extra),
    );
    assert_eq!(
        loaded.stations.count(),
        plain.stations.count() + 1,
        "a tenth of a micrometre apart"
    );
    let added = loaded.inertia.sum() - plain.inertia.sum();
    assert!((added - 0.3).abs() < 1e-12, "three disks, {added} kg m^2");
    // The short element between them is very stiff and leaves the frequencies alone.
    let first = |elements: &FiniteElements| {
        let modes = natural_modes(&elements.torsional_stiffness, &elements.inertia).unwrap();
        modes.squared_frequencies[1].sqrt()
    };
    let together = elements(&[STEEL, TITANIUM], 0.1, &disk("0.4").repeat(3));
    // 1e-6: a tenth of a micrometre on half a metre, and 1e-7 of rounding beside so stiff an element.
    assert!((first(&loaded) / first(&together) - 1.0).abs() < 1e-6);
}
