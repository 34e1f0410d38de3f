//! The packed example, driven by the importer `fmi`, against the library used directly: to the bit.

mod direct;

use direct::{AS_PACKED, CHANGED, Case, MESHES, STEP, STEPS, expected};
use fmi::fmi2::import::Fmi2Import;
use fmi::fmi2::instance::{CoSimulation, Common, InstanceCS};
use importers::{Fmu, assert_same_bits};

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
