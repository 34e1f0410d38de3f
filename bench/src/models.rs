//! The models that are measured, as texts of model files.

use std::path::{Path, PathBuf};

/// The folder of the workspace.
pub fn workspace() -> PathBuf {
    let bench = PathBuf::from(env!("CARGO_MANIFEST_DIR"));
    bench.parent().map_or_else(|| bench.clone(), PathBuf::from)
}

/// A number of lateral and torsional modes of each rotor.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Modes {
    /// Lateral modes in each plane.
    pub lateral: usize,
    /// Torsional modes, the rigid rotation included.
    pub torsional: usize,
}

/// Those of the paper, and those that the example needs at its mesh frequency.
pub const MODES: [Modes; 2] = [
    Modes {
        lateral: 3,
        torsional: 3,
    },
    Modes {
        lateral: 10,
        torsional: 8,
    },
];

impl core::fmt::Display for Modes {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.pad(&format!("{}/{}", self.lateral, self.torsional))
    }
}

/// A text file of the workspace.
pub fn read(path: impl AsRef<Path>) -> String {
    let path = workspace().join(path);
    std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

/// The paper's example with its own excitation.
pub fn three_stage(modes: Modes) -> String {
    let Modes { lateral, torsional } = modes;
    read("examples/three_stage.toml")
        .replace("lateral_modes = 3", &format!("lateral_modes = {lateral}"))
        .replace(
            "torsional_modes = 3",
            &format!("torsional_modes = {torsional}"),
        )
}

/// The example with gearbox vibration and large imbalance: case 4 of the paper.
pub fn case_four(modes: Modes) -> String {
    three_stage(modes)
        .replace("moment = 5.0e-6", "moment = 1.5e-4")
        .replace("amplitude_x = 0.0", "amplitude_x = 25e-6")
        .replace("amplitude_y = 0.0", "amplitude_y = 25e-6")
}

/// The same train 1.3 % slower: the mesh period has no common multiple with anybody's communication step.
pub fn odd_speed(text: &str) -> String {
    text.replace("speed = 314.1592653589793", "speed = 310.1487")
        .replace("speed = -314.1592653589793", "speed = -310.1487")
}
