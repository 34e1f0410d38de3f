//! The housing: alone against closed forms, and with the rotors that stand on it.

#![allow(missing_docs)]
#![allow(clippy::disallowed_methods)] // tests compare with tolerances: the platform's sin will do

mod support;

use core::f64::consts::{PI, TAU};

use geartrain::config::{Problem, SolverChoice};
use geartrain::interface::{Causality, Interface};
use geartrain::slave::Slave;
use geartrain::train::load_beside;
use nalgebra::{DVector, Matrix2};
use support::run::Run;
use support::slave::{born, initializing, read, stepping};
use support::{assembled, beside, gear_pair, model_file, valid};

/// A mode of 437 Hz at a point with a shape of (0.3, -0.2) 1/sqrt(kg), and a sensor.
const ONE_MODE: &str = "kind = \"housing\"\nname = \"one_mode\"\n[simulation]\nstart = \"rest\"\n\
    [[point]]\nname = \"p\"\n[[point]]\nname = \"s\"\nobserve = true\n\
    [[mode]]\nfrequency = 437.0\ndamping_ratio = 0.07\nshape = { p = [0.3, -0.2], s = [0.0, 0.5] }\n";
const OMEGA: f64 = TAU * 437.0;
const ZETA: f64 = 0.07;

fn named(interface: &Interface, name: &str) -> u32 {
    let variable = interface.variables.iter().position(|one| one.name == name);
    u32::try_from(variable.unwrap_or_else(|| panic!("no {name}"))).unwrap()
}

fn value(slave: &mut Slave, interface: &Interface, name: &str) -> f64 {
    read(slave, &[named(interface, name)])[0]
}

fn close(found: f64, exact: f64, scale: f64) {
    // 1e-12: rounding of some products.
    assert!(
        (found - exact).abs() < 1e-12 * scale,
        "{found}, exact {exact}"
    );
}

#[test]
fn a_held_force_swings_a_mode_as_in_closed_form_whatever_the_step() {
    // Lengths of few bits: others the solver rounds to 9 digits.
    for step in [
        0.5_f64.powi(22),
        3.0 * 0.5_f64.powi(13),
        11.0 * 0.5_f64.powi(9),
    ] {
        let (mut slave, interface) = stepping(ONE_MODE, 1e-4);
        slave
            .set_real(&[named(&interface, "p.force_x")], &[120.0])
            .unwrap();
        // At once: psi_s psi_p F.
        close(value(&mut slave, &interface, "p.ax"), 0.09 * 120.0, 10.0);
        slave.do_step(0.0, step).unwrap();
        let (decay, damped) = (ZETA * OMEGA, OMEGA * (1.0 - ZETA * ZETA).sqrt());
        let (fade, angle) = ((-decay * step).exp(), damped * step);
        let (modal, static_) = (0.3 * 120.0, 0.3 * 120.0 / (OMEGA * OMEGA));
        let eta = static_ * (1.0 - fade * (angle.cos() + decay / damped * angle.sin()));
        let rate = modal / damped * fade * angle.sin();
        let acceleration = modal - 2.0 * ZETA * OMEGA * rate - OMEGA * OMEGA * eta;
        close(value(&mut slave, &interface, "p.x"), 0.3 * eta, static_);
        close(value(&mut slave, &interface, "s.y"), 0.5 * eta, static_);
        close(
            value(&mut slave, &interface, "p.vy"),
            -0.2 * rate,
            modal / OMEGA,
        );
        close(
            value(&mut slave, &interface, "s.ay"),
            0.5 * acceleration,
            modal,
        );
        close(
            value(&mut slave, &interface, "housing.modal[1]"),
            eta,
            static_,
        );
        assert_eq!(value(&mut slave, &interface, "s.x"), 0.0);
    }
}

#[test]
fn a_force_with_a_derivative_grows_exactly_linearly_in_a_step() {
    let (mut slave, interface) = stepping(ONE_MODE, 1e-4);
    let (slope, step) = (9e4, 0.5_f64.powi(10)); // of few bits
    let force = named(&interface, "p.force_x");
    slave
        .set_input_derivatives(&[force], &[1], &[slope])
        .unwrap();
    slave.do_step(0.0, step).unwrap();
    let (decay, damped) = (ZETA * OMEGA, OMEGA * (1.0 - ZETA * ZETA).sqrt());
    let (fade, angle) = ((-decay * step).exp(), damped * step);
    // Lag 2 zeta / w, and what fades from the start at rest.
    let lag = 2.0 * ZETA / OMEGA;
    let ringing = lag * angle.cos() + (2.0 * ZETA * ZETA - 1.0) / damped * angle.sin();
    let per_second = 0.3 * slope / (OMEGA * OMEGA);
    let exact = per_second * (step - lag + fade * ringing);
    close(
        value(&mut slave, &interface, "p.x"),
        0.3 * exact,
        per_second * step,
    );
    assert_eq!(read(&mut slave, &[force])[0], slope * step);
}

#[test]
fn equilibrium_is_the_static_deflection_and_answers_to_forces_in_initialization() {
    let text = ONE_MODE.replace("\"rest\"", "\"equilibrium\"");
    let (mut slave, interface) = initializing(&text, 1e-4);
    slave
        .set_real(&[named(&interface, "p.force_y")], &[-50.0])
        .unwrap();
    let static_ = 0.2 * 50.0 / (OMEGA * OMEGA);
    close(
        value(&mut slave, &interface, "p.y"),
        -0.2 * static_,
        static_,
    );
    close(value(&mut slave, &interface, "p.x"), 0.3 * static_, static_);
    close(value(&mut slave, &interface, "p.ay"), 0.0, 10.0);
    slave.exit_initialization().unwrap();
    slave.do_step(0.0, 0.01).unwrap();
    close(
        value(&mut slave, &interface, "p.y"),
        -0.2 * static_,
        static_,
    );
}

#[test]
fn a_mode_without_frequency_floats_from_rest_and_has_no_equilibrium() {
    let text = ONE_MODE.replace("437.0", "0.0");
    let (mut slave, interface) = stepping(&text, 1e-4);
    slave
        .set_real(&[named(&interface, "p.force_x")], &[2.0])
        .unwrap();
    slave.do_step(0.0, 0.5).unwrap();
    // psi^2 F t^2 / 2
    close(
        value(&mut slave, &interface, "p.x"),
        0.09 * 2.0 * 0.125,
        0.02,
    );
    let refused = load_beside(&text.replace("\"rest\"", "\"equilibrium\""), &beside).unwrap_err();
    assert!(
        refused[0].message.contains("start = \"rest\""),
        "{refused:?}"
    );
}

#[test]
fn parameters_of_modes_are_those_that_count() {
    let (mut slave, interface) = initializing(ONE_MODE, 1e-4);
    let names = ["housing.frequency[1]", "housing.damping_ratio[1]"];
    let references = names.map(|name| named(&interface, name));
    assert_eq!(read(&mut slave, &references), [437.0, 0.07]);
    slave.set_real(&references, &[200.0, 0.0]).unwrap();
    slave.exit_initialization().unwrap();
    slave
        .set_real(&[named(&interface, "p.force_x")], &[10.0])
        .unwrap();
    slave.do_step(0.0, 0.5 / 200.0).unwrap();
    // Half a period later an undamped mode stands at twice the static deflection.
    let twice = 2.0 * 0.09 * 10.0 / (TAU * 200.0).powi(2);
    close(value(&mut slave, &interface, "p.x"), twice, twice);
}

/// A shaft that does not bend on two equal bearings, which stand on points that move alike: 4 kg on 2 x 3e7 N/m.
fn rigid_on_mode(frequency: f64, shape: f64) -> (String, String) {
    let train = "kind = \"gear_train\"\nname = \"rigid\"\n[basis]\nlateral_modes = 1\ntorsional_modes = 1\n\
         [material.default]\nyoungs_modulus = 1e18\npoisson_ratio = 0.3\ndensity = 1e-9\n\
         [[rotor]]\nname = \"r\"\nspeed = 0.0\n[[rotor.segment]]\nlength = 0.4\nouter_diameter = 0.1\n\
         [[rotor.disk]]\nposition = 0.2\nmass = 4.0\npolar_inertia = 0.1\ndiametral_inertia = 0.05\n\
         [[rotor.bearing]]\nname = \"a\"\nposition = 0.0\nstiffness = { xx = 3e7 }\n\
         [[rotor.bearing]]\nname = \"b\"\nposition = 0.4\nstiffness = { xx = 3e7 }\n\
         [housing]\nfile = \"it.toml\"\n[housing.connect]\n\"r.a\" = \"left\"\n\"r.b\" = \"right\"\n";
    let housing = format!(
        "kind = \"housing\"\nname = \"it\"\n[[point]]\nname = \"left\"\n[[point]]\nname = \"right\"\n\
         [[mode]]\nfrequency = {frequency}\ndamping_ratio = 0.0\nshape = {{ left = [{shape}, 0.0], right = [{shape}, 0.0] }}\n"
    );
    (train.to_string(), housing)
}

#[test]
fn a_rotor_on_a_mode_vibrates_as_two_masses_do() {
    let (train, housing) = rigid_on_mode(300.0, 0.2);
    let files = |_: &str| Ok(housing.clone());
    let loaded = load_beside(&train, &files).unwrap();
    let model = geartrain::model::ModalModel::assemble(&loaded.train, None).unwrap();
    let found: Vec<f64> = model
        .natural_vibrations()
        .unwrap()
        .iter()
        .map(|one| one.frequency)
        .collect();
    // x = xi / sqrt(m), u = psi eta: both against the springs 2k between them.
    let (k, m, w) = (6e7, 4.0_f64, TAU * 300.0);
    let between = -k * 0.2 / m.sqrt();
    let matrix = Matrix2::new(k / m, between, between, w * w + k * 0.04);
    for squared in matrix.symmetric_eigenvalues().iter() {
        let exact = squared.sqrt() / TAU;
        // 1e-6: the shaft bends a little, E = 1e18 Pa.
        let near = found
            .iter()
            .any(|frequency| (frequency / exact - 1.0).abs() < 1e-6);
        assert!(near, "{exact} Hz among {found:?}");
    }
}

/// The pair of gears with everything that takes energy away left out, on the box.
fn without_losses() -> String {
    let text = gear_pair(5, "law = \"constant\"\nmean = 4e8", "")
        .replace(
            "lateral_damping_ratio = 0.01",
            "lateral_damping_ratio = 0.0",
        )
        .replace(
            "torsional_damping_ratio = 0.01",
            "torsional_damping_ratio = 0.0",
        )
        .replace("damping = { xx = 900.0 }", "")
        .replace("damping = { xx = 700.0 }", "")
        .replace("moment = 2e-4", "moment = 0.0")
        .replace("slope = 2", "slope = 0.0");
    format!(
        "{text}\n[housing]\nfile = \"box.toml\"\n[housing.connect]\n\
         \"one.left\" = \"pinion_left\"\n\"one.right\" = \"pinion_right\"\n\"two.left\" = \"wheel_left\"\n"
    )
}

#[test]
fn energy_stays_in_rotors_and_housing_together_over_a_hundred_mesh_periods() {
    let loaded = load_beside(&without_losses(), &|file| {
        let undamped = |text: String| text.replace("damping_ratio = 0.03", "damping_ratio = 0.0");
        beside(file).map(undamped)
    });
    let train = loaded.unwrap().train;
    let model = geartrain::model::ModalModel::assemble(&train, None).unwrap();
    let (stiffness, _) = model.mean_matrices();
    let energy = |run: &Run| {
        let q = DVector::from_column_slice(run.state.position());
        let velocity = DVector::from_column_slice(run.state.velocity());
        0.5 * velocity.norm_squared() + 0.5 * q.dot(&(&stiffness * &q))
    };
    let period = 1.0 / model.meshes[0].frequency();
    let size = model.system.size;
    let mut run = Run::new(model, &[0.0; 2], SolverChoice::Exponential, 1e-8);
    let kick = |i: usize| 0.01 * ((7 * i) as f64).sin();
    run.put(vec![0.0; size], (0..size).map(kick).collect());
    let first = energy(&run);
    for index in 1..=100 {
        run.advance_to(period * f64::from(index));
        // 1e-6: equations.md, section 6.
        assert!(
            (energy(&run) / first - 1.0).abs() < 1e-6,
            "{index}: {} of {first}",
            energy(&run)
        );
    }
}

#[test]
fn bearings_stand_still_on_a_housing_too_stiff_to_move() {
    let (train, housing) = rigid_on_mode(1e7, 0.2);
    let on_ground = train.split("[housing]").next().unwrap().to_string();
    let loaded = load_beside(&train, &|_| Ok(housing.clone())).unwrap();
    let held = geartrain::model::ModalModel::assemble(&loaded.train, None).unwrap();
    let lowest = |model: &geartrain::model::ModalModel| {
        let all = model.natural_vibrations().unwrap();
        all.iter()
            .map(|one| one.frequency)
            .find(|hertz| *hertz > 1.0)
            .unwrap()
    };
    let [held, ground] = [lowest(&held), lowest(&assembled(&on_ground))];
    // (f / 1e7 Hz)^2 and less.
    assert!((held / ground - 1.0).abs() < 1e-8, "{held} {ground}");
}

#[test]
fn inputs_of_held_bearings_give_way_to_the_points_of_the_housing() {
    let (mut slave, interface) = stepping(&model_file("boxed.toml"), 1e-6);
    let inputs: Vec<&str> = interface
        .variables
        .iter()
        .filter(|variable| variable.causality() == Causality::Input)
        .map(|variable| variable.name.as_str())
        .collect();
    let housing: Vec<&&str> = inputs
        .iter()
        .filter(|name| name.contains(".housing."))
        .collect();
    assert_eq!(housing.len(), 4, "{inputs:?}");
    assert!(
        housing
            .iter()
            .all(|name| name.starts_with("wheel_shaft.right."))
    );
    // Forces act where no bearing stands and that is not only looked at.
    assert!(inputs.contains(&"foot.force_x") && !inputs.contains(&"pinion_left.force_x"));
    assert!(!inputs.contains(&"sensor.force_x"));
    // What a bearing puts on the housing is what it sees of it: K (u - u_b), at rest.
    let text = model_file("boxed.toml")
        .replace("amplitude_x = 2e-6", "amplitude_x = 0.0")
        .replace("amplitude_y = 3e-6", "amplitude_y = 0.0");
    let (mut still, interface) = initializing(&text, 1e-6);
    let [ux, uy, bx, by, force] = [
        "pinion_shaft.left.x",
        "pinion_shaft.left.y",
        "pinion_left.x",
        "pinion_left.y",
        "pinion_shaft.left.force_x",
    ]
    .map(|name| value(&mut still, &interface, name));
    close(force, 6e7 * (ux - bx) + 4e6 * (uy - by), force.abs() * 1e2);
    assert!(bx.abs() > 1e-8 && value(&mut slave, &interface, "sensor.ax") != 0.0);
}

#[test]
fn the_derivative_of_a_points_velocity_is_its_acceleration() {
    for name in ["box.toml", "boxed.toml", "boxed_journal.toml"] {
        let (mut slave, interface) = stepping(&model_file(name), 1e-8);
        slave
            .set_real(&[named(&interface, "foot.force_y")], &[300.0])
            .unwrap();
        slave.do_step(0.0, 7.7e-4).unwrap();
        for point in ["foot", "sensor", "pinion_left"] {
            let [velocity, acceleration] =
                ["vx", "ax"].map(|end| named(&interface, &format!("{point}.{end}")));
            let mut rate = [0.0];
            slave
                .output_derivatives(&[velocity], &[1], &mut rate)
                .unwrap();
            let found = read(&mut slave, &[acceleration])[0];
            // 1e-9: the same sums in another order, of parts up to a thousand times larger.
            assert!(
                (rate[0] - found).abs() < 1e-9 * (found.abs() + 1.0),
                "{name} {point}: {} {found}",
                rate[0]
            );
        }
    }
}

#[test]
fn a_table_of_modes_says_what_modes_in_the_file_say() {
    let csv = "frequency,damping_ratio,p.x,p.y,s.x,s.y\n437.0,0.07,0.3,-0.2,0.0,0.5\n";
    let text = format!(
        "{}[modes]\nfile = \"m.csv\"\n",
        ONE_MODE.split("[[mode]]").next().unwrap()
    );
    let one = valid(ONE_MODE).train.housing.unwrap();
    let loaded = load_beside(&text, &|_| Ok(csv.to_string())).unwrap();
    assert_eq!(loaded.train.housing.unwrap(), one);
    // The file inside the FMU is the model: no other one is needed to wake it up.
    born(&model_file("box.toml"));
}

/// The problems of a train on the box, with changes to the three files.
fn problems(train: [&str; 2], housing: [&str; 2], modes: [&str; 2]) -> Vec<Problem> {
    let changed = |text: String, [from, to]: [&str; 2]| {
        assert!(
            from.is_empty() || text.contains(from),
            "nothing to replace: {from}"
        );
        text.replacen(from, to, 1)
    };
    let files = |file: &str| {
        let change = if file.ends_with("csv") {
            modes
        } else {
            housing
        };
        beside(file).map(|text| changed(text, change))
    };
    let text = changed(model_file("boxed.toml"), train);
    load_beside(&text, &files).expect_err("something is wrong")
}

const SAME: [&str; 2] = ["", ""];

#[test]
fn what_is_wrong_with_a_housing_names_file_line_and_rule() {
    let cases = [
        (
            ["= \"pinion_left\"", "= \"nowhere\""],
            SAME,
            SAME,
            None,
            "the housing has no point \"nowhere\"",
        ),
        (
            ["\"pinion_shaft.left\" =", "\"pinion_shaft.middle\" ="],
            SAME,
            SAME,
            None,
            "no such bearing; there are pinion_shaft.left",
        ),
        (
            ["= \"pinion_left\"", "= \"sensor\""],
            SAME,
            SAME,
            None,
            "is only looked at",
        ),
        (["box.toml", "bax.toml"], SAME, SAME, None, "file: "),
        (
            SAME,
            ["name = \"foot\"", "name = \"mesh\""],
            SAME,
            Some("box.toml"),
            "must be unique",
        ),
        (
            SAME,
            ["observe = true", "observe = 1"],
            SAME,
            Some("box.toml"),
            "must be true or false",
        ),
        (
            SAME,
            ["kind = \"housing\"", "kind = \"gear_train\""],
            SAME,
            Some("box.toml"),
            "must be \"housing\"",
        ),
        (
            SAME,
            ["damping_ratio = 0.03", ""],
            SAME,
            Some("box_modes.csv"),
            "no column damping_ratio",
        ),
        (
            SAME,
            SAME,
            ["517.0", "-517.0"],
            Some("box_modes.csv"),
            "must be 0 or more",
        ),
        (
            SAME,
            SAME,
            ["517.0", "fast"],
            Some("box_modes.csv"),
            "must be a number, found \"fast\"",
        ),
        (
            SAME,
            SAME,
            ["sensor.x", "sensor.z"],
            Some("box_modes.csv"),
            "column \"sensor.z\"",
        ),
        (
            SAME,
            SAME,
            ["foot.x", "fuss.x"],
            Some("box_modes.csv"),
            "\"fuss\" is no [[point]]",
        ),
        (
            SAME,
            SAME,
            ["0.26, 0.04", "0.26"],
            Some("box_modes.csv"),
            "fields",
        ),
    ];
    for (train, housing, modes, file, words) in cases {
        let found = problems(train, housing, modes);
        let told = found.iter().find(|problem| problem.message.contains(words));
        let told = told.unwrap_or_else(|| panic!("{words}: {found:#?}"));
        assert_eq!(told.file.as_deref(), file, "{told:?}");
        assert!(told.spot.is_some(), "{told:?}");
    }
    let line = problems(SAME, SAME, ["517.0", "-517.0"])[0]
        .spot
        .unwrap()
        .line;
    assert_eq!(line, 5, "the third mode, behind a comment and the titles");
}

#[test]
fn the_example_is_the_box_beam_that_it_says_it_is() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/examples/gearbox_housing.toml");
    let text = std::fs::read_to_string(path).unwrap();
    let housing = valid(&text).train.housing.unwrap();
    // Where each point is: the comments of the file.
    let places: Vec<[f64; 3]> = text
        .lines()
        .filter(|line| line.starts_with("[[point]]"))
        .map(|line| {
            let number = |name: &str| {
                let value = line.split(&format!("{name} = ")).nth(1);
                value.map_or(0.0, |rest| {
                    rest.split(" m").next().unwrap().parse().unwrap()
                })
            };
            [number("z"), number("X"), number("Y")]
        })
        .collect();
    assert_eq!(places.len(), housing.points.len());
    let (bend, twist) = ((2.0_f64 / 60.0).sqrt(), (2.0_f64 / 2.4).sqrt());
    for mode in &housing.modes {
        let bending = |hertz: f64| (mode.frequency / hertz).sqrt();
        for (shape, [z, x, y]) in mode.shape.iter().zip(&places) {
            let s = |n: f64| (n * PI * (z + 0.75) / 1.4).sin();
            let n = mode.frequency / 560.0;
            let exact = if n == n.round() {
                [-y * twist * s(n), x * twist * s(n)]
            } else if bending(320.0) == bending(320.0).round() {
                [0.0, bend * s(bending(320.0))]
            } else {
                [bend * s(bending(410.0)), 0.0]
            };
            for axis in 0..2 {
                // Six digits are printed.
                let error = (shape[axis] - exact[axis]).abs();
                assert!(
                    error < 5e-6 * exact[axis].abs() + 1e-12,
                    "{mode:?}: {shape:?}, {exact:?}"
                );
            }
        }
    }
}
