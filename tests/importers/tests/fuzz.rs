//! Random calls, states and model files: always the same ones, a few seconds of each (`importers::fuzz`).

use std::sync::Arc;

use importers::{Fmu, fuzz};

fn bounded(name: &str, cases: u64) {
    let test = fuzz::TESTS.into_iter().find(|test| test.0 == name);
    let test = test.expect("a test of this name");
    for model in ["three_stage", "rattle", "run_up", "known_box"] {
        let fmu = Arc::new(Fmu::unpack(model));
        let failures: Vec<String> = (0..cases)
            .filter_map(|seed| fuzz::run(test, &fmu, seed).err())
            .take(3)
            .collect();
        assert!(failures.is_empty(), "{model}: {}", failures.join("\n"));
    }
}

#[test]
fn random_calls() {
    bounded("calls", 30);
}

#[test]
fn hostile_states() {
    bounded("states", 40);
}

#[test]
fn random_model_files() {
    bounded("files", 100);
}
