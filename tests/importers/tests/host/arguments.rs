//! Arrays that are NULL, references that do not exist, values that are no numbers.

use fmi::schema::fmi2::Causality;
use geartrain::fmi2::abi::{LAST_SUCCESSFUL_TIME, Status, TERMINATED};
use importers::calls::CALLS;
use importers::instance::BaseType;
use importers::{Booleans, Host, Instance, Integers, Reals, STEP, Strings, bits};

const UNKNOWN: u32 = u32::MAX;

#[test]
fn every_function_refuses_null_as_component() {
    // Ecos calls on after a failed fmi2Instantiate.
    let host = Host::of("three_stage");
    for call in &CALLS {
        assert_eq!(host.call_nobody(call), Status::Error, "{}", call.name);
    }
    host.free_nobody();
}

/// Null pointers and unknown references for one base type.
fn odd_arrays<T: BaseType>(instance: &Instance<'_>, name: &str) {
    let (some, none) = ([T::SOME; 3], &mut [T::SOME; 3]);
    let (known, unknown) = ([0, 1, 2], [UNKNOWN; 3]);
    // FMI 2.0.4, 2.1.7: for no variables the arrays mean nothing.
    instance.accepted(instance.get_array::<T>(None, 0, None));
    instance.accepted(instance.set_array::<T>(None, 0, None));
    instance.accepted(instance.get_array::<T>(Some(&unknown), 0, Some(none)));
    instance.accepted(instance.set_array::<T>(Some(&unknown), 0, Some(&some)));

    let refused = |status, function: &str| {
        let text = instance.refused(status);
        assert!(text.starts_with(&format!("{function}{name}: ")), "{text}");
        text
    };
    assert!(refused(instance.get_array::<T>(None, 3, Some(none)), "fmi2Get").contains("NULL"));
    assert!(refused(instance.set_array::<T>(None, 3, Some(&some)), "fmi2Set").contains("NULL"));
    refused(instance.get_array::<T>(Some(&known), 3, None), "fmi2Get");
    refused(instance.set_array::<T>(Some(&known), 3, None), "fmi2Set");
    let reference = UNKNOWN.to_string();
    for found in [
        refused(
            instance.get_array::<T>(Some(&unknown), 3, Some(none)),
            "fmi2Get",
        ),
        refused(
            instance.set_array::<T>(Some(&unknown), 3, Some(&some)),
            "fmi2Set",
        ),
    ] {
        assert!(found.contains(&reference), "{found}");
    }
}

#[test]
fn null_arrays_and_unknown_references_are_refused_in_words() {
    let host = Host::of("three_stage");
    for instance in [host.instance(), host.running()] {
        odd_arrays::<Reals>(&instance, "Real");
        odd_arrays::<Integers>(&instance, "Integer");
        odd_arrays::<Booleans>(&instance, "Boolean");
        odd_arrays::<Strings>(&instance, "String");
    }
}

#[test]
fn real_variables_are_not_integers_booleans_or_strings() {
    let host = Host::of("three_stage");
    let instance = host.running();
    let torque = [host.fmu().reference("stage1.drive.torque")];
    let text = instance.refused(instance.set_array::<Integers>(Some(&torque), 1, Some(&[1])));
    assert!(text.contains("Integer"), "{text}");
    let text = instance.refused(instance.get_array::<Booleans>(Some(&torque), 1, Some(&mut [1])));
    assert!(text.contains("Boolean"), "{text}");
}

/// What a later step depends on: parameters, inputs and, where they can be read, outputs.
fn everything(instance: &Instance<'_>, outputs: bool) -> Vec<u64> {
    let fmu = instance.host().fmu();
    let mut references = fmu.references(&Causality::Parameter);
    references.extend(fmu.references(&Causality::Input));
    if outputs {
        references.extend(fmu.references(&Causality::Output));
        references.extend(fmu.references(&Causality::Local));
    }
    bits(&instance.values(&references))
}

/// Sets these values, which must be refused with the variable's name and change nothing.
fn refused_without_effect(instance: &Instance<'_>, running: bool, values: &[(&str, f64)]) {
    let before = everything(instance, running);
    let text = instance.refused(instance.set(values));
    let (guilty, _) = values[1];
    assert!(
        text.starts_with("fmi2SetReal: ") && text.contains(guilty),
        "{text}"
    );
    assert_eq!(everything(instance, running), before, "{text}");
}

#[test]
fn nan_and_infinite_values_are_refused_and_change_nothing() {
    let host = Host::of("three_stage");
    let undisturbed = host.running();
    undisturbed.steps(0, 5);
    let instance = host.instance();
    let setting = |guilty: &str, running: bool| {
        for value in [f64::NAN, -f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            // The good value comes first: nothing may be written before everything was checked.
            let values = [
                ("stage2.load.torque", 7.0),
                (guilty, value),
                ("stage3.load.torque", 8.0),
            ];
            refused_without_effect(&instance, running, &values);
        }
    };
    for guilty in [
        "stage1.b1.housing.x",
        "stage1.b1.stiffness.xx",
        "stage1.mean_speed",
    ] {
        setting(guilty, false);
    }
    instance.accepted(instance.setup(None, 0.0, None));
    instance.accepted(instance.enter());
    for guilty in ["stage1.drive.torque", "simulation.tolerance"] {
        setting(guilty, true);
    }
    instance.accepted(instance.exit());
    for index in 0..5 {
        setting("stage1.b2.housing.vy", true);
        instance.steps(index, 1);
    }
    assert_eq!(everything(&instance, true), everything(&undisturbed, true));
}

#[test]
fn outputs_and_calculated_values_cannot_be_set() {
    let host = Host::of("three_stage");
    let names = [
        "mesh12.force",
        "stage1.b1.force_x",
        "stage1.modal.x[1]",
        "stage1.lateral_frequency[1]",
        "stage2.mean_speed", // follows stage 1 through the teeth
        "stage1.angle",
    ];
    for (instance, running) in [(host.instance(), false), (host.running(), true)] {
        for name in names {
            let values = [("stage1.drive.torque", 7.0), (name, 0.0)];
            refused_without_effect(&instance, running, &values);
        }
    }
}

#[test]
fn parameters_cannot_be_set_in_step_mode() {
    let host = Host::of("three_stage");
    let instance = host.running();
    let fixed = [
        "mesh12.stiffness_factor",
        "stage1.gear_unbalance.moment",
        "simulation.tolerance",
    ];
    for name in fixed {
        let values = [("stage1.drive.torque", 7.0), (name, host.fmu().start(name))];
        refused_without_effect(&instance, true, &values);
    }
    let text = instance.refused(instance.set(&[("mesh12.stiffness_factor", 2.0)]));
    assert!(text.contains("initialization"), "{text}");
}

#[test]
fn an_unknown_reference_among_known_ones_is_refused_and_changes_nothing() {
    let host = Host::of("three_stage");
    let instance = host.running();
    let torque = host.fmu().reference("stage1.drive.torque");
    let before = everything(&instance, true);
    let references = [torque, UNKNOWN];
    let status = instance.set_array::<Reals>(Some(&references), 2, Some(&[7.0, 8.0]));
    assert!(instance.refused(status).contains(&UNKNOWN.to_string()));
    let mut values = [1.0, 2.0];
    let status = instance.get_array::<Reals>(Some(&references), 2, Some(&mut values));
    assert!(instance.refused(status).contains(&UNKNOWN.to_string()));
    assert_eq!(everything(&instance, true), before);
}

#[test]
fn outputs_are_refused_by_name_before_initialization() {
    let host = Host::of("three_stage");
    let instance = host.instance();
    for name in ["mesh12.force", "stage1.b1.force_x", "stage1.modal.x[1]"] {
        let reference = [host.fmu().reference(name)];
        let status = instance.get_array::<Reals>(Some(&reference), 1, Some(&mut [0.0]));
        let text = instance.refused(status);
        assert!(
            text.contains(name) && text.contains("initialization"),
            "{text}"
        );
    }
    instance.initialize();
    assert!(instance.value("mesh12.force").is_finite());
}

#[test]
fn parameters_and_inputs_have_their_start_values_from_the_start() {
    let host = Host::of("three_stage");
    let instance = host.instance();
    for variable in host.fmu().description().get_model_variables() {
        if matches!(variable.causality, Causality::Parameter | Causality::Input) {
            let (found, written) = (
                instance.value(&variable.name),
                host.fmu().start(&variable.name),
            );
            assert_eq!(found.to_bits(), written.to_bits(), "{}", variable.name);
        }
    }
}

fn all_finite(values: &[f64]) -> bool {
    values.iter().all(|value| value.is_finite())
}

#[test]
fn every_variable_can_be_read_in_one_call() {
    let host = Host::of("three_stage");
    let variables = host.fmu().description().get_model_variables();
    let references: Vec<u32> = variables.map(|variable| variable.value_reference).collect();
    let instance = host.instance();
    instance.accepted(instance.setup(None, 0.0, None));
    instance.accepted(instance.enter());
    // libcosim reads everything, here too.
    assert!(all_finite(&instance.values(&references)));
    instance.accepted(instance.exit());
    instance.steps(0, 3);
    instance.accepted(instance.terminate());
    assert!(all_finite(&instance.values(&references)));
    assert_eq!(instance.time(), 2.0 * STEP + STEP);
}

#[test]
fn statuses_are_answered_or_discarded_in_words() {
    let host = Host::of("three_stage");
    let instance = host.running();
    instance.steps(0, 1);
    assert_eq!(
        instance.real_status(LAST_SUCCESSFUL_TIME),
        (Status::Ok, STEP)
    );
    assert_eq!(instance.boolean_status(TERMINATED), (Status::Ok, 0));
    assert_eq!(instance.messages(), []);
    instance.accepted(instance.log(true, &[]));
    for kind in [-1, 0, 1, 4, i32::MAX] {
        let mut statuses = instance.other_statuses(kind).to_vec();
        statuses.extend([
            instance.real_status(kind).0,
            instance.boolean_status(kind).0,
        ]);
        assert_eq!(statuses, [Status::Discard; 5]);
        let messages = instance.messages();
        assert_eq!(messages.len(), 5);
        for message in messages {
            assert_eq!(message.category.as_deref(), Some("logStatusDiscard"));
            assert!(
                message
                    .text
                    .is_some_and(|text| text.contains(&kind.to_string()))
            );
        }
    }
    for status in instance.status_into_nothing(LAST_SUCCESSFUL_TIME, TERMINATED) {
        assert_eq!(status, Status::Error);
    }
    for message in instance.messages() {
        assert!(message.text.is_some_and(|text| text.contains("NULL")));
    }
    instance.steps(1, 1);
}

#[test]
fn freeing_no_state_is_fine() {
    let host = Host::of("three_stage");
    for instance in [host.instance(), host.running()] {
        instance
            .free_no_state()
            .into_iter()
            .for_each(|status| instance.accepted(status));
    }
}
