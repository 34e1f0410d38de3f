//! What an FMU can run on.

/// A platform that binaries can be packed for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Platform {
    /// x86-64 Linux.
    Linux64,
    /// x86-64 Windows.
    Win64,
    /// macOS, both processors in one file.
    Darwin64,
    /// 64-bit ARM Linux, for which FMI 2.0 has no name: it carries that of FMI 3.0.
    Aarch64Linux,
}

impl Platform {
    /// All of them.
    pub const ALL: [Platform; 4] = [
        Platform::Linux64,
        Platform::Win64,
        Platform::Darwin64,
        Platform::Aarch64Linux,
    ];

    /// The platform this program runs on, where it is one of ours.
    pub fn native() -> Option<Platform> {
        match (std::env::consts::OS, std::env::consts::ARCH) {
            ("linux", "x86_64") => Some(Platform::Linux64),
            ("linux", "aarch64") => Some(Platform::Aarch64Linux),
            ("windows", "x86_64") => Some(Platform::Win64),
            ("macos", "x86_64" | "aarch64") => Some(Platform::Darwin64),
            _ => None,
        }
    }

    /// The platform with this folder name.
    pub fn named(folder: &str) -> Option<Platform> {
        let mut all = Platform::ALL.into_iter();
        all.find(|platform| platform.folder() == folder)
    }

    /// The folder under `binaries/`.
    pub fn folder(self) -> &'static str {
        match self {
            Platform::Linux64 => "linux64",
            Platform::Win64 => "win64",
            Platform::Darwin64 => "darwin64",
            Platform::Aarch64Linux => "aarch64-linux",
        }
    }

    /// The ending of a shared library's file name.
    pub fn library_extension(self) -> &'static str {
        match self {
            Platform::Linux64 | Platform::Aarch64Linux => "so",
            Platform::Win64 => "dll",
            Platform::Darwin64 => "dylib",
        }
    }

    /// What cargo puts before the name of a shared library.
    pub(crate) fn library_prefix(self) -> &'static str {
        if self == Platform::Win64 { "" } else { "lib" }
    }

    /// The compiler's names for what the binary has to contain.
    pub fn targets(self) -> &'static [&'static str] {
        match self {
            Platform::Linux64 => &["x86_64-unknown-linux-gnu"],
            Platform::Win64 => &["x86_64-pc-windows-gnu"],
            Platform::Darwin64 => &["x86_64-apple-darwin", "aarch64-apple-darwin"],
            Platform::Aarch64Linux => &["aarch64-unknown-linux-gnu"],
        }
    }

    /// Whether its binary is linked by zig, from the Python registry, on this machine.
    pub fn needs_zig(self) -> bool {
        match self {
            Platform::Linux64 | Platform::Aarch64Linux => true,
            Platform::Darwin64 => !cfg!(target_os = "macos"),
            Platform::Win64 => false,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_platform_is_found_by_its_folder() {
        for platform in Platform::ALL {
            assert_eq!(Platform::named(platform.folder()), Some(platform));
        }
        assert_eq!(Platform::named("linux32"), None);
    }
}
