//! What users get wrong about meshes and trains: one message each, with place, rule and value.

mod support;

use geartrain::train::{load, no_files};
use support::{gear_pair, star, three_stage, valid};

const LAW: &str = "law = \"constant\"\nmean = 4e8";

/// The messages about a gear pair with this stiffness law.
fn about_law(law: &str) -> Vec<String> {
    about(&gear_pair(3, law, ""))
}

fn about(text: &str) -> Vec<String> {
    let problems = load(text).map(|_| ()).expect_err("the file is not valid");
    assert!(
        problems.iter().all(|problem| problem.spot.is_some()),
        "{problems:#?}"
    );
    problems.iter().map(ToString::to_string).collect()
}

/// Exactly one message, and all of `words` in it.
#[track_caller]
fn one_message(messages: &[String], words: &[&str]) {
    assert_eq!(messages.len(), 1, "{messages:#?}");
    for word in words {
        assert!(
            messages[0].contains(word),
            "`{word}` is not in {}",
            messages[0]
        );
    }
}

#[test]
fn fourier_laws_must_stay_positive_and_have_harmonics() {
    valid(&gear_pair(
        3,
        "law = \"fourier\"\nmean = 4e8\ncosine = [0.2]\nsine = [0, 0.1]",
        "",
    ));
    valid(&gear_pair(
        3,
        "law = \"fourier\"\nmean = 4e8\nsine = [0.9]",
        "",
    ));
    for (law, words) in [
        ("mean = 4e8", ["cosine", "missing", "sine, or both"]),
        (
            "mean = -4e8\ncosine = [0.1]",
            ["mean", "greater than 0", "-4"],
        ),
        (
            "cosine = [0.1]",
            ["mesh \"mesh\", stiffness", "mean", "missing"],
        ),
        (
            "mean = 4e8\ncosine = [0.8]\nsine = [0.7]",
            ["cosine", "stay above 0", "-0.063"],
        ),
        (
            "mean = 4e8\nsine = [1.0]",
            ["sine", "stay above 0", "relative to the mean"],
        ),
        ("mean = 4e8\ncosine = [inf]", ["cosine", "finite", "inf"]),
        (
            "mean = 4e8\ncosine = [\"a\"]",
            ["cosine", "must be a number", "the string \"a\""],
        ),
        (
            "mean = 4e8\ncosine = 0.1",
            ["cosine", "list of numbers", "0.1"],
        ),
        (
            "mean = 4e8\ncosine = [0.1]\nphase = [0.1]",
            ["phase", "unknown key", "cosine, sine, mean"],
        ),
    ] {
        one_message(&about_law(&format!("law = \"fourier\"\n{law}")), &words);
    }
    let many = vec!["0.001"; 101].join(", ");
    one_message(
        &about_law(&format!("law = \"fourier\"\nmean = 4e8\ncosine = [{many}]")),
        &["cosine", "at most 100", "101"],
    );
}

#[test]
fn tables_must_ascend_within_a_period_and_stay_positive() {
    let table =
        |phase: &str, value: &str| format!("law = \"table\"\nphase = [{phase}]\nvalue = [{value}]");
    for (phase, value) in [("0.3", "2e8"), ("0, 0, 0.5, 0.5", "2e8, 3e8, 3e8, 2e8")] {
        valid(&gear_pair(3, &table(phase, value), ""));
    }
    for (phase, value, words) in [
        ("", "", ["phase", "1 to 1000", "found 0"]),
        ("0, 0.5", "2e8", ["value", "as many entries as phase", "2"]),
        ("0, 1.0", "2e8, 3e8", ["phase", "less than 1", "found 1"]),
        ("-0.1, 0.5", "2e8, 3e8", ["phase", "0 or more", "-0.1"]),
        ("0.5, 0.2", "2e8, 3e8", ["phase", "ascend", "0.2 after 0.5"]),
        (
            "0.5, 0.50000001",
            "2e8, 3e8",
            ["phase", "ascend", "at a jump"],
        ),
        ("0.5, 0.5, 0.5", "2e8, 3e8, 2e8", ["phase", "twice", "0.5"]),
        (
            "0.0, 0.9999999",
            "2e8, 3e8",
            ["phase", "around the period", "0.9999999 and 0"],
        ),
        (
            "0.0, 0.5",
            "2e8, 0.0",
            ["value", "greater than 0", "found 0"],
        ),
        (
            "0.0, true",
            "2e8, 3e8",
            ["phase", "list of numbers", "true"],
        ),
    ] {
        one_message(&about_law(&table(phase, value)), &words);
    }
    one_message(
        &about_law("law = \"table\"\nvalue = [2e8]"),
        &["mesh \"mesh\", stiffness", "phase", "missing"],
    );
}

#[test]
fn transmission_error_counts_its_orders_per_tooth() {
    let with =
        |keys: &str| gear_pair(3, LAW, "") + &format!("[[mesh.transmission_error]]\n{keys}\n");
    valid(&with("order = 3\namplitude = 5e-6\nphase = 0.4"));
    for (keys, words) in [
        (
            "order = 0\namplitude = 1e-6",
            ["mesh \"mesh\", transmission_error 1", "order", "found 0"],
        ),
        (
            "order = 101\namplitude = 1e-6",
            ["order", "from 1", "to 100"],
        ),
        (
            "order = 1.5\namplitude = 1e-6",
            ["order", "whole number", "1.5"],
        ),
        (
            "amplitude = 1e-6",
            ["transmission_error 1", "order", "missing"],
        ),
        (
            "order = 1",
            ["transmission_error 1", "amplitude", "missing"],
        ),
        ("order = 1\namplitude = nan", ["amplitude", "finite", "NaN"]),
        (
            "order = 1\namplitude = 1e-6\nphase = inf",
            ["phase", "finite", "inf"],
        ),
        (
            "order = 1\namplitude = 1e-6\nangle = 1",
            ["angle", "unknown key", "order, amplitude, phase"],
        ),
    ] {
        one_message(&about(&with(keys)), &words);
    }
}

#[test]
fn a_ring_is_the_second_gear_the_larger_one_and_turns_the_same_way() {
    one_message(
        &about(&gear_pair(3, LAW, "internal = true").replace("speed = -150", "speed = 150")),
        &["mesh \"mesh\": gears", "ring", "24 : 24", "swap the two"],
    );
    let first_ring = "gears = [\"planet1.gear\", \"ring.gear\"]";
    let swapped = star().replace(first_ring, "gears = [\"ring.gear\", \"planet1.gear\"]");
    one_message(&about(&swapped), &["ring1", "70 : 25", "swap the two"]);
    let flat = star().replace("base_radius = 0.14", "base_radius = 0.05");
    let messages = about(&flat);
    assert_eq!(messages.len(), 2, "{messages:#?}");
    assert!(messages[0].contains("base radius of the second gear") && messages[0].contains("0.05"));
    // The speed of a ring has the sign of that of the gear inside it.
    let backwards = star().replace("speed = -57.142857142857146", "speed = 57.142857142857146");
    let messages = about(&backwards);
    assert_eq!(messages.len(), 2, "{messages:#?}");
    for word in [
        "ring1",
        "25 : 70 teeth in a ring",
        "-57.14",
        "\"ring\"",
        "found 57.14",
    ] {
        assert!(
            messages[0].contains(word),
            "`{word}` is not in {}",
            messages[0]
        );
    }
    one_message(
        &about(&gear_pair(3, LAW, "internal = 1")),
        &["internal", "true or false", "found 1"],
    );
}

#[test]
fn a_loop_that_cannot_turn_names_its_meshes_and_what_to_change() {
    // Without internal = true, planet 1 would turn the ring the other way than planet 2 does.
    one_message(
        &about(&star().replacen("internal = true\n", "", 1)),
        &[
            "mesh \"ring1\": gears: closes a loop",
            "cannot turn",
            "is -0.357",
            "and 0.357",
            "through \"sun1\", \"sun2\", \"ring2\"",
            "change tooth numbers",
        ],
    );
}

/// The messages of all warnings.
fn warnings(text: &str) -> Vec<String> {
    valid(text)
        .warnings
        .iter()
        .map(ToString::to_string)
        .collect()
}

#[test]
fn meshes_of_one_gear_follow_each_other_as_its_teeth_pass() {
    // The tooth of the sun that is at planet 1 now is at planet 2 half a turn later: p_2(t + pi / Om) = p_1(t).
    let train = valid(&star()).train;
    let phase = |mesh: usize, time: f64| {
        train.meshes[mesh].start_phase + train.meshes[mesh].phase_rate * time
    };
    let half_turn = core::f64::consts::PI / 200.0;
    assert!(
        (phase(1, half_turn + 0.001) - phase(0, 0.001)).abs() < 1e-12,
        "rounding"
    );
    assert_eq!((phase(0, 0.0), phase(1, 0.0)), (0.0, -10.0)); // 20 teeth, half a turn

    // The same on the other flank, from a given phase, with an initial angle: s = -1, z = 36, 90 degrees.
    let text = three_stage()
        .replace("flank = 1", "flank = -1")
        .replace(
            "speed = 314.1592653589793 ",
            "angle = 0.5\nspeed = 314.1592653589793 ",
        )
        .replacen("phase = 0.0\ncontact", "phase = 0.25\ncontact", 1)
        .replacen("center_angle = 0.0", "center_angle = 4.71238898038469", 1);
    let (before, last) = text.rsplit_once("phase = 0.0\ncontact").unwrap();
    let loaded = valid(&format!("{before}contact{last}"));
    assert!(loaded.warnings.is_empty(), "{:?}", loaded.warnings);
    let turned = 36.0 * 0.5 / core::f64::consts::TAU;
    for (mesh, phase) in loaded.train.meshes.iter().zip([0.25, 0.25 + 9.0]) {
        assert!(
            (mesh.start_phase - (phase - turned)).abs() < 1e-12,
            "rounding"
        );
    }
}

#[test]
fn phases_that_geometry_alone_does_not_give_are_warned_of() {
    // The planets are idlers: their flanks toward sun and ring differ.
    let found = warnings(&star().replace("phase = 0.3\n", ""));
    assert_eq!(found.len(), 2, "{found:#?}");
    for (message, names) in found.iter().zip([["ring1", "sun1"], ["ring2", "sun2"]]) {
        for word in [
            names[0],
            "phase: missing",
            "0 pitches",
            names[1],
            "tooth thicknesses",
            "give phase",
        ] {
            assert!(message.contains(word), "`{word}` is not in {message}");
        }
    }
    // One gear driving on one flank and driven on the other.
    let (before, last) = three_stage()
        .rsplit_once("flank = 1")
        .map(|(a, b)| (a.to_string(), b.to_string()))
        .unwrap();
    let found = warnings(&format!(
        "{before}flank = -1{}",
        last.replace("phase = 0.0\n", "")
    ));
    assert_eq!(found.len(), 1, "{found:#?}");
    assert!(
        found[0].contains("mesh13") && found[0].contains("-18 pitches"),
        "{found:#?}"
    );
}

#[test]
fn teeth_of_different_base_pitch_and_rings_meshed_from_outside_are_warned_of() {
    let found = warnings(&star().replace("base_radius = 0.14", "base_radius = 0.1401"));
    assert_eq!(found.len(), 2, "{found:#?}");
    for word in [
        "ring1",
        "0.05 m and 0.1401 m",
        "25 : 70 teeth",
        "do not fit",
        "change a base_radius",
    ] {
        assert!(found[0].contains(word), "`{word}` is not in {}", found[0]);
    }
    // Planet 2 outside the ring instead of inside.
    let star = star();
    let (sun2, ring1) = (
        star.find("[[mesh]]\nname = \"sun2\""),
        star.find("[[mesh]]\nname = \"ring1\""),
    );
    let (before, after) = (&star[..sun2.unwrap()], &star[ring1.unwrap()..]);
    let (inside, outside) = after.split_at(after.find("name = \"ring2\"").unwrap());
    let outside = outside.replace("internal = true", "internal = false");
    let planet2 = "name = \"planet2\"\nspeed = ";
    let before = before.replace(&format!("{planet2}-160.0"), &format!("{planet2}160.0"));
    let found = warnings(&format!("{before}{inside}{outside}"));
    assert_eq!(found.len(), 1, "{found:#?}");
    for word in [
        "ring1",
        "\"ring.gear\" is a ring here",
        "external gear in mesh \"ring2\"",
        "a gear of their own",
    ] {
        assert!(found[0].contains(word), "`{word}` is not in {}", found[0]);
    }
}

#[test]
fn loops_whose_centres_do_not_close_are_warned_of() {
    // Planet 2 a quarter turn away from the place that the ring has for it.
    let star = star();
    let (before, sun2) = star.split_at(star.find("name = \"sun2\"").unwrap());
    let turned = sun2.replacen(
        "center_angle = 3.141592653589793",
        "center_angle = 1.5707963267948966",
        1,
    );
    let found = warnings(&format!("{before}{turned}"));
    assert_eq!(found.len(), 1, "{found:#?}");
    for word in [
        "mesh \"ring2\": center_angle",
        "\"ring.gear\"",
        "0.096164 m at 0.000000 rad",
        "\"planet2.gear\"",
        "at -1.57",
        "around the loop",
    ] {
        assert!(found[0].contains(word), "`{word}` is not in {}", found[0]);
    }
    one_message(
        &about(&gear_pair(3, LAW, "").replace("center_angle = 0.3", "center_angle = 1e9")),
        &["center_angle", "within -1000 and 1000", "found 1000000000"],
    );
}

#[test]
fn flanks_that_the_torques_pull_apart_are_warned_of_in_rings_too() {
    let package =
        geartrain::package::Package::of(&star().replace("flank = -1", "flank = 1"), &no_files)
            .unwrap();
    let found: Vec<String> = package.warnings.iter().map(ToString::to_string).collect();
    assert_eq!(found.len(), 2, "{found:#?}");
    for (message, mesh) in found.iter().zip(["ring1", "ring2"]) {
        assert!(
            message.contains(mesh) && message.contains("pulls this flank apart"),
            "{message}"
        );
    }
}
