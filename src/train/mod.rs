//! A gear train that cannot be wrong: names resolved, ranges checked, speeds consistent.
//!
//! The only way to a [`GearTrain`] is [`validate`] (or [`load`], which reads a file first). Everything the
//! floors above assume about a model stands here as a rule with a message; they check nothing again.
//! Knows no modes and no time.

mod basis;
mod bearings;
mod centres;
mod housing;
mod laws;
mod meshes;
mod names;
mod phases;
mod rotors;
mod rules;
mod speeds;
mod tooth_geometry;
mod validate;

use crate::config::{
    self, BasisModes, BasisSupport, Bow, Config, Disk, Files, GearboxVibration, Lines, Material,
    Probe, Problem, Simulation, Torque, TorqueCoupling, Unbalance,
};
use crate::mesh::{LineOfAction, StiffnessLaw, TransmissionError};

pub use bearings::{Bearing, BearingLaw, CoefficientCurves, Coefficients};
pub use centres::centres;
pub use housing::{Housing, HousingMode, HousingPoint};
pub use rotors::SAME_PLACE;
pub use speeds::{SpeedRatio, speed_ratios};
pub use validate::validate;

/// A valid gear train.
#[derive(Debug, Clone, PartialEq)]
pub struct GearTrain {
    /// FMI modelIdentifier.
    pub name: String,
    /// One line for people.
    pub description: String,
    /// How the time simulation starts and runs.
    pub simulation: Simulation,
    /// What represents each rotor.
    pub basis: Basis,
    /// The shafts.
    pub rotors: Vec<Rotor>,
    /// The meshes between them.
    pub meshes: Vec<Mesh>,
    /// Sinusoidal motion of all bearing supports.
    pub gearbox_vibration: GearboxVibration,
    /// The structure around the rotors, or the one that is all.
    pub housing: Option<Housing>,
}

/// What represents each rotor.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Basis {
    /// The modes.
    pub modes: BasisModes,
    /// Whether the deflections under unit loads at gears, bearings and torques are added.
    pub static_shapes: bool,
}

/// One shaft and everything on it.
#[derive(Debug, Clone, PartialEq)]
pub struct Rotor {
    /// Unique name.
    pub name: String,
    /// Mean speed, positive about +z [rad/s].
    pub speed: f64,
    /// Rotation angle at time 0 [rad].
    pub angle: f64,
    /// Longest finite element [m].
    pub max_element_length: f64,
    /// Modal damping ratio of the elastic lateral modes.
    pub lateral_damping_ratio: f64,
    /// Modal damping ratio of the elastic torsional modes.
    pub torsional_damping_ratio: f64,
    /// Shaft sections from left to right.
    pub sections: Vec<Section>,
    /// Rigid disks without teeth.
    pub disks: Vec<Disk>,
    /// Gears.
    pub gears: Vec<Gear>,
    /// Bearings to the gearbox.
    pub bearings: Vec<Bearing>,
    /// Mass unbalances.
    pub unbalances: Vec<Unbalance>,
    /// Residual bows.
    pub bows: Vec<Bow>,
    /// External torques.
    pub torques: Vec<Torque>,
    /// Nominal supports for the basis.
    pub basis_supports: Vec<BasisSupport>,
    /// Further output places.
    pub probes: Vec<Probe>,
}

/// A cylindrical shaft section between two positions.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Section {
    /// Right end [m].
    pub end: f64,
    /// Outer diameter [m].
    pub outer_diameter: f64,
    /// Inner diameter [m].
    pub inner_diameter: f64,
    /// What it is made of.
    pub material: Material,
}

/// A gear as a rigid body with a base circle.
#[derive(Debug, Clone, PartialEq)]
pub struct Gear {
    /// Unique name on its rotor.
    pub name: String,
    /// Position and inertia.
    pub body: Disk,
    /// Number of teeth.
    pub teeth: u32,
    /// Base radius [m].
    pub base_radius: f64,
}

/// A gear by the indices of its rotor and of itself on that rotor.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct GearAddress {
    /// Index into [`GearTrain::rotors`].
    pub rotor: usize,
    /// Index into [`Rotor::gears`].
    pub gear: usize,
}

/// Two gears in contact.
#[derive(Debug, Clone, PartialEq)]
pub struct Mesh {
    /// Unique name.
    pub name: String,
    /// Gear a and gear b.
    pub gears: [GearAddress; 2],
    /// Line of action between them.
    pub line: LineOfAction,
    /// Unilateral contact, with this backlash [m].
    pub backlash: Option<f64>,
    /// Which motions the mesh torque follows.
    pub torque_coupling: TorqueCoupling,
    /// Stiffness over the phase, without the factor.
    pub stiffness: StiffnessLaw,
    /// Scales the stiffness.
    pub stiffness_factor: f64,
    /// Damping c [N s/m].
    pub damping: f64,
    /// Deviation of the unloaded teeth from perfect ones.
    pub transmission_error: TransmissionError,
    /// Phase at time 0, rotation angle of gear a included [pitches].
    pub start_phase: f64,
    /// Change of the phase per rotation angle of gear a: s z_a / 2 pi [pitches/rad].
    pub pitches: f64,
    /// Change of the phase at the mean speed: signed mesh frequency [pitches/s].
    pub phase_rate: f64,
}

/// A model file that was read and found valid.
#[derive(Debug, Clone)]
pub struct Loaded {
    /// What the file says.
    pub config: Config,
    /// What it means.
    pub train: GearTrain,
    /// What is allowed but probably not meant.
    pub warnings: Vec<Problem>,
    /// Where every key stands.
    pub lines: Lines,
}

impl Rotor {
    /// Length of the shaft [m].
    pub fn length(&self) -> f64 {
        self.sections.last().map_or(0.0, |section| section.end)
    }
}

impl GearTrain {
    /// The name of a gear as model files write it: `rotor.gear`.
    pub fn gear_name(&self, address: GearAddress) -> String {
        format!(
            "{}.{}",
            self.rotors[address.rotor].name,
            self.gear(address).name
        )
    }

    /// Whether a bearing stands on the housing in this model; all rotors' bearings count, in their order.
    pub fn is_held(&self, bearing: usize) -> bool {
        let housing = self.housing.as_ref();
        housing.is_some_and(|housing| housing.holds[bearing].is_some())
    }

    /// The gear at an address.
    pub fn gear(&self, address: GearAddress) -> &Gear {
        &self.rotors[address.rotor].gears[address.gear]
    }
}

/// Reads and validates the text of a model file that names no other file; all problems at once, each with its line.
pub fn load(text: &str) -> Result<Loaded, Vec<Problem>> {
    load_beside(text, &no_files)
}

/// No other files are at hand.
pub fn no_files(file: &str) -> Result<String, String> {
    Err(format!("\"{file}\" is not at hand"))
}

/// The same for one that may name others, whose texts `files` gives.
pub fn load_beside(text: &str, files: Files<'_>) -> Result<Loaded, Vec<Problem>> {
    let config::Reading {
        config,
        mut problems,
        lines,
    } = config::read(text, files);
    let Some(config) = config else {
        return Err(problems);
    };
    let located = |mut problem: Problem| {
        problem.spot = lines.find(problem.file.as_deref(), &problem.key);
        problem
    };
    match validate(&config) {
        Ok((train, warnings)) if problems.is_empty() => {
            let warnings = warnings.into_iter().map(located).collect();
            Ok(Loaded {
                lines,
                config,
                train,
                warnings,
            })
        }
        Ok(_) => Err(problems),
        Err(found) => {
            // A key that could not be read has its problem already; its placeholder breaks rules too.
            let unread: Vec<(Option<String>, String)> = problems
                .iter()
                .map(|problem| (problem.file.clone(), problem.key.clone()))
                .collect();
            let news = found.into_iter().filter(|problem| {
                !unread.iter().any(|(file, key)| {
                    let inside = problem.key == *key || starts_below(&problem.key, key);
                    inside && problem.file == *file
                })
            });
            problems.extend(news.map(located));
            problems.sort_by_key(|problem| problem.spot);
            Err(problems)
        }
    }
}

/// Whether `key` lies inside the table `outer`.
fn starts_below(key: &str, outer: &str) -> bool {
    !outer.is_empty()
        && key
            .strip_prefix(outer)
            .is_some_and(|rest| rest.starts_with('.'))
}
