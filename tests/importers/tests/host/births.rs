//! The library's symbols, and fmi2Instantiate with good, strange and bad arguments.

use std::ffi::CString;
use std::process::Command;

use geartrain::fmi2::abi::CO_SIMULATION;
use importers::host::text;
use importers::log::Message;
use importers::{Birth, Callbacks, Host};

/// fmi2Functions.h without the functions of model exchange.
const FUNCTIONS: [&str; 34] = [
    "fmi2CancelStep",
    "fmi2DeSerializeFMUstate",
    "fmi2DoStep",
    "fmi2EnterInitializationMode",
    "fmi2ExitInitializationMode",
    "fmi2FreeFMUstate",
    "fmi2FreeInstance",
    "fmi2GetBoolean",
    "fmi2GetBooleanStatus",
    "fmi2GetDirectionalDerivative",
    "fmi2GetFMUstate",
    "fmi2GetInteger",
    "fmi2GetIntegerStatus",
    "fmi2GetReal",
    "fmi2GetRealOutputDerivatives",
    "fmi2GetRealStatus",
    "fmi2GetStatus",
    "fmi2GetString",
    "fmi2GetStringStatus",
    "fmi2GetTypesPlatform",
    "fmi2GetVersion",
    "fmi2Instantiate",
    "fmi2Reset",
    "fmi2SerializeFMUstate",
    "fmi2SerializedFMUstateSize",
    "fmi2SetBoolean",
    "fmi2SetDebugLogging",
    "fmi2SetFMUstate",
    "fmi2SetInteger",
    "fmi2SetReal",
    "fmi2SetRealInputDerivatives",
    "fmi2SetString",
    "fmi2SetupExperiment",
    "fmi2Terminate",
];

#[test]
fn exactly_the_34_functions_are_exported() {
    for name in ["three_stage", "reducer", "compound"] {
        let host = Host::of(name);
        // From the package (binutils) that also brings the linker of every Rust program.
        let output = Command::new("nm")
            .args(["-D", "--defined-only", "--format=just-symbols"])
            .arg(host.fmu().library())
            .output()
            .expect("nm can be started");
        assert!(output.status.success(), "{output:?}");
        let listing = String::from_utf8(output.stdout).expect("symbols are ASCII");
        let mut symbols: Vec<&str> = listing.lines().collect();
        symbols.sort_unstable();
        assert_eq!(symbols, FUNCTIONS, "{name}");
    }
}

#[test]
fn platform_and_version_are_answered_without_an_instance() {
    assert_eq!(
        Host::of("three_stage").platform_and_version(),
        ["default", "2.0"]
    );
}

/// With these arguments an instance is born, tells nothing, and runs.
fn lives(host: &Host, birth: &Birth) {
    let (instance, messages) = host.instantiate(birth);
    assert_eq!(messages, [], "{birth:?}");
    let instance = instance.unwrap_or_else(|| panic!("no instance: {birth:?}"));
    instance.initialize();
    instance.steps(0, 1);
}

#[test]
fn every_spelling_of_the_resource_location_is_accepted() {
    let host = Host::of("three_stage");
    let folder = host.fmu().folder().display();
    let spellings = [
        format!("file:///{folder}/resources").replace("////", "///"),
        format!("file:{folder}/resources"),
        format!("file://localhost{folder}/resources"),
        format!("file:///{folder}/resources"), // Ecos, OMSimulator: four slashes
        format!("file://{folder}/resources/"), // fmi-rs
        format!("file://{folder}/an unencoded Ümlaut и пробел/resources"),
        format!("file://{folder}/an%20encoded%20%C3%9Cmlaut/resources"),
        format!("file://{folder}/half%2/%zz/resources"),
        "file:///../resources/".to_string(), // fmusim
        "file:///C:/Temp/fmu/resources".to_string(),
        "file:///a/missing/folder/resources".to_string(),
        "http://example.org/resources".to_string(),
        "no URI at all".to_string(),
        String::new(),
    ];
    for spelling in &spellings {
        let resources = text(spelling);
        lives(
            &host,
            &Birth {
                resources,
                ..host.birth()
            },
        );
    }
    let not_utf8 = CString::new(b"file:///\xff\xfe").ok();
    for resources in [None, not_utf8] {
        lives(
            &host,
            &Birth {
                resources,
                ..host.birth()
            },
        );
    }
}

#[test]
fn any_name_that_is_not_blank_is_accepted() {
    let host = Host::of("three_stage");
    for name in [
        "/home/me/three_stage.fmu",
        "%s%n%d #r1# {}",
        "три ступени",
        " x ",
    ] {
        lives(
            &host,
            &Birth {
                name: text(name),
                ..host.birth()
            },
        );
    }
    let not_utf8 = CString::new(b"\xff\xfe").ok();
    lives(
        &host,
        &Birth {
            name: not_utf8,
            ..host.birth()
        },
    );
    let long = text(&"n".repeat(100_000));
    lives(
        &host,
        &Birth {
            name: long,
            ..host.birth()
        },
    );
}

#[test]
fn memory_functions_are_not_needed() {
    let host = Host::of("three_stage");
    lives(
        &host,
        &Birth {
            callbacks: Callbacks::LoggerOnly,
            ..host.birth()
        },
    );
}

#[test]
fn a_slave_without_a_logger_lives_and_errs_in_silence() {
    let host = Host::of("three_stage");
    let birth = Birth {
        callbacks: Callbacks::Nulls,
        logging_on: true,
        ..host.birth()
    };
    lives(&host, &birth);
    let (instance, _) = host.instantiate(&birth);
    let instance = instance.expect("an instance");
    assert_eq!(instance.step(0.0, 1.0), geartrain::fmi2::abi::Status::Error);
    assert_eq!(instance.messages(), []);
}

/// With these arguments no instance is born, and the one message contains all `words`.
fn stillborn(host: &Host, birth: &Birth, words: &[&str]) {
    let (instance, messages) = host.instantiate(birth);
    assert!(instance.is_none(), "{birth:?}");
    let [
        Message {
            status,
            category,
            text,
            ..
        },
    ] = &messages[..]
    else {
        panic!("{birth:?}: {messages:?}");
    };
    assert_eq!(*status, 3);
    assert_eq!(category.as_deref(), Some("logStatusError"));
    let text = text.as_deref().expect("a text");
    assert!(text.starts_with("fmi2Instantiate: "), "{text}");
    for word in words {
        assert!(text.contains(word), "{word:?} is missing in: {text}");
    }
}

#[test]
fn a_blank_name_is_refused_in_words() {
    let host = Host::of("three_stage");
    for name in [None, text(""), text(" \t\n")] {
        stillborn(
            &host,
            &Birth {
                name,
                ..host.birth()
            },
            &["instance name"],
        );
    }
}

#[test]
fn a_wrong_guid_is_refused_with_both_guids() {
    let host = Host::of("three_stage");
    let guid = &host.fmu().description().guid;
    let wrong = [
        "{00000000-0000-0000-0000-000000000000}".to_string(),
        guid.trim_matches(['{', '}']).to_string(),
        guid.to_uppercase(),
        format!(" {guid}"),
        String::new(),
    ];
    for wrong in &wrong {
        stillborn(
            &host,
            &Birth {
                guid: text(wrong),
                ..host.birth()
            },
            &[wrong, guid],
        );
    }
    stillborn(
        &host,
        &Birth {
            guid: None,
            ..host.birth()
        },
        &["NULL", guid],
    );
    let not_utf8 = CString::new(b"\xff{}").ok();
    stillborn(
        &host,
        &Birth {
            guid: not_utf8,
            ..host.birth()
        },
        &[guid],
    );
}

#[test]
fn the_guid_of_another_fmu_is_refused() {
    let (host, other) = (Host::of("three_stage"), Host::of("reducer"));
    let guid = other.birth().guid;
    stillborn(
        &host,
        &Birth {
            guid,
            ..host.birth()
        },
        &["do not belong together"],
    );
}

#[test]
fn other_interface_types_are_refused_in_words() {
    let host = Host::of("three_stage");
    for fmu_type in [0, 2, -1, i32::MAX] {
        assert_ne!(fmu_type, CO_SIMULATION);
        stillborn(
            &host,
            &Birth {
                fmu_type,
                ..host.birth()
            },
            &["co-simulation"],
        );
    }
}

#[test]
fn without_callbacks_nobody_is_told_and_nothing_is_born() {
    let host = Host::of("three_stage");
    let absent = Birth {
        callbacks: Callbacks::Absent,
        ..host.birth()
    };
    let silent = Birth {
        callbacks: Callbacks::Nulls,
        guid: None,
        name: None,
        ..host.birth()
    };
    for birth in [absent, silent] {
        let (instance, messages) = host.instantiate(&birth);
        assert!(instance.is_none(), "{birth:?}");
        assert_eq!(messages, []);
    }
}

#[test]
fn a_slave_is_freed_in_any_state() {
    let host = Host::of("three_stage");
    drop(host.instance());
    let instance = host.instance();
    instance.accepted(instance.setup(None, 0.0, None));
    instance.accepted(instance.enter());
    drop(instance);
    let instance = host.running();
    instance.steps(0, 2);
    drop(instance); // without fmi2Terminate: fmu-runner
    let instance = host.running();
    instance.accepted(instance.terminate());
    drop(instance);
    host.free_nobody();
}
