//! Stiffness and damping of bearings in the file of a housing: what is refused, and where they count for nothing.

mod support;

use geartrain::interface::Interface;
use geartrain::model::ModalModel;
use geartrain::train::load_beside;
use support::{beside, model_file};

#[test]
fn inside_a_gear_train_the_bearings_themselves_are_there() {
    let model = |file: &'static str| {
        let files = move |name: &str| beside(if name == "box.toml" { file } else { name });
        let loaded = load_beside(&model_file("boxed.toml"), &files).unwrap();
        let model = ModalModel::assemble(&loaded.train, None).unwrap();
        let interface = Interface::of(&loaded.config, &loaded.train, &model);
        (loaded.train, interface)
    };
    let ((known_train, known), (train, plain)) = (model("known_box.toml"), model("box.toml"));
    assert_eq!(known, plain);
    assert_eq!(known_train, train);
}

#[test]
fn what_is_wrong_with_a_known_bearing_names_place_and_rule() {
    let box_file = model_file("known_box.toml");
    let cases = [
        (
            "xx = 6e7, yy = 9e7",
            "xx = -6e7, yy = 9e7",
            "point \"pinion_left\", stiffness: xx: must be 0 or more and finite, found -60000000 N/m",
        ),
        (
            "xy = 60.0",
            "xy = nan",
            "point \"pinion_left\", damping: xy: must be a finite number, found NaN",
        ),
        (
            "{ xx = 600.0 }",
            "[600.0, 600.0]",
            "point \"pinion_right\": damping: must be a table",
        ),
        (
            "{ xx = 600.0 }",
            "{ xx = 600.0, zz = 1.0 }",
            "zz: unknown key",
        ),
        ("{ xx = 600.0 }", "{ xx = \"600 N/m\" }", "damping: xx: "),
        (
            "stiffness = { xx = \"70 N/um\" }\n",
            "",
            "stiffness: missing beside damping",
        ),
        (
            "observe = true",
            "observe = true\nstiffness = { xx = 1.0 }",
            "point \"sensor\": stiffness: no bearing stands on a point that is only looked at",
        ),
    ];
    for (from, to, message) in cases {
        assert!(box_file.contains(from), "{from}");
        let problems = load_beside(&box_file.replacen(from, to, 1), &beside).unwrap_err();
        let found: Vec<String> = problems.iter().map(ToString::to_string).collect();
        assert!(
            found.iter().any(|found| found.contains(message)),
            "{message}: {found:?}"
        );
        assert!(
            problems.iter().all(|problem| problem.spot.is_some()),
            "{problems:?}"
        );
    }
    let in_a_train =
        model_file("reducer.toml").replace("[simulation]", "[simulation]\nknown_bearings = true");
    let problems = load_beside(&in_a_train, &beside).unwrap_err();
    let unknown = "known_bearings: unknown key";
    assert!(problems[0].message.contains(unknown), "{problems:?}");
}

#[test]
fn a_housing_may_wait_for_its_bearings_but_says_so() {
    let text =
        model_file("box.toml").replace("[simulation]", "[simulation]\nknown_bearings = true");
    let warnings = load_beside(&text, &beside).unwrap().warnings;
    let message = "known_bearings: no [[point]] has the stiffness of a bearing; cargo xtask couple";
    assert!(
        warnings[0].message.contains(message) && warnings[0].spot.is_some(),
        "{warnings:?}"
    );
}
