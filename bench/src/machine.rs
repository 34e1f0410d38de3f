//! What a measurement belongs to: machine, compiler, version.

use std::process::Command;

use crate::models::workspace;

/// One line for the head of the tables.
pub fn line() -> String {
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    let compiler = said(Command::new("rustc").arg("--version"));
    let commit = said(Command::new("git").args(["describe", "--always", "--dirty", "--abbrev=10"]));
    let version = env!("CARGO_PKG_VERSION");
    format!(
        "{cores} cores, {}; {compiler}; geartrain {version}, commit {commit}",
        processor()
    )
}

fn processor() -> String {
    let information = std::fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let name = information.lines().find_map(|line| {
        let (key, value) = line.split_once(':')?;
        (key.trim() == "model name").then(|| value.trim().to_string())
    });
    name.unwrap_or_else(|| std::env::consts::ARCH.to_string())
}

/// What a program prints, without spaces around it.
fn said(program: &mut Command) -> String {
    let output = program.current_dir(workspace()).output();
    let text = output.map(|output| String::from_utf8_lossy(&output.stdout).trim().to_string());
    text.ok()
        .filter(|text| !text.is_empty())
        .unwrap_or_else(|| "unknown".to_string())
}
