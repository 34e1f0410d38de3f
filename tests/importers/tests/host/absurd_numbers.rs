//! Numbers that are finite but absurd: an answer in words or a result, soon, and a way back.

use geartrain::fmi2::abi::Status;
use importers::{Host, Instance, Reals, STEP, bits, within};

/// The slave assembles a model or makes a few steps in milliseconds; this is forever.
const SECONDS: u64 = 20;

/// Every output is read; its value may be absurd, too.
fn read_everything(instance: &Instance<'_>) {
    let variables = instance.host().fmu().description().get_model_variables();
    let references: Vec<u32> = variables.map(|variable| variable.value_reference).collect();
    let mut values = vec![0.0; references.len()];
    let count = references.len();
    instance.get_array::<Reals>(Some(&references), count, Some(&mut values));
    instance.messages();
}

/// The text of a refusal, `None` when all went well; anything else is a failure.
fn answer(instance: &Instance<'_>, status: Status) -> Option<String> {
    if status == Status::Ok {
        instance.accepted(status);
        return None;
    }
    let text = instance.refused(status);
    let (function, sentence) = text.split_once(": ").expect("the function's name");
    assert!(function.starts_with("fmi2"), "{text}");
    assert!(sentence.len() > 20, "no sentence: {text}");
    assert!(!text.contains("internal error"), "a panic: {text}");
    Some(text)
}

fn mesh_forces(instance: &Instance<'_>) -> Vec<u64> {
    bits(&["mesh12.force", "mesh13.force"].map(|name| instance.value(name)))
}

/// Life with absurd parameters: what was refused first, if anything. In the end the parameters are corrected,
/// and the slave must run as if nothing had been.
fn live_with(parameters: &[(&str, f64)]) -> Option<String> {
    let host = Host::of("three_stage");
    let undisturbed = host.running();
    undisturbed.steps(0, 5);
    let instance = host.instance();
    let refused = run_with(&instance, parameters);
    let corrected: Vec<_> = parameters
        .iter()
        .map(|&(name, _)| (name, host.fmu().start(name)))
        .collect();
    if refused.is_some() {
        // Still in initialization mode: corrected parameters are enough.
        instance.accepted(instance.set(&corrected));
        instance.accepted(instance.exit());
    } else {
        instance.accepted(instance.reset());
        instance.initialize();
    }
    instance.steps(0, 5);
    assert_eq!(mesh_forces(&instance), mesh_forces(&undisturbed));
    refused
}

/// Initialization and, if that goes well, a few steps; the text with which initialization was refused.
fn run_with(instance: &Instance<'_>, parameters: &[(&str, f64)]) -> Option<String> {
    instance.accepted(instance.setup(None, 0.0, None));
    instance.accepted(instance.enter());
    let set = answer(instance, instance.set(parameters));
    read_everything(instance);
    let refused = answer(instance, instance.exit());
    if refused.is_some() {
        return refused;
    }
    assert_eq!(
        set, None,
        "refused values have no effect, so initialization has to succeed"
    );
    for index in 0..5 {
        if answer(instance, instance.step(f64::from(index) * STEP, STEP)).is_some() {
            break;
        }
        read_everything(instance);
    }
    None
}

/// Runs `life` with every value, soon, and fails with all values that break its claim.
fn each(name: &str, values: &[f64], life: impl Fn(f64) + Copy + Send + 'static) {
    let complaint = |&value: &f64| {
        let outcome = within(SECONDS, move || life(value));
        outcome
            .err()
            .map(|reason| format!("{name} = {value:e}: {reason}"))
    };
    let complaints: Vec<String> = values.iter().filter_map(complaint).collect();
    assert!(complaints.is_empty(), "{}", complaints.join("\n"));
}

/// These values are survived.
fn survives(name: &'static str, values: &[f64]) {
    each(name, values, move |value| {
        live_with(&[(name, value)]);
    });
}

/// These values are refused with all `words` on leaving initialization.
fn refuses(name: &'static str, values: &[f64], words: &'static [&'static str]) {
    each(name, values, move |value| {
        let text = live_with(&[(name, value)]).expect("a refusal");
        assert!(text.starts_with("fmi2ExitInitializationMode: "), "{text}");
        for word in words {
            assert!(text.contains(word), "{word:?} is missing in: {text}");
        }
    });
}

#[test]
fn bearings() {
    refuses(
        "stage1.b1.stiffness.xx",
        &[-1.0, -1e300],
        &["stage1", "b1", "0 or more"],
    );
    refuses(
        "stage1.b1.damping.yy",
        &[-1e-300],
        &["stage1", "b1", "0 or more"],
    );
    survives(
        "stage1.b1.stiffness.xx",
        &[1e300, f64::MAX, 1e20, 1e-300, 0.0],
    );
    survives("stage1.b1.stiffness.xy", &[1e300, -1e300, 1e12]);
    survives("stage1.b1.damping.xx", &[1e300, f64::MAX, 1e20, 0.0]);
    survives("stage1.b1.damping.xy", &[1e300, -1e20]);
}

#[test]
fn damping_ratios() {
    refuses(
        "stage1.lateral_damping_ratio",
        &[-0.01, -1e300],
        &["stage1", "lateral_damping_ratio"],
    );
    refuses(
        "stage2.torsional_damping_ratio",
        &[-0.01],
        &["stage2", "torsional_damping_ratio"],
    );
    survives("stage1.lateral_damping_ratio", &[1e300, 1e9, 5e-324]);
    survives("stage1.torsional_damping_ratio", &[1e300, 1e9, 5e-324]);
}

#[test]
fn tolerances() {
    refuses(
        "simulation.tolerance",
        &[0.0, -1e-4, 1e300, 0.2],
        &["tolerance", "at most 0.1"],
    );
    survives("simulation.tolerance", &[1e-300, 5e-324, 1e-17, 1e-14, 0.1]);
}

#[test]
fn speeds() {
    survives(
        "stage1.mean_speed",
        &[0.0, -0.0, -314.0, 1e9, -1e9, 1e20, 1e300, f64::MAX, 1e-300],
    );
}

#[test]
fn meshes() {
    refuses(
        "mesh12.stiffness_factor",
        &[0.0, -1.0, -1e300],
        &["mesh12", "stiffness_factor"],
    );
    survives(
        "mesh12.stiffness_factor",
        &[1e300, f64::MAX, 1e20, 1e-20, 1e-300, 5e-324],
    );
}

#[test]
fn unbalances_and_vibration() {
    refuses(
        "stage1.gear_unbalance.moment",
        &[-1.0],
        &["stage1", "gear_unbalance", "moment"],
    );
    survives("stage1.gear_unbalance.moment", &[1e300, f64::MAX]);
    survives("stage1.gear_unbalance.phase", &[1e300, -1e20]);
    refuses(
        "gearbox_vibration.frequency",
        &[-1.0],
        &["gearbox_vibration", "frequency"],
    );
    survives("gearbox_vibration.frequency", &[1e300, f64::MAX, 1e12]);
    survives("gearbox_vibration.amplitude_x", &[1e300, f64::MAX, -1e300]);
}

#[test]
fn a_fast_and_strong_vibration() {
    each(
        "amplitude_x = 1 m, frequency",
        &[1e6, 1e9, 1e12],
        |frequency| {
            let amplitude = ("gearbox_vibration.amplitude_x", 1.0);
            live_with(&[amplitude, ("gearbox_vibration.frequency", frequency)]);
        },
    );
}

/// The same stiffness for all bearings of stage 1.
fn bearings_of_stage_1(stiffness: f64) -> [(&'static str, f64); 6] {
    [
        "stage1.b1.stiffness.xx",
        "stage1.b1.stiffness.yy",
        "stage1.b2.stiffness.xx",
        "stage1.b2.stiffness.yy",
        "stage1.b3.stiffness.xx",
        "stage1.b3.stiffness.yy",
    ]
    .map(|name| (name, stiffness))
}

#[test]
fn a_rotor_that_nothing_holds_is_refused_by_its_number() {
    each("all bearings of stage 1", &[0.0], |stiffness| {
        let text = live_with(&bearings_of_stage_1(stiffness)).expect("a refusal");
        assert!(
            text.contains("rotor 1") && text.contains("equilibrium"),
            "{text}"
        );
    });
}

#[test]
fn a_rotor_that_hardly_anything_holds_works_or_is_refused() {
    each(
        "all bearings of stage 1",
        &[1e-300, 1e-9, 1.0, 1e300],
        |stiffness| {
            live_with(&bearings_of_stage_1(stiffness));
        },
    );
}

#[test]
fn tolerances_of_the_experiment() {
    each(
        "tolerance",
        &[1e300, f64::INFINITY, 1.0, 1e-14, 1e-300, 5e-324],
        |tolerance| {
            let host = Host::of("three_stage");
            let instance = host.instance();
            if answer(&instance, instance.setup(Some(tolerance), 0.0, None)).is_none() {
                instance.accepted(instance.enter());
                if answer(&instance, instance.exit()).is_none() {
                    answer(&instance, instance.step(0.0, STEP));
                }
            }
            instance.accepted(instance.reset());
            instance.initialize();
            instance.steps(0, 2);
        },
    );
}

#[test]
fn inputs() {
    for name in [
        "stage1.drive.torque",
        "stage1.b1.housing.x",
        "stage1.b1.housing.vy",
    ] {
        each(name, &[1e300, -f64::MAX, 1e20, 5e-324], |value| {
            absurd_input(name, value);
        });
    }
}

/// An input that is absurd, from the start or from step mode on: the slave fails in words or goes on, and can be
/// reset.
fn absurd_input(name: &str, value: f64) {
    let host = Host::of("three_stage");
    let instance = host.instance();
    for early in [true, false] {
        instance.accepted(instance.setup(None, 0.0, None));
        instance.accepted(instance.enter());
        if early {
            instance.accepted(instance.set(&[(name, value)]));
        }
        if answer(&instance, instance.exit()).is_none() {
            answer(&instance, instance.set(&[(name, value)]));
            read_everything(&instance);
            for index in 0..5 {
                answer(&instance, instance.step(f64::from(index) * STEP, STEP));
            }
            read_everything(&instance);
        }
        instance.accepted(instance.reset());
    }
    let undisturbed = host.running();
    undisturbed.steps(0, 5);
    instance.initialize();
    instance.steps(0, 5);
    assert_eq!(mesh_forces(&instance), mesh_forces(&undisturbed));
}
