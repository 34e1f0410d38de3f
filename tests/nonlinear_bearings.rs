//! Bearings with clearance, cubic and Hertz forces, and bearings that follow the speed: periods, energies, steady states.
//!
//! Authority: closed form.

#![allow(clippy::disallowed_methods)] // tests compare with tolerances: the platform's sin will do

mod support;

use std::f64::consts::PI;

use geartrain::config::SolverChoice;
use support::run::Run;
use support::{assembled, head};

const SOLVERS: [SolverChoice; 2] = [SolverChoice::Exponential, SolverChoice::Newmark];
/// Mass of shaft and disk [kg].
const MASS: f64 = 10.0;

/// A disk in the middle of a rigid shaft, in a bearing at the same place: one mass in a plane.
fn point(stiffness: f64, nonlinear: &str, extra: &str) -> String {
    let disk = MASS - 100.0 * PI / 4.0 * 0.1 * 0.1 * 0.2;
    format!(
        "{}[material.rigid]\nyoungs_modulus = 1e15\npoisson_ratio = 0.3\ndensity = 100.0\n{extra}\
         [[rotor]]\nname = \"r\"\nspeed = 0.0\nmax_element_length = 0.1\n\
         [[rotor.segment]]\nlength = 0.2\nouter_diameter = 0.1\nmaterial = \"rigid\"\n\
         [[rotor.disk]]\nposition = 0.1\nmass = {disk}\npolar_inertia = 0.05\ndiametral_inertia = 0.05\n\
         [[rotor.bearing]]\nname = \"b\"\nposition = 0.1\nstiffness = {{ xx = {stiffness} }}\n{nonlinear}",
        head(2, 1)
    )
}

/// The mass released at (x, y) with a velocity.
fn released(text: &str, place: [f64; 2], velocity: [f64; 2], solver: SolverChoice) -> Run {
    // Far below the claims: without damping errors of phase add up, and Hertz's force is not smooth where it begins.
    let mut run = Run::new(assembled(text), &[], solver, 1e-9);
    let station = &run.model.rotors[0].bearings[0].station;
    // Translation without tilt: the squares of the shapes in the middle add up to 1/m.
    let shapes = [&station.x, &station.y].map(|row| row.to_dense(run.model.system.size));
    let along = |part: [f64; 2]| -> Vec<f64> {
        let mut sum = vec![0.0; run.model.system.size];
        for (shape, part) in shapes.iter().zip(part) {
            let square: f64 = shape.iter().map(|one| one * one).sum();
            assert!((square * MASS - 1.0).abs() < 1e-6, "a rigid body: {square}");
            sum.iter_mut()
                .zip(shape)
                .for_each(|(sum, one)| *sum += part * one / square);
        }
        sum
    };
    let (position, velocity) = (along(place), along(velocity));
    run.put(position, velocity);
    run
}

fn place(run: &Run) -> [f64; 2] {
    let station = &run.model.rotors[0].bearings[0].station;
    [&station.x, &station.y].map(|row| run.motion().displacement(row))
}

/// Integral of f from 0 to 1 by the midpoint rule on x = sin^2: good for roots at the end.
fn quadrature(f: impl Fn(f64) -> f64) -> f64 {
    let count = 4000;
    let at = |i: u32| (f64::from(i) + 0.5) / f64::from(count) * 0.5 * PI;
    let one = |i: u32| f(at(i).sin()) * at(i).cos();
    (0..count).map(one).sum::<f64>() * 0.5 * PI / f64::from(count)
}

#[test]
fn free_vibration_has_the_period_of_its_potential() {
    // From rest at a:  T = 4 integral from 0 to a of du / sqrt(2 (V(a) - V(u)) / m), with
    //   V = k u^2/2 + C u^(n+1)/(n+1):  Duffing's oscillator for n = 3, Hertz's contact for n = 3/2 and 10/9.
    let a = 2e-5;
    for (law, stiffness, coefficient, exponent) in [
        ("law = \"cubic\"\ncoefficient = 5e16", 4e7, 5e16, 3.0),
        ("law = \"hertz\"\ncoefficient = 1.5e10", 0.0, 1.5e10, 1.5),
        (
            "law = \"hertz\"\ncoefficient = 8e8\nexponent = 1.1111111111111112",
            1e6,
            8e8,
            10.0 / 9.0,
        ),
    ] {
        let potential = |u: f64| {
            0.5 * stiffness * u * u + coefficient * u.powf(exponent + 1.0) / (exponent + 1.0)
        };
        let rate = |s: f64| a / (2.0 * (potential(a) - potential(a * s)) / MASS).sqrt();
        let period = 4.0 * quadrature(rate);
        for solver in SOLVERS {
            let text = point(
                stiffness,
                &format!("[rotor.bearing.nonlinear]\n{law}\n"),
                "",
            );
            let mut run = released(&text, [0.8 * a, -0.6 * a], [0.0, 0.0], solver);
            // After ten and a quarter periods the mass passes the middle: the place tells the period.
            run.advance_to(10.25 * period);
            let speed = (2.0 * potential(a) / MASS).sqrt();
            let [x, y] = place(&run);
            let late = (0.8 * x - 0.6 * y) / speed;
            assert!(
                late.abs() < 1e-6 * 10.25 * period,
                "{law} {solver:?}: {late:e} s of {period:e} s"
            );
            assert!((0.6 * x + 0.8 * y).abs() < 1e-8 * a, "a straight line");
        }
    }
}

#[test]
fn a_radial_force_keeps_energy_and_angular_momentum() {
    // An orbit with both: F_r acts towards the middle and has a potential.
    let clearance = 6e-6;
    let law = format!(
        "[rotor.bearing.nonlinear]\nlaw = \"hertz\"\ncoefficient = 5e9\nclearance = {clearance}\n"
    );
    let potential = |r: f64| 0.5 * 3e6 * r * r + 5e9 * (r - clearance).max(0.0).powf(2.5) / 2.5;
    for solver in SOLVERS {
        let mut run = released(&point(3e6, &law, ""), [2e-5, 0.0], [0.0, 4e-3], solver);
        let invariants = |run: &Run| {
            let station = &run.model.rotors[0].bearings[0].station;
            let [x, y] = place(run);
            let [vx, vy] = [&station.x, &station.y].map(|row| row.dot(run.state.velocity()));
            let energy = 0.5 * MASS * (vx * vx + vy * vy) + potential(x.hypot(y));
            (energy, MASS * (x * vy - y * vx))
        };
        let before = invariants(&run);
        let mut worst = 0.0_f64;
        let mut inside = 0;
        for sample in 1..=500 {
            run.advance_to(2e-4 * f64::from(sample));
            let now = invariants(&run);
            worst = worst
                .max((now.0 / before.0 - 1.0).abs())
                .max((now.1 / before.1 - 1.0).abs());
            let [x, y] = place(&run);
            inside += u32::from(x.hypot(y) < clearance);
        }
        assert!(worst < 1e-6, "{solver:?}: {worst:e}");
        assert!(
            inside > 10 && run.counts().events > 20,
            "contact opens and closes: {inside} {:?}",
            run.counts()
        );
    }
}

#[test]
fn play_gives_free_flights_between_half_waves() {
    // Without a linear spring: m v crosses the play of 2 c in 2 c/v and turns round in half a wave of sqrt(k/m).
    let (clearance, k, v) = (1e-5_f64, 2e8_f64, 0.02);
    let law = format!(
        "[rotor.bearing.nonlinear]\nlaw = \"clearance\"\nclearance = {clearance}\nstiffness = {k}\n"
    );
    let omega = (k / MASS).sqrt();
    for solver in SOLVERS {
        let mut run = released(
            &point(0.0, &law, ""),
            [0.0, 0.0],
            [v * 0.6, v * 0.8],
            solver,
        );
        let (flight, half) = (clearance / v, PI / omega);
        for (time, exact) in [
            (0.5 * flight, 0.5 * clearance),
            (
                flight + 0.25 * half,
                clearance + v / omega * (0.25 * PI).sin(),
            ),
            (flight + half + flight, 0.0),
            (
                10.0 * (2.0 * flight + half) + flight + 0.5 * half,
                clearance + v / omega,
            ),
            (
                11.0 * (2.0 * flight + half) + flight + 0.5 * half,
                -clearance - v / omega,
            ),
        ] {
            run.advance_to(time);
            let [x, y] = place(&run);
            let found = 0.6 * x + 0.8 * y;
            let amplitude = clearance + v / omega;
            assert!(
                (found - exact).abs() < 1e-6 * amplitude,
                "{solver:?} {time}: {found} against {exact}"
            );
        }
    }
}

#[test]
fn the_bearing_force_that_is_shown_is_the_force_that_acts() {
    // m u'' = -force on the gearbox: second difference of the motion.
    let law = "damping = { xx = 300.0 }\n[rotor.bearing.nonlinear]\nlaw = \"cubic\"\ncoefficient = 5e16\n";
    let mut run = released(
        &point(2e7, law, ""),
        [2e-5, 1e-5],
        [0.0, 0.0],
        SolverChoice::Exponential,
    );
    let h = 1e-5;
    let (mut places, mut forces) = (vec![place(&run)], vec![[0.0; 2]]);
    for sample in 1..=200 {
        run.advance_to(h * f64::from(sample));
        places.push(place(&run));
        let bearing = &run.model.rotors[0].bearings[0];
        forces.push(run.motion().bearing_force(0, bearing, 0));
    }
    let largest = forces
        .iter()
        .flatten()
        .fold(0.0_f64, |largest, force| largest.max(force.abs()));
    for (three, force) in places.windows(3).zip(&forces[1..]) {
        for axis in [0, 1] {
            let second = (three[0][axis] - 2.0 * three[1][axis] + three[2][axis]) / (h * h);
            // (w h)^2 / 12 with the highest harmonics at 10^4 rad/s.
            assert!(
                (MASS * second + force[axis]).abs() < 1e-3 * largest,
                "{second} m/s^2, {force:?} N"
            );
        }
    }
}

#[test]
fn a_bearing_follows_the_speed_of_a_rotor_that_turns_freely() {
    // Stiffness over speed, a steady push by a displaced gearbox on one of two bearings: the rotor settles where
    // k(Om) (u_b - u) = k_2 u with the stiffness of the speed reached, 120 rad/s, between the points of the table.
    let table = "[[rotor.bearing.at_speed]]\nspeed = 0.0\nstiffness = { xx = 1e6 }\ndamping = { xx = 3000.0 }\n\
                 [[rotor.bearing.at_speed]]\nspeed = 200.0\nstiffness = { xx = 5e6 }\ndamping = { xx = 3000.0 }\n";
    let text = point(
        2e6,
        "damping = { xx = 3000.0 }\n",
        "[simulation]\nspeed = \"free\"\nstart = \"rest\"\n",
    ) + "[[rotor.bearing]]\nname = \"oil\"\nposition = 0.1\noutside_speeds = \"hold\"\n"
        + table
        + "[[rotor.torque]]\nname = \"t\"\nposition = 0.1\nslope = 0.1\n";
    for solver in SOLVERS {
        let mut run = Run::new(assembled(&text), &[12.0], solver, 1e-7);
        run.inputs.bases_mut()[1][0] = 1e-4;
        run.advance_to(15.0 * 0.5); // the speed settles with J/slope = 0.5 s
        let speed = run.motion().speed(0);
        assert!((speed / 120.0 - 1.0).abs() < 1e-6, "{speed}");
        // Two points: the interpolation is the straight line.
        let k = 1e6 + 4e6 * speed / 200.0;
        let exact = k * 1e-4 / (k + 2e6);
        let [x, _] = place(&run);
        assert!(
            (x / exact - 1.0).abs() < 1e-6,
            "{solver:?}: {x} against {exact} m"
        );
        let bearing = &run.model.rotors[0].bearings[1];
        let force = run.motion().bearing_force(0, bearing, 1);
        assert!((force[0] / (k * (exact - 1e-4)) - 1.0).abs() < 1e-5);
    }
}
