//! Random tests with a seed each: what a seed does is the same on every machine.
//!
//! ```text
//!   calls    sequences of calls, in any order and with any arguments, beside a twin that gets only what was accepted
//!   states   serialized states that were cut, changed, and forged so that only their content gives them away
//!   files    model files with changes that people make, and with changes that nobody makes; the trains run if accepted
//! ```
//!
//! A test fails by a panic in words; [`run`] adds the seed and what no test can see from inside: a hang, and memory.
//! A bounded run is in `tests/fuzz.rs`, a long one is `cargo xtask fuzz --seconds N`.

mod calls;
mod files;
mod states;

use std::sync::Arc;

use crate::{Fmu, within};

/// One case of a test, from a seed.
pub type Case = fn(&Arc<Fmu>, u64);

/// The tests by name.
pub const TESTS: [(&str, Case); 3] = [
    ("calls", calls::case),
    ("states", states::case),
    ("files", files::case),
];

/// Every case ends sooner [s]; most take milliseconds.
const LONGEST: u64 = 60;

/// No case takes more address space [bytes]; a train with all its copies takes some megabytes.
const LARGEST: usize = 1 << 30;

/// Runs a case; what went wrong with it.
pub fn run((name, case): (&str, Case), fmu: &Arc<Fmu>, seed: u64) -> Result<(), String> {
    let before = address_space();
    let its_own = Arc::clone(fmu);
    within(LONGEST, move || case(&its_own, seed))
        .map_err(|reason| format!("{name}, seed {seed}: {reason}"))?;
    let grown = address_space().saturating_sub(before);
    if grown > LARGEST {
        return Err(format!("{name}, seed {seed}: {grown} bytes of memory"));
    }
    Ok(())
}

/// The largest address space that this process has had [bytes]; 0 where the system does not tell.
fn address_space() -> usize {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status
        .lines()
        .find_map(|line| line.strip_prefix("VmPeak:"))
        .unwrap_or_default();
    let kilobytes = line
        .split_whitespace()
        .next()
        .and_then(|word| word.parse::<usize>().ok());
    kilobytes.unwrap_or(0) * 1024
}
