//! What the tolerance buys: the error of mesh and bearing forces over the tolerance, for every example and for the models of the tests.

use std::path::PathBuf;

use geartrain::config;
use geartrain::config::SolverChoice::{self, Exponential, Newmark};
use geartrain::interface::Interface;
use geartrain::train::{Loaded, load_beside};

use crate::forces::Forces;
use crate::models::{read, workspace};
use crate::problem::started;
use crate::table::Table;

/// The decades of tolerance, 1e-2 to 1e-8.
const TOLERANCES: [f64; 7] = [1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8];
/// Our converged solution, and the other solver's that it is compared with.
const CONVERGED: f64 = 1e-10;
const OTHER: f64 = 1e-7;
/// Communication steps: that of the file, and so many of them in one, where the tolerance alone decides on steps.
const STRIDES: [u32; 2] = [1, 37];

/// Measures and prints.
pub fn run() -> Result<(), String> {
    println!(
        "Error over tolerance, default solver: every model as its file says to its stop time, at its communication step and at\n\
         {} times that, where the tolerance alone decides on steps. Error: RMS of the difference from the solution at {CONVERGED:e} /\n\
         RMS of the alternating part, worst mesh and worst bearing. newmark: how far its solution at {OTHER:e} is from that.\n",
        STRIDES[1]
    );
    let mut headings = vec![
        "model".to_string(),
        "step, us".to_string(),
        "forces".to_string(),
        "newmark".to_string(),
    ];
    headings.extend(TOLERANCES.map(|tolerance| format!("{tolerance:.0e}")));
    let mut table = Table::new(&headings.iter().map(String::as_str).collect::<Vec<_>>());
    let (mut broken, mut notes) = (Vec::new(), Vec::new());
    for path in files()? {
        let text = read(&path);
        let name = path
            .file_stem()
            .unwrap_or_default()
            .to_string_lossy()
            .into_owned();
        for stride in STRIDES {
            let forces = |solver, tolerance| forces(&text, solver, tolerance, stride);
            let converged = forces(Exponential, CONVERGED)?;
            let step = format!("{:.0}", 1e6 * converged.step);
            let mut rows =
                ["mesh", "bearing"].map(|kind| vec![name.clone(), step.clone(), kind.to_string()]);
            let mut add = |found: &Result<Forces, String>| {
                let errors = match found {
                    Ok(found) => [
                        found.mesh_error(&converged),
                        found.bearing_error(&converged),
                    ],
                    Err(why) => {
                        notes.push(format!("{name}, {step} us: {why}"));
                        [f64::NAN; 2]
                    }
                };
                for (row, error) in rows.iter_mut().zip(errors) {
                    row.push(format!("{error:.1e}"));
                }
            };
            add(&forces(Newmark, OTHER));
            for tolerance in TOLERANCES {
                let found = forces(Exponential, tolerance);
                add(&found);
                let promised = found.map_or(f64::NAN, |found| found.promised_error(&converged));
                if promised > tolerance {
                    broken.push(format!(
                        "{name}, {step} us: {promised:.1e} at {tolerance:.0e}"
                    ));
                }
            }
            let has_meshes = !converged.meshes.is_empty();
            let rows = rows.into_iter().skip(usize::from(!has_meshes));
            rows.for_each(|row| table.row(row));
        }
    }
    table.print();
    println!(
        "RMS error of a mesh force / RMS of that force above the tolerance (what the tolerance promises):"
    );
    println!(
        "{}\n",
        if broken.is_empty() {
            "none".to_string()
        } else {
            broken.join("\n")
        }
    );
    Ok(())
}

/// The model files of the examples and of the tests.
fn files() -> Result<Vec<PathBuf>, String> {
    let mut files = Vec::new();
    for folder in ["examples", "tests/models"] {
        let entries = std::fs::read_dir(workspace().join(folder));
        let entries = entries.map_err(|error| format!("{folder}: {error}"))?;
        let mut paths: Vec<PathBuf> = entries
            .filter_map(|entry| Some(entry.ok()?.path()))
            .collect();
        paths.retain(|path| path.extension().is_some_and(|ending| ending == "toml"));
        paths.sort();
        files.extend(paths);
    }
    Ok(files)
}

/// The text of a file that a model file of the tests names.
fn beside(file: &str) -> Result<String, String> {
    let path = workspace().join("tests/models").join(file);
    std::fs::read_to_string(path).map_err(|error| error.to_string())
}

/// The forces that a model file leads to.
fn forces(text: &str, solver: SolverChoice, tolerance: f64, stride: u32) -> Result<Forces, String> {
    let Loaded { config, train, .. } =
        load_beside(text, &beside).map_err(|problems| format!("{problems:?}"))?;
    let settings = config::Simulation {
        solver,
        ..config.simulation.clone()
    };
    let simulation = started(&train, &settings, tolerance);
    let interface = Interface::of(&config, &train, simulation.model());
    let step = f64::from(stride) * settings.step_size;
    let count = (settings.stop_time / step).round() as u32;
    Forces::of(simulation, &interface, (step, count), None)
}
