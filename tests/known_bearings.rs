//! A housing by itself that knows the bearings on its points: closed forms, the housing as it is in the limit, and nothing else.
//!
//! ```text
//!   eta'' + (2 zeta w + psi' C psi) eta' + (w^2 + psi' K psi) eta = psi' (R + R' t),   R = F + K u + C u' at the step's start
//! ```

#![allow(clippy::disallowed_methods)] // tests compare with tolerances: the platform's sin will do

mod support;

use core::f64::consts::TAU;

use geartrain::interface::{Causality, Interface};
use geartrain::slave::Slave;
use support::slave::{initializing, read, references, stepping};
use support::{assembled, model_file};

/// A mode of 437 Hz at a point on which a bearing with cross-coupling stands.
const ONE_MODE: &str = "kind = \"housing\"\nname = \"one_mode\"\n[simulation]\nstart = \"rest\"\nknown_bearings = true\n\
    [[point]]\nname = \"p\"\nstiffness = { xx = 4e7, yy = 2e7, xy = 5e6, yx = -3e6 }\ndamping = { xx = 900.0, yy = 400.0, xy = 70.0 }\n\
    [[mode]]\nfrequency = 437.0\ndamping_ratio = 0.07\nshape = { p = [0.3, -0.2] }\n";
const OMEGA: f64 = TAU * 437.0;
const ZETA: f64 = 0.07;
const SHAPE: [f64; 2] = [0.3, -0.2];
/// psi' K psi and psi' C psi.
const STIFFNESS: f64 = 0.09 * 4e7 + 0.04 * 2e7 - 0.06 * (5e6 - 3e6);
const DAMPING: f64 = 0.09 * 900.0 + 0.04 * 400.0 - 0.06 * 70.0;

fn named(interface: &Interface, name: &str) -> u32 {
    let variable = interface.variables.iter().position(|one| one.name == name);
    u32::try_from(variable.unwrap_or_else(|| panic!("no {name}"))).unwrap()
}

fn value(slave: &mut Slave, interface: &Interface, name: &str) -> f64 {
    read(slave, &[named(interface, name)])[0]
}

/// eta and eta' of the mode.
#[derive(Clone, Copy)]
struct Swing {
    eta: f64,
    rate: f64,
}

impl Swing {
    /// After `time` on the bearing, under a rest of the force, projected on the mode, of `rest` + `slope` t.
    fn after(self, time: f64, rest: f64, slope: f64) -> Swing {
        let squared = OMEGA * OMEGA + STIFFNESS;
        let decay = ZETA * OMEGA + 0.5 * DAMPING;
        let damped = (squared - decay * decay).sqrt();
        // The straight line that the mode follows once it has stopped ringing.
        let along = slope / squared;
        let offset = (rest - 2.0 * decay * along) / squared;
        let (eta, rate) = (self.eta - offset, self.rate - along);
        let (fade, (sine, cosine)) = ((-decay * time).exp(), (damped * time).sin_cos());
        Swing {
            eta: offset
                + along * time
                + fade * (eta * cosine + (rate + decay * eta) / damped * sine),
            rate: along + fade * (rate * cosine - (squared * eta + decay * rate) / damped * sine),
        }
    }

    /// The rest of the modal force `force`.
    fn rest(self, force: f64) -> f64 {
        force + STIFFNESS * self.eta + DAMPING * self.rate
    }

    /// eta'' under the whole modal force.
    fn acceleration(self, force: f64) -> f64 {
        force - 2.0 * ZETA * OMEGA * self.rate - OMEGA * OMEGA * self.eta
    }

    fn check(self, slave: &mut Slave, interface: &Interface) {
        let found = value(slave, interface, "housing.modal[1]");
        close(found, self.eta, 1e-5);
        close(value(slave, interface, "p.vy"), SHAPE[1] * self.rate, 1e-2);
    }
}

fn close(found: f64, exact: f64, scale: f64) {
    // 1e-11: rounding of some products, of which K u is a few times larger than what is left of it.
    assert!(
        (found - exact).abs() < 1e-11 * scale,
        "{found}, exact {exact}"
    );
}

/// A length of few bits: others the solver rounds to 9 digits. Half a vibration.
const STEP: f64 = 5.0 / 4096.0;

#[test]
fn the_force_follows_the_motion_within_a_step_and_is_the_one_that_was_set_at_its_start() {
    let (mut slave, interface) = stepping(ONE_MODE, 1e-4);
    let force = named(&interface, "p.force_x");
    let mut swing = Swing {
        eta: 0.0,
        rate: 0.0,
    };
    for (index, pushed) in [120.0, -70.0, 30.0].into_iter().enumerate() {
        slave.set_real(&[force], &[pushed]).unwrap();
        let modal = SHAPE[0] * pushed;
        let acceleration = SHAPE[0] * swing.acceleration(modal);
        close(value(&mut slave, &interface, "p.ax"), acceleration, 100.0);
        slave.do_step(STEP * index as f64, STEP).unwrap();
        let rest = swing.rest(modal);
        swing = swing.after(STEP, rest, 0.0);
        swing.check(&mut slave, &interface);
        // The force has gone on with the motion; what the master has set stays what it is.
        let now = rest - STIFFNESS * swing.eta - DAMPING * swing.rate;
        let acceleration = SHAPE[0] * swing.acceleration(now);
        close(value(&mut slave, &interface, "p.ax"), acceleration, 100.0);
        assert_eq!(read(&mut slave, &[force]), [pushed]);
    }
}

#[test]
fn an_input_derivative_is_that_of_the_whole_force() {
    let (mut slave, interface) = stepping(ONE_MODE, 1e-4);
    let force = named(&interface, "p.force_x");
    let mut swing = Swing {
        eta: 0.0,
        rate: 0.0,
    };
    let mut set = 50.0;
    for (index, slope) in [9e4, -4e4].into_iter().enumerate() {
        slave.set_real(&[force], &[set]).unwrap();
        slave
            .set_input_derivatives(&[force], &[1], &[slope])
            .unwrap();
        let modal = SHAPE[0] * set;
        let rest_slope =
            SHAPE[0] * slope + STIFFNESS * swing.rate + DAMPING * swing.acceleration(modal);
        // While the derivative is set, it is that of the force.
        let mut rate = [0.0];
        let acceleration = named(&interface, "p.ax");
        slave
            .output_derivatives(&[acceleration], &[1], &mut rate)
            .unwrap();
        let own = 2.0 * ZETA * OMEGA * swing.acceleration(modal) + OMEGA * OMEGA * swing.rate;
        close(rate[0], SHAPE[0] * (SHAPE[0] * slope - own), 1e6);
        slave.do_step(STEP * index as f64, STEP).unwrap();
        swing = swing.after(STEP, swing.rest(modal), rest_slope);
        swing.check(&mut slave, &interface);
        set += slope * STEP;
        assert_eq!(read(&mut slave, &[force]), [set]);
    }
}

#[test]
fn extrapolation_continues_what_the_motion_does_not_explain() {
    let text = ONE_MODE.replace("known_", "input_extrapolation = true\nknown_");
    let (mut slave, interface) = stepping(&text, 1e-4);
    let force = named(&interface, "p.force_x");
    let still = Swing {
        eta: 0.0,
        rate: 0.0,
    };
    slave.set_real(&[force], &[120.0]).unwrap();
    slave.do_step(0.0, STEP).unwrap();
    let first = SHAPE[0] * 120.0;
    let swing = still.after(STEP, first, 0.0);
    slave.set_real(&[force], &[-70.0]).unwrap();
    slave.do_step(STEP, STEP).unwrap();
    // Two points make a line.
    let second = swing.rest(SHAPE[0] * -70.0);
    let swing = swing.after(STEP, second, (second - first) / STEP);
    swing.check(&mut slave, &interface);
}

/// Position and velocity of all modes of the box 2 ms after rest, under forces that grow linearly, with steps of this length.
fn pushed(text: &str, step: f64) -> Vec<f64> {
    let text = text.replace("[simulation]", "[simulation]\nstart = \"rest\"");
    let (mut slave, interface) = stepping(&text, 1e-8);
    let growing = [
        ("pinion_left.force_x", 4e5),
        ("pinion_right.force_y", -3e5),
        ("wheel_left.force_y", 7e5),
        ("foot.force_x", 1e5),
    ];
    let references = growing.map(|(name, _)| named(&interface, name));
    let slopes = growing.map(|(_, slope)| slope);
    let steps = (2e-3 / step).round();
    for index in 0..steps as u32 {
        let time = step * f64::from(index);
        slave
            .set_real(&references, &slopes.map(|slope| slope * time))
            .unwrap();
        slave
            .set_input_derivatives(&references, &[1; 4], &slopes)
            .unwrap();
        slave.do_step(time, step).unwrap();
    }
    let ends = ["x", "vx", "y", "vy"];
    let points = ["pinion_left", "pinion_right", "wheel_left", "sensor"];
    let names = points
        .iter()
        .flat_map(|point| ends.map(|end| format!("{point}.{end}")));
    names
        .map(|name| value(&mut slave, &interface, &name))
        .collect()
}

#[test]
fn short_steps_lead_to_the_housing_as_it_is() {
    let exact = pushed(&model_file("box.toml"), 1e-3);
    let errors = [2e-5, 1e-5].map(|step| {
        let found = pushed(&model_file("known_box.toml"), step);
        let part = |(found, exact): (&f64, &f64)| (found / exact - 1.0).abs();
        found.iter().zip(&exact).map(part).fold(0.0, f64::max)
    });
    // Of second order; 1e-2: (w h)^2 / 12 with w = sqrt(K / m) of 2e4 rad/s, and what a point moves across its force.
    assert!(
        errors[0] < 1e-2 && errors[1] < 0.3 * errors[0],
        "{errors:?}"
    );
}

#[test]
fn at_communication_points_the_housing_is_as_it_is() {
    let [mut known, mut plain] =
        ["known_box.toml", "box.toml"].map(|name| initializing(&model_file(name), 1e-6));
    let forces = [
        ("pinion_left.force_x", 3e3),
        ("wheel_left.force_y", -2e3),
        ("foot.force_y", 500.0),
    ];
    let mut answers = Vec::new();
    for (slave, interface) in [&mut known, &mut plain] {
        for (name, force) in forces {
            slave.set_real(&[named(interface, name)], &[force]).unwrap();
        }
        let outputs: Vec<u32> = [
            "sensor.x",
            "pinion_left.y",
            "housing.modal[3]",
            "wheel_left.ay",
            "housing.frequency[2]",
        ]
        .iter()
        .map(|name| named(interface, name))
        .collect();
        let input = named(interface, "pinion_left.force_x");
        let mut change = [0.0; 3];
        // In initialization mode the static solution follows the forces.
        slave
            .directional_derivative(&outputs[..3], (&[input], &[1.0]), &mut change)
            .unwrap();
        let start = read(slave, &outputs);
        slave.exit_initialization().unwrap();
        slave
            .directional_derivative(&outputs[3..4], (&[input], &[1.0]), &mut change[..1])
            .unwrap();
        answers.push((start, change));
    }
    assert_eq!(answers[0], answers[1]);
    // Under constant forces it stays in its equilibrium, whatever the step.
    let (slave, interface) = &mut known;
    let deflection = value(slave, interface, "sensor.x");
    slave.do_step(0.0, 3e-3).unwrap();
    slave.do_step(3e-3, 1e-5).unwrap();
    let after = value(slave, interface, "sensor.x");
    // 1e-9: rounding of K u, which the slave takes off and puts on again.
    assert!(
        (after / deflection - 1.0).abs() < 1e-9,
        "{after} {deflection}"
    );
    let frequencies = |name: &str| assembled(&model_file(name)).natural_vibrations().unwrap();
    assert_eq!(frequencies("known_box.toml"), frequencies("box.toml"));
}

#[test]
fn output_derivatives_are_those_of_the_step_to_come() {
    for slope in [None, Some(-3e5)] {
        let (mut slave, interface) = stepping(&model_file("known_box.toml"), 1e-8);
        let force = named(&interface, "pinion_left.force_y");
        let outputs = references(&interface, Causality::Output);
        slave.set_real(&[force], &[200.0]).unwrap();
        slave.do_step(0.0, 7e-4).unwrap();
        slave.set_real(&[force], &[150.0]).unwrap();
        if let Some(slope) = slope {
            slave
                .set_input_derivatives(&[force], &[1], &[slope])
                .unwrap();
        }
        let mut found = vec![0.0; outputs.len()];
        let orders = vec![1; outputs.len()];
        slave
            .output_derivatives(&outputs, &orders, &mut found)
            .unwrap();
        let before = read(&mut slave, &outputs);
        let step = 1e-8;
        slave.do_step(7e-4, step).unwrap();
        let after = read(&mut slave, &outputs);
        for (index, &output) in outputs.iter().enumerate() {
            let variable = &interface.variables[output as usize];
            let same =
                |other: &usize| interface.variables[outputs[*other] as usize].unit == variable.unit;
            let fastest = (0..outputs.len())
                .filter(same)
                .map(|other| found[other].abs());
            let difference = (after[index] - before[index]) / step;
            // 1e-3: w h of the fastest mode on its bearings, 1e4 Hz, and margin.
            let bound = 1e-3 * fastest.fold(0.0, f64::max);
            let error = (found[index] - difference).abs();
            let name = &variable.name;
            assert!(
                error <= bound,
                "{name}: {} found, {difference}",
                found[index]
            );
        }
    }
}

#[test]
fn with_the_parameter_at_0_the_bits_are_those_of_a_housing_that_knows_nothing() {
    let [known, plain] = ["known_box.toml", "box.toml"].map(|name| {
        let (mut slave, interface) = initializing(&model_file(name), 1e-6);
        if name == "known_box.toml" {
            let switch = named(&interface, "simulation.known_bearings");
            assert_eq!(read(&mut slave, &[switch]), [1.0]);
            slave.set_real(&[switch], &[0.0]).unwrap();
        }
        slave.exit_initialization().unwrap();
        let [force, x, a] =
            ["pinion_left.force_x", "sensor.x", "sensor.ay"].map(|name| named(&interface, name));
        let mut bits = Vec::new();
        for index in 0..20 {
            slave
                .set_real(&[force], &[f64::from(index * index)])
                .unwrap();
            slave.do_step(3e-5 * f64::from(index), 3e-5).unwrap();
            bits.extend(read(&mut slave, &[x, a]).into_iter().map(f64::to_bits));
        }
        bits
    });
    assert_eq!(known, plain);
}

#[test]
fn stiffness_and_damping_are_parameters() {
    let (mut slave, interface) = initializing(&ONE_MODE.replace("xx = 4e7", "xx = 1e7"), 1e-4);
    let stiffness = named(&interface, "p.stiffness.xx");
    assert_eq!(read(&mut slave, &[stiffness]), [1e7]);
    slave.set_real(&[stiffness], &[4e7]).unwrap();
    slave.exit_initialization().unwrap();
    slave
        .set_real(&[named(&interface, "p.force_x")], &[120.0])
        .unwrap();
    slave.do_step(0.0, STEP).unwrap();
    let still = Swing {
        eta: 0.0,
        rate: 0.0,
    };
    still
        .after(STEP, SHAPE[0] * 120.0, 0.0)
        .check(&mut slave, &interface);
}
