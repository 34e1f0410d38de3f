//! Bad model files: every problem at once, each with its line, place, rule and value.

mod support;

use std::panic::catch_unwind;

use geartrain::config::Problem;
use geartrain::train::{load, no_files};
use support::{gear_pair, three_stage};

const LAW: &str = "law = \"constant\"\nmean = 4e8";

fn problems(text: &str) -> Vec<Problem> {
    load(text).map(|_| ()).expect_err("the file is not valid")
}

/// The problems as a user sees them, with the line in front.
fn shown(text: &str) -> Vec<String> {
    let line = |problem: &Problem| {
        problem
            .spot
            .map_or("?".to_string(), |spot| spot.line.to_string())
    };
    problems(text)
        .iter()
        .map(|problem| format!("{}: {problem}", line(problem)))
        .collect()
}

/// The example with one line replaced must be refused with exactly one message that contains all of `words`
/// and stands at the first line that differs.
#[track_caller]
fn one_problem(from: &str, to: &str, words: &[&str]) {
    let text = three_stage();
    assert!(text.contains(from), "the example has no `{from}`");
    let changed = text.replacen(from, to, 1);
    let same = text
        .lines()
        .zip(changed.lines())
        .take_while(|(one, two)| one == two)
        .count();
    let found = problems(&changed);
    assert_eq!(found.len(), 1, "{found:#?}");
    let sentence = found[0].to_string();
    for word in words {
        assert!(sentence.contains(word), "`{word}` is not in: {sentence}");
    }
    let line = found[0].spot.map(|spot| spot.line);
    assert_eq!(line, Some(same + 1), "{sentence}");
}

#[test]
fn the_example_is_valid_and_warns_of_nothing() {
    let loaded = load(&three_stage()).unwrap();
    assert!(loaded.warnings.is_empty(), "{:?}", loaded.warnings);
}

#[test]
fn numbers_out_of_range_name_rule_and_value() {
    one_problem(
        "length = 1.016",
        "length = -1.016",
        &["stage1", "segment 1", "length", "greater than 0", "-1.016"],
    );
    one_problem(
        "density = 7830.0",
        "density = nan",
        &["material.default", "density", "NaN"],
    );
    one_problem(
        "poisson_ratio = 0.3",
        "poisson_ratio = 0.7",
        &["poisson_ratio", "at most 0.5", "0.7"],
    );
    one_problem(
        "tolerance = 1e-4",
        "tolerance = 0.0",
        &["simulation", "tolerance", "at least 1e-12"],
    );
    one_problem(
        "step_size = 2e-5",
        "step_size = inf",
        &["step_size", "finite", "inf"],
    );
    one_problem(
        "lateral_modes = 3",
        "lateral_modes = 0",
        &["lateral_modes", "at least 1"],
    );
    one_problem(
        "contact_ratio = 1.6",
        "contact_ratio = 0.5",
        &["mesh12", "stiffness", "contact_ratio", "0.5"],
    );
    one_problem(
        "pressure_angle = 0.3490658503988659",
        "pressure_angle = 20.0",
        &["mesh12", "pressure_angle", "20"],
    );
    one_problem(
        "moment = 5.0e-6",
        "moment = -1.0",
        &["gear_unbalance", "moment", "-1"],
    );
    one_problem(
        "quadratic = 0.4",
        "quadratic = 1.4",
        &["quadratic", "negative"],
    );
    one_problem(
        "max_element_length = 0.05",
        "max_element_length = 1e-9",
        &["max_element_length", "1/400"],
    );
}

#[test]
fn positions_beyond_the_shaft_are_refused() {
    one_problem(
        "name = \"b1\"\nposition = 0.661",
        "name = \"b1\"\nposition = 1.2",
        &[
            "rotor \"stage1\", bearing \"b1\": position 1.2 m lies beyond the shaft's end at 1.016 m",
        ],
    );
}

#[test]
fn unknown_keys_name_what_is_known() {
    one_problem(
        "teeth = 36",
        "teeth = 36\ntooth = 3",
        &["gear \"gear\"", "tooth", "unknown key", "base_radius"],
    );
}

#[test]
fn wrong_types_name_what_was_found() {
    one_problem(
        "teeth = 36",
        "teeth = 36.5",
        &["teeth", "whole number", "36.5"],
    );
    one_problem(
        "base_radius = 0.1074069",
        "base_radius = true",
        &["base_radius", "number", "true"],
    );
    one_problem(
        "length = 1.016",
        "length = \"40 rpm\"",
        &["length", "40 rpm", "angular speed", "length in m"],
    );
    one_problem(
        "kind = \"gear_train\"",
        "kind = 3",
        &["kind", "string", "3"],
    );
}

#[test]
fn names_must_be_unique_identifiers_that_collide_with_nothing() {
    one_problem(
        "name = \"b2\"",
        "name = \"b1\"",
        &["unique", "bearing \"b1\""],
    );
    one_problem("name = \"b2\"", "name = \"b 2\"", &["letters", "b 2"]);
    one_problem("name = \"b2\"", "name = \"modal\"", &["reserved", "modal"]);
    one_problem(
        "name = \"mesh12\"",
        "name = \"stage1\"",
        &["unique", "rotor \"stage1\""],
    );
    one_problem(
        "name = \"three_stage\"",
        "name = \"3 stages\"",
        &["C identifier", "3 stages"],
    );
}

#[test]
fn gears_must_exist_and_speeds_must_fit_the_teeth() {
    let pair = "gears = [\"stage1.gear\", \"stage2.gear\"]";
    one_problem(
        pair,
        "gears = [\"stage1.gear\", \"stage4.gear\"]",
        &["stage4.gear", "stage3.gear"],
    );
    one_problem(pair, "gears = [\"stage1.gear\"]", &["gears", "two strings"]);
    let text = three_stage().replacen("speed = -314.1592653589793", "speed = 314.1592653589793", 1);
    let found = shown(&text);
    assert_eq!(found.len(), 1, "{found:#?}");
    for word in [
        "mesh12",
        "36 : 36 teeth",
        "-314.159",
        "stage2",
        "found 314.159",
    ] {
        assert!(found[0].contains(word), "`{word}` is not in {}", found[0]);
    }
}

#[test]
fn a_loop_of_meshes_that_cannot_turn_is_refused() {
    // Three equal gears in a ring: each turns against its neighbours, which an odd ring cannot.
    let mut text = gear_pair(3, LAW, "")
        .replace("speed = 150", "speed = 0")
        .replace("speed = -150", "speed = 0");
    let third =
        text[text.find("[[rotor]]").unwrap()..text.find("name = \"two\"").unwrap()].to_string();
    let third = third.replace("\"one\"", "\"three\"");
    text = text.replacen(
        "[[rotor]]",
        &format!("{}[[rotor]]", third.trim_end_matches("[[rotor]]\n")),
        1,
    );
    for (name, gears) in [
        ("m2", "\"two.gear\", \"three.gear\""),
        ("m3", "\"three.gear\", \"one.gear\""),
    ] {
        text += &format!(
            "[[mesh]]\nname = \"{name}\"\ngears = [{gears}]\ncenter_angle = 1.0\npressure_angle = 0.35\nphase = 0.0\n\
             [mesh.stiffness]\n{LAW}\n"
        );
    }
    let found = shown(&text);
    assert!(
        found.iter().any(|problem| problem.contains("cannot turn")),
        "{found:#?}"
    );
}

#[test]
fn all_problems_are_reported_together_in_the_order_of_the_file() {
    let text = three_stage()
        .replacen("density = 7830.0", "density = -1.0", 1)
        .replacen("teeth = 36", "teeth = \"many\"", 1)
        .replacen("position = 0.508", "position = -0.5", 1)
        .replacen("law = \"tooth_pair\"", "law = \"magic\"", 1)
        + "\nnonsense = 1\n";
    let found = problems(&text);
    let lines: Vec<_> = found
        .iter()
        .map(|problem| problem.spot.expect("every problem has a line"))
        .collect();
    assert!(lines.is_sorted() && found.len() == 5, "{found:#?}");
    for (problem, word) in found
        .iter()
        .zip(["density", "teeth", "position", "law", "nonsense"])
    {
        assert!(problem.message.contains(word), "{problem}");
    }
}

#[test]
fn missing_keys_are_named_once_each() {
    let found = shown(&three_stage().replacen("teeth = 36\n", "", 1));
    assert_eq!(
        found,
        ["36: rotor \"stage1\", gear \"gear\": teeth: missing"],
        "the line of the gear's table"
    );
    let found = shown("kind = \"gear_train\"\n");
    for key in ["name", "rotor"] {
        assert_eq!(
            found.iter().filter(|problem| problem.contains(key)).count(),
            1,
            "{key}: {found:#?}"
        );
    }
}

#[test]
fn torques_that_drift_and_flanks_that_contradict_are_warnings() {
    let drifting = three_stage()
        .replace("slope = 0.5", "slope = 0.0")
        .replacen("value = 2250.0", "value = 2000.0", 1);
    let warnings = load(&drifting).unwrap().warnings;
    assert!(
        warnings.len() == 1 && warnings[0].message.contains("drift"),
        "{warnings:?}"
    );
    let package = geartrain::package::Package::of(
        &three_stage().replace("flank = 1", "flank = -1"),
        &no_files,
    )
    .unwrap();
    assert!(
        package
            .warnings
            .iter()
            .all(|warning| warning.message.contains("pulls this flank apart"))
    );
    assert_eq!(package.warnings.len(), 2);
}

#[test]
fn damaged_files_never_panic() {
    // Every prefix of the example and every line of it left out or doubled: an answer, never a panic.
    let text = three_stage();
    let lines: Vec<&str> = text.lines().collect();
    for index in 0..lines.len() {
        let mut without = lines.clone();
        let line = without.remove(index);
        let mut doubled = lines.clone();
        doubled.insert(index, line);
        for damaged in [
            without.join("\n"),
            doubled.join("\n"),
            lines[..index].join("\n"),
        ] {
            assert!(
                catch_unwind(|| load(&damaged).is_ok()).is_ok(),
                "line {}",
                index + 1
            );
        }
    }
    for garbage in [
        "",
        "\0",
        "= 1",
        "[[rotor",
        "rotor = 1",
        "[rotor]\nname = 1",
        "name = \"\u{fffd}",
        "material = [1]",
    ] {
        assert!(
            catch_unwind(|| load(garbage).is_err()).unwrap(),
            "{garbage:?}"
        );
    }
}
