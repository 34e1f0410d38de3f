//! `cargo xtask new`: a model file to start from.

use std::path::Path;

use crate::{shell, workspace};

/// The file that is copied, and its name in itself.
const TEMPLATE: (&str, &str) = ("examples/two_shaft.toml", "two_shaft");

/// Writes `NAME.toml` into the current folder; an existing file is left alone.
pub fn command(arguments: &[&str]) -> Result<(), String> {
    let &[name] = arguments else {
        return Err("give one name: cargo xtask new NAME".to_string());
    };
    let path = Path::new(name).with_extension("toml");
    let stem = path.file_stem().and_then(|stem| stem.to_str());
    let name = stem.filter(|stem| is_identifier(stem)).ok_or_else(|| {
        format!(
            "the name becomes the FMU's: letters, digits and _, no digit in front; found {name}"
        )
    })?;
    if path.exists() {
        return Err(format!("{} is there already", path.display()));
    }
    let (file, own) = TEMPLATE;
    let text = shell::read(&workspace().join(file))?
        .lines()
        .filter(|line| !line.contains("cargo xtask new"))
        .map(|line| line.replacen(&format!("\"{own}\""), &format!("\"{name}\""), 1) + "\n")
        .collect::<String>();
    shell::write(&path, text.as_bytes())?;
    let shown = path.display();
    println!(
        "{shown}: a two-shaft reducer to change into your own\n  cargo xtask inspect {shown}\n  cargo xtask fmu {shown}"
    );
    Ok(())
}

fn is_identifier(name: &str) -> bool {
    let letter = |letter: char| letter.is_ascii_alphanumeric() || letter == '_';
    name.chars().all(letter)
        && !name.starts_with(|first: char| first.is_ascii_digit())
        && !name.is_empty()
}
