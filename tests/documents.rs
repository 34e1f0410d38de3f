//! What the pages in `docs/` name exists: files, items of the code, tests.

use std::fs;
use std::path::{Path, PathBuf};

fn root() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR"))
}

fn page(name: &str) -> String {
    fs::read_to_string(root().join(name)).unwrap()
}

/// Everything between single backticks outside of fenced blocks.
fn quoted(text: &str) -> Vec<String> {
    let outside = text.split("```").step_by(2);
    let words = outside.flat_map(|part| part.split('`').skip(1).step_by(2));
    words.map(ToString::to_string).collect()
}

fn rust_sources(folder: &Path, all: &mut String) {
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            rust_sources(&path, all);
        } else if path.extension().is_some_and(|ending| ending == "rs") {
            *all += &fs::read_to_string(&path).unwrap();
        }
    }
}

fn code(folder: &str) -> String {
    let mut all = String::new();
    rust_sources(&root().join(folder), &mut all);
    all
}

#[test]
fn every_file_that_the_pages_name_exists() {
    let pages = [
        "README.md",
        "ARCHITECTURE.md",
        "docs/theory.md",
        "docs/errata.md",
        "docs/validation.md",
        "docs/inspect.md",
    ];
    let folders = [
        "src/",
        "tests/",
        "docs/",
        "examples/",
        "xtask/",
        "validation/",
        "bench/",
    ];
    for name in pages {
        for word in quoted(&page(name)) {
            let is_path = folders.iter().any(|folder| word.starts_with(folder));
            let plain =
                !word.contains(|letter: char| letter.is_whitespace() || "*{<".contains(letter));
            let exists = root().join(&word).exists();
            assert!(exists || !is_path || !plain, "{name} names {word}");
        }
    }
}

#[test]
fn every_item_in_the_tables_of_symbols_exists() {
    let (theory, code) = (page("docs/theory.md"), code("src"));
    let items: Vec<String> = quoted(&theory)
        .into_iter()
        .filter(|word| word.contains("::"))
        .collect();
    assert!(items.len() > 30, "the table of symbols was found");
    for item in items {
        let (parent, member) = item.rsplit_once("::").unwrap();
        let parent = parent.rsplit("::").next().unwrap();
        let declared = ["struct", "enum"].map(|kind| format!("pub {kind} {parent} "));
        assert!(
            declared.iter().any(|one| code.contains(one))
                || code.contains(&format!("pub struct {parent}<")),
            "{item}: no {parent}"
        );
        let (field, function) = (format!("pub {member}:"), format!("pub fn {member}("));
        assert!(
            code.contains(&field) || code.contains(&function),
            "{item}: no {member}"
        );
    }
}

#[test]
fn every_test_that_decides_a_misprint_exists() {
    let code = code("src") + &code("tests");
    let named = quoted(&page("docs/errata.md"));
    let tests = named.iter().filter(|word| word.matches('_').count() >= 3);
    assert!(tests.clone().count() >= 4);
    for test in tests {
        assert!(code.contains(&format!("fn {test}()")), "{test}");
    }
}
