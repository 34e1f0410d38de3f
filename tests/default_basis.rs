//! Trains on modes and static shapes: what the outside sees of them, and how far they carry.
//!
//! Authority: the same train with every mode of its finite elements.

mod support;

use std::f64::consts::TAU;

use geartrain::interface::{Interface, Variable};
use geartrain::model::ModalModel;
use nalgebra::{Complex, Normed};
use support::{assembled, gear_pair, started, steady_amplitude, valid};

#[test]
fn a_train_without_a_basis_lists_its_modes_and_runs_with_static_shapes() {
    let text = gear_pair(1, "law = \"constant\"\nmean = 4e8", "")
        .replace("[basis]\nlateral_modes = 1\ntorsional_modes = 1\n", "");
    let loaded = valid(&text);
    let model = ModalModel::assemble(&loaded.train, None).unwrap();
    let counts = model.rotors[0].counts;
    assert_eq!(
        (
            counts.lateral - counts.lateral_modes,
            counts.torsional - counts.torsional_modes
        ),
        (3, 2),
        "two bearings and a gear, a gear and a torque"
    );
    let interface = Interface::of(&loaded.config, &loaded.train, &model);
    let count = |prefix: &str| {
        let named = |variable: &&Variable| variable.name.starts_with(prefix);
        interface.variables.iter().filter(named).count()
    };
    assert_eq!(count("one.lateral_frequency["), counts.lateral_modes);
    assert_eq!(count("one.modal.x["), counts.lateral);
    // The rigid rotation has a name of its own and no frequency.
    assert_eq!(
        count("one.torsional_frequency["),
        counts.torsional_modes - 1
    );
    assert_eq!(count("one.modal.theta["), counts.torsional - 1);
    let described = |name: &str| {
        let variable = interface.variables.iter().find(|one| one.name == name);
        variable.unwrap().description.clone()
    };
    let first = counts.lateral_modes + 1;
    assert!(described(&format!("one.modal.y[{first}]")).contains("static shape 1"));

    started(&text, 1e-3).advance_to(0.002).unwrap();
}

#[test]
fn static_shapes_carry_the_response_below_the_highest_mode() {
    // Mesh deflection per torque at 300 Hz, modes kept to 1000 Hz: against all modes.
    let pair = |basis: &str| {
        let counts = "lateral_modes = 1\ntorsional_modes = 1\n";
        assembled(&gear_pair(1, "law = \"constant\"\nmean = 4e8", "").replace(counts, basis))
    };
    let response = |model: &ModalModel| {
        let load = model.rotors[0].torques[0].to_dense(model.system.size);
        let none = vec![0.0; model.system.size];
        let amplitude = steady_amplitude(model, 300.0 * TAU, &load, &none);
        let row = model.meshes[0].row.to_dense(model.system.size);
        let along = row.iter().zip(amplitude.iter());
        along.map(|(&w, &q)| q * w).sum::<Complex<f64>>()
    };
    let exact = response(&pair("lateral_modes = 18\ntorsional_modes = 9\n"));
    let error = |basis: &str| (response(&pair(basis)) - exact).norm() / exact.norm();
    let (with, without) = (
        error("max_frequency = 1e3\nstatic_shapes = true\n"),
        error("max_frequency = 1e3\n"),
    );
    // Measured 7e-7 and 2e-2: what is left grows with (300 Hz / frequency of the shapes)^2.
    assert!(with < 1e-5 && without > 1e-2, "{with:e}, {without:e}");
}
