//! The ODE crate diffsol, in the program `bench/diffsol`.

use std::process::Command;

use super::elsewhere::ask;
use crate::contest::{SAMPLES, SPAN};
use crate::problem::Run;

/// The variable that names the program.
pub const PROGRAM: &str = "GEARTRAIN_BENCH_DIFFSOL";

/// One of its methods: `bdf`, `tr_bdf2` or `tsit45`.
pub fn run(text: &str, method: &str, tolerance: f64) -> Result<Run, String> {
    let program = std::env::var_os(PROGRAM).ok_or("skipped: diffsol was not built")?;
    let numbers = [
        format!("{tolerance:e}"),
        format!("{SPAN}"),
        format!("{SAMPLES}"),
    ];
    ask(Command::new(program).arg(method).args(numbers), text)
}
