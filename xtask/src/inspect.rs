//! `cargo xtask inspect`: what a model file describes.

use std::path::Path;

use geartrain::model::ModalModel;
use geartrain::train::{GearTrain, load};

use crate::{pack, shell};

/// Prints the rotors with their frequencies and the meshes. A file `<model>.published.csv` beside the model
/// (rotor,kind,mode,frequency_hz,source) is shown for comparison.
pub fn command(path: &Path) -> Result<(), String> {
    pack::describe(path)?; // prints warnings
    let loaded =
        load(&shell::read(path)?).map_err(|problems| pack::located(path, "", &problems))?;
    let model = ModalModel::assemble(&loaded.train, None).map_err(|error| error.to_string())?;
    let published = Published::beside(path)?;
    println!("{}: {}\n", loaded.train.name, loaded.train.description);
    print_frequencies(&loaded.train, &model, &published);
    print_meshes(&loaded.train, &model);
    print_coupled(&model);
    Ok(())
}

fn print_frequencies(train: &GearTrain, model: &ModalModel, published: &Published) {
    println!("Natural frequencies of the uncoupled rotors [Hz]");
    let head = format!(
        "  {:<12} {:<10} {:>4} {:>12}",
        "rotor", "kind", "mode", "computed"
    );
    if published.0.is_empty() {
        println!("{head}");
    } else {
        println!("{head} {:>12} {:>10}   source", "published", "deviation");
    }
    for (rotor, modal) in train.rotors.iter().zip(&model.rotors) {
        let elastic = modal
            .torsional_frequencies
            .iter()
            .filter(|&&hertz| hertz > 0.0);
        let kinds = [
            ("torsional", elastic.copied().collect::<Vec<f64>>()),
            ("lateral", modal.lateral_frequencies.clone()),
        ];
        for (kind, frequencies) in kinds {
            for (index, hertz) in frequencies.iter().enumerate() {
                let mode = index + 1;
                let row = format!("  {:<12} {kind:<10} {mode:>4} {hertz:>12.3}", rotor.name);
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
    println!();
}

fn print_meshes(train: &GearTrain, model: &ModalModel) {
    if train.meshes.is_empty() {
        return;
    }
    println!("Meshes");
    println!(
        "  {:<12} {:<18} {:<18} {:>12} {:>16} {:>14}",
        "mesh", "gear a", "gear b", "f_mesh [Hz]", "k_mean [N/m]", "c [N s/m]"
    );
    for (mesh, modal) in train.meshes.iter().zip(&model.meshes) {
        let [a, b] = mesh.gears.map(|gear| train.gear_name(gear));
        println!(
            "  {:<12} {a:<18} {b:<18} {:>12.3} {:>16.6e} {:>14.2}",
            mesh.name,
            modal.frequency(),
            modal.mean_stiffness(),
            modal.damping
        );
    }
}

/// Natural vibrations of the coupled train, up to three times the highest mesh frequency.
fn print_coupled(model: &ModalModel) {
    let fastest = model
        .meshes
        .iter()
        .map(geartrain::model::Mesh::frequency)
        .fold(0.0, f64::max);
    let Some(vibrations) = model.natural_vibrations().filter(|_| fastest > 0.0) else {
        return;
    };
    println!(
        "\nCoupled natural vibrations at speed, with the mean mesh stiffness, up to three times the mesh frequency"
    );
    println!("  {:>12} {:>12}", "f [Hz]", "damping [%]");
    for one in vibrations
        .iter()
        .filter(|one| one.damped_frequency > 0.0 && one.frequency < 3.0 * fastest)
    {
        println!(
            "  {:>12.3} {:>12.4}",
            one.frequency,
            100.0 * one.damping_ratio
        );
    }
}

/// Frequencies that somebody published or measured for the same rotors.
struct Published(Vec<PublishedFrequency>);

struct PublishedFrequency {
    rotor: String,
    kind: String,
    mode: usize,
    hertz: f64,
    source: String,
}

impl Published {
    /// Reads the table beside a model file; without a file there is nothing to compare with.
    fn beside(model: &Path) -> Result<Published, String> {
        let path = model.with_extension("published.csv");
        if !path.is_file() {
            return Ok(Published(Vec::new()));
        }
        let text = shell::read(&path)?;
        let rows = text
            .lines()
            .enumerate()
            .skip(1)
            .filter(|(_, line)| !line.trim().is_empty());
        let parsed = rows.map(|(index, line)| {
            let rule = "must have the columns rotor,kind,mode,frequency_hz,source";
            PublishedFrequency::parse(line)
                .ok_or_else(|| format!("{}:{}: {rule}, found `{line}`", path.display(), index + 1))
        });
        Ok(Published(parsed.collect::<Result<_, _>>()?))
    }

    fn find(&self, rotor: &str, kind: &str, mode: usize) -> Option<(f64, &str)> {
        let same =
            |row: &&PublishedFrequency| row.rotor == rotor && row.kind == kind && row.mode == mode;
        self.0
            .iter()
            .find(same)
            .map(|row| (row.hertz, row.source.as_str()))
    }
}

impl PublishedFrequency {
    fn parse(line: &str) -> Option<PublishedFrequency> {
        let mut cells = line.splitn(5, ',').map(str::trim);
        Some(PublishedFrequency {
            rotor: cells.next()?.to_string(),
            kind: cells.next()?.to_string(),
            mode: cells.next()?.parse().ok()?,
            hertz: cells.next()?.parse().ok()?,
            source: cells.next()?.to_string(),
        })
    }
}
