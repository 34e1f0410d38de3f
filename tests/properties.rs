//! What holds for every train: balances of force, moment, power and momentum, and the symmetries of space.
//!
//! Authority: closed form. Trains are drawn from a fixed seed, so that every run tests the same ones.

#![allow(clippy::disallowed_methods)] // tests compare with tolerances: the platform's sin will do

mod support;

use geartrain::config::SolverChoice;
use geartrain::model::equilibrium;
use nalgebra::DVector;
use proptest::prelude::*;
use proptest::test_runner::{Config, RngAlgorithm, TestCaseError, TestRng, TestRunner};
use random_trains::{Train, base_radius, trains};
use support::run::Run;
use support::{assembled, rms, rms_difference, valid};

/// Tests a property on `cases` trains, the same ones every time.
fn for_all(cases: u32, property: impl Fn(Train) -> Result<(), TestCaseError>) {
    let config = Config {
        cases,
        failure_persistence: None,
        ..Config::default()
    };
    let rng = TestRng::deterministic_rng(RngAlgorithm::ChaCha);
    let mut runner = TestRunner::new_with_rng(config, rng);
    runner.run(&trains(), property).unwrap();
}

fn run(train: &Train, tolerance: f64) -> Run {
    let torques: Vec<f64> = train.shafts.iter().map(|shaft| shaft.torque).collect();
    Run::new(
        assembled(&train.text()),
        &torques,
        SolverChoice::Exponential,
        tolerance,
    )
}

/// Some motion of all coordinates in which teeth are pressed by micrometres: fixed numbers without a pattern.
fn stir(run: &mut Run) {
    let n = run.model.system.size;
    let entry = |i: usize, scale: f64| scale * (1.0 + 7.3 * i as f64).sin();
    let position = (0..n).map(|i| entry(i, 2e-6)).collect();
    let velocity = (0..n).map(|i| entry(i + n, 2e-3)).collect();
    run.put(position, velocity);
}

#[test]
fn every_mesh_acts_and_reacts_also_in_modal_coordinates() {
    for_all(60, |train| {
        let mut run = run(&train, 1e-4);
        stir(&mut run);
        let motion = run.motion();
        for (index, (mesh, link)) in run.model.meshes.iter().zip(&train.links).enumerate() {
            let [on_a, on_b] = motion.mesh_loads(index);
            let force = on_a.x.hypot(on_a.y).max(1e-3);
            prop_assert!((on_a.x + on_b.x).hypot(on_a.y + on_b.y) < 1e-12 * force);
            // Moment about the centre of a: b's centre is at the distance at which the line of action touches both circles.
            let [a, b] = link
                .gears
                .map(|(shaft, gear)| base_radius(train.shafts[shaft].teeth[gear]));
            let distance = if link.internal { b - a } else { a + b } / 0.35_f64.cos();
            let (y, x) = link.center_angle.sin_cos();
            let moment = on_a.torque + on_b.torque + distance * (x * on_b.y - y * on_b.x);
            prop_assert!(
                moment.abs() < 1e-12 * force * (a + b),
                "{moment} N m at {force} N"
            );
            // Phi' of these loads is what the solver applies; the power is that of the deflection rates.
            let mut modal = vec![0.0; run.model.system.size];
            let mut power = 0.0;
            for (gear, load) in mesh.gears.iter().zip([on_a, on_b]) {
                let station = &run.model.rotors[gear.rotor].gears[gear.gear];
                let parts = [
                    (&station.x, load.x),
                    (&station.y, load.y),
                    (&station.theta, load.torque),
                ];
                for (row, part) in parts {
                    row.add_to(part, &mut modal);
                    power += part * row.dot(run.state.velocity());
                }
            }
            let flanks = if link.backlash.is_some() { 2 } else { 1 };
            let before: usize = train.links[..index]
                .iter()
                .map(|link| if link.backlash.is_some() { 2 } else { 1 })
                .sum();
            let mut rates = 0.0;
            for (flank, coupling) in run.model.system.couplings[before..before + flanks]
                .iter()
                .enumerate()
            {
                // One flank alone carries the force: its sign says which.
                let total = motion.mesh_force(index);
                let own = if flanks == 1 || (flank == 0) == (total > 0.0) {
                    total.abs()
                } else {
                    0.0
                };
                let own = if flanks == 1 { total } else { own };
                coupling.column.add_to(own, &mut modal);
                rates += own * coupling.row.dot(run.state.velocity());
            }
            let size = mesh
                .row
                .to_dense(modal.len())
                .iter()
                .fold(0.0_f64, |size, one| size.max(one.abs()));
            let left = modal.iter().fold(0.0_f64, |left, one| left.max(one.abs()));
            prop_assert!(left < 1e-12 * force * size, "{left}; rounding");
            prop_assert!(
                (power + rates).abs() < 1e-12 * force,
                "{power} W against {rates} W"
            );
        }
        Ok(())
    });
}

#[test]
fn the_equilibrium_leaves_nothing_but_a_rigid_acceleration() {
    for_all(60, |train| {
        let train = train.bilateral();
        let text = train.text();
        let model = assembled(&text);
        let inputs = support::file_inputs(&text);
        let found = equilibrium(&model, &inputs).unwrap();
        let (stiffness, _) = model.mean_matrices();
        let load = support::run::held_load(&model, &inputs);
        let left = DVector::from_vec(load.clone()) - stiffness * DVector::from_vec(found.position);
        let size = DVector::from_vec(load).amax();
        for (rotor, index) in model.rotors.iter().zip(0..) {
            let rigid = rotor.torsional.range().start;
            let end = rigid + rotor.counts.torsional;
            for i in (rotor.lateral.range().start..end).filter(|&i| i != rigid) {
                prop_assert!(
                    left[i].abs() < 1e-9 * size,
                    "rotor {index}, {i}: {} of {size}",
                    left[i]
                );
            }
        }
        // It turns the rotors in the ratio of their teeth: no mesh is deflected.
        let part = |mesh: &geartrain::model::Mesh| mesh.row.dot(left.as_slice());
        for mesh in &model.meshes {
            prop_assert!(part(mesh).abs() < 1e-9 * size * mesh.row.dot_row(&mesh.row).sqrt());
        }
        Ok(())
    });
}

#[test]
fn space_has_no_direction_no_handedness_and_meshes_no_first_gear() {
    for_all(16, |train| {
        let train = Train {
            skew: 4e6,
            ..train.bilateral()
        };
        let series = |train: &Train| -> Vec<Vec<f64>> {
            let mut run = run(train, 1e-8);
            let mut forces = vec![Vec::new(); train.links.len()];
            for sample in 1..=40 {
                run.advance_to(5e-5 * f64::from(sample));
                for (index, forces) in forces.iter_mut().enumerate() {
                    forces.push(run.motion().mesh_force(index));
                }
            }
            forces
        };
        let base = series(&train);
        for (name, other) in [
            ("turned", train.clone().turned(0.7)),
            ("mirrored", train.clone().mirrored()),
            ("swapped", train.clone().swapped()),
        ] {
            for (one, two) in base.iter().zip(series(&other)) {
                let error = rms_difference(one, &two) / rms(one);
                prop_assert!(error < 1e-7, "{name}: {error:e}; two runs with 1e-8");
            }
        }
        Ok(())
    });
}

fn energy(run: &Run) -> f64 {
    let (stiffness, _) = run.model.mean_matrices();
    let q = DVector::from_column_slice(run.state.position());
    let velocity = DVector::from_column_slice(run.state.velocity());
    0.5 * velocity.norm_squared() + 0.5 * q.dot(&(stiffness * &q))
}

#[test]
fn energy_stays_without_damping_over_a_hundred_mesh_periods() {
    for_all(10, |train| {
        let mut train = Train {
            damped: false,
            ..train.bilateral().quiet()
        };
        train.shafts.iter_mut().for_each(|shaft| shaft.torque = 0.0);
        let mut run = run(&train, 1e-9);
        stir(&mut run);
        let rate = run
            .model
            .meshes
            .iter()
            .map(geartrain::model::Mesh::frequency)
            .fold(0.0, f64::max);
        let before = energy(&run);
        for part in 1..=10 {
            run.advance_to(10.0 * f64::from(part) / rate);
            let change = energy(&run) / before - 1.0;
            prop_assert!(change.abs() < 1e-6, "{change:e}, the claim of equations.md");
        }
        Ok(())
    });
}

#[test]
fn energy_changes_by_the_work_of_torques_and_dampers() {
    for_all(10, |train| {
        let mut run = run(&train.bilateral().quiet(), 1e-9);
        stir(&mut run);
        let (_, damping) = run.model.mean_matrices();
        let power = |run: &Run| {
            let velocity = DVector::from_column_slice(run.state.velocity());
            let torques = run.model.torques().zip(run.inputs.torques());
            let given: f64 = torques
                .map(|(row, torque)| torque * row.dot(run.state.velocity()))
                .sum();
            given - velocity.dot(&(&damping * &velocity))
        };
        let before = energy(&run);
        // Boole's rule with steps far below the shortest period, 2e-5 s with these bases.
        let (h, mut work, mut moved) = (5e-7, 0.0, 0.0);
        let mut now = power(&run);
        for step in 0..400 {
            let mut sum = 7.0 * now;
            for (part, weight) in [(1, 32.0), (2, 12.0), (3, 32.0), (4, 7.0)] {
                run.advance_to(h * f64::from(4 * step + part));
                now = power(&run);
                sum += weight * now;
            }
            work += 2.0 / 45.0 * h * sum;
            moved += 4.0 * h * now.abs();
        }
        let change = energy(&run) - before;
        prop_assert!(
            (change - work).abs() < 1e-6 * moved.max(before),
            "{change} J against {work} J of {moved} J"
        );
        Ok(())
    });
}

#[test]
fn momentum_grows_with_the_external_torques_alone() {
    // Rotations in the ratio of the speeds deflect no flank of any mesh, so that sum of ratio x L_i grows with the sum of
    // ratio x T_i, whatever the meshes do: parting teeth, changing stiffness, loops.
    for_all(16, |train| {
        for simulation in ["start = \"rest\"", "start = \"rest\"\nspeed = \"free\""] {
            let train = Train {
                simulation,
                ..train.clone()
            };
            let mut run = run(&train, 1e-4);
            let ratios: Vec<f64> = train
                .shafts
                .iter()
                .map(|shaft| shaft.speed / train.shafts[0].speed)
                .collect();
            let momentum = |run: &Run| -> f64 {
                let of = |(rotor, ratio): (&geartrain::model::Rotor, &f64)| {
                    let rigid = rotor.torsional.range().start;
                    ratio * run.state.velocity()[rigid] / rotor.gears[0].theta.entry(rigid)
                };
                run.model.rotors.iter().zip(&ratios).map(of).sum()
            };
            let before = momentum(&run);
            let end = 4e-3;
            run.advance_to(end);
            let found = momentum(&run) - before;
            let torques = train.shafts.iter().map(|shaft| shaft.torque).zip(&ratios);
            let (mut exact, mut size) = (0.0, before.abs());
            for (torque, ratio) in torques {
                exact += ratio * torque * end;
                size += (ratio * torque * end).abs();
            }
            prop_assert!(
                (found - exact).abs() < 1e-9 * size,
                "{found} against {exact} N m s; rounding"
            );
        }
        Ok(())
    });
}

#[test]
fn drawn_trains_are_valid_and_of_every_kind() {
    let counts = std::cell::RefCell::new([0; 4]);
    for_all(60, |train| {
        valid(&train.text());
        let found = [
            train.links.iter().any(|link| link.internal),
            train.links.len() >= train.shafts.len(),
            train.shafts.iter().any(|shaft| shaft.teeth.len() > 1),
            train.links.iter().any(|link| link.backlash.is_some()),
        ];
        for (count, found) in counts.borrow_mut().iter_mut().zip(found) {
            *count += u32::from(found);
        }
        Ok(())
    });
    let counts = counts.into_inner();
    assert!(
        counts.iter().all(|&count| count > 8),
        "rings, loops, compound shafts, backlash: {counts:?}"
    );
}
