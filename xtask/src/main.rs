//! The project's commands: `cargo xtask <command>`. Parses, calls, prints.

#![allow(clippy::print_stdout, clippy::print_stderr)] // a command line talks

mod bench;
mod couple;
mod coupling;
mod demo;
mod fuzz;
mod golden;
mod icon;
mod importers;
mod inspect;
mod merge;
mod model_file;
mod new;
mod pack;
mod platforms;
mod python;
mod shell;
mod test;
mod validation;

use std::path::PathBuf;
use std::process::ExitCode;

const HELP: &str = "\
cargo xtask <command>

  new NAME                        write NAME.toml, a commented two-shaft reducer to start from
  fmu MODEL.toml... [--platform linux64,win64,darwin64,aarch64-linux] [--out DIR]
                                  pack FMUs for this machine, or to be given away for the platforms named
                                  (default folder: target/fmu)
  merge A.fmu B.fmu... [--out DIR]
                                  one FMU from those of the same model, packed on different machines
  inspect MODEL.toml [--html [--out DIR] | --format json] [--speeds FROM:TO:COUNT[:x|rpm|rad/s]]
                                  what a model file describes: frequencies, critical speeds, whether the
                                  modes kept are enough, communication step; --html: one page with pictures
                                  (default folder: target/inspect)
  couple TRAIN.toml HOUSING.toml [--out DIR] [--connect ROTOR.BEARING=POINT]...
                                  a gear train and a housing, told of the bearings on it, as a pair of FMUs with an
                                  .ssp file, as one FMU for comparison, and a script that runs them (default
                                  folder: target/couple/NAME)
  demo                            pack examples/three_stage.toml, run the paper's four cases through FMPy, write
                                  Table I, figures 3 to 16 of the paper and CSV files to target/demo
  test                            everything: formatting, lints, Rust tests, packed FMUs in real importers
  platforms                       FMUs for all platforms, run on a Debian 11, under wine and qemu and compared to the bit
  fuzz [--seconds N] [--seed S]   random calls, states and model files for N seconds (60); a failure names its seed
  bench [solvers|masters|start|chains|accuracy|trains]... [--record]
                                  how fast it is: our solvers against others at the same error, a communication
                                  step through the C interface, starting an instance, growth with the number of
                                  rotors, error over tolerance; --record puts all tables into docs/performance.md
  validation                      measure the paper's claims anew, write their tables into docs/validation.md
  coupling                        measure ways to couple the example with its housing anew (4 minutes), write
                                  their errors and stability limits into docs/coupling.md
  golden                          regenerate modelDescription/modelDescription.xml; review its diff
";

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let words: Vec<&str> = arguments.iter().map(String::as_str).collect();
    let outcome = match words.as_slice() {
        ["fmu", rest @ ..] => pack::command(rest),
        ["new", rest @ ..] => new::command(rest),
        ["merge", rest @ ..] => merge::command(rest),
        ["inspect", rest @ ..] => inspect::command(rest),
        ["couple", rest @ ..] => couple::command(rest),
        ["demo"] => demo::command(),
        ["test"] => test::command(),
        ["platforms"] => platforms::command(),
        ["fuzz", rest @ ..] => fuzz::command(rest),
        ["bench", parts @ ..] => bench::command(parts),
        ["coupling"] => coupling::command(),
        ["golden"] => golden::command(),
        ["validation"] => validation::command(),
        [] | ["help" | "--help" | "-h"] => {
            print!("{HELP}");
            Ok(())
        }
        other => Err(format!("unknown command: {}\n\n{HELP}", other.join(" "))),
    };
    match outcome {
        Ok(()) => ExitCode::SUCCESS,
        Err(message) => {
            eprintln!("{message}");
            ExitCode::FAILURE
        }
    }
}

/// The folder of the workspace.
fn workspace() -> PathBuf {
    let xtask = PathBuf::from(env!("CARGO_MANIFEST_DIR"));
    xtask.parent().map_or_else(|| xtask.clone(), PathBuf::from)
}
