//! Random tests for as long as one likes: `cargo xtask fuzz --seconds N [--seed S]`.
#![allow(clippy::print_stdout, clippy::print_stderr)] // a command line talks

use std::process::ExitCode;
use std::sync::Arc;
use std::time::{Duration, Instant};

use importers::{Fmu, fuzz};

/// Seconds and first seed.
fn main() -> ExitCode {
    let numbers: Vec<u64> = std::env::args()
        .skip(1)
        .filter_map(|word| word.parse().ok())
        .collect();
    let [seconds, first] = numbers[..] else {
        eprintln!("fuzz SECONDS SEED");
        return ExitCode::FAILURE;
    };
    let names = ["three_stage", "rattle", "run_up", "known_box"];
    let fmus = names.map(|name| Arc::new(Fmu::unpack(name)));
    let (begin, mut seed) = (Instant::now(), first);
    while begin.elapsed() < Duration::from_secs(seconds) {
        for test in fuzz::TESTS {
            let fmu = &fmus[usize::try_from(seed % 4).expect("less than 4")];
            if let Err(failure) = fuzz::run(test, fmu, seed) {
                eprintln!("{failure}");
                return ExitCode::FAILURE;
            }
        }
        seed += 1;
    }
    println!("seeds {first} to {} passed", seed - 1);
    ExitCode::SUCCESS
}
