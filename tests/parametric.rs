//! Excitation by the mesh itself: transmission error, and stiffness that varies smoothly.
//!
//! Authority: closed form; where there is none, Runge-Kutta with small steps on the one degree of freedom.

#![allow(clippy::disallowed_methods)] // tests compare with tolerances: the platform's sin will do

mod support;

use std::f64::consts::TAU;

use geartrain::config::SolverChoice;
use support::run::{RigidPair, Run, rigid_pair};
use support::{assembled, rms, rms_difference};

const STIFFNESS: f64 = 1e8;
const ZETA: f64 = 0.08;
/// Tooth frequency of 20 teeth at 150 rad/s [rad/s]; the pair itself has 7958 rad/s.
const OMEGA: f64 = 20.0 * 150.0;

fn pair(law: &str) -> Run {
    let damping = 2.0 * ZETA * (STIFFNESS * RigidPair::mass()).sqrt();
    let mesh = format!("phase = 0.2\ndamping = {damping}");
    let text = rigid_pair("start = \"rest\"", 150.0, [(0.0, 0.0); 2], &mesh, law);
    Run::new(
        assembled(&text),
        &[100.0, 200.0],
        SolverChoice::Exponential,
        1e-7,
    )
}

#[test]
fn transmission_error_moves_a_constant_mesh_as_its_harmonics_say() {
    // delta = x - e with m x'' + c (x' - e') + k (x - e) = f, f = m (R_a T_a/J_a + R_b T_b/J_b):
    //   every harmonic of delta = m w^2 / (k - m w^2 + i c w) times that of e, with the phase p = p_0 + w t/2 pi.
    let harmonics = [(1.0, 2e-6, 0.4), (2.0, 1e-6, -1.1), (3.0, 7e-7, 2.0)];
    let errors: String = harmonics
        .iter()
        .map(|(order, amplitude, phase)| {
            format!("[[mesh.transmission_error]]\norder = {order}\namplitude = {amplitude}\nphase = {phase}\n")
        })
        .collect();
    let law = format!("law = \"constant\"\nmean = {STIFFNESS}\n{errors}");
    let mut run = pair(&law);
    run.advance_to(0.05); // zeta w t = 32
    let (m, c) = (
        RigidPair::mass(),
        2.0 * ZETA * (STIFFNESS * RigidPair::mass()).sqrt(),
    );
    let [ra, rb] = [0, 1].map(|i| RigidPair::RADIUS[i] / RigidPair::INERTIA[i]);
    let load = m * (100.0 * ra + 200.0 * rb);
    let (mut found, mut exact) = (Vec::new(), Vec::new());
    for sample in 1..=200 {
        let time = 0.05 + 2e-5 * f64::from(sample);
        run.advance_to(time);
        let (mut delta, mut rate) = (load / STIFFNESS, 0.0);
        for (order, amplitude, phase) in harmonics {
            let w = order * OMEGA;
            let (re, im) = (STIFFNESS - m * w * w, c * w);
            let gain = m * w * w / re.hypot(im);
            let angle = TAU * order * 0.2 + w * time + phase - im.atan2(re);
            delta += gain * amplitude * angle.cos();
            rate -= gain * amplitude * w * angle.sin();
        }
        found.push(run.motion().mesh_force(0));
        exact.push(STIFFNESS * delta + c * rate);
    }
    let error = rms_difference(&found, &exact) / rms(&exact);
    assert!(error < 1e-6, "{error:e}");
}

#[test]
fn smooth_stiffness_drives_the_mesh_as_runge_kutta_says() {
    // m x'' + c x' + k(p) x = f from rest, Mathieu's equation and its relatives.
    let fourier = |p: f64| STIFFNESS * (1.0 + 0.3 * (TAU * p).cos() - 0.2 * (2.0 * TAU * p).sin());
    // Two pairs of a contact ratio of 1.7, their ramps of 0.3.
    let tooth_pair = |p: f64| -> f64 {
        let x0 = p - p.floor();
        let one = |x: f64| {
            if !(0.0..=1.7).contains(&x) {
                return 0.0;
            }
            let (xi, u) = (2.0 * x / 1.7 - 1.0, (x.min(1.7 - x) / 0.3).clamp(0.0, 1.0));
            7e7 * (1.0 - 0.25 * xi * xi) * u * u * u * (10.0 - 15.0 * u + 6.0 * u * u)
        };
        one(x0) + one(x0 + 1.0)
    };
    let (m, c) = (
        RigidPair::mass(),
        2.0 * ZETA * (STIFFNESS * RigidPair::mass()).sqrt(),
    );
    let [ra, rb] = [0, 1].map(|i| RigidPair::RADIUS[i] / RigidPair::INERTIA[i]);
    let load = m * (100.0 * ra + 200.0 * rb);
    let laws: [(String, &dyn Fn(f64) -> f64); 2] = [
        (
            format!(
                "law = \"fourier\"\nmean = {STIFFNESS}\ncosine = [0.3, 0.0]\nsine = [0.0, -0.2]"
            ),
            &fourier,
        ),
        (
            "law = \"tooth_pair\"\npair = 7e7\nquadratic = 0.25\nramp = 0.3\ncontact_ratio = 1.7"
                .to_string(),
            &tooth_pair,
        ),
    ];
    for (law, stiffness) in laws {
        let mut run = pair(&law);
        let (mut found, mut exact) = (Vec::new(), Vec::new());
        let (mut x, mut v) = (0.0, 0.0);
        // w h = 8e-3: the error of fourth order is 1e-9 per period. The second derivative of the ramp jumps.
        let h = 1e-6;
        let rate =
            |t: f64, x: f64, v: f64| (load - c * v - stiffness(0.2 + OMEGA * t / TAU) * x) / m;
        for step in 0..20_000 {
            let t = h * f64::from(step);
            let a1 = rate(t, x, v);
            let (v2, a2) = (
                v + 0.5 * h * a1,
                rate(t + 0.5 * h, x + 0.5 * h * v, v + 0.5 * h * a1),
            );
            let (v3, a3) = (
                v + 0.5 * h * a2,
                rate(t + 0.5 * h, x + 0.5 * h * v2, v2 + 0.5 * h * (a2 - a1)),
            );
            let (v4, a4) = (v + h * a3, rate(t + h, x + h * v3, v + h * a3));
            x += h / 6.0 * (v + 2.0 * v2 + 2.0 * v3 + v4);
            v += h / 6.0 * (a1 + 2.0 * a2 + 2.0 * a3 + a4);
            if (step + 1) % 20 == 0 {
                let time = h * f64::from(step + 1);
                run.advance_to(time);
                found.push(run.motion().mesh_force(0));
                exact.push(stiffness(0.2 + OMEGA * time / TAU) * x + c * v);
            }
        }
        let error = rms_difference(&found, &exact) / rms(&exact);
        assert!(error < 1e-6, "{law}: {error:e}");
    }
}
