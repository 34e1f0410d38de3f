//! Every function in every state: legal calls are carried out, the others refused in words and without a trace.

use geartrain::fmi2::abi::Status;
use importers::calls::{Answer, CALLS, Call, State, declared};
use importers::{Host, Instance, STEP, bits};

/// Communication point of the instances that have made steps [s].
const NOW: f64 = 2.0 * STEP;

/// Cross-coupled stiffness [N/m] that no damping holds: the motion grows beyond all numbers within a second.
const UNSTABLE: [(&str, f64); 2] = [
    ("stage1.b1.stiffness.xy", 1e10),
    ("stage1.b1.stiffness.yx", -1e10),
];

fn instance_in(host: &Host, state: State) -> Instance<'_> {
    let instance = host.instance();
    if state == State::Failed {
        instance.accepted(instance.set(&UNSTABLE));
    }
    instance.accepted(instance.setup(None, 0.0, None));
    if state != State::Instantiated {
        instance.accepted(instance.enter());
    }
    if !matches!(state, State::Instantiated | State::Initialization) {
        instance.accepted(instance.exit());
        instance.steps(0, 2);
    }
    match state {
        State::Terminated => instance.accepted(instance.terminate()),
        State::Failed => {
            let text = instance.refused(instance.step(NOW, 1.0));
            assert!(text.starts_with("fmi2DoStep: "), "{text}");
        }
        State::Instantiated | State::Initialization | State::Stepping => {}
    }
    instance
}

fn words(state: State) -> &'static str {
    match state {
        State::Instantiated => "after instantiation",
        State::Initialization => "initialization mode",
        State::Stepping => "step mode",
        State::Terminated => "terminated",
        State::Failed => "error state",
    }
}

fn outputs(instance: &Instance<'_>) -> Vec<u64> {
    let names = [
        "stage1.angle",
        "mesh12.force",
        "stage1.b1.force_x",
        "stage3.gear.theta",
    ];
    bits(&instance.values(&names.map(|name| instance.host().fmu().reference(name))))
}

/// What the rest of the instance's life brings.
fn rest_of_life(instance: &Instance<'_>, state: State) -> Vec<u64> {
    let first = match state {
        State::Instantiated => {
            instance.initialize();
            0
        }
        State::Initialization => {
            instance.accepted(instance.exit());
            0
        }
        State::Stepping => 2,
        State::Terminated | State::Failed => {
            let values = outputs(instance);
            instance.accepted(instance.reset());
            instance.initialize();
            return [values, outputs(instance)].concat();
        }
    };
    instance.steps(first, 5);
    let values = outputs(instance);
    instance.accepted(instance.terminate());
    values
}

/// The answer to a legal call.
fn check_answer(instance: &Instance<'_>, call: &Call, status: Status) {
    match call.answer {
        Answer::Ok => instance.accepted(status),
        Answer::Discard => assert_eq!(status, Status::Discard, "{}", call.name),
        Answer::IfDeclared(capability) if declared(instance.host().fmu(), capability) => {
            instance.accepted(status);
        }
        Answer::IfDeclared(capability) => {
            let text = instance.refused(status);
            assert!(text.starts_with(&format!("{}: ", call.name)), "{text}");
            assert!(text.contains(capability), "{text}");
        }
    }
}

#[test]
fn legal_calls_are_carried_out_and_capabilities_not_declared_named() {
    let host = Host::of("three_stage");
    for state in State::ALL {
        for call in CALLS.iter().filter(|call| call.legal.contains(&state)) {
            let instance = instance_in(&host, state);
            if call.name == "fmi2EnterInitializationMode" {
                instance.accepted(instance.setup(None, 0.0, None)); // it needs an experiment
            }
            let status = instance.call(call, NOW);
            check_answer(&instance, call, status);
        }
    }
}

#[test]
fn illegal_calls_are_refused_with_function_and_state_and_leave_no_trace() {
    let host = Host::of("three_stage");
    for state in State::ALL {
        let undisturbed = rest_of_life(&instance_in(&host, state), state);
        let instance = instance_in(&host, state);
        let mut refused = 0;
        for call in CALLS.iter().filter(|call| !call.legal.contains(&state)) {
            let text = instance.refused(instance.call(call, NOW));
            assert!(
                text.starts_with(&format!("{}: ", call.name)),
                "{state:?}: {text}"
            );
            assert!(text.contains(words(state)), "{state:?}: {text}");
            refused += 1;
        }
        assert!(refused >= 4, "{state:?}");
        assert_eq!(rest_of_life(&instance, state), undisturbed, "{state:?}");
    }
}

#[test]
fn refused_capabilities_leave_no_trace() {
    let host = Host::of("three_stage");
    for state in State::ALL {
        let undisturbed = rest_of_life(&instance_in(&host, state), state);
        let instance = instance_in(&host, state);
        for call in CALLS.iter().filter(|call| call.legal.contains(&state)) {
            if matches!(call.answer, Answer::IfDeclared(_)) {
                instance.call(call, NOW);
                instance.messages();
            }
        }
        assert_eq!(rest_of_life(&instance, state), undisturbed, "{state:?}");
    }
}

#[test]
fn a_failed_step_leaves_the_state_before_it() {
    let host = Host::of("three_stage");
    let before = host.instance();
    before.accepted(before.set(&UNSTABLE));
    before.initialize();
    before.steps(0, 2);
    let instance = instance_in(&host, State::Failed);
    assert_eq!(outputs(&instance), outputs(&before));
    assert_eq!(instance.time(), NOW);
    // Masters that terminate after an error get an answer, and free what they have.
    let text = instance.refused(instance.terminate());
    assert!(text.contains("error state"), "{text}");
    instance.accepted(instance.reset());
    instance.initialize();
    instance.steps(0, 10);
}

#[test]
fn a_state_from_anywhere_in_life_goes_on_to_the_bit_wherever_it_is_restored() {
    let host = Host::of("three_stage");
    for from in State::ALL {
        let origin = instance_in(&host, from);
        let bytes = origin.bytes(&origin.save());
        let rest = rest_of_life(&origin, from);
        for to in State::ALL {
            let instance = instance_in(&host, to);
            let (status, state) = instance.read(&bytes);
            instance.accepted(status);
            instance.accepted(instance.restore(&state.expect("a state")));
            assert_eq!(rest_of_life(&instance, from), rest, "{from:?} in {to:?}");
        }
    }
}
