//! `cargo xtask merge`: FMUs that were packed on different machines become one.

use std::path::{Path, PathBuf};

use fmu_build::{Archive, merge};

use crate::{shell, workspace};

/// Merges the files named in the arguments; the result has the name of the first one.
pub fn command(arguments: &[&str]) -> Result<(), String> {
    let (mut files, mut out) = (Vec::new(), workspace().join("target/fmu/merged"));
    let mut words = arguments.iter();
    while let Some(&word) = words.next() {
        match word {
            "--out" => {
                let folder = words.next().map(PathBuf::from);
                out = folder.ok_or("--out needs a folder")?;
            }
            option if option.starts_with("--") => return Err(format!("unknown option {option}")),
            file => files.push(Path::new(file)),
        }
    }
    let [first, others @ ..] = &files[..] else {
        return Err("name the files: cargo xtask merge A.fmu B.fmu".to_string());
    };
    let mut merged = read(first)?;
    for other in others {
        merged = merge(merged, read(other)?)
            .map_err(|error| format!("{} and {}: {error}", first.display(), other.display()))?;
    }
    let path = out.join(first.file_name().unwrap_or_default());
    let bytes = merged.to_bytes().map_err(|error| error.to_string())?;
    shell::write(&path, &bytes)?;
    println!("{}", path.display());
    Ok(())
}

fn read(path: &Path) -> Result<Archive, String> {
    let located = |error: &dyn std::fmt::Display| format!("{}: {error}", path.display());
    let bytes = std::fs::read(path).map_err(|error| located(&error))?;
    Archive::from_bytes(&bytes).map_err(|error| located(&error))
}
