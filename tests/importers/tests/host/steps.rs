//! Communication steps that are too long, too short, somewhere else or no numbers; and the end of a run.

use geartrain::fmi2::abi::Status;
use importers::{Host, Instance, STEP, bits, within};

fn outputs(instance: &Instance<'_>) -> Vec<u64> {
    let names = ["mesh12.force", "stage1.b1.force_x", "stage3.gear.theta"];
    bits(&instance.values(&names.map(|name| instance.host().fmu().reference(name))))
}

/// After three steps, a step that must be refused, soon, with all `words`; then two more steps as if nothing had
/// been.
fn refused_and_forgotten(time: f64, step: f64, words: &[&str]) {
    let words: Vec<String> = words.iter().map(ToString::to_string).collect();
    within(20, move || refused_step(time, step, &words)).unwrap_or_else(|reason| {
        panic!("step of {step:e} s from {time:e} s: {reason}");
    });
}

fn refused_step(time: f64, step: f64, words: &[String]) {
    let host = Host::of("three_stage");
    let (undisturbed, instance) = (host.running(), host.running());
    undisturbed.steps(0, 5);
    instance.steps(0, 3);
    let before = outputs(&instance);
    let text = instance.refused(instance.step(time, step));
    for word in words {
        assert!(
            text.starts_with("fmi2DoStep: ") && text.contains(word),
            "{word:?}: {text}"
        );
    }
    assert_eq!(outputs(&instance), before, "{text}");
    instance.steps(3, 2);
    assert_eq!(outputs(&instance), outputs(&undisturbed), "{text}");
}

#[test]
fn steps_of_no_length_are_refused_and_forgotten() {
    for step in [0.0, -0.0, -STEP, f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        refused_and_forgotten(3.0 * STEP, step, &["greater than 0", &format!("{step:?}")]);
    }
}

#[test]
fn steps_from_elsewhere_are_refused_and_forgotten() {
    for time in [
        0.0,
        2.0 * STEP,
        4.0 * STEP,
        1.0,
        -1.0,
        f64::NAN,
        f64::INFINITY,
        f64::MIN,
    ] {
        refused_and_forgotten(time, STEP, &["starts at", &format!("{time:?}")]);
    }
}

#[test]
fn a_step_that_ends_beyond_all_numbers_is_refused_and_forgotten() {
    refused_and_forgotten(3.0 * STEP, f64::MAX, &[]);
}

#[test]
fn a_step_of_next_to_nothing_changes_nothing() {
    // OMSimulator ends a run with h = 1.1e-16.
    let host = Host::of("three_stage");
    let undisturbed = host.running();
    undisturbed.steps(0, 5);
    let instance = host.running();
    for index in 0..5 {
        let time = f64::from(index) * STEP;
        for step in [1e-16, 1.1e-16, f64::MIN_POSITIVE, 5e-324] {
            instance.accepted(instance.step(time, step));
        }
        assert_eq!(bits(&[instance.time()]), bits(&[time]));
        instance.steps(index, 1);
    }
    assert_eq!(outputs(&instance), outputs(&undisturbed));
}

#[test]
fn steps_of_a_few_roundings_are_accepted_and_add_up() {
    // The first step of a run is the one that the solver divides.
    let host = Host::of("three_stage");
    for start in [0.0_f64, 0.3, 1e3, -1e5] {
        let rounding = start.abs().max(0.1).next_up() - start.abs().max(0.1);
        for count in 1..60 {
            let instance = host.instance();
            instance.accepted(instance.setup(None, start, None));
            instance.accepted(instance.enter());
            instance.accepted(instance.exit());
            let (mut time, step) = (start, f64::from(count) * rounding);
            for _ in 0..40 {
                instance.accepted(instance.step(time, step));
                time += step;
            }
            let behind = time - instance.time();
            assert!(
                (0.0..=1e-15_f64.max(32.0 * f64::EPSILON * time.abs())).contains(&behind),
                "{start}, {count}: {behind:e}"
            );
        }
    }
}

#[test]
fn times_added_up_in_floating_point_are_accepted() {
    let host = Host::of("three_stage");
    let instance = host.running();
    let mut time = 0.0;
    for index in 0..1000 {
        // As OMSimulator and fmi-rs: the step is the difference of two times.
        let next = f64::from(index + 1) * STEP;
        instance.accepted(instance.step(time, next - time));
        time += next - time;
        if index % 10 == 0 {
            time += 1e-16;
        }
    }
    assert!((instance.time() - 1000.0 * STEP).abs() < 1e-12);
}

#[test]
fn steps_beyond_the_stop_time_are_refused_and_up_to_it_accepted() {
    let host = Host::of("three_stage");
    let instance = host.instance();
    instance.accepted(instance.setup(None, 0.0, Some(5.0 * STEP)));
    instance.accepted(instance.enter());
    instance.accepted(instance.exit());
    instance.steps(0, 4);
    let text = instance.refused(instance.step(4.0 * STEP, 1.01 * STEP));
    assert!(text.contains("stop time"), "{text}");
    // Rounding of the master's clock is no overshoot.
    instance.accepted(instance.step(4.0 * STEP, STEP * (1.0 + 1e-10)));
    let text = instance.refused(instance.step(5.0 * STEP, STEP));
    assert!(text.contains("stop time"), "{text}");
    instance.accepted(instance.terminate());
}

#[test]
fn a_clock_far_from_zero_reaches_the_stop_time() {
    // Every sum is rounded by up to 7e-12 s there, always in the same direction: 3.5e-9 s after 500 steps.
    let host = Host::of("three_stage");
    let (start, stop) = (1e5, 1e5 + 500.0 * STEP);
    let instance = host.instance();
    instance.accepted(instance.setup(None, start, Some(stop)));
    instance.accepted(instance.enter());
    instance.accepted(instance.exit());
    let mut time = start;
    for _ in 0..500 {
        instance.accepted(instance.step(time, STEP));
        time += STEP;
    }
    assert!(time > stop + 1e-9 * (stop - start), "nothing to forgive");
    let text = instance.refused(instance.step(time, 0.01 * STEP));
    assert!(text.contains("stop time"), "{text}");
}

#[test]
fn without_a_stop_time_a_run_goes_on_and_on() {
    let host = Host::of("three_stage");
    let instance = host.running();
    let end = host
        .fmu()
        .description()
        .default_experiment
        .as_ref()
        .and_then(|e| e.stop_time);
    let end = end.expect("a stop time");
    instance.accepted(instance.step(0.0, end));
    instance.accepted(instance.step(end, 0.25 * end)); // FMUChecker steps over it
}

#[test]
fn a_run_may_start_at_any_time() {
    for start in [-3.5, 10.0, 1e5] {
        let run = within(20, move || run_from(start));
        run.unwrap_or_else(|reason| panic!("from {start} s: {reason}"));
    }
}

fn run_from(start: f64) {
    let host = Host::of("three_stage");
    let instance = host.instance();
    instance.accepted(instance.setup(None, start, Some(start + 1.0)));
    instance.accepted(instance.enter());
    instance.accepted(instance.exit());
    let text = instance.refused(instance.step(start + 1e-3, STEP));
    assert!(text.contains("starts at"), "{text}");
    let point = |index: u32| start + f64::from(index) * STEP;
    for index in 0..100 {
        let step = point(index + 1) - point(index);
        instance.accepted(instance.step(point(index), step));
    }
    assert_eq!(bits(&[instance.time()]), bits(&[point(100)]));
    assert!(instance.value("mesh12.force").is_finite());
}

#[test]
fn experiments_without_sense_are_refused_and_forgotten() {
    let host = Host::of("three_stage");
    let instance = host.instance();
    for (tolerance, start, stop, word) in [
        (None, f64::NAN, None, "start time"),
        (None, f64::INFINITY, None, "start time"),
        (None, 1.0, Some(0.5), "stop time"),
        (None, 0.0, Some(f64::NAN), "stop time"),
        (Some(0.0), 0.0, None, "tolerance"),
        (Some(-1e-4), 0.0, None, "tolerance"),
        (Some(f64::NAN), 0.0, None, "tolerance"),
    ] {
        let text = instance.refused(instance.setup(tolerance, start, stop));
        assert!(
            text.starts_with("fmi2SetupExperiment: ") && text.contains(word),
            "{text}"
        );
    }
    let text = instance.refused(instance.enter());
    assert!(text.contains("fmi2SetupExperiment"), "{text}");
    instance.initialize();
    instance.steps(0, 1);
}

#[test]
fn a_run_ends_once() {
    let host = Host::of("three_stage");
    let instance = host.running();
    instance.steps(0, 3);
    let before = outputs(&instance);
    instance.accepted(instance.terminate());
    // OMSimulator terminates twice when something failed.
    let text = instance.refused(instance.terminate());
    assert!(text.starts_with("fmi2Terminate: "), "{text}");
    assert_eq!(outputs(&instance), before, "final values stay readable");
    instance.accepted(instance.reset());
    instance.initialize();
    instance.steps(0, 3);
    assert_eq!(outputs(&instance), before);
}

#[test]
fn a_refused_step_does_not_keep_a_run_from_ending() {
    // libcosim, Ecos and OMSimulator terminate and free after an error.
    let host = Host::of("three_stage");
    let instance = host.running();
    instance.refused(instance.step(1.0, STEP));
    instance.accepted(instance.terminate());
    assert_ne!(instance.terminate(), Status::Ok);
}

#[test]
fn a_reset_forgets_time_parameters_and_inputs() {
    let host = Host::of("three_stage");
    let fresh = host.running();
    fresh.steps(0, 3);
    let instance = host.instance();
    instance.accepted(instance.set(&[("mesh12.stiffness_factor", 2.0)]));
    instance.initialize();
    instance.accepted(instance.set(&[("stage1.drive.torque", 0.0)]));
    instance.steps(0, 7);
    instance.accepted(instance.reset());
    let text = instance.refused(instance.enter());
    assert!(
        text.contains("fmi2SetupExperiment"),
        "the experiment is forgotten too: {text}"
    );
    instance.initialize();
    instance.steps(0, 3);
    assert_eq!(outputs(&instance), outputs(&fresh));
}
