//! `cargo xtask couple`: a gear train and a housing as a pair of FMUs that any master can run, and as one for comparison.

mod known;

use std::path::{Path, PathBuf};

use fmu_build::Ssp;
use geartrain::config::Kind;
use geartrain::description::{Component, Connection, system_structure};
use geartrain::interface::{Contact, Interface, Link, contacts_by_name, links};
use geartrain::model::ModalModel;
use geartrain::train::{Loaded, load_beside};

use crate::model_file::ModelFile;
use crate::pack::pack;
use crate::{shell, workspace};

/// The script that runs the pair; it is copied beside it.
const SCRIPT: &str = "examples/couple.py";

/// What the arguments say.
struct Options {
    train: PathBuf,
    housing: PathBuf,
    out: Option<PathBuf>,
    contacts: Vec<Contact>,
}

/// A model file with what it means.
struct Model {
    file: ModelFile,
    loaded: Loaded,
    model: ModalModel,
    interface: Interface,
}

/// Packs both, the train in the housing as one, and an `.ssp` file of the pair.
pub fn command(arguments: &[&str]) -> Result<(), String> {
    let options = Options::parse(arguments)?;
    let [train, housing] = [&options.train, &options.housing].map(|path| Model::read(path));
    let (train, housing) = (train?, housing?);
    let kinds = [
        (&options.train, &train, Kind::GearTrain),
        (&options.housing, &housing, Kind::Housing),
    ];
    for (path, model, wanted) in kinds {
        if model.loaded.config.kind != wanted {
            let word = if wanted == Kind::Housing {
                "housing"
            } else {
                "gear_train"
            };
            return Err(format!(
                "{}: kind = \"{word}\" is wanted here",
                path.display()
            ));
        }
    }
    if train.loaded.config.housing.is_some() {
        let path = options.train.display();
        return Err(format!("{path}: has a [housing] inside already"));
    }
    let contacts = contacts(&train, &housing, options.contacts)?;
    let name = format!("{}_in_{}", train.name(), housing.name());
    let out = options
        .out
        .unwrap_or_else(|| workspace().join("target/couple").join(&name));
    let structure = write_housing(&out, (&train, &housing), &contacts)?;
    let embedded = write_embedded(&out, &name, (&train, &housing), &contacts)?;
    let fmus = pack(&[options.train, structure, embedded], &out, &[])?;
    write_system(&out, &name, [&train, &housing], &fmus[..2], &contacts)?;
    shell::write(
        &out.join("couple.py"),
        shell::read(&workspace().join(SCRIPT))?.as_bytes(),
    )?;
    for Contact { bearing, point } in &contacts {
        println!("{bearing} stands on {point}");
    }
    for bearing in train.bearings() {
        if !contacts.iter().any(|contact| contact.bearing == bearing) {
            println!("{bearing} stands on the ground");
        }
    }
    for fmu in fmus {
        println!("{}", fmu.display());
    }
    println!("{}", out.join(format!("{name}.ssp")).display());
    println!("run it: python {}", out.join("couple.py").display());
    Ok(())
}

impl Options {
    fn parse(arguments: &[&str]) -> Result<Options, String> {
        let (mut files, mut out, mut contacts) = (Vec::new(), None, Vec::new());
        let mut words = arguments.iter();
        while let Some(&word) = words.next() {
            match word {
                "--out" => out = Some(PathBuf::from(words.next().ok_or("--out needs a folder")?)),
                "--connect" => {
                    let pair = words.next().and_then(|pair| pair.split_once('='));
                    let (bearing, point) = pair.ok_or("--connect needs rotor.bearing=point")?;
                    contacts.push(Contact {
                        bearing: bearing.to_string(),
                        point: point.to_string(),
                    });
                }
                option if option.starts_with("--") => {
                    return Err(format!("unknown option {option}"));
                }
                file => files.push(PathBuf::from(file)),
            }
        }
        let [train, housing] = <[PathBuf; 2]>::try_from(files).map_err(|_| {
            "name two model files: cargo xtask couple TRAIN.toml HOUSING.toml".to_string()
        })?;
        Ok(Options {
            train,
            housing,
            out,
            contacts,
        })
    }
}

impl Model {
    fn read(path: &Path) -> Result<Model, String> {
        let file = ModelFile::read(path)?;
        let beside = |name: &str| file.beside(name);
        let loaded = load_beside(&file.text, &beside);
        let loaded = loaded.map_err(|problems| file.located("", &problems))?;
        let model = ModalModel::assemble(&loaded.train, None)
            .map_err(|error| format!("{}: {error}", path.display()))?;
        Ok(Model {
            interface: Interface::of(&loaded.config, &loaded.train, &model),
            model,
            file,
            loaded,
        })
    }

    fn name(&self) -> &str {
        &self.loaded.config.name
    }

    /// All bearings, written `rotor.bearing`.
    fn bearings(&self) -> Vec<String> {
        let rotors = self.loaded.train.rotors.iter();
        let names = rotors.flat_map(|rotor| {
            let bearings = rotor.bearings.iter();
            bearings.map(|bearing| format!("{}.{}", rotor.name, bearing.name))
        });
        names.collect()
    }
}

/// The contacts that were asked for, and those that the names tell.
fn contacts(train: &Model, housing: &Model, asked: Vec<Contact>) -> Result<Vec<Contact>, String> {
    let structure = housing.loaded.train.housing.as_ref();
    let structure = structure.ok_or("a housing is wanted")?;
    let points = || structure.points.iter().filter(|point| point.takes_forces);
    let names = || {
        points()
            .map(|point| point.name.as_str())
            .collect::<Vec<_>>()
            .join(", ")
    };
    for Contact { bearing, point } in &asked {
        if !train.bearings().contains(bearing) {
            let there_are = train.bearings().join(", ");
            return Err(format!(
                "--connect: no bearing \"{bearing}\"; there are {there_are}"
            ));
        }
        if !points().any(|one| one.name == *point) {
            return Err(format!(
                "--connect: forces act on no point \"{point}\"; there are {}",
                names()
            ));
        }
    }
    let mut contacts = asked;
    for contact in contacts_by_name(&train.loaded.train, structure) {
        let taken =
            |other: &Contact| other.bearing == contact.bearing || other.point == contact.point;
        if !contacts.iter().any(taken) {
            contacts.push(contact);
        }
    }
    for (index, one) in contacts.iter().enumerate() {
        if let Some(other) = contacts[..index]
            .iter()
            .find(|other| other.point == one.point)
        {
            return Err(format!(
                "{} and {} stand on one point, {}: no master can add their forces, give each a point of its own",
                other.bearing, one.bearing, one.point
            ));
        }
    }
    if contacts.is_empty() {
        return Err(format!(
            "no point is named after a bearing (rotor_bearing): say --connect rotor.bearing=point; bearings are {}, points {}",
            train.bearings().join(", "),
            names()
        ));
    }
    Ok(contacts)
}

/// The train with the housing inside, as a model file of its own.
fn write_embedded(
    out: &Path,
    name: &str,
    (train, housing): (&Model, &Model),
    contacts: &[Contact],
) -> Result<PathBuf, String> {
    let spot = train.loaded.lines.find(None, "name");
    let spot = spot.ok_or("the train has no name")?;
    let mut lines: Vec<String> = train.file.text.lines().map(str::to_string).collect();
    let line = &mut lines[spot.line - 1];
    let before: String = line.chars().take(spot.column).collect();
    let after: String = line.chars().skip(spot.column + spot.width).collect();
    *line = format!("{before}\"{name}\"{after}");
    let mut text = lines.join("\n");
    text.push_str(&format!(
        "\n\n[housing]\nfile = \"{}.toml\"\n\n[housing.connect]\n",
        housing.name()
    ));
    for Contact { bearing, point } in contacts {
        text.push_str(&format!("\"{bearing}\" = \"{point}\"\n"));
    }
    let path = out.join(format!("{name}.toml"));
    shell::write(&path, text.as_bytes())?;
    Ok(path)
}

/// The housing's file, with what it is to know of the bearings, and the table of its modes.
fn write_housing(
    out: &Path,
    (train, housing): (&Model, &Model),
    contacts: &[Contact],
) -> Result<PathBuf, String> {
    let text = known::with_bearings(housing, train, contacts)?;
    let path = out.join(format!("{}.toml", housing.name()));
    if path
        .canonicalize()
        .is_ok_and(|there| housing.file.is_at(&there))
    {
        let there = path.display();
        return Err(format!(
            "{there} is the housing's own file, of which a copy with its bearings is written: choose another folder"
        ));
    }
    shell::write(&path, text.as_bytes())?;
    let structure = housing.loaded.config.housing.iter();
    for file in structure.filter_map(|structure| structure.modes_file.as_ref()) {
        shell::write(&out.join(file), housing.file.beside(file)?.as_bytes())?;
    }
    Ok(path)
}

/// The `.ssp` file, and its connections as a table.
fn write_system(
    out: &Path,
    name: &str,
    models: [&Model; 2],
    fmus: &[PathBuf],
    contacts: &[Contact],
) -> Result<(), String> {
    let components = models.map(|model| Component {
        name: model.name(),
        interface: &model.interface,
    });
    let links = links(contacts);
    let connection = |link: &'_ Link| {
        let (from, to) = if link.from_train { (0, 1) } else { (1, 0) };
        Connection {
            from: (from, link.output.clone()),
            to: (to, link.input.clone()),
        }
    };
    let connections: Vec<Connection> = links.iter().map(connection).collect();
    let stop_time = models[0].loaded.config.simulation.stop_time;
    let read = |path: &PathBuf| {
        let bytes = std::fs::read(path).map_err(|error| format!("{}: {error}", path.display()))?;
        let file = path.file_name().unwrap_or_default();
        Ok((file.to_string_lossy().into_owned(), bytes))
    };
    let ssp = Ssp {
        structure: system_structure(name, stop_time, &components, &connections),
        fmus: fmus.iter().map(read).collect::<Result<_, String>>()?,
    };
    let bytes = ssp.to_bytes().map_err(|error| error.to_string())?;
    shell::write(&out.join(format!("{name}.ssp")), &bytes)?;
    let mut table = String::from("from,to\n");
    for Connection { from, to } in &connections {
        let full =
            |(index, variable): &(usize, String)| format!("{}.{variable}", components[*index].name);
        table.push_str(&format!("{},{}\n", full(from), full(to)));
    }
    shell::write(&out.join("connections.csv"), table.as_bytes())
}
