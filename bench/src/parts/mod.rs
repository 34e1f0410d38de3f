//! The parts of the benchmark, each with a table of its own.

pub mod accuracy;
pub mod chains;
pub mod masters;
pub mod solvers;
pub mod start;
pub mod trains;

/// A part: its name, and what measures and prints it.
pub type Part = (&'static str, fn() -> Result<(), String>);

/// All parts, in the order in which they run.
pub const PARTS: [Part; 6] = [
    ("solvers", solvers::run),
    ("masters", masters::run),
    ("start", start::run),
    ("chains", chains::run),
    ("accuracy", accuracy::run),
    ("trains", trains::run),
];
