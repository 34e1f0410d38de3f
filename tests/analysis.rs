//! Kinds, whirl, Campbell table and critical speeds of trains that are known in closed form.
//!
//! Authority: textbooks. Genta, Dynamics of Rotating Systems, chapters 2 and 5: Jeffcott rotor, overhung
//! gyroscopic disk.

#![allow(clippy::disallowed_methods)] // tests compare with tolerances: the platform's powi will do

mod support;

use std::f64::consts::{PI, TAU};

use geartrain::analysis::{
    Campbell, ForceResponse, Kind, SpeedRange, Vibrations, Whirl, campbell, vibrations,
};
use nalgebra::{Complex, Matrix2};
use support::parts::{bearing, disk, shaft};
use support::{assembled, valid};

const E: f64 = 2.1e11;
const NU: f64 = 0.3;

fn head() -> String {
    format!(
        "kind = \"gear_train\"\nname = \"m\"\n[basis]\nlateral_modes = 2\ntorsional_modes = 2\n\
         [material.default]\nyoungs_modulus = {E}\npoisson_ratio = {NU}\ndensity = 1e-6\n\
         [material.rigid]\nyoungs_modulus = 1e17\npoisson_ratio = 0.3\ndensity = 1e-6\n"
    )
}

/// A disk of 10 kg in the middle of a light shaft on stiff bearings, and its stiffness [N/m]:
/// 1/k = L^3 / 48 E I + L / 4 kappa G A.
fn jeffcott(name: &str, speed: f64, diameter: f64) -> (String, f64) {
    let length: f64 = 0.8;
    let area = PI / 4.0 * diameter * diameter;
    let shear = 6.0 * (1.0 + NU) / (7.0 + 6.0 * NU) * E / (2.0 * (1.0 + NU)) * area;
    let bending = E * PI / 64.0 * diameter.powi(4);
    let stiffness = 1.0 / (length.powi(3) / (48.0 * bending) + length / (4.0 * shear));
    let text = [
        shaft(name, speed, length, diameter, "default"),
        disk(0.4, 10.0, 1e-9, 1e-9),
        bearing("b1", 0.0, 1e15, 0.0),
        bearing("b2", length, 1e15, 0.0),
    ];
    (text.concat(), stiffness)
}

fn shapes(text: &str) -> Vibrations {
    vibrations(&assembled(text)).expect("the iteration converges")
}

fn table(text: &str, to: f64, count: usize) -> Campbell {
    let loaded = valid(text);
    let model = assembled(text);
    let nominal = shapes(text).oscillating;
    let range = SpeedRange {
        from: 0.0,
        to,
        count,
    };
    campbell(&loaded.config, &model.counts(), &nominal, &range).expect("the model has a table")
}

#[test]
fn two_disks_on_a_light_shaft_are_torsional() {
    // w^2 = k (1/J1 + 1/J2)
    let (j1, j2, d, length) = (0.3, 0.7, 0.01_f64, 0.5);
    let text = [
        head(),
        shaft("r", 0.0, length, d, "default"),
        disk(0.0, 1.0, j1, 0.1),
        disk(length, 1.0, j2, 0.1),
        bearing("b1", 0.0, 1e8, 0.0),
        bearing("b2", length, 1e8, 0.0),
    ];
    let found = shapes(&text.concat());
    let k = E / (2.0 * (1.0 + NU)) * PI / 32.0 * d.powi(4) / length;
    let exact = (k * (1.0 / j1 + 1.0 / j2)).sqrt() / TAU;
    let of_kind = |kind| found.oscillating.iter().filter(move |one| one.kind == kind);
    let torsional: Vec<f64> = of_kind(Kind::Torsional)
        .map(|one| one.natural.frequency)
        .collect();
    assert_eq!(torsional.len(), 1);
    // 1e-9: the shaft's own inertia is 1e-12 of the disks'.
    assert!(
        (torsional[0] / exact - 1.0).abs() < 1e-9,
        "{torsional:?}, exact {exact}"
    );
    assert_eq!(
        of_kind(Kind::Lateral).count(),
        4,
        "two modes in either plane"
    );
    assert_eq!(found.rigid, 1, "the free rotation");
}

/// Two gears that can only turn, against a mesh spring of 3e8 N/m.
fn gear_pair() -> String {
    let rotor = |name: &str, speed: f64, radius: f64, teeth: u32, inertia: f64| {
        [
            shaft(name, speed, 0.1, 0.3, "rigid"),
            format!(
                "[[rotor.gear]]\nname = \"g\"\nposition = 0.05\nteeth = {teeth}\nbase_radius = {radius}\n\
                 mass = 1e9\npolar_inertia = {inertia}\ndiametral_inertia = 1e7\n"
            ),
            bearing("b1", 0.0, 1e12, 0.0),
            bearing("b2", 0.1, 1e12, 0.0),
        ]
        .concat()
    };
    let mesh = "[[mesh]]\nname = \"m\"\ngears = [\"a.g\", \"b.g\"]\ncenter_angle = 0.0\n\
                pressure_angle = 0.35\n[mesh.stiffness]\nlaw = \"constant\"\nmean = 3e8\n";
    [
        head().replace("torsional_modes = 2", "torsional_modes = 1"),
        rotor("a", 100.0, 0.1, 20, 0.02),
        rotor("b", -50.0, 0.2, 40, 0.3),
        mesh.to_string(),
    ]
    .concat()
}

#[test]
fn gears_that_ring_against_each_other_are_a_mesh_vibration_of_the_lighter_one() {
    let found = shapes(&gear_pair());
    let exact = (3e8 * (0.1_f64.powi(2) / 0.02 + 0.2_f64.powi(2) / 0.3)).sqrt() / TAU;
    let mesh: Vec<_> = found
        .oscillating
        .iter()
        .filter(|one| one.kind == Kind::Mesh)
        .collect();
    assert_eq!(mesh.len(), 1);
    // 1e-8: gears of 1e9 kg move sideways by (2/m) / (R_a^2/J_a + R_b^2/J_b).
    assert!((mesh[0].natural.frequency / exact - 1.0).abs() < 1e-8);
    // Inertias at the line of action J/R^2: 2 kg and 7.5 kg.
    assert_eq!(mesh[0].rotor, 0);
    assert_eq!(found.rigid, 1, "the common rotation");
}

#[test]
fn transmission_error_presses_two_free_gears_as_closed_form_says() {
    // F = k (d - e), d = F / (w^2 m):   F = -k e / (1 - k / (w^2 m))
    let model = assembled(&gear_pair());
    let response = ForceResponse::of(&model);
    let error = response
        .sources
        .iter()
        .position(|source| matches!(source, geartrain::analysis::Source::TransmissionError(0)))
        .unwrap();
    let (k, m) = (3e8, 1.0 / (0.1_f64.powi(2) / 0.02 + 0.2_f64.powi(2) / 0.3));
    for w in [1e3, 1e4, 1e5] {
        let found = response.at(Complex::new(0.0, w)).unwrap()[(0, error)];
        let exact = -k / (1.0 - k / (w * w * m));
        // 1e-7: sideways motion as above, larger near the natural frequency.
        assert!(
            (found - exact).norm_sqr().sqrt() < 1e-7 * exact.abs(),
            "{found}, {exact}"
        );
    }
}

#[test]
fn jeffcott_rotors_are_lateral_each_on_its_own() {
    let (soft, k_soft) = jeffcott("soft", 50.0, 0.02);
    let (hard, k_hard) = jeffcott("hard", 80.0, 0.03);
    let one_mode = head().replace("lateral_modes = 2", "lateral_modes = 1");
    let found = shapes(&[one_mode, soft, hard].concat()).oscillating;
    let expected = [(0, k_soft), (0, k_soft), (1, k_hard), (1, k_hard)];
    let lateral: Vec<_> = found
        .iter()
        .filter(|one| one.kind == Kind::Lateral)
        .collect();
    assert_eq!(lateral.len(), 4);
    for (one, (rotor, k)) in lateral.iter().zip(expected) {
        assert_eq!(one.rotor, rotor);
        let exact = (k / 10.0).sqrt() / TAU;
        // 1e-8: bearings of 1e15 N/m against shafts below 1e6 N/m.
        assert!((one.natural.frequency / exact - 1.0).abs() < 1e-8);
    }
}

#[test]
fn damping_ratio_of_a_rigid_rotor_in_its_bearings_is_c_over_two_root_k_m() {
    let (m, k, c) = (20.0, 5e6, 900.0);
    let text = [
        head(),
        shaft("r", 0.0, 0.4, 0.1, "rigid"),
        disk(0.2, m, 0.1, 0.08),
        bearing("b1", 0.0, k, c),
        bearing("b2", 0.4, k, c),
    ];
    let mut found = shapes(&text.concat()).oscillating;
    found.retain(|one| one.kind == Kind::Lateral);
    // Up and down: 2 k on m. Tilting: 2 k l^2 on I_d.
    let bounce = 2.0 * c / (2.0 * (2.0 * k * m).sqrt());
    let tilt = 2.0 * c * 0.04 / (2.0 * (2.0 * k * 0.04 * 0.08_f64).sqrt());
    assert_eq!(found.len(), 4);
    for (one, exact) in found.iter().zip([bounce, bounce, tilt, tilt]) {
        // 1e-6: the shaft bends by 1e-8 of what the bearings give.
        assert!(
            (one.natural.damping_ratio / exact - 1.0).abs() < 1e-6,
            "{one:?}"
        );
        assert_eq!(
            (one.kind, one.whirl),
            (Kind::Lateral, None),
            "x and y alike, standing still"
        );
    }
}

/// A disk at the end of a light clamped shaft, and the stiffness it feels.
struct Overhung {
    mass: f64,
    diametral: f64,
    polar: f64,
    stiffness: Matrix2<f64>,
}

impl Overhung {
    fn new() -> Overhung {
        let (length, d) = (0.3_f64, 0.03_f64);
        let ei = E * PI / 64.0 * d.powi(4);
        let shear = 6.0 * (1.0 + NU) / (7.0 + 6.0 * NU) * E / (2.0 * (1.0 + NU)) * PI / 4.0 * d * d;
        // Cantilever: inverse of [[L^3/3EI + L/kGA, L^2/2EI], [L^2/2EI, L/EI]].
        let flexibility = Matrix2::new(
            length.powi(3) / (3.0 * ei) + length / shear,
            length * length / (2.0 * ei),
            length * length / (2.0 * ei),
            length / ei,
        );
        Overhung {
            mass: 8.0,
            diametral: 0.05,
            polar: 0.08,
            stiffness: flexibility.try_inverse().unwrap(),
        }
    }

    /// A rigid carrier in two stiff bearings clamps the shaft.
    fn text(&self, speed: f64) -> String {
        let carrier = shaft("r", speed, 0.1, 0.1, "rigid");
        let overhang = "[[rotor.segment]]\nlength = 0.3\nouter_diameter = 0.03\n";
        [
            head(),
            carrier.replace("max_element_length = 0.1", "max_element_length = 0.3"),
            overhang.to_string(),
            disk(0.4, self.mass, self.polar, self.diametral),
            bearing("b1", 0.0, 1e14, 0.0),
            bearing("b2", 0.1, 1e14, 0.0),
        ]
        .concat()
    }

    /// x + i y ~ exp(i w t): det [[k11 - m w^2, k12], [k12, k22 - I_d w^2 + I_p Om w]].
    fn determinant(&self, w: f64, speed: f64) -> f64 {
        let k = &self.stiffness;
        (k[(0, 0)] - self.mass * w * w)
            * (k[(1, 1)] - self.diametral * w * w + self.polar * speed * w)
            - k[(0, 1)] * k[(1, 0)]
    }
}

#[test]
fn campbell_table_of_an_overhung_disk_is_the_closed_form_at_every_speed() {
    let rotor = Overhung::new();
    // The other sense of rotation turns forward and backward around, too.
    for speed in [400.0, -400.0] {
        let found = table(&rotor.text(speed), 800.0, 5);
        assert_eq!(found.points.len(), 5);
        for point in &found.points {
            let signed = point.rotor_speeds[0];
            let lateral = point
                .vibrations
                .iter()
                .filter(|one| one.kind == Kind::Lateral);
            let lateral: Vec<_> = lateral.collect();
            assert_eq!(lateral.len(), 4, "two forward and two backward whirls");
            for one in lateral {
                let w = one.natural.damped_frequency * TAU;
                let sense = match one.whirl {
                    None => {
                        assert_eq!(point.speed, 0.0);
                        1.0
                    }
                    Some(Whirl::Forward) => signed.signum(),
                    Some(Whirl::Backward) => -signed.signum(),
                };
                // A root within 1e-6 (clamped by bearings of 1e14 N/m).
                let at = |part: f64| rotor.determinant(sense * w * part, signed);
                assert!(
                    at(1.0 - 1e-6) * at(1.0 + 1e-6) < 0.0,
                    "{} rad/s: {one:?}",
                    point.speed
                );
            }
            let mut branches: Vec<_> = point.branches.iter().flatten().collect();
            branches.sort_unstable();
            branches.dedup();
            assert_eq!(
                branches.len(),
                point.vibrations.len(),
                "every branch goes on"
            );
        }
    }
}

#[test]
fn overhung_disk_is_critical_where_whirl_and_rotation_agree() {
    let rotor = Overhung::new();
    let found = table(&rotor.text(400.0), 3000.0, 13);
    // Forward, w = Om: (k11 - m W) (k22 + (I_p - I_d) W) = k12^2, W = Om^2. Backward, w = -Om: I_p -> -I_p.
    let roots = |polar: f64| {
        let k = &rotor.stiffness;
        let (a, b) = (
            -rotor.mass * (polar - rotor.diametral),
            k[(0, 0)] * (polar - rotor.diametral) - rotor.mass * k[(1, 1)],
        );
        let c = k.determinant();
        let root = (b * b - 4.0 * a * c).sqrt();
        let squares = [(-b - root) / (2.0 * a), (-b + root) / (2.0 * a)];
        let real = squares
            .into_iter()
            .filter(|square| *square > 0.0 && *square < 9e6);
        real.map(f64::sqrt).collect::<Vec<f64>>()
    };
    for (whirl, polar) in [
        (Whirl::Forward, rotor.polar),
        (Whirl::Backward, -rotor.polar),
    ] {
        let mut exact = roots(polar);
        exact.sort_by(f64::total_cmp);
        let of_whirl = found.critical_speeds.iter();
        let speeds: Vec<f64> = of_whirl
            .filter(|one| one.vibration.whirl == Some(whirl))
            .map(|one| one.speed)
            .collect();
        assert_eq!(
            speeds.len(),
            exact.len(),
            "{whirl:?}: {speeds:?}, exact {exact:?}"
        );
        for (speed, exact) in speeds.iter().zip(&exact) {
            // 1e-6: the clamp.
            assert!(
                (speed / exact - 1.0).abs() < 1e-6,
                "{whirl:?}: {speed}, exact {exact}"
            );
        }
    }
}

#[test]
fn jeffcott_rotor_is_critical_at_root_k_over_m() {
    let (rotor, k) = jeffcott("r", 70.0, 0.02);
    let one_mode = head().replace("lateral_modes = 2", "lateral_modes = 1");
    let found = table(&(one_mode + &rotor), 300.0, 4);
    let speeds: Vec<f64> = found.critical_speeds.iter().map(|one| one.speed).collect();
    assert_eq!(
        speeds.len(),
        2,
        "forward and backward whirl at one speed: {speeds:?}"
    );
    let exact = (k / 10.0).sqrt();
    for speed in speeds {
        // 1e-8: bearings as above.
        assert!((speed / exact - 1.0).abs() < 1e-8, "{speed}, exact {exact}");
    }
}

#[test]
fn mesh_frequency_meets_the_natural_frequency_of_the_pair() {
    // z Om = w and 2 z Om = w of the gear pair, z = 20.
    let found = table(&gear_pair(), 1500.0, 7);
    let exact = (3e8 * (0.1_f64.powi(2) / 0.02 + 0.2_f64.powi(2) / 0.3)).sqrt();
    for harmonic in [1, 2] {
        let speed = exact / (20.0 * f64::from(harmonic));
        let matching = found.critical_speeds.iter().filter(|one| {
            let excitation = &found.excitations[one.excitation];
            one.vibration.kind == Kind::Mesh
                && excitation.meshes == [(0, harmonic)]
                // 1e-8: gears of 1e9 kg as above.
                && (one.speed / speed - 1.0).abs() < 1e-8
        });
        assert_eq!(
            matching.count(),
            1,
            "{harmonic} x mesh frequency at {speed} rad/s"
        );
    }
}
