//! Many simulations in one process. Alone in its test binary: it looks at the memory of the process.

use std::sync::{Arc, Mutex, PoisonError};

use importers::{Fmu, Host};

/// Resident memory of this process [bytes].
fn resident_memory() -> usize {
    const PAGE: usize = 4096;
    let line = std::fs::read_to_string("/proc/self/statm").expect("Linux tells");
    let pages = line
        .split_whitespace()
        .nth(1)
        .expect("the second number is the resident size");
    pages.parse::<usize>().expect("a number") * PAGE
}

/// Two tests at once would count each other's memory.
static ALONE: Mutex<()> = Mutex::new(());

/// Loads, instantiates, runs, frees and unloads, `count` times.
fn simulate(fmu: &Arc<Fmu>, count: usize) {
    for _ in 0..count {
        let host = Host::load(fmu);
        host.running().steps(0, 5);
    }
}

#[test]
#[cfg_attr(not(target_os = "linux"), ignore = "reads /proc")]
fn a_thousand_simulations_leave_no_memory_behind() {
    let _alone = ALONE.lock().unwrap_or_else(PoisonError::into_inner);
    // Importers crashed after about 1,020 simulations in one process (FMPy #110, #140).
    let fmu = Arc::new(Fmu::unpack("three_stage"));
    simulate(&fmu, 100);
    let before = resident_memory();
    simulate(&fmu, 1000);
    let growth = resident_memory().saturating_sub(before);
    // 1,000 instances that were not freed take 230 MB, the allocator's whims far less than 10 MB.
    assert!(growth < 10_000_000, "{growth} bytes more");
}

#[test]
#[cfg_attr(not(target_os = "linux"), ignore = "reads /proc")]
fn a_thousand_simulations_each_from_a_folder_of_its_own_leave_no_memory_behind() {
    let _alone = ALONE.lock().unwrap_or_else(PoisonError::into_inner);
    // As FMPy's simulate_fmu: it unpacks the FMU anew each time, which is another library to the loader.
    let unpack_and_simulate = |count| {
        for _ in 0..count {
            simulate(&Arc::new(Fmu::unpack("three_stage")), 1);
        }
    };
    unpack_and_simulate(100);
    let before = resident_memory();
    unpack_and_simulate(1000);
    let growth = resident_memory().saturating_sub(before);
    assert!(growth < 10_000_000, "{growth} bytes more");
}
