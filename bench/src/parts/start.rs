//! What an instance costs before its first step: time, memory, the size of its library.

use std::time::Instant;

use crate::clock::median;
use crate::fmu::Fmu;
use crate::models::{MODES, three_stage};
use crate::table::Table;

/// Instances whose memory is measured together, and starts whose times are.
const INSTANCES: usize = 200;
const STARTS: usize = 101;

/// Measures and prints.
pub fn run() -> Result<(), String> {
    println!(
        "Before the first step, through the C interface: three_stage. Time from fmi2Instantiate to the end of\n\
         fmi2ExitInitializationMode, median of {STARTS}; resident memory, difference over {INSTANCES} instances that have made a step.\n"
    );
    let mut table = Table::new(&["modes", "ms to start", "kB per instance", "kB of library"]);
    for modes in MODES {
        let fmu = Fmu::of(&three_stage(modes))?;
        let start = |_| {
            let clock = Instant::now();
            fmu.instantiate().initialize();
            1e3 * clock.elapsed().as_secs_f64()
        };
        let milliseconds = median((0..STARTS).map(start).collect());
        table.row(vec![
            modes.to_string(),
            format!("{milliseconds:.2}"),
            memory(&fmu).map_or("?".to_string(), |kilobytes| format!("{kilobytes:.0}")),
            format!("{:.0}", fmu.bytes() as f64 / 1e3),
        ]);
    }
    table.print();
    Ok(())
}

/// Resident memory of one instance [kB]; nothing where the system does not tell.
fn memory(fmu: &Fmu) -> Option<f64> {
    let running = || {
        let slave = fmu.instantiate();
        slave.initialize();
        slave.step(0.0, 2e-5);
        slave
    };
    let first = running();
    let before = resident()?;
    let instances: Vec<_> = (0..INSTANCES).map(|_| running()).collect();
    let after = resident()?;
    drop((first, instances));
    Some((after - before) / INSTANCES as f64)
}

/// Resident memory of this process [kB], from Linux.
fn resident() -> Option<f64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find(|line| line.starts_with("VmRSS:"))?;
    line.split_whitespace().nth(1)?.parse().ok()
}
