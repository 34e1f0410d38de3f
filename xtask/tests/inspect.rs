//! `cargo xtask inspect` as somebody else's program uses it.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use geartrain::model::ModalModel;
use geartrain::train::load;
use serde_json::Value;

fn example() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../examples/three_stage.toml")
}

fn inspect(words: &[&str]) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_xtask"));
    command.arg("inspect").arg(example()).args(words);
    command.output().expect("xtask runs")
}

fn json(words: &[&str]) -> Value {
    let output = inspect(&[&["--format", "json"], words].concat());
    assert!(output.status.success(), "{output:?}");
    serde_json::from_slice(&output.stdout).expect("valid JSON")
}

fn list(value: &Value) -> &[Value] {
    value.as_array().expect("a list")
}

#[test]
fn json_has_the_promised_names_and_the_numbers_of_the_library_to_the_bit() {
    let report = json(&[]);
    let text = std::fs::read_to_string(example()).unwrap();
    let loaded = load(&text).unwrap();
    let model = ModalModel::assemble(&loaded.train, None).unwrap();
    for (index, rotor) in list(&report["rotors"]).iter().enumerate() {
        assert_eq!(rotor["name"], loaded.train.rotors[index].name);
        let lateral = list(&rotor["lateral_frequencies"])
            .iter()
            .map(Value::as_f64);
        let expected = &model.rotors[index].lateral_frequencies;
        assert!(lateral.eq(expected.iter().copied().map(Some)));
        let torsional = &rotor["torsional_frequencies"];
        assert_eq!(list(torsional).len(), 2, "elastic ones only");
        let shapes = &rotor["mode_shapes"];
        let stations = list(&shapes["positions"]).len();
        for (kind, frequencies) in [("lateral", 3), ("torsional", 2)] {
            let shapes = list(&shapes[kind]);
            assert_eq!(shapes.len(), frequencies);
            assert!(shapes.iter().all(|shape| list(shape).len() == stations));
        }
        let gear = loaded.train.rotors[index].gears[0].body.position;
        assert_eq!(rotor["gears"][0]["position"], gear);
    }
    for (index, mesh) in list(&report["meshes"]).iter().enumerate() {
        assert_eq!(mesh["name"], loaded.train.meshes[index].name);
        assert_eq!(mesh["frequency"], 1800.0);
        assert_eq!(mesh["mean_stiffness"], model.meshes[index].mean_stiffness());
    }
    let coupled = list(&report["coupled"]);
    let own = model.natural_vibrations().unwrap();
    // The common rotation against the load slopes does not oscillate.
    let oscillating = own.iter().filter(|one| one.damped_frequency > 0.05);
    let own: Vec<f64> = oscillating.map(|one| one.frequency).collect();
    assert_eq!(coupled.len(), own.len());
    for (one, hertz) in coupled.iter().zip(own) {
        let found = one["frequency_hz"].as_f64().unwrap();
        // 1e-9: eigenvalues with and without their vectors.
        assert!((found / hertz - 1.0).abs() < 1e-9);
        assert!(one["damping_ratio"].as_f64().unwrap() > 0.0);
        assert!(one["damped_frequency_hz"].as_f64().unwrap() <= found);
        let kind = one["kind"].as_str().unwrap();
        assert!(["lateral", "torsional", "mesh"].contains(&kind));
        assert!(one["rotor"].is_string());
    }
    assert_eq!(report["basis"]["sufficient"], false);
    assert!(
        report["basis"]["recommended"]["max_frequency"]
            .as_f64()
            .unwrap()
            > 1800.0
    );
    assert!(!list(&report["critical_speeds"]).is_empty());
    assert_eq!(list(&report["campbell"]["points"]).len(), 13);
    assert_eq!(report["suggested_step"], 1e-5, "README.md says the same");
}

#[test]
fn speeds_of_the_table_can_be_chosen() {
    let report = json(&["--speeds", "0:6000:3:rpm"]);
    let points = list(&report["campbell"]["points"]);
    let speeds: Vec<f64> = points
        .iter()
        .filter_map(|point| point["speed"].as_f64())
        .collect();
    let unit = std::f64::consts::TAU / 60.0;
    for (speed, rpm) in speeds.iter().zip([0.0, 3000.0, 6000.0]) {
        assert!((speed - rpm * unit).abs() < 1e-9);
    }
    assert!(!inspect(&["--speeds", "5:1:3"]).status.success());
}

#[test]
fn people_are_told_that_three_modes_are_not_enough() {
    let output = inspect(&[]);
    assert!(output.status.success());
    let text = String::from_utf8(output.stdout).unwrap();
    for part in [
        "NOT LARGE ENOUGH",
        "1200 Hz",
        "max_frequency",
        "Table I",
        "Critical speeds",
        "1e-5 s",
    ] {
        assert!(text.contains(part), "{part} is missing in\n{text}");
    }
}
