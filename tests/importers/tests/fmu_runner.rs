//! The packed example, driven by the importer `fmu-runner`: alone, two at once, saved and restored.

mod direct;

use std::path::PathBuf;

use direct::{AS_PACKED, CHANGED, Case, MESHES, STEP, STEPS, expected};
use fmu_runner::{Fmu, FmuInstance, FmuLibrary, fmi2Type};

fn library(name: &str) -> FmuLibrary {
    let folder = std::env::var_os("GEARTRAIN_FMUS").expect("run with `cargo xtask test`");
    let path = PathBuf::from(folder).join(format!("{name}.fmu"));
    let fmu = Fmu::unpack(path).expect("an FMU");
    fmu.load(fmi2Type::fmi2CoSimulation).expect("a library")
}

type Instance<'l> = FmuInstance<&'l FmuLibrary>;

fn set(instance: &Instance<'_>, name: &str, value: f64) {
    let values = [(&instance.lib.variables()[name], value)].into();
    instance.set_reals(&values).expect("fmi2OK");
}

fn get(instance: &Instance<'_>, name: &str) -> f64 {
    let variable = &instance.lib.variables()[name];
    instance.get_reals(&[variable]).expect("fmi2OK")[variable]
}

/// An instance in step mode, with the parameters of a case.
fn running<'l>(library: &'l FmuLibrary, case: &Case) -> Instance<'l> {
    let instance = FmuInstance::instantiate(library, false).expect("an instance");
    instance.setup_experiment(0.0, None, None).expect("fmi2OK");
    for (name, value) in case.parameters {
        set(&instance, name, *value);
    }
    instance.enter_initialization_mode().expect("fmi2OK");
    instance.exit_initialization_mode().expect("fmi2OK");
    instance
}

/// One communication step of a case; the mesh forces at its end.
fn step(instance: &Instance<'_>, case: &Case, index: u32) -> [u64; 2] {
    if index == 100 {
        set(instance, "stage1.drive.torque", case.torque);
    }
    if index == 200 {
        set(instance, "stage1.b2.housing.y", case.displacement);
    }
    instance
        .do_step(f64::from(index) * STEP, STEP, true)
        .expect("fmi2OK");
    MESHES.map(|mesh| get(instance, mesh).to_bits())
}

fn expected_bits(case: &Case) -> Vec<u64> {
    expected(case).iter().map(|force| force.to_bits()).collect()
}

#[test]
fn fmu_runner_finds_the_bits_of_the_library() {
    let library = library("three_stage");
    for case in [AS_PACKED, CHANGED] {
        let instance = running(&library, &case);
        let found: Vec<u64> = (0..STEPS)
            .flat_map(|index| step(&instance, &case, index))
            .collect();
        assert!(found == expected_bits(&case));
        // Freed without fmi2Terminate: fmu-runner never calls it.
    }
}

#[test]
fn two_instances_of_one_library_do_not_see_each_other() {
    let library = library("three_stage");
    let (one, two) = (running(&library, &AS_PACKED), running(&library, &CHANGED));
    let mut found = [vec![], vec![]];
    for index in 0..STEPS {
        found[0].extend(step(&one, &AS_PACKED, index));
        found[1].extend(step(&two, &CHANGED, index));
    }
    assert!(found[0] == expected_bits(&AS_PACKED));
    assert!(found[1] == expected_bits(&CHANGED));
}

#[test]
fn a_state_taken_as_bytes_from_one_instance_goes_on_in_another() {
    let library = library("three_stage");
    let (one, other) = (running(&library, &CHANGED), running(&library, &AS_PACKED));
    for index in 0..150 {
        step(&one, &CHANGED, index);
    }
    let states = one.get_set_state_capability().expect("declared");
    let bytes = one
        .serialize_state_capability()
        .expect("declared")
        .serialize_state(&states.get_state().expect("fmi2OK"))
        .expect("fmi2OK");
    let copy = other
        .serialize_state_capability()
        .expect("declared")
        .deserialize_state(&bytes)
        .expect("fmi2OK");
    let restoring = other.get_set_state_capability().expect("declared");
    restoring.set_state(copy).expect("fmi2OK");
    for index in 150..300 {
        let (here, there) = (step(&one, &CHANGED, index), step(&other, &CHANGED, index));
        assert_eq!(here, there, "step {index}");
    }
}

/// Mesh force of the follower behind the reducer after 10 ms; without the coupling each of them is alone.
fn follower_force(coupled: bool) -> f64 {
    let (reducer, follower) = (library("reducer"), library("follower"));
    let (first, second) = (
        running(&reducer, &AS_PACKED),
        running(&follower, &AS_PACKED),
    );
    for index in 0..1000 {
        if coupled {
            let forward = get(&first, "wheel_shaft.wheel.mesh_torque");
            let backward = get(&second, "input.pinion.mesh_torque");
            let motion = get(&first, "wheel_shaft.right.x");
            set(&second, "input.coupling.torque", forward);
            set(&second, "input.pilot.housing.x", motion);
            set(&first, "wheel_shaft.load.torque", backward);
        }
        for instance in [&first, &second] {
            let time = f64::from(index) * 1e-5;
            instance.do_step(time, 1e-5, true).expect("fmi2OK");
        }
    }
    get(&second, "mesh.force")
}

#[test]
fn two_trains_on_one_shaft_feel_each_other() {
    let (together, alone) = (follower_force(true), follower_force(false));
    assert!((together / alone - 1.0).abs() > 1e-2, "{together} {alone}");
    let again = follower_force(true);
    assert_eq!(again.to_bits(), together.to_bits());
}
