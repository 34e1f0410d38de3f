//! Rotors that turn freely: run-up, load lines, coast-down, unbalance with acceleration, and free against prescribed.
//!
//! Authority: closed form.

#![allow(clippy::disallowed_methods)] // tests compare with tolerances: the platform's sin will do

mod support;

use geartrain::config::SolverChoice;
use support::run::{RigidPair, Run, rigid_pair};
use support::{assembled, head, rms, rms_difference};

const FREE: &str = "speed = \"free\"\nstart = \"rest\"";
const LAW: &str = "law = \"constant\"\nmean = 1e8";
const SOLVERS: [SolverChoice; 2] = [SolverChoice::Exponential, SolverChoice::Newmark];

/// J_1 + J_2 i^2 with i = z_1/z_2: what the first rotor has to accelerate [kg m^2].
fn reduced_inertia() -> f64 {
    let [one, two] = RigidPair::INERTIA;
    one + two * 0.25
}

fn free_pair(speed: f64, ports: [(f64, f64); 2]) -> Run {
    let text = rigid_pair(FREE, speed, ports, "damping_ratio = 0.1", LAW);
    let torques = ports.map(|(value, _)| value);
    Run::new(assembled(&text), &torques, SolverChoice::Exponential, 1e-6)
}

#[test]
fn a_run_up_from_rest_accelerates_with_torque_over_reduced_inertia() {
    let exact = 50.0 / reduced_inertia();
    for solver in SOLVERS {
        let text = rigid_pair(
            FREE,
            0.0,
            [(50.0, 0.0), (0.0, 0.0)],
            "damping_ratio = 0.2",
            LAW,
        );
        let mut run = Run::new(assembled(&text), &[50.0, 0.0], solver, 1e-6);
        // The oscillation that the sudden torque starts has died out after 0.05 s: zeta w t = 0.2 x 3900 x 0.05.
        run.advance_to(0.05);
        let before = [0, 1].map(|rotor| run.motion().speed(rotor));
        run.advance_to(0.25);
        let found = [0, 1].map(|rotor| (run.motion().speed(rotor) - before[rotor]) / 0.2);
        assert!(
            (found[0] / exact - 1.0).abs() < 1e-6,
            "{solver:?}: {found:?}, exact {exact}"
        );
        assert!(
            (found[1] / (-0.5 * exact) - 1.0).abs() < 1e-6,
            "{solver:?}: {found:?}"
        );
        // angle = Om'/2 t^2 up to the short beginning, which lags by the first twist of the teeth: 1e-5 rad.
        let angle = 0.5 * exact * 0.25 * 0.25;
        assert!(
            (run.motion().angle(0) - angle).abs() < 1e-4,
            "{}",
            run.motion().angle(0)
        );
        // The teeth carry what accelerates the second rotor: J_2 Om_2' / R_2.
        let force = RigidPair::INERTIA[1] * 0.5 * exact / RigidPair::RADIUS[1];
        assert!((run.motion().mesh_force(0) / force - 1.0).abs() < 1e-6);
    }
}

#[test]
fn rounded_lengths_of_steps_do_not_add_up() {
    // J_1 Om_1/R_1 - J_2 Om_2/R_2 grows by T_1/R_1 per second, however the teeth vibrate: a clock. Lengths of steps are rounded,
    // 5e-5 s by 2.5e-10 of itself, always the same way.
    let (torque, speed, step) = (50.0, 100.0, 5e-5);
    let law = "law = \"fourier\"\nmean = 1e8\ncosine = [-0.3, 0.1]";
    let mesh = "damping_ratio = 0.02";
    let text = rigid_pair(FREE, speed, [(torque, 0.0), (0.0, 0.0)], mesh, law);
    let momentum = |speeds: [f64; 2]| -> f64 {
        let [one, two] = [0, 1].map(|i| RigidPair::INERTIA[i] * speeds[i] / RigidPair::RADIUS[i]);
        one - two
    };
    let solver = SolverChoice::Exponential;
    let mut run = Run::new(assembled(&text), &[torque, 0.0], solver, 1e-8);
    let count = 200;
    for index in 1..=count {
        run.advance_to(step * f64::from(index));
    }
    let speeds = [0, 1].map(|rotor| run.motion().speed(rotor));
    let gained = momentum(speeds) - momentum([speed, -0.5 * speed]);
    let error = gained / (torque / RigidPair::RADIUS[0] * step * f64::from(count)) - 1.0;
    // 2e-11: a quarter of the tolerance of one of 200 calls, and rounding.
    assert!(error.abs() < 2e-11, "{error:e}");
}

#[test]
fn a_step_after_an_event_takes_all_the_time_that_is_left() {
    // Coasting pairs turn by Om t. Their stiffness jumps at 0.6 pitches, close to three quarters of the call: what is left of it
    // looks like a quarter, and is a little more or less.
    let speed = 100.0;
    let law = "law = \"rectangular\"\npair = 1e8\ncontact_ratio = 1.6";
    let text = rigid_pair(FREE, speed, [(0.0, 0.0); 2], "damping_ratio = 0.1", law);
    let jump = 0.6 * std::f64::consts::TAU / (20.0 * speed);
    for solver in SOLVERS {
        for beside in [-1e-6, -1e-8, 1e-7, 1e-6] {
            let end = jump / 0.75 * (1.0 + beside);
            let mut run = Run::new(assembled(&text), &[0.0; 2], solver, 1e-8);
            run.advance_to(end);
            assert_eq!(run.counts().events, 1, "the jump");
            let error = run.motion().angle(0) / (speed * end) - 1.0;
            // 1e-9: the last 22 bits of few lengths, which nobody makes up for in a single call.
            assert!(error.abs() < 1e-9, "{solver:?}, {beside}: {error:e}");
        }
    }
}

#[test]
fn a_load_line_ends_the_run_up_where_the_torques_balance() {
    // T = slope_1 Om + slope_2 i^2 Om.
    let mut run = free_pair(0.0, [(80.0, 0.3), (0.0, 2.0)]);
    run.advance_to(5.0); // 45 time constants of 0.11 s
    let exact = 80.0 / (0.3 + 2.0 * 0.25);
    let found = run.motion().speed(0);
    assert!(
        (found / exact - 1.0).abs() < 1e-6,
        "{found} against {exact} rad/s"
    );
    assert!((run.motion().speed(1) / (-0.5 * exact) - 1.0).abs() < 1e-6);
}

#[test]
fn a_coast_down_is_exponential() {
    // Om = Om_0 exp(-slope t / J), phi its integral. The teeth see the drag of rotor one appear suddenly: the mean of
    // momentum is exact, J_1 Om_1 - i J_2 Om_2 decays by itself only where the drag is shared as the inertia is.
    let rate = 1.5; // slope / J of either rotor: no torque passes the mesh, the closed form is exact
    let slopes = RigidPair::INERTIA.map(|inertia| rate * inertia);
    let mut run = free_pair(200.0, [(0.0, slopes[0]), (0.0, slopes[1])]);
    for time in [0.1, 0.5, 1.5] {
        run.advance_to(time);
        let decay = (-rate * time).exp();
        for (rotor, first) in [(0, 200.0), (1, -100.0)] {
            let (speed, angle) = (run.motion().speed(rotor), run.motion().angle(rotor));
            assert!(
                (speed / (first * decay) - 1.0).abs() < 1e-6,
                "{time} s: {speed}"
            );
            let exact = first * (1.0 - decay) / rate;
            assert!(
                (angle / exact - 1.0).abs() < 1e-6,
                "{time} s: {angle} against {exact}"
            );
        }
    }
}

#[test]
fn a_weak_drag_that_is_shared_as_the_inertia_is_leaves_the_teeth_alone() {
    // As above with a time constant of 100 s: nothing passes the mesh. What the teeth feel is rounding of the angles by which the gears
    // have turned, and must not be that of where they would come to rest, 2e4 rad on.
    let rate = 0.01;
    let slopes = RigidPair::INERTIA.map(|inertia| rate * inertia);
    let mut run = free_pair(200.0, [(0.0, slopes[0]), (0.0, slopes[1])]);
    for index in 1..=20 {
        run.advance_to(0.05 * f64::from(index));
        let travel = RigidPair::RADIUS[0] * run.motion().angle(0);
        // 16: a few dozen roundings of either sign, and the rates.
        let bound = 16.0 * f64::EPSILON * travel.max(RigidPair::RADIUS[0]) * 1e8;
        let force = run.motion().mesh_force(0);
        assert!(force.abs() < bound, "{force:e} N, {bound:e} N of rounding");
    }
}

#[test]
fn a_reversed_torque_crosses_the_backlash_in_the_time_of_free_flight() {
    // From just in touch, -T on rotor one alone: it flies freely, delta = -R_1 T t^2 / 2 J_1, until delta = -backlash.
    let (backlash, torque) = (3e-4, 20.0);
    let text = rigid_pair(
        FREE,
        100.0,
        [(0.0, 0.0); 2],
        &format!("contact = \"unilateral\"\nbacklash = {backlash}"),
        LAW,
    );
    let mut run = Run::new(
        assembled(&text),
        &[-torque, 0.0],
        SolverChoice::Exponential,
        1e-6,
    );
    let acceleration = RigidPair::RADIUS[0] * torque / RigidPair::INERTIA[0];
    let arrival = (2.0 * backlash / acceleration).sqrt();
    run.advance_to(0.999 * arrival);
    assert_eq!(run.motion().mesh_force(0), 0.0);
    let exact = -0.5 * acceleration * (0.999 * arrival) * (0.999 * arrival);
    assert!((run.motion().mesh_deflection(0) / exact - 1.0).abs() < 1e-6);
    // Half the half wave of the impact later the back flank carries force, and the second rotor is braked.
    let half = std::f64::consts::PI / (1e8 / RigidPair::mass()).sqrt();
    run.advance_to(arrival + 0.5 * half);
    let (force, speed) = (run.motion().mesh_force(0), acceleration * arrival);
    // m d'' + k d = -m a from d = 0, d' = -v: after a quarter wave k d = -v sqrt(k m) - m a.
    let exact = -speed * (1e8 * RigidPair::mass()).sqrt() - RigidPair::mass() * acceleration;
    assert!(
        (force / exact - 1.0).abs() < 1e-5,
        "{force} against {exact} N; the tolerance, and the time of impact"
    );
    assert_eq!(run.motion().speed(1).signum(), -1.0);
}

const DENSITY: f64 = 7800.0;

/// Mass, polar and diametral inertia of the bare shaft of [`lonely_rotor`].
fn shaft() -> [f64; 3] {
    let (length, d) = (0.4_f64, 0.05_f64);
    let area = std::f64::consts::PI / 4.0 * d * d;
    let second_moment = area * d * d / 16.0;
    let mass = DENSITY * area * length;
    [
        mass,
        DENSITY * 2.0 * second_moment * length,
        DENSITY * second_moment * length + mass * length * length / 12.0,
    ]
}

/// A rigid rotor on two equal bearings without a mesh: as a whole one mass on a spring, in free spin under a torque.
fn lonely_rotor(speed_mode: &str, speed: f64, disk: &str, extra: &str) -> String {
    format!(
        "{}[material.rigid]\nyoungs_modulus = 1e16\npoisson_ratio = 0.3\ndensity = {DENSITY}\n\
         [simulation]\nspeed = \"{speed_mode}\"\nstart = \"rest\"\n\
         [[rotor]]\nname = \"r\"\nspeed = {speed}\nangle = 0.3\nmax_element_length = 0.2\n\
         [[rotor.segment]]\nlength = 0.4\nouter_diameter = 0.05\nmaterial = \"rigid\"\n{disk}\
         [[rotor.bearing]]\nname = \"b1\"\nposition = 0.0\nstiffness = {{ xx = 2e5 }}\ndamping = {{ xx = 80.0 }}\n\
         [[rotor.bearing]]\nname = \"b2\"\nposition = 0.4\nstiffness = {{ xx = 2e5 }}\ndamping = {{ xx = 80.0 }}\n\
         [[rotor.torque]]\nname = \"t\"\nposition = 0.2\n{extra}",
        head(2, 1)
    )
}

/// Classical fourth-order Runge-Kutta with small steps: the closed form of what has none.
fn integrate<const N: usize>(
    mut y: [f64; N],
    end: f64,
    count: u32,
    rate: impl Fn(f64, &[f64; N]) -> [f64; N],
) -> [f64; N] {
    let h = end / f64::from(count);
    let plus = |y: &[f64; N], k: &[f64; N], h: f64| -> [f64; N] {
        core::array::from_fn(|i| y[i] + h * k[i])
    };
    for step in 0..count {
        let t = h * f64::from(step);
        let k1 = rate(t, &y);
        let k2 = rate(t + 0.5 * h, &plus(&y, &k1, 0.5 * h));
        let k3 = rate(t + 0.5 * h, &plus(&y, &k2, 0.5 * h));
        let k4 = rate(t + h, &plus(&y, &k3, h));
        y = core::array::from_fn(|i| y[i] + h / 6.0 * (k1[i] + 2.0 * k2[i] + 2.0 * k3[i] + k4[i]));
    }
    y
}

#[test]
fn unbalance_follows_the_angle_with_its_radial_and_tangential_part() {
    // m u'' + c u' + k u = me (Om^2 cos + Om' sin, Om^2 sin - Om' cos)(phi + d) under constant acceleration, through the
    // resonance of 190 rad/s.
    let (mass, polar, moment, torque) = (5.0, 0.02, 2e-3, 60.0);
    let disk = format!(
        "[[rotor.disk]]\nposition = 0.2\nmass = {mass}\npolar_inertia = {polar}\ndiametral_inertia = 0.01\n"
    );
    let unbalance = format!(
        "[[rotor.unbalance]]\nname = \"u\"\nposition = 0.2\nmoment = {moment}\nphase = 0.5\n"
    );
    let model = assembled(&lonely_rotor("free", 0.0, &disk, &unbalance));
    let (mass, polar) = (mass + shaft()[0], polar + shaft()[1]);
    for solver in SOLVERS {
        let mut run = Run::new(model.clone(), &[torque], solver, 1e-6);
        let acceleration = torque / polar;
        for end in [0.03, 0.1, 0.2] {
            run.advance_to(end);
            let exact = integrate([0.0; 4], end, 20_000, |t, &[x, y, vx, vy]| {
                let (speed, angle) = (acceleration * t, 0.3 + 0.5 * acceleration * t * t + 0.5);
                let (sine, cosine) = angle.sin_cos();
                let (radial, tangential) = (moment * speed * speed, moment * acceleration);
                let fx = radial * cosine + tangential * sine - 4e5 * x - 160.0 * vx;
                let fy = radial * sine - tangential * cosine - 4e5 * y - 160.0 * vy;
                [vx, vy, fx / mass, fy / mass]
            });
            let station = &run.model.rotors[0].bearings[0].station;
            let found = [&station.x, &station.y].map(|row| run.motion().displacement(row));
            let size = exact[0].hypot(exact[1]);
            for axis in [0, 1] {
                // 1e-5: rotors without a mesh are held to 1e-6 of the motion's RMS over the run at each step.
                assert!(
                    (found[axis] - exact[axis]).abs() < 1e-5 * size,
                    "{solver:?} {end} s: {found:?} {exact:?}"
                );
            }
            assert!(
                (run.motion().speed(0) / (acceleration * end) - 1.0).abs() < 1e-9,
                "rigid rotation"
            );
        }
    }
}

#[test]
fn an_accelerated_gyroscope_feels_both_gyroscopic_terms() {
    // A disk off the middle tilts: planar coordinates (u, b = du/dz) about the middle, with Jp Om b_y' + Jp Om' b_y on
    // b_x and the opposite on b_y; bearings at -+l. The mass hangs at the middle: tilt and translation are apart.
    let (diametral, polar, torque, l) = (0.02, 0.04, 40.0, 0.2);
    let disk = format!(
        "[[rotor.disk]]\nposition = 0.2\nmass = 5.0\npolar_inertia = {polar}\ndiametral_inertia = {diametral}\n"
    );
    let (polar, diametral) = (polar + shaft()[1], diametral + shaft()[2]);
    let model = assembled(&lonely_rotor("free", 0.0, &disk, "").replace("xx = 80.0", "xx = 1.0"));
    let mut run = Run::new(model, &[torque], SolverChoice::Exponential, 1e-7);
    // Sudden: the gearbox is tilted about y, the left end by +1 mm, the right end by -1 mm.
    let tilt = 1e-3;
    run.inputs.bases_mut()[0][0] = tilt;
    run.inputs.bases_mut()[1][0] = -tilt;
    let end = 0.2;
    run.advance_to(end);
    let acceleration = torque / polar;
    let (k, c) = (2.0 * 2e5 * l * l, 2.0 * 1.0 * l * l);
    let exact = integrate([0.0; 4], end, 40_000, |t, &[bx, by, vx, vy]| {
        let speed = acceleration * t;
        let base = -tilt / l;
        let mx = -k * (bx - base) - c * vx - polar * (speed * vy + acceleration * by);
        let my = -k * by - c * vy + polar * (speed * vx + acceleration * bx);
        [vx, vy, mx / diametral, my / diametral]
    });
    let [left, right] = [0, 1].map(|one| &run.model.rotors[0].bearings[one].station);
    let slope = |left, right| {
        (run.motion().displacement(right) - run.motion().displacement(left)) / (2.0 * l)
    };
    let found = [slope(&left.x, &right.x), slope(&left.y, &right.y)];
    let size = tilt / l;
    for axis in [0, 1] {
        assert!(
            (found[axis] - exact[axis]).abs() < 1e-5 * size,
            "{found:?} against {exact:?}; 1e-7 per step"
        );
    }
    // Without Om' G the answer would be another one: the test sees the term.
    let without = integrate([0.0; 4], end, 40_000, |t, &[bx, by, vx, vy]| {
        let speed = acceleration * t;
        let mx = -k * (bx + tilt / l) - c * vx - polar * speed * vy;
        let my = -k * by - c * vy + polar * speed * vx;
        [vx, vy, mx / diametral, my / diametral]
    });
    assert!((without[0] - exact[0]).hypot(without[1] - exact[1]) > 0.01 * size);
}

#[test]
fn free_spin_with_huge_inertia_is_prescribed_speed() {
    // 1e12 kg m^2 on either shaft keep the speed; the stiffness law then passes at the same rate, its jumps located as
    // events here and known in advance there. The gears sit on the shafts of `gear_pair` with torsion between.
    let law = "law = \"rectangular\"\npair = 2.2e8\ncontact_ratio = 1.6";
    let text = support::gear_pair(4, law, "damping_ratio = 0.05")
        .replace("slope = 2", "slope = 0")
        .replace(
            "[[rotor.unbalance]]",
            "[[rotor.disk]]\nposition = 0.4\nmass = 0.0\npolar_inertia = 1e9\n\
                  diametral_inertia = 0.0\n[[rotor.unbalance]]",
        );
    let series = |text: &str| {
        let mut run = Run::new(
            assembled(text),
            &[0.4, 0.4],
            SolverChoice::Exponential,
            1e-7,
        );
        let forces = (1..=500).map(|sample| {
            run.advance_to(2e-5 * f64::from(sample));
            run.motion().mesh_force(0)
        });
        forces.collect::<Vec<f64>>()
    };
    let (prescribed, free) = (
        series(&text),
        series(&format!("{text}[simulation]\nspeed = \"free\"\n")),
    );
    let error = rms_difference(&prescribed, &free) / rms(&prescribed);
    // In free spin the phase follows the gear, which 0.4 N m twist by 1e-6 rad: jumps of k come 5e-6 pitches later.
    assert!(error < 1e-4, "{error:e}");
    assert!(error > 0.0, "not the same equations");
}
