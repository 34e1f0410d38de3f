//! Model files with random changes: they are refused in words, or become trains that live.

use std::path::Path;
use std::sync::{Arc, OnceLock};

use geartrain::package::{Package, PackageError};
use geartrain::slave::{Experiment, Slave};
use geartrain::train::load_beside;

use crate::random::Random;
use crate::{Fmu, STEP};

/// A changed file. All the files begin valid.
pub(super) fn case(_fmu: &Arc<Fmu>, seed: u64) {
    let random = &mut Random::new(seed);
    let files = files();
    let mut text = files[random.below(files.len())].clone();
    for _ in 0..=random.below(4) {
        text = changed(&text, &files[random.below(files.len())], random);
    }
    match Package::of(&text, &beside) {
        Ok(package) => {
            assert!(package.model_description.starts_with("<?xml"));
            live(&text);
        }
        Err(PackageError::Irreducible(error)) => assert!(!error.to_string().is_empty()),
        Err(PackageError::Invalid(problems)) => {
            assert!(!problems.is_empty());
            for problem in problems {
                let words = problem.to_string();
                assert!(words.len() > 10 && words.len() < 10_000, "{words}");
            }
        }
    }
}

/// The train of an accepted file: initialization and some steps succeed or fail in words.
fn live(text: &str) {
    let Ok(loaded) = load_beside(text, &beside) else {
        panic!("accepted before");
    };
    let mut slave = Slave::new(&loaded.config.to_bytes()).expect("an accepted model");
    let experiment = Experiment {
        tolerance: None,
        start: 0.0,
        stop: None,
    };
    slave.setup_experiment(experiment).expect("legal");
    slave.enter_initialization().expect("legal");
    if slave.exit_initialization().is_err() {
        return;
    }
    for index in 0..3 {
        if slave.do_step(f64::from(index) * STEP, STEP).is_err() {
            break;
        }
    }
    assert!(slave.last_successful_time().is_finite());
}

/// The text of a file that a model file names: all of them stand in one folder.
fn beside(file: &str) -> Result<String, String> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../models");
    std::fs::read_to_string(folder.join(file)).map_err(|error| error.to_string())
}

/// All model files of the repository.
fn files() -> &'static [String] {
    static FILES: OnceLock<Vec<String>> = OnceLock::new();
    FILES.get_or_init(|| {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
        let folders = ["examples", "tests/models"].map(|folder| root.join(folder));
        let mut paths: Vec<_> = folders
            .iter()
            .flat_map(|folder| std::fs::read_dir(folder).expect("the repository"))
            .filter_map(|entry| Some(entry.ok()?.path()))
            .filter(|path| path.extension().is_some_and(|ending| ending == "toml"))
            .collect();
        paths.sort();
        let read = |path| std::fs::read_to_string(path).expect("a text");
        paths.iter().map(read).collect()
    })
}

/// One change: of a line, of a number, of a word, of a character.
fn changed(text: &str, other: &str, random: &mut Random) -> String {
    let mut lines: Vec<String> = text.lines().map(str::to_string).collect();
    if lines.is_empty() {
        return text.to_string();
    }
    let at = random.below(lines.len());
    match random.below(12) {
        0 => drop(lines.remove(at)),
        1 => lines.insert(at, lines[random.below(lines.len())].clone()),
        2 => {
            let foreign: Vec<&str> = other.lines().collect();
            lines.insert(at, foreign[random.below(foreign.len())].to_string());
        }
        3 => lines.truncate(at),
        4 => lines[at] = without_a_part(&lines[at], random),
        5 => lines[at] = with_a_character(&lines[at], random),
        6 => lines[at] = renamed(&lines[at], random),
        7 => {
            let depth = random.below(3000);
            lines[at].push_str(&"[".repeat(depth));
        }
        _ => lines = with_another_number(lines, at, random),
    }
    lines.join("\n")
}

/// The first number at or after line `at` becomes another.
fn with_another_number(mut lines: Vec<String>, at: usize, random: &mut Random) -> Vec<String> {
    let begins = |line: &str| {
        let value = line.find('=')?;
        Some(value + line[value..].find(|c: char| c.is_ascii_digit())?)
    };
    let Some(line) = lines[at..].iter_mut().find(|line| begins(line).is_some()) else {
        return lines;
    };
    let begin = begins(line).expect("found");
    let rest = line[begin..].find(|c: char| !(c.is_ascii_alphanumeric() || ".+-_".contains(c)));
    let end = rest.map_or(line.len(), |length| begin + length);
    let another = match random.below(6) {
        0 => "99999999999999999999".to_string(),
        1 => random.below(1000).to_string(),
        2 => "\"20 deg\"".to_string(),
        3 => format!("{:?}", random.odd_number()).replace("NaN", "nan"),
        _ => {
            let present = line[begin..end].parse().unwrap_or(1.0);
            let factor = random.pick(&[0.5, 0.9, 1.1, 2.0, -1.0, 1e3, 1e-3]);
            format!("{:?}", present * factor)
        }
    };
    line.replace_range(begin..end, &another);
    lines
}

fn without_a_part(line: &str, random: &mut Random) -> String {
    let begin = random.below(line.len() + 1);
    let length = random.below(4);
    let kept = line
        .char_indices()
        .filter(|(index, _)| !(begin..begin + length).contains(index));
    kept.map(|(_, character)| character).collect()
}

fn with_a_character(line: &str, random: &mut Random) -> String {
    const ODD: [char; 14] = [
        '"', '\'', '{', '}', ']', ',', '=', '#', '.', '\\', '\0', '\u{feff}', 'ä', '-',
    ];
    let mut characters: Vec<char> = line.chars().collect();
    characters.insert(random.below(characters.len() + 1), random.pick(&ODD));
    characters.into_iter().collect()
}

fn renamed(line: &str, random: &mut Random) -> String {
    const NAMES: [&str; 8] = [
        "",
        "time",
        "b1",
        "gear",
        "simulation",
        "a.b",
        "x\u{0}",
        "änderung",
    ];
    let name = match random.below(NAMES.len() + 1) {
        0 => "n".repeat(100_000),
        index => NAMES[index - 1].to_string(),
    };
    let mut parts: Vec<String> = line.split('"').map(str::to_string).collect();
    if parts.len() > 1 {
        parts[1] = name;
    }
    parts.join("\"")
}
