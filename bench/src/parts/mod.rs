//! The parts of the benchmark, each with a table of its own.

pub mod masters;
pub mod solvers;
pub mod start;

/// A part: its name, and what measures and prints it.
pub type Part = (&'static str, fn() -> Result<(), String>);

/// All parts, in the order in which they run.
pub const PARTS: [Part; 3] = [
    ("solvers", solvers::run),
    ("masters", masters::run),
    ("start", start::run),
];
