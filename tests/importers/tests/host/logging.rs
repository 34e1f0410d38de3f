//! What the logger is told, and when.

use geartrain::fmi2::abi::Status;
use importers::host::text;
use importers::log::Message;
use importers::{Birth, Callbacks, Host, Instance, STEP};

const ERROR: &str = "logStatusError";
const DISCARD: &str = "logStatusDiscard";

/// Provokes an error and a discard, and gives the categories of what was told.
fn provoked(instance: &Instance<'_>) -> Vec<Option<String>> {
    assert_eq!(instance.step(-1.0, STEP), Status::Error);
    assert_eq!(instance.other_statuses(0), [Status::Discard; 3]);
    let mut told: Vec<Option<String>> = instance
        .messages()
        .into_iter()
        .map(|message| message.category)
        .collect();
    told.dedup();
    told
}

fn categories(names: &[&str]) -> Vec<Option<String>> {
    names.iter().map(|name| Some((*name).to_string())).collect()
}

#[test]
fn errors_are_told_from_the_start_and_the_rest_on_request() {
    let host = Host::of("three_stage");
    let quiet = host.running();
    assert_eq!(provoked(&quiet), categories(&[ERROR]));
    let (talkative, messages) = host.instantiate(&Birth {
        logging_on: true,
        ..host.birth()
    });
    let talkative = talkative.expect("an instance");
    assert!(!messages.is_empty(), "loggingOn tells of the birth");
    assert!(
        messages
            .iter()
            .all(|message| message.category.as_deref() == Some("logEvents"))
    );
    assert!(
        messages
            .iter()
            .all(|message| message.status == Status::Ok as i32)
    );
    talkative.setup(None, 0.0, None);
    talkative.enter();
    talkative.exit();
    talkative.messages();
    assert_eq!(provoked(&talkative), categories(&[ERROR, DISCARD]));
}

#[test]
fn only_the_categories_asked_for_are_told() {
    // FMI 2.0.4, 2.1.5: with categories "only debug messages according to the categories" are printed.
    let host = Host::of("three_stage");
    let instance = host.running();
    /// loggingOn, categories, categories told then.
    type Case = (
        bool,
        &'static [Option<&'static str>],
        &'static [&'static str],
    );
    let cases: [Case; 7] = [
        (true, &[], &[ERROR, DISCARD]),
        (false, &[], &[]),
        (true, &[Some(DISCARD)], &[DISCARD]),
        (true, &[Some(ERROR)], &[ERROR]),
        (true, &[Some("logEvents")], &[]),
        (true, &[Some(ERROR), Some(DISCARD)], &[ERROR, DISCARD]),
        (true, &[Some("logAll")], &[ERROR, DISCARD]),
    ];
    for (on, names, expected) in cases {
        instance.accepted(instance.log(on, names));
        assert_eq!(provoked(&instance), categories(expected), "{on} {names:?}");
    }
}

#[test]
fn unknown_and_null_categories_are_ignored() {
    let host = Host::of("three_stage");
    let instance = host.running();
    let names = [Some("no such category"), None, Some(""), Some(ERROR)];
    instance.accepted(instance.log(true, &names));
    assert_eq!(provoked(&instance), categories(&[ERROR]));
    instance.accepted(instance.log_nothing(0));
    let text = instance.refused(instance.log_nothing(3));
    assert!(
        text.starts_with("fmi2SetDebugLogging: ") && text.contains("NULL"),
        "{text}"
    );
}

#[test]
fn every_category_told_is_declared() {
    let host = Host::of("three_stage");
    let declared = host
        .fmu()
        .description()
        .log_categories
        .as_ref()
        .expect("categories");
    let declared: Vec<_> = declared
        .categories
        .iter()
        .map(|entry| entry.name.as_str())
        .collect();
    let (instance, mut messages) = host.instantiate(&Birth {
        logging_on: true,
        ..host.birth()
    });
    let instance = instance.expect("an instance");
    for _ in 0..2 {
        instance.step(0.0, STEP);
        instance.other_statuses(0);
        instance.setup(None, 0.0, None);
        instance.enter();
        instance.exit();
        instance.terminate();
        instance.reset();
    }
    messages.extend(instance.messages());
    assert!(messages.len() > 2);
    for message in messages {
        let category = message.category.expect("NULL crashes three importers");
        assert!(declared.contains(&category.as_str()), "{category}");
    }
}

#[test]
fn percent_and_number_signs_of_users_are_escaped() {
    let host = Host::of("three_stage");
    let guid = text("100% of #r12# and %s%n%%");
    let (_, messages) = host.instantiate(&Birth {
        guid,
        ..host.birth()
    });
    let [
        Message {
            text: Some(text), ..
        },
    ] = &messages[..]
    else {
        panic!("{messages:?}");
    };
    assert!(text.contains("100%% of ##r12## and %%s%%n%%%%"), "{text}");
    let unescaped = text.replace("%%", "").replace("##", "");
    assert!(!unescaped.contains(['%', '#']), "{text}");
}

#[test]
fn the_instance_name_arrives_as_it_was_given() {
    let host = Host::of("three_stage");
    for name in ["100%#r1#", "/a/path to/an.fmu", "Über шестерня"] {
        let (instance, _) = host.instantiate(&Birth {
            name: text(name),
            ..host.birth()
        });
        let instance = instance.expect("an instance");
        instance.step(0.0, STEP);
        let messages = instance.messages();
        assert_eq!(messages.len(), 1);
        assert_eq!(messages[0].instance.as_deref(), Some(name));
    }
}

#[test]
fn every_instance_keeps_its_own_environment() {
    // The callbacks struct is gone when fmi2Instantiate returns; the pointer in it is not to be forgotten.
    let host = Host::of("three_stage");
    let callbacks = [Callbacks::Usual, Callbacks::LoggerOnly];
    let instances = callbacks.map(|callbacks| {
        host.instantiate(&Birth {
            callbacks,
            ..host.birth()
        })
        .0
    });
    let [Some(one), Some(two)] = &instances else {
        panic!("two instances");
    };
    for _ in 0..3 {
        one.refused(one.step(0.0, STEP));
        assert_eq!(two.messages(), []);
        two.refused(two.step(0.0, STEP));
        assert_eq!(one.messages(), []);
    }
}

#[test]
fn messages_are_lines_of_text() {
    let host = Host::of("three_stage");
    let instance = host.running();
    let texts = [
        instance.refused(instance.step(1.0, STEP)),
        instance.refused(instance.set(&[("mesh12.force", 1.0)])),
        instance.refused(instance.enter()),
    ];
    for text in texts {
        assert!(!text.ends_with(['\n', '.', ' ']), "{text:?}");
        assert!(text.starts_with("fmi2"), "{text:?}");
    }
}
