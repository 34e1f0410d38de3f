//! What several test files share: small models as text, and running them.

#![allow(dead_code, missing_docs)] // each test file uses its own part
#![allow(clippy::disallowed_methods)] // tests compare with tolerances: the platform's sin will do

pub mod orbits;
pub mod parts;
pub mod run;
pub mod slave;

use geartrain::config::{self, Start};
use geartrain::model::{Inputs, ModalModel};
use geartrain::simulation::Simulation;
use geartrain::train::{Loaded, load_beside};
use nalgebra::{Complex, DMatrix, DVector};

/// The paper's example.
pub fn three_stage() -> String {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/examples/three_stage.toml");
    std::fs::read_to_string(path).expect("the example is part of the repository")
}

/// A two-step train that rings long after a start from rest: two of its shafts have no damping.
pub fn compound() -> String {
    model_file("compound.toml")
}

/// A sun, two planets on a fixed carrier and the ring around them.
pub fn star() -> String {
    model_file("star.toml")
}

/// A file of tests/models.
pub fn model_file(name: &str) -> String {
    beside(name).expect("the model is part of the repository")
}

/// What a model file of the tests may name.
pub fn beside(name: &str) -> Result<String, String> {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/models");
    std::fs::read_to_string(format!("{folder}/{name}")).map_err(|error| error.to_string())
}

/// The example with gearbox vibration and large imbalance: case 4 of the paper.
pub fn case_four() -> String {
    three_stage()
        .replace("moment = 5.0e-6", "moment = 1.5e-4")
        .replace("amplitude_x = 0.0", "amplitude_x = 25e-6")
        .replace("amplitude_y = 0.0", "amplitude_y = 25e-6")
}

/// Lines that start every small model: name, basis, and a shaft material.
pub fn head(lateral_modes: usize, torsional_modes: usize) -> String {
    format!(
        "kind = \"gear_train\"\nname = \"small\"\n\
         [basis]\nlateral_modes = {lateral_modes}\ntorsional_modes = {torsional_modes}\n\
         [material.default]\nyoungs_modulus = 2.1e11\npoisson_ratio = 0.3\ndensity = 7800.0\n"
    )
}

/// Two rotors on stiff bearings with one mesh; `law` is the body of `[mesh.stiffness]`, `extra` goes into
/// `[[mesh]]`.
pub fn gear_pair(modes: usize, law: &str, extra: &str) -> String {
    let rotor = |name: &str, speed: f64, torque: f64, slope: f64| {
        format!(
            "[[rotor]]\nname = \"{name}\"\nspeed = {speed}\nmax_element_length = 0.05\n\
             lateral_damping_ratio = 0.01\ntorsional_damping_ratio = 0.01\n\
             [[rotor.segment]]\nlength = 0.4\nouter_diameter = 0.05\n\
             [[rotor.gear]]\nname = \"gear\"\nposition = 0.25\nteeth = 24\nbase_radius = 0.07\n\
             mass = 5.0\npolar_inertia = 0.015\ndiametral_inertia = 0.008\n\
             [[rotor.bearing]]\nname = \"left\"\nposition = 0.05\n\
             stiffness = {{ xx = 8e7, yy = 6e7 }}\ndamping = {{ xx = 900.0 }}\n\
             [[rotor.bearing]]\nname = \"right\"\nposition = 0.35\n\
             stiffness = {{ xx = 9e7, yy = 7e7 }}\ndamping = {{ xx = 700.0 }}\n\
             [[rotor.unbalance]]\nname = \"unbalance\"\nposition = 0.25\nmoment = 2e-4\nphase = 0.4\n\
             [[rotor.torque]]\nname = \"port\"\nposition = 0.0\nvalue = {torque}\nslope = {slope}\n"
        )
    };
    format!(
        "{}{}{}[[mesh]]\nname = \"mesh\"\ngears = [\"one.gear\", \"two.gear\"]\ncenter_angle = 0.3\n\
         pressure_angle = 0.35\nflank = 1\n{extra}\n[mesh.stiffness]\n{law}\n",
        head(modes, modes),
        rotor("one", 150.0, 400.0, 0.0),
        rotor("two", -150.0, 400.0, 2.0)
    )
}

/// Loads a model that must be valid.
pub fn valid(text: &str) -> Loaded {
    load_beside(text, &beside).unwrap_or_else(|problems| panic!("{problems:#?}"))
}

pub fn assembled(text: &str) -> ModalModel {
    ModalModel::assemble(&valid(text).train, None).expect("the model has modes")
}

/// The inputs of the file: its torques, no gearbox motion.
pub fn file_inputs(text: &str) -> Inputs {
    let loaded = valid(text);
    let torques = loaded.train.rotors.iter().flat_map(|rotor| &rotor.torques);
    let torques: Vec<f64> = torques.map(|torque| torque.value).collect();
    assembled(text).inputs_at_rest(&torques)
}

/// A simulation as the file describes it, with another tolerance.
pub fn started(text: &str, tolerance: f64) -> Simulation {
    let mut settings = valid(text).config.simulation;
    settings.tolerance = tolerance;
    Simulation::start(assembled(text), file_inputs(text), &settings, 0.0)
        .expect("the model has an equilibrium")
}

/// A model that moves from these inputs, by the default solver.
pub fn set_going(model: ModalModel, inputs: Inputs, start: Start, tolerance: f64) -> Simulation {
    let settings = config::Simulation {
        start,
        tolerance,
        ..valid(&three_stage()).config.simulation
    };
    Simulation::start(model, inputs, &settings, 0.0).expect("the model has an equilibrium")
}

/// Root mean square of a series.
pub fn rms(values: &[f64]) -> f64 {
    (values.iter().map(|value| value * value).sum::<f64>() / values.len() as f64).sqrt()
}

/// RMS of the difference of two series.
pub fn rms_difference(one: &[f64], two: &[f64]) -> f64 {
    rms(&one
        .iter()
        .zip(two)
        .map(|(a, b)| a - b)
        .collect::<Vec<f64>>())
}

/// The steady amplitude of q under a load c cos(w t) + s sin(w t): (K + i w D - w^2) q = c - i s.
pub fn steady_amplitude(
    model: &ModalModel,
    frequency: f64,
    cosine: &[f64],
    sine: &[f64],
) -> DVector<Complex<f64>> {
    let (stiffness, damping) = model.mean_matrices();
    let n = stiffness.nrows();
    let matrix = DMatrix::from_fn(n, n, |i, j| {
        let inertia = if i == j { frequency * frequency } else { 0.0 };
        Complex::new(stiffness[(i, j)] - inertia, frequency * damping[(i, j)])
    });
    let load = DVector::from_fn(n, |i, _| Complex::new(cosine[i], -sine[i]));
    matrix
        .lu()
        .solve(&load)
        .expect("a damped system answers at every frequency")
}

/// Value at `time` of the vibration with complex amplitude `amplitude` along a dense row.
pub fn harmonic_value(
    row: &[f64],
    amplitude: &DVector<Complex<f64>>,
    frequency: f64,
    time: f64,
) -> f64 {
    let along: Complex<f64> = row.iter().zip(amplitude.iter()).map(|(&w, &q)| q * w).sum();
    along.re * (frequency * time).cos() - along.im * (frequency * time).sin()
}
