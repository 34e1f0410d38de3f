//! The parts of the benchmark, each with a table of its own.

pub mod masters;
pub mod solvers;
pub mod start;
