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

/// These values, one at a time and soon, are survived.
fn survives(name: &'static str, values: &'static [f64]) {
    for &value in values {
        let what = format!("{name} = {value:e}");
        within(SECONDS, &what, move || live_with(&[(name, value)]));
    }
}

/// These values, one at a time and soon, are refused with all `words` on leaving initialization.
fn refuses(name: &'static str, values: &'static [f64], words: &[&str]) {
    for &value in values {
        let what = format!("{name} = {value:e}");
        let refused = within(SECONDS, &what, move || live_with(&[(name, value)]));
        let text = refused.unwrap_or_else(|| panic!("{what}: not refused"));
        assert!(
            text.starts_with("fmi2ExitInitializationMode: "),
            "{what}: {text}"
        );
        for word in words {
            assert!(
                text.contains(word),
                "{what}: {word:?} is missing in: {text}"
            );
        }
    }
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
        &["tolerance", "at least 1e-12"],
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
    const BOTH: [(&str, f64); 2] = [
        ("gearbox_vibration.amplitude_x", 1.0),
        ("gearbox_vibration.frequency", 1e9),
    ];
    within(SECONDS, "vibration", || live_with(&BOTH));
}

#[test]
fn a_rotor_that_nothing_holds_is_refused_by_its_number() {
    const LOOSE: [(&str, f64); 6] = [
        ("stage1.b1.stiffness.xx", 0.0),
        ("stage1.b1.stiffness.yy", 0.0),
        ("stage1.b2.stiffness.xx", 0.0),
        ("stage1.b2.stiffness.yy", 0.0),
        ("stage1.b3.stiffness.xx", 0.0),
        ("stage1.b3.stiffness.yy", 0.0),
    ];
    let text = within(SECONDS, "a loose rotor", || live_with(&LOOSE)).expect("a refusal");
    assert!(
        text.contains("rotor") && text.contains("equilibrium"),
        "{text}"
    );
}

#[test]
fn a_rotor_that_hardly_anything_holds_works_or_is_refused() {
    const SOFT: [(&str, f64); 6] = [
        ("stage1.b1.stiffness.xx", 1e-300),
        ("stage1.b1.stiffness.yy", 1e-300),
        ("stage1.b2.stiffness.xx", 1e-300),
        ("stage1.b2.stiffness.yy", 1e-300),
        ("stage1.b3.stiffness.xx", 1e-300),
        ("stage1.b3.stiffness.yy", 1e-300),
    ];
    within(SECONDS, "a soft rotor", || live_with(&SOFT));
}

#[test]
fn tolerances_of_the_experiment() {
    for tolerance in [1e300, f64::INFINITY, 1.0, 1e-14, 1e-300] {
        within(SECONDS, &format!("tolerance {tolerance:e}"), move || {
            let host = Host::of("three_stage");
            let instance = host.instance();
            let refused = answer(&instance, instance.setup(Some(tolerance), 0.0, None));
            if refused.is_none() {
                instance.accepted(instance.enter());
                if answer(&instance, instance.exit()).is_none() {
                    answer(&instance, instance.step(0.0, STEP));
                }
            }
            instance.accepted(instance.reset());
            instance.initialize();
            instance.steps(0, 2);
        });
    }
}

#[test]
fn inputs() {
    const INPUTS: [&str; 3] = [
        "stage1.drive.torque",
        "stage1.b1.housing.x",
        "stage1.b1.housing.vy",
    ];
    for name in INPUTS {
        for value in [1e300, -f64::MAX, 1e20, 5e-324] {
            within(SECONDS, &format!("{name} = {value:e}"), move || {
                absurd_input(name, value)
            });
        }
    }
}

/// An input that is absurd at the start and for one step; the slave then fails in words or goes on, and can be
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
