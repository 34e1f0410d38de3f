//! `cargo xtask validation`: measures the claims of the paper and writes them down.

use validation::document::{Families, MARK};

use crate::{shell, workspace};

/// Writes the tables of `docs/validation.md`.
pub fn command() -> Result<(), String> {
    let path = workspace().join("docs/validation.md");
    let page = shell::read(&path)?;
    let (text, _) = page
        .split_once(MARK)
        .ok_or_else(|| format!("{} has no line {MARK}", path.display()))?;
    let page = format!("{text}{MARK}\n{}", Families::run().document());
    shell::write(&path, page.as_bytes())?;
    println!("{}: review its diff before committing", path.display());
    Ok(())
}
