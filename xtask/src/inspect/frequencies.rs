//! Frequencies of the rotors, the meshes and the coupled train, at speed and over speed.

use std::f64::consts::TAU;

use geartrain::analysis::{Campbell, Point, Vibration};

use super::{Inspection, Published, json, kind, whirl};

/// Speeds beside each other at most.
const COLUMNS: usize = 7;
/// Crossings of mesh frequencies are listed within this part of the file's speed; all are in the JSON form.
const NEAR: f64 = 0.2;

/// The rotors by themselves, compared with what was published.
pub fn print_rotors(inspection: &Inspection, published: &Published) {
    let width = rotor_width(inspection);
    println!("\nNatural frequencies of the uncoupled rotors [Hz]");
    if !published.is_empty() {
        print_compared(inspection, published);
        return;
    }
    for (rotor, modal) in inspection.train.rotors.iter().zip(&inspection.model.rotors) {
        let kinds = [
            ("torsional", json::elastic(modal)),
            ("lateral", modal.lateral_frequencies.clone()),
        ];
        for (kind, frequencies) in kinds {
            let cells = frequencies.iter().map(|hertz| format!("{hertz:>10.2}"));
            for (line, cells) in cells.collect::<Vec<_>>().chunks(8).enumerate() {
                let (name, kind) = if line == 0 {
                    (rotor.name.as_str(), kind)
                } else {
                    ("", "")
                };
                println!("  {name:<width$} {kind:<10}{}", cells.concat());
            }
        }
    }
}

fn print_compared(inspection: &Inspection, published: &Published) {
    let width = rotor_width(inspection);
    println!(
        "  {:<width$} {:<10} {:>4} {:>12} {:>12} {:>10}   source",
        "rotor", "kind", "mode", "computed", "published", "deviation"
    );
    for (rotor, modal) in inspection.train.rotors.iter().zip(&inspection.model.rotors) {
        let kinds = [
            ("torsional", json::elastic(modal)),
            ("lateral", modal.lateral_frequencies.clone()),
        ];
        for (kind, frequencies) in kinds {
            for (index, hertz) in frequencies.iter().enumerate() {
                let mode = index + 1;
                let row = format!(
                    "  {:<width$} {kind:<10} {mode:>4} {hertz:>12.3}",
                    rotor.name
                );
                match published.find(&rotor.name, kind, mode) {
                    Some((value, source)) => {
                        let deviation = 100.0 * (hertz / value - 1.0);
                        println!("{row} {value:>12.1} {deviation:>+9.2}%   {source}");
                    }
                    None => println!("{row}"),
                }
            }
        }
    }
}

/// The meshes.
pub fn print_meshes(inspection: &Inspection) {
    let train = &inspection.train;
    if train.meshes.is_empty() {
        return;
    }
    let gears = train.meshes.iter().flat_map(|mesh| mesh.gears);
    let gear_width = widest(gears.map(|gear| train.gear_name(gear)));
    let mesh_width = widest(train.meshes.iter().map(|mesh| &mesh.name));
    println!("\nMeshes");
    println!(
        "  {:<mesh_width$} {:<gear_width$} {:<gear_width$} {:>12} {:>16} {:>14}",
        "mesh", "gear a", "gear b", "f_mesh [Hz]", "k_mean [N/m]", "c [N s/m]"
    );
    for (mesh, modal) in train.meshes.iter().zip(&inspection.model.meshes) {
        let [a, b] = mesh.gears.map(|gear| train.gear_name(gear));
        println!(
            "  {:<mesh_width$} {a:<gear_width$} {b:<gear_width$} {:>12.3} {:>16.6e} {:>14.2}",
            mesh.name,
            modal.frequency(),
            modal.mean_stiffness(),
            modal.damping
        );
    }
    for mesh in &train.meshes {
        if let Some(norm) = iso_stiffness(mesh) {
            println!(
                "  {}: ISO 6336-1 gives {norm:.6e} N/m for these teeth (c_gamma x face width)",
                mesh.name
            );
        }
    }
}

/// c_gamma x face width of ISO 6336-1 [N/m], for comparison where the stiffness follows from tooth geometry.
pub fn iso_stiffness(mesh: &geartrain::train::Mesh) -> Option<f64> {
    let pair = mesh.stiffness.spur_pair()?;
    Some(mesh.stiffness_factor * pair.iso6336().mesh * pair.face_width)
}

/// Natural vibrations of the coupled train in the range of interest, at speed and over speed.
pub fn print_coupled(inspection: &Inspection) {
    let limit = inspection.basis.reference.highest_frequency;
    let found = &inspection.vibrations;
    let width = rotor_width(inspection);
    println!("\nCoupled natural vibrations at speed up to {limit:.0} Hz, mean mesh stiffness");
    let columns = match &inspection.campbell {
        Ok(table) => columns(table),
        Err(_) => Vec::new(),
    };
    let head = format!(
        "  {:>4} {:>10} {:>9}  {:<9} {:<width$} {:<8}",
        "no.", "f [Hz]", "damp. [%]", "kind", "rotor", "whirl"
    );
    let speed = inspection.train.rotors[0].speed.abs();
    if columns.is_empty() {
        println!("{head}");
    } else {
        let (unit, factor) = if speed > 0.0 {
            ("", 1.0 / speed)
        } else {
            (" rpm", 60.0 / TAU)
        };
        let indent = head.len() + 2;
        let heads = columns
            .iter()
            .map(|point| format!("{:>9}", trimmed(point.speed * factor)));
        let of = if speed > 0.0 {
            "times the speed"
        } else {
            "speed of the first rotor"
        };
        println!("{:>indent$}damped f [Hz] at{unit} ... {of}", "");
        println!("{head}  {}", heads.collect::<String>());
    }
    let shown = found
        .oscillating
        .iter()
        .take_while(|one| one.natural.frequency <= limit);
    for (index, one) in shown.enumerate() {
        let cells: String = columns.iter().map(|point| cell(point, index)).collect();
        let row = format!(
            "  {:>4} {}  {cells}",
            index + 1,
            columns_of(inspection, one)
        );
        println!("{}", row.trim_end());
    }
    if found
        .oscillating
        .iter()
        .any(|one| one.natural.damping_ratio < 0.0)
    {
        println!("  UNSTABLE: vibrations with negative damping grow");
    }
    if !found.creeping.is_empty() {
        println!("  and {} that do not oscillate", found.creeping.len());
    }
    if let Err(reason) = &inspection.campbell {
        println!("  no frequencies over speed: {reason}");
    }
    if let Ok(table) = &inspection.campbell
        && let Some((speed, reason)) = table.refused.first()
    {
        println!("  no frequencies at {}: {reason}", rpm(*speed));
    }
}

fn columns_of(inspection: &Inspection, one: &Vibration) -> String {
    let width = rotor_width(inspection);
    format!(
        "{:>10.2} {:>9.3}  {:<9} {:<width$} {:<8}",
        one.natural.frequency,
        100.0 * one.natural.damping_ratio,
        kind(one.kind),
        inspection.rotor_name(one.rotor),
        whirl(one.whirl).unwrap_or("-")
    )
}

/// At most [`COLUMNS`] speeds of the table, the first and the last among them.
fn columns(table: &Campbell) -> Vec<&Point> {
    let count = table.points.len();
    let step = (count - 1).div_ceil(COLUMNS - 1).max(1);
    table.points.iter().step_by(step).collect()
}

fn cell(point: &Point, branch: usize) -> String {
    let place = point.branches.iter().position(|own| *own == Some(branch));
    match place {
        Some(place) => format!("{:>9.2}", point.vibrations[place].natural.damped_frequency),
        None => format!("{:>9}", "-"),
    }
}

/// Speeds at which unbalance or the teeth meet a natural frequency.
pub fn print_critical_speeds(inspection: &Inspection) {
    let Ok(table) = &inspection.campbell else {
        return;
    };
    let speed = inspection.train.rotors[0].speed.abs();
    let near = |critical: f64| (critical - speed).abs() <= NEAR * speed;
    let shown: Vec<_> = table
        .critical_speeds
        .iter()
        .filter(|one| {
            let synchronous = !table.excitations[one.excitation].rotors.is_empty();
            synchronous || speed == 0.0 || near(one.speed)
        })
        .collect();
    let (Some(first), Some(last)) = (table.points.first(), table.points.last()) else {
        return;
    };
    println!(
        "\nCritical speeds of {} between {} and {}: unbalance of any rotor; mesh frequencies (1x, 2x) within {:.0} % of the speed",
        inspection.rotor_name(0),
        rpm(first.speed),
        rpm(last.speed),
        100.0 * NEAR
    );
    let width = rotor_width(inspection);
    if shown.is_empty() {
        println!("  none");
        return;
    }
    println!(
        "  {:>10} {:>8} {:>10} {:>9}  {:<9} {:<width$} {:<8}  excited by",
        "n [rpm]", "of speed", "f [Hz]", "damp. [%]", "kind", "rotor", "whirl"
    );
    for critical in shown {
        let part = if speed > 0.0 {
            trimmed(critical.speed / speed)
        } else {
            "-".to_string()
        };
        println!(
            "  {:>10.1} {part:>8} {}  {}",
            critical.speed * 60.0 / TAU,
            columns_of(inspection, &critical.vibration),
            exciters(inspection, table, critical.excitation)
        );
    }
}

/// What meets a vibration at a critical speed.
pub fn exciters(inspection: &Inspection, table: &Campbell, excitation: usize) -> String {
    let excitation = &table.excitations[excitation];
    let rotors = excitation
        .rotors
        .iter()
        .map(|&rotor| inspection.rotor_name(rotor).to_string());
    let meshes = excitation.meshes.iter().map(|&(mesh, harmonic)| {
        let name = &inspection.train.meshes[mesh].name;
        if harmonic == 1 {
            name.clone()
        } else {
            format!("{harmonic}x {name}")
        }
    });
    rotors.chain(meshes).collect::<Vec<_>>().join(", ")
}

fn rpm(speed: f64) -> String {
    format!("{} rpm", trimmed(speed * 60.0 / TAU))
}

/// Three decimals, without trailing zeros.
fn trimmed(value: f64) -> String {
    let text = format!("{value:.3}");
    text.trim_end_matches('0').trim_end_matches('.').to_string()
}

/// Width of the column with the names of rotors.
fn rotor_width(inspection: &Inspection) -> usize {
    widest(inspection.train.rotors.iter().map(|rotor| &rotor.name))
}

/// Width of a column with these words.
fn widest(words: impl Iterator<Item = impl AsRef<str>>) -> usize {
    words.map(|word| word.as_ref().len()).fold(8, usize::max)
}
