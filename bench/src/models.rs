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

/// How the meshes of a chain stand to each other.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Phases {
    /// All pass the same phase at the same time.
    Together,
    /// Each is a little ahead of the one before, by a multiple of a hundredth of the mesh period.
    Apart,
    /// As before, by a number that fits no communication step.
    Anywhere,
}

/// Shafts in a row, each in mesh with the next one: the first drives, the last is braked, those between are idlers. Mesh
/// period 2 ms.
pub fn chain(rotors: usize, modes: Modes, phases: Phases) -> String {
    let Modes { lateral, torsional } = modes;
    let mut text = format!(
        "kind = \"gear_train\"\nname = \"chain\"\n\
         [basis]\nlateral_modes = {lateral}\ntorsional_modes = {torsional}\nstatic_shapes = false\n\
         [material.default]\nyoungs_modulus = 2.1e11\npoisson_ratio = 0.3\ndensity = 7800.0\n"
    );
    let sign = |rotor: usize| if rotor.is_multiple_of(2) { 1 } else { -1 };
    for rotor in 0..rotors {
        // 500 teeth per second.
        let speed = f64::from(sign(rotor)) * core::f64::consts::TAU * 500.0 / 24.0;
        text += &format!(
            "[[rotor]]\nname = \"shaft{rotor}\"\nspeed = {speed}\nmax_element_length = 0.1\n\
             lateral_damping_ratio = 0.01\ntorsional_damping_ratio = 0.01\n\
             [[rotor.segment]]\nlength = 0.4\nouter_diameter = 0.05\n\
             [[rotor.gear]]\nname = \"gear\"\nposition = 0.25\nteeth = 24\nbase_radius = 0.07\n\
             mass = 5.0\npolar_inertia = 0.015\ndiametral_inertia = 0.008\n\
             [[rotor.bearing]]\nname = \"left\"\nposition = 0.05\n\
             stiffness = {{ xx = 8e7, yy = 6e7 }}\ndamping = {{ xx = 900.0 }}\n\
             [[rotor.bearing]]\nname = \"right\"\nposition = 0.35\n\
             stiffness = {{ xx = 9e7, yy = 7e7 }}\ndamping = {{ xx = 700.0 }}\n\
             [[rotor.unbalance]]\nname = \"unbalance\"\nposition = 0.25\nmoment = 2e-4\nphase = {}\n",
            0.4 * rotor as f64
        );
        let torque = match rotor {
            0 => 400,
            _ if rotor + 1 == rotors => -400 * sign(rotor),
            _ => continue,
        };
        text += &format!(
            "[[rotor.torque]]\nname = \"port\"\nposition = 0.0\nvalue = {torque}\nslope = 1.0\n"
        );
    }
    for mesh in 1..rotors {
        let ahead = match phases {
            Phases::Together => 0.0,
            Phases::Apart => 0.07,
            Phases::Anywhere => 0.0737,
        };
        let phase = ahead * mesh as f64 % 1.0;
        text += &format!(
            "[[mesh]]\nname = \"mesh{mesh}\"\ngears = [\"shaft{}.gear\", \"shaft{mesh}.gear\"]\n\
             center_angle = 0.3\npressure_angle = 0.35\nflank = {}\ndamping_ratio = 0.05\nphase = {phase}\n\
             [mesh.stiffness]\nlaw = \"tooth_pair\"\npair = 3e8\nquadratic = 0.4\nquartic = 0.0\nramp = 0.1\ncontact_ratio = 1.6\n",
            mesh - 1,
            sign(mesh - 1),
        );
    }
    text
}
