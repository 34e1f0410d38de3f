//! The packed example, driven by the importer `fmi-rs`: by its functions and by its own simulation loop.

mod direct;

use std::path::{Path, PathBuf};
use std::sync::Arc;

use direct::{AS_PACKED, CHANGED, Case, MESHES, STEP, STEPS, expected};
use fmi_rs::fmi2::builder::FMU2Builder;
use fmi_rs::fmi2::types::fmi2Status;
use fmi_rs::fmi2::{CS, FMU2};
use fmi_rs::model_description::fmi2::ModelDescription;
use fmi_rs::sim::fmi2::cs::simulate;
use fmi_rs::sim::fmi2::recorder::Recorder;
use fmi_rs::sim::fmi2::{SimulationSettings, Trajectories, VariableValue};

fn unpacked(name: &str) -> FMU2Builder {
    let folder = std::env::var_os("GEARTRAIN_FMUS").expect("run with `cargo xtask test`");
    let path = PathBuf::from(folder).join(format!("{name}.fmu"));
    FMU2Builder::new(&path).expect("an FMU")
}

fn reference(fmu: &FMU2Builder, name: &str) -> u32 {
    let variables = &fmu.model_description.modelVariables;
    let found = variables.iter().find(|variable| variable.name == name);
    found.expect(name).valueReference
}

#[track_caller]
fn accepted(status: fmi2Status) {
    assert_eq!(status, fmi2Status::Ok);
}

/// A whole run of a case; the bits of the mesh forces.
fn run(builder: &FMU2Builder, fmu: &FMU2<CS>, case: &Case) -> Vec<u64> {
    for (name, value) in case.parameters {
        accepted(fmu.setReal(&[reference(builder, name)], &[*value]));
    }
    accepted(fmu.setupExperiment(None, 0.0, None));
    accepted(fmu.enterInitializationMode());
    accepted(fmu.exitInitializationMode());
    let torque = [reference(builder, "stage1.drive.torque")];
    let motion = [reference(builder, "stage1.b2.housing.y")];
    let meshes = MESHES.map(|mesh| reference(builder, mesh));
    let mut found = Vec::new();
    for index in 0..STEPS {
        if index == 100 {
            accepted(fmu.setReal(&torque, &[case.torque]));
        }
        if index == 200 {
            accepted(fmu.setReal(&motion, &[case.displacement]));
        }
        accepted(fmu.doStep(f64::from(index) * STEP, STEP, 0));
        let mut forces = [0.0; 2];
        accepted(fmu.getReal(&meshes, &mut forces));
        found.extend(forces.map(f64::to_bits));
    }
    accepted(fmu.terminate());
    found
}

fn expected_bits(case: &Case) -> Vec<u64> {
    expected(case).iter().map(|force| force.to_bits()).collect()
}

#[test]
fn fmi_rs_finds_the_bits_of_the_library_also_after_a_reset() {
    let builder = unpacked("three_stage");
    let fmu = builder.instantiate_cs("one").expect("an instance");
    assert!(run(&builder, &fmu, &CHANGED) == expected_bits(&CHANGED));
    accepted(fmu.reset());
    assert!(run(&builder, &fmu, &AS_PACKED) == expected_bits(&AS_PACKED));
}

/// Communication step of fmi-rs's own loop [s]: a power of two, because it wants to divide durations by it without a rest.
const INTERVAL: f64 = 1.0 / 65536.0;

/// What fmi-rs's own loop is asked to do.
fn settings(builder: &FMU2Builder, from: f64, to: f64, log: &Path) -> SimulationSettings {
    let file = builder.unzipdir.path().join("modelDescription.xml");
    let description = ModelDescription::from_path(&file);
    SimulationSettings {
        unzipdir: builder.unzipdir.path().to_path_buf(),
        model_description: Arc::new(description.expect("modelDescription.xml")),
        start_time: from,
        stop_time: to,
        logging_on: true,
        set_stop_time: true,
        output_interval: INTERVAL,
        log_time_scale: false,
        tolerance: 1e-9,
        set_tolerance: false,
        start_values: vec![],
        log_fmi_calls: false,
        input_file: None,
        early_return_allowed: false,
        event_mode_used: false,
        log_file: Some(log.to_path_buf()),
        initial_fmu_state_file: None,
        final_fmu_state_file: None,
    }
}

/// Every variable at the end, by fmi-rs's own loop; nothing but events may be told.
fn last_row(settings: &SimulationSettings) -> Vec<f64> {
    let description = Arc::clone(&settings.model_description);
    let all = (0..description.modelVariables.len()).collect();
    #[expect(clippy::arc_with_non_send_sync, reason = "fmi-rs asks for an Arc")]
    let recorder = Arc::new(Recorder::new(Trajectories::new(description, all)));
    simulate(settings, None, Arc::clone(&recorder)).expect("a run");
    let log = settings.log_file.as_ref().expect("a log");
    let told = std::fs::read_to_string(log).expect("a log");
    assert!(
        told.contains("[logEvents]") && !told.contains("ERROR"),
        "{told}"
    );
    let trajectories = recorder.trajectories.borrow();
    let last = trajectories.rows.last().expect("a row");
    last.iter().filter_map(VariableValue::to_f64).collect()
}

#[test]
fn the_simulation_loop_of_fmi_rs_stops_and_goes_on_from_a_file() {
    let builder = unpacked("three_stage");
    let folder = builder.unzipdir.path();
    let (log, state) = (folder.join("log"), folder.join("state"));
    let (middle, end) = (300.0 * INTERVAL, 600.0 * INTERVAL);
    let straight = last_row(&settings(&builder, 0.0, end, &log));
    let mut first = settings(&builder, 0.0, middle, &log);
    first.set_stop_time = false;
    first.final_fmu_state_file = Some(state.clone());
    last_row(&first);
    let mut second = settings(&builder, middle, end, &log);
    second.initial_fmu_state_file = Some(state);
    let resumed = last_row(&second);
    assert!(straight.len() > 100);
    let bits = |row: &[f64]| row.iter().map(|value| value.to_bits()).collect::<Vec<_>>();
    assert!(bits(&straight) == bits(&resumed));
}
