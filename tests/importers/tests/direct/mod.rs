//! The library used directly, without any FMU: what every importer has to find, to the bit.
//!
//! The packed library is a release build and the library linked here is not: both do the same arithmetic.

use geartrain::model::ModalModel;
use geartrain::simulation::Simulation;
use geartrain::train::{Loaded, load};

/// Communication step [s]: that of the example's DefaultExperiment.
pub const STEP: f64 = 2e-5;
/// Communication steps of a run.
pub const STEPS: u32 = 500;
/// What is compared.
pub const MESHES: [&str; 2] = ["mesh12.force", "mesh13.force"];

/// A way to run the example: numbers of the model file and of the inputs that differ from it.
pub struct Case {
    /// Key in the model file, present value there, new value.
    pub file: &'static [(&'static str, &'static str, &'static str)],
    /// The same as parameters of the FMU.
    pub parameters: &'static [(&'static str, f64)],
    /// Driving torque [N m] from step 100 on.
    pub torque: f64,
    /// Displacement [m] of the gearbox at bearing b2 of stage 1 in y from step 200 on.
    pub displacement: f64,
}

/// The example as it is.
pub const AS_PACKED: Case = Case {
    file: &[],
    parameters: &[],
    torque: 2250.0,
    displacement: 0.0,
};

/// Case 4 of the paper, with a mesh that is a little softer and inputs that change.
pub const CHANGED: Case = Case {
    file: &[
        ("amplitude_x", "0.0", "25e-6"),
        ("amplitude_y", "0.0", "25e-6"),
        ("moment", "5.0e-6", "1.5e-4"),
        ("xx", "2.0e+07", "2.5e7"),
        ("torsional_damping_ratio", "0.01", "0.02"),
    ],
    parameters: &[
        ("gearbox_vibration.amplitude_x", 25e-6),
        ("gearbox_vibration.amplitude_y", 25e-6),
        ("stage1.gear_unbalance.moment", 1.5e-4),
        ("stage2.gear_unbalance.moment", 1.5e-4),
        ("stage3.gear_unbalance.moment", 1.5e-4),
        ("stage1.b3.stiffness.xx", 2.5e7),
        ("stage2.b3.stiffness.xx", 2.5e7),
        ("stage1.torsional_damping_ratio", 0.02),
        ("stage2.torsional_damping_ratio", 0.02),
        ("stage3.torsional_damping_ratio", 0.02),
    ],
    torque: 1800.0,
    displacement: 1e-5,
};

/// Mesh forces at every communication point, computed without any FMU.
pub fn expected(case: &Case) -> Vec<f64> {
    let Loaded { config, train, .. } = load(&model_file(case)).expect("the example is valid");
    let model = ModalModel::assemble(&train, None).expect("the example has modes");
    let torques = train.rotors.iter().flat_map(|rotor| &rotor.torques);
    let torques: Vec<f64> = torques.map(|torque| torque.value).collect();
    let inputs = model.inputs_at_rest(&torques);
    let mut simulation = Simulation::start(model, inputs, &config.simulation, 0.0)
        .expect("the example has an equilibrium");
    let mut forces = Vec::new();
    for index in 0..STEPS {
        let inputs = simulation.inputs_mut();
        if index >= 100 {
            inputs.torques_mut()[0] = case.torque;
        }
        if index >= 200 {
            inputs.bases_mut()[1][1] = case.displacement;
        }
        simulation
            .advance_to(f64::from(index) * STEP + STEP)
            .expect("the step succeeds");
        forces.extend((0..MESHES.len()).map(|mesh| simulation.motion().mesh_force(mesh)));
    }
    forces
}

fn model_file(case: &Case) -> String {
    let path = concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/../../examples/three_stage.toml"
    );
    let mut text = std::fs::read_to_string(path).expect("the example is part of the repository");
    for (key, old, new) in case.file {
        let (old, new) = (format!("{key} = {old}"), format!("{key} = {new}"));
        assert!(text.contains(&old), "{old} is not in the example");
        text = text.replace(&old, &new);
    }
    text
}
