//! Where the host runs, and with what it is compiled.

use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::{Mutex, OnceLock, PoisonError};

use fmu_build::{OLDEST_GLIBC, Platform};

use crate::{Packed, named};

/// A machine that is here, or that is played here.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Machine {
    /// This one.
    Linux,
    /// This one, with FMPy (`run.py`) in place of the host.
    FmPy,
    /// The files of a Debian 11 (glibc 2.31), as root folder of a process of this kernel.
    OldLinux,
    /// Windows' functions by wine.
    Wine,
    /// A 64-bit ARM processor by qemu.
    Arm,
}

impl Machine {
    /// All of them.
    pub const ALL: [Machine; 5] = [
        Machine::Linux,
        Machine::FmPy,
        Machine::OldLinux,
        Machine::Wine,
        Machine::Arm,
    ];

    /// Which of the FMU's binaries it loads.
    pub fn platform(self) -> Platform {
        match self {
            Machine::Linux | Machine::FmPy | Machine::OldLinux => Platform::Linux64,
            Machine::Wine => Platform::Win64,
            Machine::Arm => Platform::Aarch64Linux,
        }
    }

    /// Runs an FMU for so many steps of so many nanoseconds and gives all that it computed: the bytes of some values
    /// and of a saved state.
    ///
    /// # Panics
    ///
    /// Panics with what the host says where anything does not work.
    pub fn run(self, fmu: &Packed, nanoseconds: usize, steps: usize) -> Vec<u8> {
        let platform = self.platform();
        let extension = platform.library_extension();
        let folder = self.folder(&format!("{}-{steps}", fmu.name));
        std::fs::create_dir_all(&folder).expect("a folder");
        let library = format!("{}.{extension}", fmu.name);
        std::fs::write(folder.join(&library), fmu.library(platform)).expect("the library");
        std::fs::copy(host(platform), folder.join("run.exe")).expect("the host");

        let mut command = self.command(&folder);
        match self {
            Machine::FmPy => command.arg(fmu.path()),
            _ => command.arg(format!("./{library}")),
        };
        command
            .arg(fmu.guid())
            .args([nanoseconds.to_string(), steps.to_string()])
            .args([fmu.moving_inputs().join(","), fmu.variables().join(",")])
            .arg("results");
        // The first start of wine sets up its folder, which two at once cannot.
        let _alone =
            (self == Machine::Wine).then(|| WINE.lock().unwrap_or_else(PoisonError::into_inner));
        let output = command.output();
        let output = output.unwrap_or_else(|error| panic!("{command:?}: {error}"));
        let said = String::from_utf8_lossy(&output.stderr);
        assert!(
            output.status.success(),
            "{self:?}: {} {said}",
            output.status
        );
        let results = folder.join("results");
        let bytes = std::fs::read(&results).expect("results");
        std::fs::remove_file(&results).expect("the file just read");
        bytes
    }

    /// A folder of its own for a run, so that tests can run at the same time.
    fn folder(self, name: &str) -> PathBuf {
        let root = match self {
            Machine::OldLinux => named("GEARTRAIN_OLD_LINUX"),
            _ => named("GEARTRAIN_PLATFORMS"),
        };
        root.join("runs").join(format!("{self:?}")).join(name)
    }

    /// What starts `run.exe` in the folder.
    fn command(self, folder: &Path) -> Command {
        let mut command;
        match self {
            Machine::Linux => command = Command::new("./run.exe"),
            Machine::FmPy => {
                command = Command::new(named("GEARTRAIN_PYTHON"));
                command.arg(concat!(env!("CARGO_MANIFEST_DIR"), "/run.py"));
            }
            Machine::OldLinux => {
                let root = named("GEARTRAIN_OLD_LINUX");
                let inside = Path::new("/").join(folder.strip_prefix(&root).expect("inside"));
                command = Command::new("chroot");
                command
                    .arg(root)
                    .args(["/bin/sh", "-c", "cd \"$0\" && exec ./run.exe \"$@\""])
                    .arg(inside);
            }
            Machine::Wine => {
                command = Command::new("wine");
                command
                    .arg("run.exe")
                    .env("WINEPREFIX", named("GEARTRAIN_WINE"))
                    .env("WINEDEBUG", "-all");
            }
            Machine::Arm => {
                command = Command::new("qemu-aarch64");
                command.args(["-L", "/usr/aarch64-linux-gnu", "./run.exe"]);
            }
        }
        command.current_dir(folder);
        command
    }
}

static WINE: Mutex<()> = Mutex::new(());

/// The compiled host.
fn host(platform: Platform) -> PathBuf {
    static HOSTS: [OnceLock<PathBuf>; 4] = [const { OnceLock::new() }; 4];
    HOSTS[platform as usize]
        .get_or_init(|| compile(platform))
        .clone()
}

fn compile(platform: Platform) -> PathBuf {
    let mut compiler = if platform == Platform::Win64 {
        Command::new("x86_64-w64-mingw32-gcc")
    } else {
        let target = match platform {
            Platform::Aarch64Linux => "aarch64-linux-gnu",
            _ => "x86_64-linux-gnu",
        };
        let mut zig = Command::new(named("GEARTRAIN_ZIG").join("python-zig"));
        zig.args(["cc", "-target", &format!("{target}.{OLDEST_GLIBC}")]);
        zig
    };
    let host = named("GEARTRAIN_PLATFORMS").join(format!("run-{}.exe", platform.folder()));
    let output = compiler
        .args(["-std=c11", "-Wall", "-Wextra", "-Werror", "-O1"])
        .arg("-ffp-contract=off")
        .arg(concat!(env!("CARGO_MANIFEST_DIR"), "/c/run.c"))
        .arg("-o")
        .arg(&host)
        .output();
    let output = output.unwrap_or_else(|error| panic!("{compiler:?}: {error}"));
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{said}");
    host
}
