//! `cargo xtask fmu`: from model files to FMUs.

use std::path::{Path, PathBuf};

use fmu_build::{Binary, Fmu, Platform, build_native_library};
use geartrain::config::Problem;
use geartrain::package::{Package, PackageError};

use crate::{shell, workspace};

/// Packs the files named in the arguments.
pub fn command(arguments: &[&str]) -> Result<(), String> {
    let (mut models, mut out) = (Vec::new(), workspace().join("target/fmu"));
    let mut words = arguments.iter();
    while let Some(&word) = words.next() {
        match word {
            "--out" => {
                out = words
                    .next()
                    .map(PathBuf::from)
                    .ok_or("--out needs a folder")?;
            }
            option if option.starts_with("--") => return Err(format!("unknown option {option}")),
            model => models.push(PathBuf::from(model)),
        }
    }
    if models.is_empty() {
        return Err("name at least one model file: cargo xtask fmu MODEL.toml".to_string());
    }
    for fmu in pack(&models, &out)? {
        println!("{}", fmu.display());
    }
    Ok(())
}

/// Packs model files into `out` and gives the paths of the FMUs. All files are checked before the first
/// one is packed.
pub fn pack(models: &[PathBuf], out: &Path) -> Result<Vec<PathBuf>, String> {
    let packages: Vec<Result<(Package, &PathBuf), String>> = models
        .iter()
        .map(|path| describe(path).map(|package| (package, path)))
        .collect();
    let problems: Vec<&str> = packages
        .iter()
        .filter_map(|package| package.as_ref().err())
        .map(String::as_str)
        .collect();
    if !problems.is_empty() {
        return Err(problems.join("\n"));
    }
    let names = || {
        packages
            .iter()
            .flatten()
            .map(|(package, _)| &package.model_identifier)
    };
    if let Some(twice) = names()
        .enumerate()
        .find(|(index, name)| names().take(*index).any(|other| other == *name))
    {
        return Err(format!(
            "two of the model files have the same name: \"{}\"",
            twice.1
        ));
    }
    let platform = Platform::native()
        .ok_or("FMI 2.0 has no name for this platform; FMUs cannot be packed on it")?;
    let library =
        build_native_library(&workspace(), "geartrain").map_err(|error| error.to_string())?;
    let library =
        std::fs::read(&library).map_err(|error| format!("{}: {error}", library.display()))?;
    let mut written = Vec::new();
    for (package, model) in packages.into_iter().flatten() {
        let source = shell::read(model)?;
        let bytes = package
            .implant(library.clone())
            .map_err(|error| error.to_string())?;
        let fmu = Fmu {
            binaries: vec![Binary { platform, bytes }],
            documents: documents(&package, &source)?,
            model_identifier: package.model_identifier.clone(),
            model_description: package.model_description,
        };
        let path = out.join(format!("{}.fmu", package.model_identifier));
        shell::write(&path, &fmu.to_bytes().map_err(|error| error.to_string())?)?;
        written.push(path);
    }
    Ok(written)
}

/// Reads and checks a model file; warnings are printed, problems are the error.
pub fn describe(path: &Path) -> Result<Package, String> {
    let text = shell::read(path)?;
    let package = Package::of(&text).map_err(|error| match error {
        PackageError::Invalid(problems) => located(path, &text, "", &problems),
        PackageError::Irreducible(error) => format!("{}: {error}", path.display()),
    })?;
    if !package.warnings.is_empty() {
        eprintln!("{}", located(path, &text, "warning: ", &package.warnings));
    }
    Ok(package)
}

/// Every problem as `file:line: place: message`, with `kind` before the place, and its line of the file below it.
pub fn located(path: &Path, text: &str, kind: &str, problems: &[Problem]) -> String {
    let file = path.display();
    let shown = |problem: &Problem| match problem.spot {
        Some(spot) => {
            let line = spot.line;
            format!("{file}:{line}: {kind}{problem}\n{}", spot.excerpt(text))
        }
        None => format!("{file}: {kind}{problem}"),
    };
    problems.iter().map(shown).collect::<Vec<_>>().join("\n")
}

fn documents(package: &Package, source: &str) -> Result<Vec<(String, Vec<u8>)>, String> {
    let mut documents = vec![
        (
            "documentation/index.html".to_string(),
            package.documentation.clone().into_bytes(),
        ),
        (
            "documentation/model.toml".to_string(),
            source.as_bytes().to_vec(),
        ),
    ];
    let mut license =
        String::from("geartrain is licensed under MIT or Apache-2.0, at your choice.\n");
    for file in ["LICENSE-MIT", "LICENSE-APACHE"] {
        license.push_str("\n\n");
        license.push_str(&shell::read(&workspace().join(file))?);
    }
    documents.push((
        "documentation/licenses/license.txt".to_string(),
        license.into_bytes(),
    ));
    Ok(documents)
}
