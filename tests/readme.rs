//! What the README shows works.

mod support;

use support::{assembled, started, valid};

#[test]
fn the_readmes_model_is_valid_and_runs() {
    let readme =
        std::fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/README.md")).unwrap();
    let model = readme
        .split("```toml\n")
        .nth(1)
        .and_then(|rest| rest.split("```").next())
        .unwrap();
    assert!(valid(model).warnings.is_empty());
    assert!(
        assembled(model)
            .rotors
            .iter()
            .all(|rotor| rotor.counts.lateral >= 4)
    );
    started(model, 1e-3).advance_to(0.01).unwrap();
}
