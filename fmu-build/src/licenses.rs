//! The crates that are linked into the library, and their licences in full.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write;
use std::path::Path;

use crate::metadata::{Package, cargo, output, packages};
use crate::platform::Platform;

/// What comes with the compiler and not as a crate of the workspace.
const RUNTIME: &str = include_str!("runtime.txt");

/// A text that names every crate linked into the library of `package`, on whatever platform, with its licences in full.
pub fn linked_crates(workspace: &Path, package: &str) -> Result<String, String> {
    let linked = linked(workspace, package)?;
    let packages = packages(workspace)?;
    let mut crates: Vec<&Package> = packages
        .iter()
        .filter(|package| package.foreign)
        .filter(|package| linked.contains(&format!("{} v{}", package.name, package.version)))
        .collect();
    crates.sort_by(|a, b| (&a.name, &a.version).cmp(&(&b.name, &b.version)));

    let mut page =
        "Crates the library is built from, with their licences; the texts follow.\n\n".to_string();
    // The same text stands once, below all crates that carry it.
    let mut texts: BTreeMap<String, Vec<String>> = BTreeMap::new();
    for package in crates {
        let (name, version) = (&package.name, &package.version);
        let license = package.license.as_deref().unwrap_or("see its text");
        let name = format!("{name} {version}");
        let _ = writeln!(page, "  {name:<36}{license}");
        for (file, text) in license_files(&package.folder)? {
            let carriers = texts.entry(text).or_default();
            carriers.push(format!("{name} ({file})"));
        }
    }
    let _ = write!(page, "\n{RUNTIME}");
    let mut texts: Vec<(Vec<String>, String)> = texts
        .into_iter()
        .map(|(text, carriers)| (carriers, text))
        .collect();
    texts.sort();
    for (carriers, text) in texts {
        let _ = write!(
            page,
            "\n\n==== {}\n\n{}\n",
            carriers.join(", "),
            text.trim_end()
        );
    }
    Ok(page)
}

/// `name vVERSION` of the crates whose code is in the library, on any platform; none that only runs while compiling.
fn linked(workspace: &Path, package: &str) -> Result<BTreeSet<String>, String> {
    let mut linked = BTreeSet::new();
    for target in Platform::ALL.iter().flat_map(|platform| platform.targets()) {
        let mut tree = cargo();
        tree.current_dir(workspace)
            .args(["tree", "--locked", "--package", package, "--target", target])
            .args([
                "--edges",
                "normal,no-proc-macro",
                "--prefix",
                "none",
                "--no-dedupe",
            ]);
        let crates = output(&mut tree)?;
        let names = crates
            .lines()
            .map(|line| line.split(" (").next().unwrap_or(line));
        linked.extend(names.map(ToString::to_string));
    }
    Ok(linked)
}

/// Names and contents of the files with licences in the folder of a crate.
fn license_files(folder: &Path) -> Result<Vec<(String, String)>, String> {
    let unreadable = |error| format!("{}: {error}", folder.display());
    let mut files = Vec::new();
    for entry in std::fs::read_dir(folder).map_err(unreadable)? {
        let entry = entry.map_err(unreadable)?;
        let name = entry.file_name().to_string_lossy().into_owned();
        let words = [
            "LICENSE",
            "LICENCE",
            "COPYING",
            "COPYRIGHT",
            "NOTICE",
            "UNLICENSE",
        ];
        if words
            .iter()
            .any(|word| name.to_uppercase().starts_with(word))
            && entry.path().is_file()
        {
            let text = std::fs::read(entry.path()).map_err(unreadable)?;
            files.push((name, String::from_utf8_lossy(&text).replace("\r\n", "\n")));
        }
    }
    files.sort();
    Ok(files)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// This workspace: there is always one around the tests.
    fn page(package: &str) -> String {
        let workspace = Path::new(env!("CARGO_MANIFEST_DIR")).parent().unwrap();
        linked_crates(workspace, package).unwrap()
    }

    #[test]
    fn linked_crates_are_named_with_their_texts_and_those_that_run_while_compiling_are_not() {
        let page = page("geartrain");
        for name in ["nalgebra", "libm", "sha2", "toml", "winnow"] {
            let line = page
                .lines()
                .find(|line| line.starts_with(&format!("  {name} ")));
            assert!(line.is_some(), "{name} is not listed");
            let text = page
                .lines()
                .find(|line| line.starts_with("====") && line.contains(&format!("{name} ")));
            assert!(text.is_some(), "{name} has no text");
        }
        assert!(!page.contains("serde_derive"), "runs while compiling");
        assert!(!page.contains("proptest"), "only tests use it");
        assert!(!page.contains("\n  geartrain "), "has its own page");
    }
}
