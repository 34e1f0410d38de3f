//! `cargo xtask inspect`: what a model file describes, as an engineer looks at it.
//!
//! Everything is computed by `geartrain::analysis`; here it is asked for and printed. What each number
//! means: `docs/inspect.md`.

mod basis;
mod frequencies;
mod housing;
mod json;
mod options;
mod page;
mod published;

use std::path::Path;

use geartrain::analysis::{
    BasisErrors, Campbell, Kind, Recommendation, Reference, SuggestedStep, VibrationErrors,
    Vibrations, Whirl, campbell, range_of_interest, recommend, suggested_step, vibrations,
};
use geartrain::config::Config;
use geartrain::model::ModalModel;
use geartrain::rotor::ModalRotor;
use geartrain::train::{GearTrain, Loaded, load_beside};

use crate::model_file::ModelFile;
use crate::{pack, shell};
use options::{Format, Options};
use published::Published;

/// Everything `inspect` shows.
struct Inspection {
    config: Config,
    train: GearTrain,
    model: ModalModel,
    /// Every rotor by itself, with its shapes.
    reduced: Vec<ModalRotor>,
    vibrations: Vibrations,
    /// The table over speed, or why there is none.
    campbell: Result<Campbell, String>,
    basis: BasisReport,
    step: SuggestedStep,
}

/// The modal basis beside the full finite-element model.
struct BasisReport {
    reference: Reference,
    errors: BasisErrors,
    vibration: Option<VibrationErrors>,
    recommendation: Option<Recommendation>,
}

/// Prints what the file describes, for people or as JSON, or writes it as a page.
pub fn command(arguments: &[&str]) -> Result<(), String> {
    let options = Options::parse(arguments)?;
    let path = &options.model;
    let (package, file) = pack::describe(path)?; // prints warnings
    let loaded = load_file(path)?;
    if let (true, Some(housing)) = (loaded.train.rotors.is_empty(), &loaded.train.housing) {
        match options.format {
            Format::Json => println!("{:#}", housing::report(&loaded.train.name, housing)),
            Format::Text => housing::print(&loaded.train.name, housing),
            Format::Html => write_page(&options, &loaded.train.name, &package.documentation)?,
        }
        return Ok(());
    }
    let inspection = Inspection::of_file(loaded, &options)?;
    match options.format {
        Format::Json => println!("{:#}", json::report(&inspection)),
        Format::Text => print_for_people(&inspection, path)?,
        Format::Html => {
            let page = page::page(&inspection, &file.text);
            write_page(&options, &inspection.train.name, &page)?;
        }
    }
    Ok(())
}

fn write_page(options: &Options, name: &str, page: &str) -> Result<(), String> {
    let file = options.out.join(format!("{name}.html"));
    shell::write(&file, page.as_bytes())?;
    println!("{}", file.display());
    Ok(())
}

/// What `--format json` prints of a model file, with the table over the default speeds.
pub fn as_json(path: &Path) -> Result<String, String> {
    let word = path.to_string_lossy();
    let options = Options::parse(&[&word])?;
    Ok(format!(
        "{:#}",
        json::report(&Inspection::of_file(load_file(path)?, &options)?)
    ))
}

fn load_file(path: &Path) -> Result<Loaded, String> {
    let file = ModelFile::read(path)?;
    let beside = |name: &str| file.beside(name);
    load_beside(&file.text, &beside).map_err(|problems| file.located("", &problems))
}

impl Inspection {
    fn of_file(loaded: Loaded, options: &Options) -> Result<Inspection, String> {
        let path = &options.model;
        Inspection::of(loaded, options).map_err(|message| format!("{}: {message}", path.display()))
    }

    fn of(loaded: Loaded, options: &Options) -> Result<Inspection, String> {
        let Loaded { config, train, .. } = loaded;
        let model = ModalModel::assemble(&train, None).map_err(|error| error.to_string())?;
        let found =
            vibrations(&model).ok_or("the eigenvalues of the coupled train do not converge")?;
        let range = options.speeds.range(train.rotors[0].speed);
        let campbell = range.and_then(|range| {
            campbell(&config, &model.counts(), &found.oscillating, &range)
                .map_err(|error| error.to_string())
        });
        let reduced = train.rotors.iter();
        let reduced = reduced.map(|rotor| ModalRotor::reduce(rotor, &train.basis, None));
        let range = range_of_interest(&train, &model);
        Ok(Inspection {
            basis: BasisReport::of(&train, &model, range)?,
            step: suggested_step(&model, range),
            vibrations: found,
            campbell,
            reduced: reduced
                .collect::<Result<_, _>>()
                .map_err(|error| error.to_string())?,
            config,
            train,
            model,
        })
    }

    fn rotor_name(&self, index: usize) -> &str {
        &self.train.rotors[index].name
    }
}

impl BasisReport {
    fn of(train: &GearTrain, model: &ModalModel, range: f64) -> Result<BasisReport, String> {
        let failed = |error: geartrain::rotor::ReductionError| error.to_string();
        let reference = Reference::of(train, range).map_err(failed)?;
        Ok(BasisReport {
            errors: reference.errors(model),
            vibration: reference.vibration_errors(model, &train.gearbox_vibration),
            recommendation: recommend(train, &reference).map_err(failed)?,
            reference,
        })
    }
}

fn print_for_people(inspection: &Inspection, path: &Path) -> Result<(), String> {
    println!(
        "{}: {}",
        inspection.train.name, inspection.train.description
    );
    frequencies::print_rotors(inspection, &Published::beside(path)?);
    frequencies::print_meshes(inspection);
    frequencies::print_coupled(inspection);
    frequencies::print_critical_speeds(inspection);
    basis::print_basis(inspection);
    basis::print_step(&inspection.step);
    Ok(())
}

/// The name of a kind.
fn kind(kind: Kind) -> &'static str {
    match kind {
        Kind::Lateral => "lateral",
        Kind::Torsional => "torsional",
        Kind::Mesh => "mesh",
        Kind::Housing => "housing",
    }
}

/// The name of a whirl.
fn whirl(whirl: Option<Whirl>) -> Option<&'static str> {
    whirl.map(|whirl| match whirl {
        Whirl::Forward => "forward",
        Whirl::Backward => "backward",
    })
}
