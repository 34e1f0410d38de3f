//! The packed example, driven by the importer `fmi`, against the library used directly: to the bit.
//!
//! The packed library is a release build and the library linked here is not: both do the same arithmetic.

use fmi::fmi2::import::Fmi2Import;
use fmi::fmi2::instance::{CoSimulation, Common, InstanceCS};
use geartrain::model::{Inputs, ModalModel};
use geartrain::simulation::Simulation;
use geartrain::train::{Loaded, load};
use importers::{Fmu, STEP, assert_same_bits};

const STEPS: u32 = 500;
const MESHES: [&str; 2] = ["mesh12.force", "mesh13.force"];

/// A way to run the example: numbers of the model file and of the inputs that differ from it.
struct Case {
    /// Key in the model file, present value there, new value.
    file: &'static [(&'static str, &'static str, &'static str)],
    /// The same as parameters of the FMU.
    parameters: &'static [(&'static str, f64)],
    /// Driving torque [N m] from step 100 on.
    torque: f64,
    /// Displacement [m] of the gearbox at bearing b2 of stage 1 in y from step 200 on.
    displacement: f64,
}

const AS_PACKED: Case = Case {
    file: &[],
    parameters: &[],
    torque: 2250.0,
    displacement: 0.0,
};

/// Case 4 of the paper, with a mesh that is a little softer and inputs that change.
const CHANGED: Case = Case {
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
fn expected(case: &Case) -> Vec<f64> {
    let Loaded { config, train, .. } = load(&model_file(case)).expect("the example is valid");
    let model = ModalModel::assemble(&train, None).expect("the example has modes");
    let torques = train.rotors.iter().flat_map(|rotor| &rotor.torques);
    let torques = torques.map(|torque| torque.value).collect();
    let inputs = Inputs::at_rest(torques, model.bearings().count());
    let mut simulation = Simulation::start(model, inputs, &config.simulation, 0.0)
        .expect("the example has an equilibrium");
    let mut forces = Vec::new();
    for index in 0..STEPS {
        let inputs = simulation.inputs_mut();
        if index >= 100 {
            inputs.torques[0] = case.torque;
        }
        if index >= 200 {
            inputs.bases[1].displacement[1] = case.displacement;
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

/// An instance that runs a case step by step.
struct Run<'a> {
    case: &'a Case,
    fmu: &'a Fmu,
    instance: InstanceCS,
    forces: Vec<f64>,
}

impl<'a> Run<'a> {
    fn new(case: &'a Case, fmu: &'a Fmu, name: &str) -> Run<'a> {
        let import: &Fmi2Import = fmu.import();
        let instance = import
            .instantiate_cs(name, false, true)
            .expect("an instance");
        let forces = Vec::new();
        Run {
            case,
            fmu,
            instance,
            forces,
        }
    }

    fn set(&mut self, variable: &str, value: f64) {
        self.instance
            .set_real(&[self.fmu.reference(variable)], &[value])
            .expect("fmi2OK");
    }

    fn initialize(&mut self) {
        self.instance
            .setup_experiment(None, 0.0, None)
            .expect("fmi2OK");
        for (name, value) in self.case.parameters {
            self.set(name, *value);
        }
        self.instance.enter_initialization_mode().expect("fmi2OK");
        self.instance.exit_initialization_mode().expect("fmi2OK");
    }

    fn step(&mut self, index: u32) {
        if index == 100 {
            self.set("stage1.drive.torque", self.case.torque);
        }
        if index == 200 {
            self.set("stage1.b2.housing.y", self.case.displacement);
        }
        let time = f64::from(index) * STEP;
        self.instance.do_step(time, STEP, true).expect("fmi2OK");
        let mut forces = [0.0; MESHES.len()];
        let references = MESHES.map(|mesh| self.fmu.reference(mesh));
        self.instance
            .get_real(&references, &mut forces)
            .expect("fmi2OK");
        self.forces.extend(forces);
    }

    /// Mesh forces of a whole run.
    fn complete(&mut self) -> Vec<f64> {
        self.forces.clear();
        self.initialize();
        (0..STEPS).for_each(|index| self.step(index));
        self.forces.clone()
    }
}

#[track_caller]
fn same_forces(found: &[f64], expected: &[f64]) {
    assert_same_bits(found, expected, MESHES.len());
}

#[test]
fn the_fmu_computes_the_bits_of_the_library() {
    let fmu = Fmu::unpack("three_stage");
    for case in [AS_PACKED, CHANGED] {
        same_forces(&Run::new(&case, &fmu, "one").complete(), &expected(&case));
    }
}

#[test]
fn two_instances_side_by_side_do_not_see_each_other() {
    let fmu = Fmu::unpack("three_stage");
    let mut one = Run::new(&AS_PACKED, &fmu, "same name");
    let mut two = Run::new(&CHANGED, &fmu, "same name");
    one.initialize();
    two.initialize();
    for index in 0..STEPS {
        one.step(index);
        two.step(index);
    }
    same_forces(&one.forces, &expected(&AS_PACKED));
    same_forces(&two.forces, &expected(&CHANGED));
}

#[test]
fn a_reset_instance_runs_as_if_new() {
    let fmu = Fmu::unpack("three_stage");
    let mut run = Run::new(&CHANGED, &fmu, "one");
    let first = run.complete();
    run.instance.terminate().expect("fmi2OK");
    run.instance.reset().expect("fmi2OK");
    same_forces(&run.complete(), &first);
    run.instance.reset().expect("fmi2OK");
    run.case = &AS_PACKED;
    // Parameters and inputs are forgotten.
    same_forces(&run.complete(), &expected(&AS_PACKED));
}
