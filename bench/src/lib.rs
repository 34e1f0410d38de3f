//! How fast geartrain is: tables for `cargo xtask bench` and `docs/performance.md`.
//!
//! ```text
//!   models      texts of model files            problem   start, times, errors       equations   x' = f(t, x) for everybody
//!   rivals      what solves it                  contest   the cheapest setting that reaches an error
//!   fmu         the FMU's library, loaded       parts     one table each             series, table, clock, machine
//!   forces      of a run, against another's
//! ```
//!
//! Measures and prints; asserts nothing but that everybody solves the same equations.

#![allow(clippy::print_stdout)] // its tables are its result

pub mod clock;
pub mod contest;
pub mod equations;
pub mod fmu;
pub mod forces;
pub mod machine;
pub mod models;
pub mod parts;
pub mod problem;
pub mod rivals;
pub mod series;
pub mod table;
