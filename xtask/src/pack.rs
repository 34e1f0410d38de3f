//! `cargo xtask fmu`: from model files to FMUs.

use std::path::{Path, PathBuf};

use fmu_build::{Binary, Builder, Fmu, Library, Platform, linked_crates};
use geartrain::package::{Package, PackageError};

use crate::model_file::ModelFile;
use crate::python::Environment;
use crate::{icon, shell, workspace};

/// The linker for other platforms, as Python packages.
pub const ZIG: &str = "fmu-build/requirements.txt";

/// Packs the files named in the arguments.
pub fn command(arguments: &[&str]) -> Result<(), String> {
    let (mut models, mut out) = (Vec::new(), workspace().join("target/fmu"));
    let mut platforms = Vec::new();
    let mut words = arguments.iter();
    while let Some(&word) = words.next() {
        match word {
            "--out" => {
                out = words
                    .next()
                    .map(PathBuf::from)
                    .ok_or("--out needs a folder")?;
            }
            "--platform" => platforms = named(words.next().copied().unwrap_or_default())?,
            option if option.starts_with("--") => return Err(format!("unknown option {option}")),
            model => models.push(PathBuf::from(model)),
        }
    }
    if models.is_empty() {
        return Err("name at least one model file: cargo xtask fmu MODEL.toml".to_string());
    }
    for fmu in pack(&models, &out, &platforms)? {
        println!("{}", fmu.display());
    }
    Ok(())
}

/// The platforms of a list such as `linux64,win64`, each once.
fn named(list: &str) -> Result<Vec<Platform>, String> {
    let known = || Platform::ALL.map(Platform::folder).join(", ");
    let platforms = list.split(',').map(|name| {
        Platform::named(name.trim())
            .ok_or_else(|| format!("--platform: \"{name}\" is none of {}", known()))
    });
    let mut platforms = platforms.collect::<Result<Vec<Platform>, String>>()?;
    platforms.sort();
    platforms.dedup();
    Ok(platforms)
}

/// Packs model files into `out` and gives the paths of the FMUs. All files are checked before the first
/// one is packed. The FMUs run on the platforms, or on this machine where none are named.
pub fn pack(
    models: &[PathBuf],
    out: &Path,
    platforms: &[Platform],
) -> Result<Vec<PathBuf>, String> {
    let packages: Vec<Result<(Package, ModelFile), String>> =
        models.iter().map(|path| describe(path)).collect();
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
    let mut libraries = Vec::new();
    for library in build(platforms)? {
        let files = library.read().map_err(|error| error.to_string())?;
        libraries.push((library.platform, files));
    }
    let licenses = licenses()?;
    let icon = ("model.png".to_string(), icon::model_png()?);
    let mut written = Vec::new();
    for (package, file) in packages.into_iter().flatten() {
        let mut documents = licenses.clone();
        documents.push(icon.clone());
        documents.push(document("index.html", package.documentation.clone()));
        documents.push(document("model.toml", file.text.clone()));
        for name in &package.named_files {
            let own = Path::new(name).file_name().unwrap_or_default();
            documents.push(document(&own.to_string_lossy(), file.beside(name)?));
        }
        let binaries = libraries.iter();
        let binaries = binaries.map(|(platform, files)| binary(&package, *platform, files));
        let fmu = Fmu {
            binaries: binaries.collect::<Result<_, _>>()?,
            documents,
            model_identifier: package.model_identifier.clone(),
            model_description: package.model_description,
        };
        let path = out.join(format!("{}.fmu", package.model_identifier));
        let bytes = fmu.into_archive().to_bytes();
        shell::write(&path, &bytes.map_err(|error| error.to_string())?)?;
        written.push(path);
    }
    Ok(written)
}

/// Builds the library for each platform, or for this machine as every build here is.
fn build(platforms: &[Platform]) -> Result<Vec<Library>, String> {
    let zig = if platforms.iter().any(|platform| platform.needs_zig()) {
        Some(Environment::prepare("zig-python", Path::new(ZIG))?.programs())
    } else {
        None
    };
    let workspace = workspace();
    let builder = Builder {
        workspace: &workspace,
        package: "geartrain",
        zig: zig.as_deref(),
    };
    let libraries = if platforms.is_empty() {
        builder.native().map(|library| vec![library])
    } else {
        let portable = platforms.iter();
        portable
            .map(|platform| builder.portable(*platform))
            .collect()
    };
    libraries.map_err(|error| error.to_string())
}

/// The library with the model in it; each processor's part carries the model.
fn binary(package: &Package, platform: Platform, files: &[Vec<u8>]) -> Result<Binary, String> {
    let slices = files.iter().map(|file| package.implant(file.clone()));
    let slices = slices.collect::<Result<_, _>>();
    let slices = slices.map_err(|error| error.to_string())?;
    Binary::of(platform, slices).map_err(|error| error.to_string())
}

/// Reads and checks a model file; warnings are printed, problems are the error.
pub fn describe(path: &Path) -> Result<(Package, ModelFile), String> {
    let file = ModelFile::read(path)?;
    let beside = |name: &str| file.beside(name);
    let package = Package::of(&file.text, &beside).map_err(|error| match error {
        PackageError::Invalid(problems) => file.located("", &problems),
        PackageError::Irreducible(error) => format!("{}: {error}", path.display()),
    })?;
    if !package.warnings.is_empty() {
        eprintln!("{}", file.located("warning: ", &package.warnings));
    }
    Ok((package, file))
}

/// Our own licence, and those of what is linked into the library.
fn licenses() -> Result<Vec<(String, Vec<u8>)>, String> {
    let mut license =
        String::from("geartrain is licensed under MIT or Apache-2.0, at your choice.\n");
    for file in ["LICENSE-MIT", "LICENSE-APACHE"] {
        license.push_str("\n\n");
        license.push_str(&shell::read(&workspace().join(file))?);
    }
    let linked = linked_crates(&workspace(), "geartrain")?;
    Ok(vec![
        document("licenses/license.txt", license),
        document("licenses/linked-crates.txt", linked),
    ])
}

fn document(name: &str, text: String) -> (String, Vec<u8>) {
    (format!("documentation/{name}"), text.into_bytes())
}
