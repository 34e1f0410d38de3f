//! Benchmarks: `cargo xtask bench [solvers] [masters] ...`. Prints tables; compare ratios within one run.

#![allow(clippy::print_stdout, clippy::print_stderr)] // a command line talks

mod clock;
mod contest;
mod equations;
mod fmu;
mod models;
mod parts;
mod problem;
mod rivals;
mod table;

use std::process::ExitCode;

use parts::{masters, solvers, start};

/// A part by its name.
type Part = (&'static str, fn() -> Result<(), String>);

const PARTS: [Part; 3] = [
    ("solvers", solvers::run),
    ("masters", masters::run),
    ("start", start::run),
];

fn main() -> ExitCode {
    let wanted: Vec<String> = std::env::args().skip(1).collect();
    let names = PARTS.map(|(name, _)| name);
    if let Some(unknown) = wanted.iter().find(|word| !names.contains(&word.as_str())) {
        eprintln!(
            "no part of the benchmark: {unknown}; there are {}",
            names.join(", ")
        );
        return ExitCode::FAILURE;
    }
    let is_wanted = |name: &str| wanted.is_empty() || wanted.iter().any(|word| word == name);
    for (name, run) in PARTS.into_iter().filter(|(name, _)| is_wanted(name)) {
        println!("== {name}\n");
        if let Err(problem) = run() {
            eprintln!("{name}: {problem}");
            return ExitCode::FAILURE;
        }
    }
    ExitCode::SUCCESS
}
