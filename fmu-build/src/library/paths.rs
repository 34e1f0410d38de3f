//! The same names of folders in every library, wherever it was built.

use std::collections::BTreeSet;
use std::path::Path;

use crate::metadata::packages;

/// Flags of the compiler that replace the names of this machine's folders.
pub fn replacements(workspace: &Path, package: &str) -> Result<Vec<String>, String> {
    let packages = packages(workspace)?;
    let foreign = packages.iter().filter(|package| package.foreign);
    // The folder of a registry has one folder for each crate.
    let registries: BTreeSet<&Path> = foreign
        .filter_map(|package| package.folder.parent())
        .collect();
    let flag = |folder: &Path, name| format!("--remap-path-prefix={}=/{name}", folder.display());
    let mut flags = vec![flag(workspace, package)];
    flags.extend(registries.into_iter().map(|folder| flag(folder, "crates")));
    Ok(flags)
}
