//! Teeth that part and strike: single impacts, many of them, energy and momentum through all of them.
//!
//! Authority: closed form.

#![allow(clippy::disallowed_methods)] // tests compare with tolerances: the platform's sin will do

mod support;

use std::f64::consts::PI;

use geartrain::config::{SolverChoice, Start};
use geartrain::solver::Coupling;
use nalgebra::DVector;
use support::run::{RigidPair, Run, rigid_pair};
use support::{assembled, gear_pair, set_going};

const STIFFNESS: f64 = 1e7;
const BACKLASH: f64 = 2e-4;

fn bouncing(zeta: f64) -> String {
    let damping = 2.0 * zeta * (STIFFNESS * RigidPair::mass()).sqrt();
    rigid_pair(
        "start = \"rest\"",
        0.0,
        [(0.0, 0.0); 2],
        &format!("contact = \"unilateral\"\nbacklash = {BACKLASH}\ndamping = {damping}"),
        &format!("law = \"constant\"\nmean = {STIFFNESS}"),
    )
}

/// The pair with the teeth just in touch on the reference flank and approaching with this velocity.
fn approaching(text: &str, velocity: f64, solver: SolverChoice, tolerance: f64) -> Run {
    let model = assembled(text);
    let mut run = Run::new(model, &[0.0; 2], solver, tolerance);
    let row = run.model.meshes[0]
        .rotation_row
        .to_dense(run.model.system.size);
    let squares: f64 = row.iter().map(|entry| entry * entry).sum();
    let along = row.iter().map(|entry| entry * velocity / squares).collect();
    run.put(vec![0.0; run.model.system.size], along);
    run
}

/// delta' of the reference flank.
fn rate(run: &Run) -> f64 {
    run.model.meshes[0].row.dot(run.state.velocity())
}

#[test]
fn a_single_impact_is_a_damped_half_wave_and_gives_back_its_restitution() {
    // m d'' + c d' + k d = 0 from d = 0, d' = v until k d + c d' = 0 (the teeth do not pull), at
    //   w_d t = pi - 2 asin zeta,   with   d' = -v exp(-zeta w t);   then free flight.
    let omega = (STIFFNESS / RigidPair::mass()).sqrt();
    let v = 0.3;
    for zeta in [0.0, 0.05, 0.3] {
        let wd = omega * (1.0_f64 - zeta * zeta).sqrt();
        let end = (PI - 2.0 * zeta.asin()) / wd;
        for solver in [SolverChoice::Exponential, SolverChoice::Newmark] {
            // Newmark's error adds up over the whole of a half wave: a tolerance further below the claim.
            let tolerance = if solver == SolverChoice::Newmark {
                1e-8
            } else {
                1e-7
            };
            let mut run = approaching(&bouncing(zeta), v, solver, tolerance);
            for part in [0.1, 0.35, 0.6, 0.95, 1.0, 1.2, 1.5] {
                let time = part * end;
                run.advance_to(time);
                let contact = time.min(end);
                let decay = v * (-zeta * omega * contact).exp();
                let (sine, cosine) = (wd * contact).sin_cos();
                let depth = decay / wd * sine;
                let speed = decay * (cosine - zeta * omega / wd * sine);
                let depth = depth + speed * (time - contact);
                let motion = run.motion();
                let (found, force) = (motion.mesh_deflection(0), motion.mesh_force(0));
                // 1e-6 of the amplitudes: the claim of equations.md.
                assert!(
                    (found - depth).abs() < 1e-6 * v / omega,
                    "{solver:?} {zeta} {part}: {found} {depth}"
                );
                assert!(
                    (rate(&run) - speed).abs() < 1e-6 * v,
                    "{solver:?} {zeta} {part}"
                );
                if part < 1.0 {
                    let exact = STIFFNESS * depth + 2.0 * zeta * omega * RigidPair::mass() * speed;
                    assert!(
                        (force - exact).abs() < 1e-6 * v * (STIFFNESS * RigidPair::mass()).sqrt()
                    );
                } else if part > 1.0 {
                    assert_eq!(force, 0.0, "apart");
                }
            }
        }
    }
}

#[test]
fn bounces_between_the_flanks_lose_their_restitution_each() {
    // exp(-zeta/sqrt(1 - zeta^2) (pi - 2 asin zeta)) per impact; contact and flight times add up.
    let (zeta, v, omega) = (0.04_f64, 0.2, (STIFFNESS / RigidPair::mass()).sqrt());
    let root = (1.0 - zeta * zeta).sqrt();
    let contact = (PI - 2.0 * zeta.asin()) / (omega * root);
    let restitution = (-zeta / root * (PI - 2.0 * zeta.asin())).exp();
    // A flank lets go at the depth d = -c d' / k: the flight is that much longer than the backlash.
    let mut run = approaching(&bouncing(zeta), v, SolverChoice::Exponential, 1e-7);
    let (mut time, mut speed) = (0.0, v);
    for impact in 1..=20 {
        time += contact;
        speed *= restitution;
        let left_at = 2.0 * zeta / omega * speed;
        // In the middle of the flight.
        let flight = (BACKLASH + left_at) / speed;
        run.advance_to(time + 0.5 * flight);
        let sign = if impact % 2 == 1 { -1.0 } else { 1.0 };
        let found = rate(&run);
        // 1e-6 of the first velocity: the tolerance is relative to the forces of the whole run.
        assert!(
            (found - sign * speed).abs() < 1e-6 * v,
            "impact {impact}: {found} against {speed}"
        );
        assert_eq!(run.motion().mesh_force(0), 0.0);
        time += flight;
    }
    assert_eq!(
        run.counts().events,
        40,
        "each impact begins and ends with an event"
    );
}

#[test]
fn a_touch_in_the_middle_of_a_long_flight_is_not_missed() {
    // A constant torque lets the teeth fall back towards the reference flank: d'' = a = T R_a / J_a. Thrown away from it with v
    // they come 0.3 % of the backlash too far, between the nodes of a step, and touch the other flank with u, which throws
    // them back with u after x = u/w sin wt - a/w^2 (1 - cos wt) = 0, at t = 2 atan(u w / a) / w; as they rose they fall.
    let (torque, omega) = (10.0, (STIFFNESS / RigidPair::mass()).sqrt());
    let a = torque * RigidPair::RADIUS[0] / RigidPair::INERTIA[0];
    let v = (2.0 * a * 1.003 * BACKLASH).sqrt();
    let u = (2.0 * a * 0.003 * BACKLASH).sqrt();
    let total = 2.0 * (v - u) / a + 2.0 * (u * omega / a).atan() / omega;
    let mut run = approaching(&bouncing(0.0), -v, SolverChoice::Exponential, 1e-4);
    run.inputs.torques_mut().copy_from_slice(&[torque, 0.0]);
    run.advance_to(0.999 * total); // the contact ends at the reference flank, where another one begins
    let left = 0.001 * total;
    let speed = v - a * left;
    // 1e-4: the tolerance.
    assert!(
        (rate(&run) / speed - 1.0).abs() < 1e-4,
        "{} m/s, {speed} m/s",
        rate(&run)
    );
    assert_eq!(run.counts().events, 2, "touch, and away again");
}

/// A pair with elastic shafts and bearings, without any damping, whose teeth can part.
fn undamped_pair(backlash: f64) -> String {
    gear_pair(
        4,
        "law = \"constant\"\nmean = 4e8",
        &format!("contact = \"unilateral\"\nbacklash = {backlash}"),
    )
    .replace("damping = { xx = 900.0 }", "")
    .replace("damping = { xx = 700.0 }", "")
    .replace("damping_ratio = 0.01", "damping_ratio = 0.0")
    .replace("moment = 2e-4", "moment = 0.0")
    .replace("slope = 2", "slope = 0")
}

/// Kinetic energy, elastic energy of the blocks, and k d^2 / 2 of the flanks that are pressed.
fn energy(run: &Run, k: f64, backlash: f64) -> f64 {
    let velocity = DVector::from_column_slice(run.state.velocity());
    let mut sum = 0.5 * velocity.norm_squared();
    for block in &run.model.system.blocks {
        let q = DVector::from_column_slice(&run.state.position()[block.range()]);
        sum += 0.5 * q.dot(&(&block.stiffness * &q));
    }
    let flanks = run.model.system.couplings.iter().zip([0.0, backlash]);
    for (flank, gap) in flanks {
        // Where the shafts bend towards each other, both flanks are pressed.
        let depth = (flank.row.dot(run.state.position()) - gap).max(0.0);
        sum += 0.5 * k * depth * depth;
    }
    sum
}

#[test]
fn impacts_on_both_flanks_keep_energy_without_damping() {
    // 100 mesh periods of an elastic pair that rattles freely: released from a load, it crosses the backlash.
    let k = 4e8;
    for backlash in [0.0, 2e-5] {
        let text = undamped_pair(backlash);
        let (mut front, mut back) = (0, 0);
        let loaded = set_going(
            assembled(&text),
            support::file_inputs(&text),
            Start::Equilibrium,
            1e-9,
        );
        let mut run = Run::new(assembled(&text), &[0.0; 2], SolverChoice::Exponential, 1e-9);
        let state = loaded.motion().state.clone();
        run.put(state.position().to_vec(), state.velocity().to_vec());
        let before = energy(&run, k, backlash);
        let period = std::f64::consts::TAU / (24.0 * 150.0);
        let mut worst = 0.0_f64;
        for sample in 1..=2000 {
            run.advance_to(0.05 * period * f64::from(sample));
            worst = worst.max((energy(&run, k, backlash) / before - 1.0).abs());
            let force = run.motion().mesh_force(0);
            front += u32::from(force > 0.0);
            back += u32::from(force < 0.0);
        }
        assert!(
            worst < 1e-6,
            "backlash {backlash}: {worst:e}, 1e-6 is the claim"
        );
        assert!(
            front > 100 && back > 100 && run.counts().events > 200,
            "{front} {back} {:?}",
            run.counts()
        );
    }
}

#[test]
fn no_flank_ever_pulls_and_both_never_push_at_once() {
    // Also with a damper that would pull while the teeth move apart.
    let text = undamped_pair(1e-5).replace("backlash", "damping_ratio = 0.3\nbacklash");
    let mut run = Run::new(
        assembled(&text),
        &[40.0, 40.0],
        SolverChoice::Exponential,
        1e-5,
    );
    let mesh = run.model.meshes[0].clone();
    let couplings = run.model.system.couplings.clone();
    let (mut open, mut closed) = (0, 0);
    for sample in 1..=3000 {
        if sample % 500 == 0 {
            let torques = run.inputs.torques_mut().iter_mut();
            torques.for_each(|torque| *torque = -*torque);
        }
        run.advance_to(1e-5 * f64::from(sample));
        let along = |coupling: &Coupling, of: &[f64]| coupling.row.dot(of);
        let depth = [
            along(&couplings[0], run.state.position()),
            along(&couplings[1], run.state.position()) - 1e-5,
        ];
        let rate = [0, 1].map(|flank| along(&couplings[flank], run.state.velocity()));
        let push = [0, 1].map(|flank| 4e8 * depth[flank] + mesh.damping * rate[flank]);
        let force = run.motion().mesh_force(0);
        // The law of equations.md, section 3, with its clamp.
        let exact = [0, 1].map(|flank| {
            if depth[flank] > 0.0 {
                push[flank].max(0.0)
            } else {
                0.0
            }
        });
        assert!(
            (force - (exact[0] - exact[1])).abs() <= 1e-9 * force.abs(),
            "{force} N, {exact:?} N"
        );
        assert!(exact[0] == 0.0 || exact[1] == 0.0);
        open += u32::from(force == 0.0);
        closed += u32::from(force != 0.0);
    }
    assert!(open > 50 && closed > 50, "{open} {closed}: both occur");
}

#[test]
fn momentum_passes_through_losses_of_contact() {
    // On both flanks the torques are -s F R_a and -s F R_b: L_a R_b - L_b R_a grows with the external torques alone,
    // in free spin as at prescribed speed. L = 1'J th' = th'_rigid / (shape of the rigid rotation).
    for free in ["", "[simulation]\nspeed = \"free\"\n"] {
        let text = undamped_pair(2e-5).replace("backlash", "damping_ratio = 0.05\nbacklash") + free;
        let mut run = Run::new(
            assembled(&text),
            &[60.0, 45.0],
            SolverChoice::Exponential,
            1e-4,
        );
        let momentum = |run: &Run| {
            let of = |rotor: usize| {
                let rotor = &run.model.rotors[rotor];
                let rigid = rotor.torsional.range().start;
                run.state.velocity()[rigid] / rotor.gears[0].theta.entry(rigid)
            };
            of(0) - of(1) // equal base radii
        };
        let before = momentum(&run);
        for end in [0.01, 0.02] {
            run.advance_to(end);
            run.inputs.torques_mut().copy_from_slice(&[-60.0, -30.0]); // through the backlash
        }
        let grown = momentum(&run) - before;
        let exact = (60.0 - 45.0) * 0.01 + (-60.0 + 30.0) * 0.01;
        assert!(
            (grown / exact - 1.0).abs() < 1e-9,
            "{grown} against {exact} N m s; rounding"
        );
        assert!(run.counts().events > 2, "contact was lost");
    }
}
