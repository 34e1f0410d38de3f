//! Rules and messages of what sits on a rotor, and of the basis.

mod support;

use geartrain::config::BasisModes;
use geartrain::train::load;
use support::{gear_pair, three_stage};

const LAW: &str = "law = \"constant\"\nmean = 4e8";

/// The file must be refused with exactly one message that has a line and contains all of `words`.
#[track_caller]
fn refused(text: &str, words: &[&str]) {
    let problems = load(text).map(|_| ()).expect_err("the file is not valid");
    assert_eq!(problems.len(), 1, "{problems:#?}");
    let sentence = problems[0].to_string();
    for word in words {
        assert!(sentence.contains(word), "`{word}` is not in: {sentence}");
    }
    assert!(problems[0].spot.is_some(), "{sentence}");
}

#[test]
fn the_basis_may_be_left_out_or_be_given_in_one_of_two_ways() {
    let counts =
        "lateral_modes = 3\ntorsional_modes = 3          # the rigid mode and two elastic ones\n";
    let text = three_stage();
    let basis = |text: &str| load(text).unwrap().train.basis;
    let without = text.replacen(&format!("[basis]\n{counts}static_shapes = false\n"), "", 1);
    assert!(without.len() < text.len());
    // 36 teeth at 50 Hz: three times 1800 Hz.
    let default = basis(&without);
    assert!(default.static_shapes);
    let BasisModes::MaxFrequency(frequency) = default.modes else {
        panic!("{default:?}");
    };
    assert!(
        (frequency / 5400.0 - 1.0).abs() < 1e-12,
        "{frequency} Hz; rounding"
    );
    let slow = gear_pair(3, LAW, "").replace("lateral_modes = 3\ntorsional_modes = 3\n", "");
    let slow = basis(
        &slow
            .replace("speed = 150", "speed = 15")
            .replace("speed = -150", "speed = -15"),
    );
    assert_eq!(
        slow.modes,
        BasisModes::MaxFrequency(1000.0),
        "24 teeth at 15 rad/s: 57 Hz"
    );
    assert!(
        !slow.static_shapes,
        "a [basis] has them only when it says so"
    );
    let both = three_stage().replacen("torsional_modes = 3 ", "max_frequency = 3e3 ", 1);
    refused(&both, &["lateral_modes", "contradicts max_frequency"]);
    let half = three_stage().replacen("torsional_modes = 3 ", "# ", 1);
    refused(&half, &["torsional_modes", "missing"]);
}

#[test]
fn bows_need_an_offset_for_each_of_several_places() {
    let torque = "[[rotor.torque]]";
    let bow = |body: &str| format!("[[rotor.bow]]\n{body}\n{torque}");
    for (body, words) in [
        (
            "amplitudes = [1e-5, 2e-5, 0.0]\npositions = [0.1, 0.5]",
            [
                "amplitudes",
                "one offset for each of the 2 positions, found 3",
            ],
        ),
        (
            "amplitudes = [1e-5, 2e-5]\npositions = [0.5, 0.5]",
            ["positions", "different"],
        ),
        (
            "amplitudes = [1e-5, 2e-5]\npositions = [0.5, 1.5]",
            ["positions 1.5 m lies beyond", "1.016 m"],
        ),
        (
            "positions = [0.1, 0.5]\namplitudes = [1e-5, nan]",
            ["amplitudes", "NaN"],
        ),
        (
            "positions = [0.1, 0.5]\namplitudes = [1e-5, true]",
            ["amplitudes", "list of numbers only"],
        ),
        (
            "amplitudes = []\npositions = []",
            ["positions", "at least one"],
        ),
    ] {
        let text = three_stage().replacen(torque, &bow(body), 1);
        refused(&text, &["rotor \"stage1\", bow 1", words[0], words[1]]);
    }
    // A straight line through two offsets: allowed, and without effect.
    let straight = bow("positions = [0.1, 0.5]\namplitudes = [1e-5, 2e-5]");
    let warnings = load(&three_stage().replacen(torque, &straight, 1))
        .unwrap()
        .warnings;
    assert!(
        warnings.len() == 1 && warnings[0].message.contains("no force"),
        "{warnings:?}"
    );
}

/// The first bearing of the example with its coefficients replaced.
fn with_speed_table(body: &str) -> String {
    let text = three_stage();
    let start = text.find("stiffness = { xx").unwrap();
    let end = start + text[start..].find("\n\n").unwrap();
    format!("{}{body}{}", &text[..start], &text[end..])
}

#[test]
fn bearing_tables_cover_the_speed_or_say_what_holds_outside() {
    let point = |speed: f64| {
        format!(
            "[[rotor.bearing.at_speed]]\nspeed = {speed:?}\nstiffness = {{ xx = 1e8, yy = 2e8 }}\n"
        )
    };
    let table = |speeds: [f64; 2]| speeds.map(point).concat();
    assert!(load(&with_speed_table(&table([100.0, 400.0]))).is_ok());
    assert!(
        load(&with_speed_table(
            &("outside_speeds = \"hold\"\n".to_string() + &table([1.0, 2.0]))
        ))
        .is_ok()
    );
    for (body, words) in [
        (
            table([100.0, 300.0]),
            [
                "bearing \"b1\": at_speed",
                "covers 100 to 300 rad/s, but the rotor turns at 314.159",
            ],
        ),
        (
            table([400.0, 300.0]),
            ["at_speed 2: speed", "greater than the 400 rad/s before it"],
        ),
        (point(100.0), ["at_speed", "at least two speeds, found 1"]),
        (table([-1.0, 400.0]), ["at_speed 1: speed", "0 or more"]),
        (
            table([1.0, 400.0]).replacen("xx = 1e8", "xx = -1e8", 1),
            ["at_speed 1, stiffness: xx", "-100000000"],
        ),
        (
            "stiffness = { xx = 1e8 }\n".to_string() + &table([1.0, 400.0]),
            ["stiffness", "contradicts at_speed"],
        ),
        (
            "stiffness = { xx = 1e8 }\noutside_speeds = \"hold\"".to_string(),
            ["outside_speeds", "only with at_speed"],
        ),
        (
            "outside_speeds = \"guess\"\n".to_string() + &table([1.0, 400.0]),
            ["outside_speeds", "\"refuse\" or \"hold\""],
        ),
        (String::new(), ["bearing \"b1\": stiffness", "missing"]),
    ] {
        refused(&with_speed_table(&body), &words);
    }
}
