//! The floors of the house: imports point downward, and `unsafe` stays in the FMI layer.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

/// The floor of every module at the top of `src/`; `ARCHITECTURE.md` draws the same picture.
const FLOORS: [(&str, u32); 17] = [
    ("package", 9),
    ("fmi2", 8),
    ("slave", 7),
    ("description", 7),
    ("interface", 6),
    ("drawing", 6),
    ("simulation", 5),
    ("analysis", 5),
    ("model", 4),
    ("rotor", 3),
    ("train", 2),
    ("config", 1),
    ("element", 1),
    ("mesh", 1),
    ("interpolation", 0),
    ("linalg", 0),
    ("solver", 0),
];

/// Neighbours that know each other: the solver is built on linear algebra.
const ALLOWED_NEIGHBOURS: [(&str, &str); 1] = [("solver", "linalg")];

fn root() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR"))
}

fn rust_files(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            rust_files(&path, found);
        } else if path.extension().is_some_and(|ending| ending == "rs") {
            found.push(path);
        }
    }
}

/// Every source file of the library with its top module and its text without comments.
fn sources() -> Vec<(PathBuf, String, String)> {
    let source = root().join("src");
    let mut files = Vec::new();
    rust_files(&source, &mut files);
    files.sort();
    let describe = |path: PathBuf| {
        let relative = path.strip_prefix(&source).unwrap();
        let first = relative
            .components()
            .next()
            .unwrap()
            .as_os_str()
            .to_string_lossy();
        let module = first.trim_end_matches(".rs").to_string();
        let text = fs::read_to_string(&path).unwrap();
        let code = text
            .lines()
            .map(|line| line.split("//").next().unwrap_or(""));
        let code = code.collect::<Vec<_>>().join("\n");
        (path, module, code)
    };
    files.into_iter().map(describe).collect()
}

#[test]
fn every_module_has_a_floor_and_imports_only_from_floors_below() {
    let floors: BTreeMap<&str, u32> = FLOORS.into_iter().collect();
    for (path, module, code) in sources() {
        if module == "lib" {
            continue;
        }
        let own = floors
            .get(module.as_str())
            .unwrap_or_else(|| panic!("{module} has no floor"));
        for part in code.split("crate::").skip(1) {
            let name: String = part
                .chars()
                .take_while(|letter| letter.is_alphanumeric() || *letter == '_')
                .collect();
            if name == module {
                continue;
            }
            let other = floors.get(name.as_str());
            let other =
                other.unwrap_or_else(|| panic!("{}: crate::{name} has no floor", path.display()));
            let neighbours = ALLOWED_NEIGHBOURS.contains(&(module.as_str(), name.as_str()));
            assert!(
                other < own || neighbours,
                "{}: {module} (floor {own}) imports {name} (floor {other})",
                path.display()
            );
        }
    }
}

#[test]
fn unsafe_code_is_only_in_the_fmi_layer() {
    for (path, module, code) in sources() {
        let words = code.split(|letter: char| !letter.is_alphanumeric() && letter != '_');
        let uses = words.filter(|&word| word == "unsafe").count();
        assert!(
            module == "fmi2" || uses == 0,
            "{} uses unsafe",
            path.display()
        );
    }
}

#[test]
fn the_library_reads_no_clock_no_files_and_no_environment() {
    for (path, module, code) in sources() {
        for absent in [
            "std::time",
            "std::fs",
            "std::env",
            "std::net",
            "std::process",
            "HashMap",
            "rand::",
            "thread::current",
            "thread::spawn",
        ] {
            assert!(
                !code.contains(absent),
                "{} ({module}) uses {absent}",
                path.display()
            );
        }
    }
}

#[test]
fn the_architecture_page_names_every_floor() {
    let page = fs::read_to_string(root().join("ARCHITECTURE.md")).unwrap();
    for (module, _) in FLOORS {
        assert!(
            page.contains(&format!("`{module}`")),
            "ARCHITECTURE.md does not mention {module}"
        );
    }
}
