//! What a model file says, as plain data in SI units: nothing resolved, nothing checked.
//!
//! ```text
//!   model.toml --read--> Config --validate--> train::GearTrain --assemble--> model::ModalModel
//!                          ^
//!                          └ FMI parameters are written here too; leaving initialization assembles anew
//! ```
//!
//! The binary form of a [`Config`] ([`Config::to_bytes`]) is what an FMU carries inside its library.
//! Rules (ranges, references, consistency) belong to [`crate::train`]; this module only knows which
//! keys exist, their types, units and defaults. Keys and defaults: `docs/model-file.md`.

mod dimension;
mod document;
mod housing;
mod mesh;
mod place;
mod quantity;
mod read;
mod rotor;
mod spot;
mod tooth_geometry;

use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

pub use housing::{Connection, Housing, HousingMode, HousingPoint, Kind, KnownBearing};
pub use mesh::{Contact, ErrorHarmonic, Flank, Mesh, MeshDamping, MeshStiffness, TorqueCoupling};
pub use place::{Place, Problem};
pub use read::{Files, Reading, read};
pub use rotor::{
    BaseCircle, BasisSupport, Bearing, Bow, Disk, Gear, OutsideSpeeds, Planar, Probe, RadialForce,
    Rotor, Segment, SpeedPoint, SpeedTable, Torque, Unbalance,
};
pub use spot::{Lines, Spot};
pub use tooth_geometry::ToothGeometry;

/// One model file.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Config {
    /// What the file describes.
    pub kind: Kind,
    /// FMI modelIdentifier and file name; a C identifier.
    pub name: String,
    /// One line for people.
    pub description: String,
    /// How the time simulation starts and runs.
    pub simulation: Simulation,
    /// What represents each rotor; the default basis when absent.
    pub basis: Option<Basis>,
    /// Materials by name; `default` is used where a segment names none.
    pub materials: BTreeMap<String, Material>,
    /// The shafts with everything on them.
    pub rotors: Vec<Rotor>,
    /// The gear meshes between them.
    pub meshes: Vec<Mesh>,
    /// Sinusoidal motion of all bearing supports, added to the inputs.
    pub gearbox_vibration: GearboxVibration,
    /// The structure around the rotors, or the one that is all.
    pub housing: Option<Housing>,
}

/// `[simulation]`: how the time simulation starts and runs.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Simulation {
    /// What the mean rotation follows.
    pub speed: SpeedMode,
    /// How time is integrated.
    pub solver: SolverChoice,
    /// State at the start time.
    pub start: Start,
    /// Bound on the RMS error of every mesh force over a run, relative to that force's RMS.
    /// [1e-12, 0.1]
    pub tolerance: f64,
    /// How far inputs are continued through steps for which the master gives no derivatives: 1 wholly, 0 not at all. [0, 1]
    pub input_extrapolation: f64,
    /// How far forces on a housing follow its motion within a step through the bearings that its points name: 1 wholly, 0 not at
    /// all. [0, 1]
    pub known_bearings: f64,
    /// Default end of a simulation [s]. > 0
    pub stop_time: f64,
    /// Default communication step [s]. > 0
    pub step_size: f64,
}

/// What the mean rotation follows.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum SpeedMode {
    /// Constant mean speeds; torsion is a vibration on top of them.
    Prescribed,
    /// The torques: the rigid rotation is a state.
    Free,
}

/// How time is integrated.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum SolverChoice {
    /// Exponential collocation: shafts and bearings exactly, forces between them by polynomials.
    Exponential,
    /// The integrator of the paper.
    Newmark,
}

/// State at the start time.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Start {
    /// Static solution under the torques and housing displacements set during initialization.
    Equilibrium,
    /// No deformation, no velocity.
    Rest,
}

/// `[basis]`: what represents each rotor.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Basis {
    /// The modes; every mode up to the default frequency when absent.
    pub modes: Option<BasisModes>,
    /// Whether the deflections under unit loads at gears, bearings and torques are added.
    pub static_shapes: bool,
}

/// Which modes represent each rotor.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub enum BasisModes {
    /// The same number of modes for every rotor.
    Counts {
        /// Modes per lateral plane. >= 1
        lateral_modes: usize,
        /// Torsional modes; the rigid rotation counts as one of them. >= 1
        torsional_modes: usize,
    },
    /// Every mode at or below this frequency [Hz], at least two lateral ones and the rigid rotation. > 0
    MaxFrequency(f64),
}

/// `[material.NAME]`: an isotropic elastic material.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Material {
    /// Young's modulus E [Pa]. > 0
    pub youngs_modulus: f64,
    /// Poisson's ratio nu. (-1, 0.5]
    pub poisson_ratio: f64,
    /// Density rho [kg/m^3]. > 0
    pub density: f64,
}

/// `[gearbox_vibration]`: sinusoidal motion of all bearing supports.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct GearboxVibration {
    /// Amplitude in x [m].
    pub amplitude_x: f64,
    /// Amplitude in y [m].
    pub amplitude_y: f64,
    /// Phase of y ahead of x [rad].
    pub phase_y: f64,
    /// Frequency [Hz]. >= 0
    pub frequency: f64,
}

impl Config {
    /// The binary form that is embedded in an FMU: exact, and the same bytes for the same model.
    pub fn to_bytes(&self) -> Vec<u8> {
        postcard::to_allocvec(self).expect("plain data in memory always serializes")
    }

    /// Reads the form written by [`Config::to_bytes`]; `None` when the bytes are not one.
    pub fn from_bytes(bytes: &[u8]) -> Option<Config> {
        match postcard::take_from_bytes(bytes) {
            Ok((config, [])) => Some(config),
            _ => None,
        }
    }
}
