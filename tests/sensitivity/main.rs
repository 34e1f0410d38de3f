//! Every key of the model file does something, does the right thing, and is in the documentation.
//!
//! Authority: `docs/model-file.md`. `rows.rs` says of every key how to change it, which variables then change and which stay.
//! The reader itself says which keys it knows: a key without a row fails the test.

#[path = "../support/mod.rs"]
mod support;

mod rows;

use std::collections::{BTreeMap, BTreeSet};

use geartrain::config::Config;
use geartrain::interface::{Interface, Quantity};
use geartrain::simulation::Simulation;
use geartrain::train::load;
use rows::{ROWS, Row, TABLES};
use support::{assembled, file_inputs, valid};

const EVERYTHING: &str = include_str!("everything.toml");

/// What a model file leads to: the configuration, and every variable at the start and after 2 ms.
struct Outcome {
    config: Config,
    values: BTreeMap<String, [f64; 2]>,
}

fn outcome(text: &str) -> Outcome {
    let loaded = valid(text);
    let model = assembled(text);
    let interface = Interface::of(&loaded.config, &loaded.train, &model);
    let settings = &loaded.config.simulation;
    let mut simulation = Simulation::start(model, file_inputs(text), settings, 0.0).unwrap();
    let mut values = BTreeMap::new();
    for (index, time) in [0.0, 2e-3].into_iter().enumerate() {
        simulation.advance_to(time).unwrap();
        for variable in &interface.variables {
            let value = variable.start.unwrap_or_else(|| match variable.quantity {
                Quantity::DerivedSpeed { .. } => 0.0,
                quantity => quantity.evaluate(&simulation.motion()),
            });
            values.entry(variable.name.clone()).or_insert([0.0; 2])[index] = value;
        }
    }
    Outcome {
        config: loaded.config,
        values,
    }
}

/// The text with some replacements, each of which has to find something.
fn edited(text: &str, edits: &[(&str, &str)]) -> String {
    let mut text = text.to_string();
    for (from, to) in edits {
        assert!(text.contains(from), "nothing to replace: {from}");
        text = text.replacen(from, to, 1);
    }
    text
}

/// Whether a variable is one of those that a pattern means: all whose name contains it.
fn matching<'a>(
    values: &'a BTreeMap<String, [f64; 2]>,
    pattern: &'a str,
) -> impl Iterator<Item = (&'a String, &'a [f64; 2])> {
    values
        .iter()
        .filter(move |(name, _)| name.contains(pattern))
}

fn check(row: &Row, before: &Outcome, after: &Outcome) -> Vec<String> {
    let mut wrong = Vec::new();
    let at = format!("[{}] {}", row.table, row.key);
    if before.config == after.config {
        wrong.push(format!("{at}: the configuration is the same"));
    }
    for pattern in row.changes {
        let changed = matching(&after.values, pattern).any(|(name, now)| {
            before.values.get(name).is_none_or(|was| {
                // Far above rounding, which other sums of a rebuilt model bring.
                (0..2).any(|i| (now[i] - was[i]).abs() > 1e-7 * was[i].abs().max(1e-12))
            })
        });
        if !changed {
            wrong.push(format!("{at}: nothing changes among *{pattern}*"));
        }
    }
    for pattern in row.keeps {
        for (name, was) in matching(&before.values, pattern) {
            if after.values.get(name).is_some_and(|now| now != was) {
                wrong.push(format!(
                    "{at}: {name} changes: {was:?} {:?}",
                    after.values[name]
                ));
            }
        }
    }
    wrong
}

#[test]
fn every_key_changes_what_it_should_and_nothing_else() {
    let mut bases: BTreeMap<String, Outcome> = BTreeMap::new();
    let mut wrong = Vec::new();
    for row in ROWS {
        let text = edited(EVERYTHING, row.base);
        let base = bases.entry(text.clone()).or_insert_with(|| outcome(&text));
        let after = outcome(&edited(&text, row.edits));
        wrong.extend(check(row, base, &after));
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// The keys that the reader knows in a table: what it answers to one that it does not.
fn known_keys(text: &str, after: &str) -> BTreeSet<String> {
    let inserted = if after.ends_with('{') {
        format!("{after} no_such_key = 1, ")
    } else {
        format!("{after}\nno_such_key = 1")
    };
    let text = edited(text, &[(after, &inserted)]);
    let problems = load(&text).expect_err("an unknown key is an error");
    let message = problems
        .iter()
        .find_map(|problem| problem.message.split_once("known here: "))
        .unwrap_or_else(|| panic!("no list of keys after {after}: {problems:?}"));
    message.1.split(", ").map(str::to_string).collect()
}

#[test]
fn every_key_that_the_reader_knows_has_a_row_and_is_documented() {
    let documentation = include_str!("../../docs/model-file.md");
    let mut wrong = Vec::new();
    for (table, base, header) in TABLES {
        for key in known_keys(&edited(EVERYTHING, base), header) {
            let has_row = ROWS.iter().any(|row| row.table == *table && row.key == key);
            if !has_row && !rows::ELSEWHERE.contains(&(*table, key.as_str())) {
                wrong.push(format!("[{table}] {key}: no row says what it changes"));
            }
            if !documentation.contains(&key) {
                wrong.push(format!("[{table}] {key}: not in docs/model-file.md"));
            }
        }
    }
    for row in ROWS {
        if !TABLES.iter().any(|(table, _, _)| *table == row.table) {
            wrong.push(format!("[{}]: no such table", row.table));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}
