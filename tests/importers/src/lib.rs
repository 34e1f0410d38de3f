//! What the tests of packed FMUs share: a host that can also do what no master should.
//!
//! ```text
//!   Fmu         an unpacked FMU: library, guid, variables by name
//!   Functions   the 34 C functions of its library
//!   Host        the loaded library                       Birth   the arguments of fmi2Instantiate
//!   Instance    one slave; freed when dropped            optional  its functions behind capability flags
//!   calls       every function with harmless arguments, and the states in which it is legal
//!   log         what the slave told the logger                 state     its saved states
//!   fuzz        random calls, states and model files             random    chance from a seed
//! ```
//!
//! The tests themselves contain no unsafe code. `GEARTRAIN_FMUS` names the folder with the FMUs; run them with
//! `cargo xtask test`.

pub mod calls;
pub mod fmu;
pub use fmi2_functions as functions;
pub mod fuzz;
pub mod host;
pub mod instance;
pub mod log;
pub mod optional;
pub mod random;
pub mod state;

pub use fmu::Fmu;
pub use host::{Birth, Callbacks, Host};
pub use instance::{Booleans, Instance, Integers, Reals, Strings};

use core::any::Any;
use std::sync::mpsc;
use std::thread;
use std::time::Duration;

/// Communication step of the tests [s]: that of the example's DefaultExperiment.
pub const STEP: f64 = 2e-5;

/// Runs `body` on a thread of its own; an error in words when it fails or has not ended after `seconds`.
pub fn within<T: Send + 'static>(
    seconds: u64,
    body: impl FnOnce() -> T + Send + 'static,
) -> Result<T, String> {
    let (sender, receiver) = mpsc::channel();
    let runner = thread::spawn(move || sender.send(body()));
    match receiver.recv_timeout(Duration::from_secs(seconds)) {
        Ok(result) => Ok(result),
        Err(mpsc::RecvTimeoutError::Timeout) => Err(format!("no end after {seconds} s")),
        Err(mpsc::RecvTimeoutError::Disconnected) => {
            let panicked = runner.join().err();
            Err(panicked.map_or("no result".to_string(), |reason| words(&*reason)))
        }
    }
}

/// What a panic said.
fn words(panicked: &(dyn Any + Send)) -> String {
    let literal = panicked.downcast_ref::<&str>().map(ToString::to_string);
    let words = literal.or_else(|| panicked.downcast_ref::<String>().cloned());
    words.unwrap_or_else(|| "failed".to_string())
}

/// The bits of numbers: equality that tells -0 from 0 and lets NaN equal itself.
pub fn bits(values: &[f64]) -> Vec<u64> {
    values.iter().map(|value| value.to_bits()).collect()
}

/// Fails at the first number that is not the same to the bit. `per_step` numbers belong to one step.
#[track_caller]
pub fn assert_same_bits(found: &[f64], expected: &[f64], per_step: usize) {
    assert_eq!(found.len(), expected.len(), "numbers");
    let differs = |(a, b): (&f64, &f64)| a.to_bits() != b.to_bits();
    let first = found.iter().zip(expected).position(differs);
    if let Some(index) = first {
        let (step, number) = (index / per_step + 1, index % per_step + 1);
        let (found, expected) = (found[index], expected[index]);
        panic!("step {step}, number {number}: {found:?}, expected {expected:?}");
    }
}
