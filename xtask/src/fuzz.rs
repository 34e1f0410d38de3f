//! `cargo xtask fuzz`: random calls, states and model files for as long as one likes.

use crate::importers::Importers;
use crate::shell;

/// `--seconds N` (60) and `--seed S` (0), the first seed.
pub fn command(arguments: &[&str]) -> Result<(), String> {
    let (mut seconds, mut seed) = (60, 0);
    let mut rest = arguments;
    while let [option, value, others @ ..] = rest {
        let number = value
            .parse::<u64>()
            .map_err(|_| format!("{option} needs a whole number, found {value}"))?;
        match *option {
            "--seconds" => seconds = number,
            "--seed" => seed = number,
            other => return Err(format!("unknown option {other}: --seconds N, --seed S")),
        }
        rest = others;
    }
    if let [word] = rest {
        return Err(format!("{word} needs a number: --seconds N, --seed S"));
    }
    let importers = Importers::prepare()?;
    let (seconds, seed) = (seconds.to_string(), seed.to_string());
    let run = [
        "run",
        "--release",
        "--quiet",
        "--package",
        "importers",
        "--bin",
        "fuzz",
        "--",
    ];
    let arguments: Vec<&str> = run.into_iter().chain([&*seconds, &*seed]).collect();
    shell::run(&mut importers.cargo(&arguments)?)
}
