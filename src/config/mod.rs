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
//! keys exist, their types and their defaults. Keys and defaults: `docs/model-file.md`.

mod document;
mod mesh;
mod place;
mod read;

use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

pub use document::Lines;
pub use mesh::{Flank, Mesh, MeshDamping, MeshStiffness, TorqueCoupling};
pub use place::{Place, Problem};
pub use read::{Reading, read};

/// One model file.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Config {
    /// FMI modelIdentifier and file name; a C identifier.
    pub name: String,
    /// One line for people.
    pub description: String,
    /// How the time simulation starts and runs.
    pub simulation: Simulation,
    /// Which modes represent each rotor.
    pub basis: Basis,
    /// Materials by name; `default` is used where a segment names none.
    pub materials: BTreeMap<String, Material>,
    /// The shafts with everything on them.
    pub rotors: Vec<Rotor>,
    /// The gear meshes between them.
    pub meshes: Vec<Mesh>,
    /// Sinusoidal motion of all bearing supports, added to the inputs.
    pub gearbox_vibration: GearboxVibration,
}

/// `[simulation]`: how the time simulation starts and runs.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Simulation {
    /// State at the start time.
    pub start: Start,
    /// Bound on the RMS error of every mesh force over a run, relative to that force's RMS.
    /// [1e-12, 0.1]
    pub tolerance: f64,
    /// Default end of a simulation [s]. > 0
    pub stop_time: f64,
    /// Default communication step [s]. > 0
    pub step_size: f64,
}

/// State at the start time.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Start {
    /// Static solution under the torques and housing displacements set during initialization.
    Equilibrium,
    /// No deformation, no velocity.
    Rest,
}

/// `[basis]`: which modes represent each rotor.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum Basis {
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

/// `[[rotor]]`: one shaft and everything on it. Positions are distances from the left end [m].
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Rotor {
    /// Unique identifier.
    pub name: String,
    /// Mean speed, positive about +z [rad/s]. At most 1e6 either way
    pub speed: f64,
    /// Rotation angle at time 0 [rad].
    pub angle: f64,
    /// Longest finite element [m]; a twentieth of the shaft when absent. > 0
    pub max_element_length: Option<f64>,
    /// Modal damping ratio of all elastic lateral modes. >= 0
    pub lateral_damping_ratio: f64,
    /// Modal damping ratio of all elastic torsional modes. >= 0
    pub torsional_damping_ratio: f64,
    /// Shaft sections from left to right.
    pub segments: Vec<Segment>,
    /// Rigid disks without teeth.
    pub disks: Vec<Disk>,
    /// Gears.
    pub gears: Vec<Gear>,
    /// Bearings to the gearbox.
    pub bearings: Vec<Bearing>,
    /// Mass unbalances.
    pub unbalances: Vec<Unbalance>,
    /// Places where an external torque acts.
    pub torques: Vec<Torque>,
    /// Nominal supports used to compute the modes only.
    pub basis_supports: Vec<BasisSupport>,
    /// Further places where displacement is output.
    pub probes: Vec<Probe>,
}

/// `[[rotor.segment]]`: a cylindrical shaft section.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Segment {
    /// Length [m]. > 0
    pub length: f64,
    /// Outer diameter [m]. > inner diameter
    pub outer_diameter: f64,
    /// Inner diameter [m]. >= 0
    pub inner_diameter: f64,
    /// Name of the material.
    pub material: String,
}

/// Position and inertia shared by disks and gears: a thin rigid body on the shaft.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Disk {
    /// Distance from the shaft's left end [m].
    pub position: f64,
    /// Mass [kg]. >= 0
    pub mass: f64,
    /// Moment of inertia about the shaft axis [kg m^2]. >= 0
    pub polar_inertia: f64,
    /// Moment of inertia about a diameter [kg m^2]. >= 0
    pub diametral_inertia: f64,
}

/// `[[rotor.gear]]`: a disk with teeth.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Gear {
    /// Unique identifier on its rotor.
    pub name: String,
    /// The gear as a rigid body.
    pub body: Disk,
    /// Number of teeth. >= 1
    pub teeth: u32,
    /// Size of the base circle.
    pub base: BaseCircle,
}

/// The base circle of a gear, given directly or by the reference rack.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub enum BaseCircle {
    /// Base radius R [m]. > 0
    Radius(f64),
    /// R = teeth x module x cos(pressure angle) / 2.
    Rack {
        /// Module [m]. > 0
        module: f64,
        /// Reference pressure angle [rad]. (0, pi/2)
        pressure_angle: f64,
    },
}

/// `[[rotor.bearing]]`: a linear spring and damper between shaft and gearbox.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Bearing {
    /// Unique identifier on its rotor.
    pub name: String,
    /// Distance from the shaft's left end [m].
    pub position: f64,
    /// Stiffness [N/m]; direct terms >= 0.
    pub stiffness: Planar,
    /// Damping [N s/m].
    pub damping: Planar,
}

/// A 2 x 2 coefficient matrix in the x-y plane: force in the first direction per motion in the second.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Planar {
    /// x force per x motion.
    pub xx: f64,
    /// x force per y motion.
    pub xy: f64,
    /// y force per x motion.
    pub yx: f64,
    /// y force per y motion.
    pub yy: f64,
}

/// `[[rotor.unbalance]]`: an eccentric mass turning with the shaft.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Unbalance {
    /// Unique identifier on its rotor.
    pub name: String,
    /// Distance from the shaft's left end [m].
    pub position: f64,
    /// Mass times eccentricity m e [kg m]. >= 0
    pub moment: f64,
    /// Direction relative to the shaft's rotation angle [rad].
    pub phase: f64,
}

/// `[[rotor.torque]]`: a place where an external torque acts.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Torque {
    /// Unique identifier on its rotor.
    pub name: String,
    /// Distance from the shaft's left end [m].
    pub position: f64,
    /// Start value of the torque input [N m].
    pub value: f64,
    /// Resisting torque per angular velocity relative to the mean rotation [N m s/rad]. >= 0
    pub slope: f64,
}

/// `[[rotor.basis_support]]`: a spring to ground used to compute the modes and subtracted again.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct BasisSupport {
    /// Distance from the shaft's left end [m].
    pub position: f64,
    /// Lateral stiffness in both planes [N/m]. >= 0
    pub lateral: f64,
    /// Torsional stiffness [N m/rad]. >= 0
    pub torsional: f64,
}

/// `[[rotor.probe]]`: a further place where displacement is output.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Probe {
    /// Unique identifier on its rotor.
    pub name: String,
    /// Distance from the shaft's left end [m].
    pub position: f64,
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

impl Planar {
    /// The coefficients as rows: `[[xx, xy], [yx, yy]]`.
    pub fn rows(&self) -> [[f64; 2]; 2] {
        [[self.xx, self.xy], [self.yx, self.yy]]
    }
}

impl BaseCircle {
    /// Base radius R [m] of a gear with this number of teeth.
    pub fn radius(&self, teeth: u32) -> f64 {
        match *self {
            BaseCircle::Radius(radius) => radius,
            BaseCircle::Rack {
                module,
                pressure_angle,
            } => f64::from(teeth) * module * libm::cos(pressure_angle) / 2.0,
        }
    }
}
