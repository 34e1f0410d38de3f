//! What users get wrong about meshes and trains: one message each, with place, rule and value.

mod support;

use geartrain::train::load;
use support::{gear_pair, valid};

/// The messages about a gear pair with this stiffness law.
fn about_law(law: &str) -> Vec<String> {
    about(&gear_pair(3, law, ""))
}

fn about(text: &str) -> Vec<String> {
    let problems = load(text).map(|_| ()).expect_err("the file is not valid");
    assert!(
        problems.iter().all(|problem| problem.line.is_some()),
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
            ["cosine", "list of numbers", "the string \"a\""],
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
