//! `cargo xtask bench [PART]...`: prints the tables of the parts named, or of all.

#![allow(clippy::print_stdout, clippy::print_stderr)] // a command line talks

use std::process::ExitCode;

use bench::machine;
use bench::parts::PARTS;

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
    println!("{}\n", machine::line());
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
