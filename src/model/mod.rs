//! The whole gear train in modal coordinates, immutable once assembled.
//!
//! ```text
//!   q = [A_1 B_1 At_1 | A_2 B_2 At_2 | ...]        per rotor: x plane, y plane, torsion
//!   q'' + D q' + K q = f(t) - sum over the meshes of b (k(t) delta + c delta'),   delta = w q
//! ```
//!
//! What is not linear with constant coefficients acts through couplings: meshes (`tooth_contact`), bearings with a
//! radial force of their own (`radial`), and in free spin everything that follows the rotation (`spin`).
//!
//! D and K are the modal matrices of [`crate::rotor`], block by block; w collects the gradient of delta
//! (paper (16)-(18), corrected) on the modal coordinates of both rotors, and b = w, because mesh forces and
//! torques come from one potential. With `torque_coupling = "as_printed"` a mesh becomes two couplings:
//! forces follow delta, torques only its rotational part.
//!
//! Nothing here changes in time: see [`Excitation`] for f(t) and the forces, [`equilibrium`] for the start and
//! [`Motion`] for what the outside sees. Knows no FMI and no solver but its [`System`].

mod assembly;
mod bearing_force;
mod change;
mod coupled;
mod equilibrium;
mod excitation;
mod housing;
mod inputs;
mod known_bearings;
mod layout;
mod monitors;
mod motion;
mod radial;
mod spin;
mod tooth_contact;

use nalgebra::DMatrix;

use crate::config::{Planar, TorqueCoupling};
use crate::mesh::{GearLoad, LineOfAction, StiffnessLaw, TransmissionError};
use crate::rotor::{ModalRotor, ModeCounts};
use crate::solver::{Block, Harmonic, Row, System};
use crate::train::{self, GearAddress};

pub use change::Change;
pub use coupled::NaturalVibration;
pub use equilibrium::{Equilibrium, NoEquilibrium, equilibrium, equilibrium_change};
pub use excitation::Excitation;
pub use housing::{Housing, Mode, Point};
pub use inputs::{BaseMotion, Course, Inputs};
pub use layout::Coordinates;
pub use motion::Motion;
pub use radial::RadialBearing;

use bearing_force::BearingForce;
use inputs::SupportVibration;
use known_bearings::KnownBearings;
use spin::Spin;

/// An assembled gear train.
#[derive(Debug, Clone)]
pub struct ModalModel {
    /// The constant part of the equations of motion.
    pub system: System,
    /// The shafts.
    pub rotors: Vec<Rotor>,
    /// The meshes.
    pub meshes: Vec<Mesh>,
    /// How far from the ends of pieces of their stiffness a step may end where the tolerance is 1 [s]: with the fourth root of
    /// the tolerance ([`StiffnessLaw::slack`]).
    slack: f64,
    /// Whether all forces are straight lines in their own deflection and rate while their pieces last.
    is_straight: bool,
    /// Whether time alone ends pieces of laws.
    is_timed: bool,
    /// Bearings with a radial force in addition.
    radial: Vec<RadialBearing>,
    /// In free spin one for every rotor, otherwise none.
    spins: Vec<Spin>,
    /// Everything that excites with a fixed frequency: unbalance and bow at prescribed speed, gearbox vibration.
    harmonics: Vec<Harmonic>,
    /// What the forces of all bearings follow from.
    bearing_forces: Vec<BearingForce>,
    /// Motion of all supports in addition to the inputs.
    vibration: SupportVibration,
    /// The structure around the rotors.
    pub housing: Option<Housing>,
    /// What a housing by itself knows of the bearings that stand on it.
    known_bearings: Option<KnownBearings>,
}

/// One rotor: where its coordinates are and what sits on it.
#[derive(Debug, Clone)]
pub struct Rotor {
    /// Where A and B are in q.
    pub lateral: Coordinates,
    /// Where its torsion is in q.
    pub torsional: Coordinates,
    /// Number of modes and static shapes.
    pub counts: ModeCounts,
    /// Whether the first torsional coordinate is the rigid rotation.
    pub has_rigid_rotation: bool,
    /// Natural frequencies of the lateral basis modes [Hz].
    pub lateral_frequencies: Vec<f64>,
    /// Natural frequencies of the torsional basis modes, 0 for the rigid rotation [Hz].
    pub torsional_frequencies: Vec<f64>,
    /// Mean speed, in free spin the first one [rad/s].
    pub speed: f64,
    /// Rotation angle at time 0 [rad].
    pub angle: f64,
    /// The mean rotation: phi - phi_0 = row q [rad].
    pub mean_rotation: Row,
    /// Places of the gears.
    pub gears: Vec<Station>,
    /// Bearings.
    pub bearings: Vec<Bearing>,
    /// Rotation at the external torques.
    pub torques: Vec<Row>,
    /// Displacement in either plane at the unbalances, on A or B.
    pub unbalances: Vec<Vec<f64>>,
    /// Places of the probes.
    pub probes: Vec<Station>,
    /// The shaft in modal coordinates.
    modal: ModalRotor,
}

/// How displacement and rotation at one place follow from q.
#[derive(Debug, Clone)]
pub struct Station {
    /// x [m].
    pub x: Row,
    /// y [m].
    pub y: Row,
    /// theta [rad].
    pub theta: Row,
}

/// A bearing between shaft and gearbox.
#[derive(Debug, Clone)]
pub struct Bearing {
    /// Where it holds the shaft.
    pub station: Station,
    /// Displacement of the shaft relative to the housing in this model, in x and y; of the shaft where there is none under it.
    pub relative: [Row; 2],
    /// Stiffness at the mean speed [N/m].
    pub stiffness: Planar,
    /// Damping at the mean speed [N s/m].
    pub damping: Planar,
    /// Whether both follow a speed that changes, and the gearbox's motion acts through them then.
    follows_speed: bool,
    bearing: train::Bearing,
}

/// A gear mesh.
#[derive(Debug, Clone)]
pub struct Mesh {
    /// Gear a and gear b.
    pub gears: [GearAddress; 2],
    /// delta = row q [m].
    pub row: Row,
    /// The part of delta that comes from rotations [m].
    pub rotation_row: Row,
    /// Line of action.
    pub line: LineOfAction,
    /// Which motions the mesh torque follows.
    pub torque_coupling: TorqueCoupling,
    /// Damping c [N s/m].
    pub damping: f64,
    law: StiffnessLaw,
    factor: f64,
    error: TransmissionError,
    /// Unilateral contact, with this backlash [m].
    backlash: Option<f64>,
    start_phase: f64,
    /// Phase per rotation angle of gear a [pitches/rad].
    pitches: f64,
    phase_rate: f64,
    /// In free spin the coupling that observes the rotation of gear a.
    turning: Option<usize>,
    /// The couplings through which it pushes.
    couplings: core::ops::Range<usize>,
    first_law: usize,
}

impl ModalModel {
    /// Whether the rotations are states.
    pub fn is_free(&self) -> bool {
        !self.spins.is_empty()
    }

    /// Loads that turn with fixed frequencies.
    pub fn harmonics(&self) -> &[Harmonic] {
        &self.harmonics
    }

    /// The displacements and velocities of the rotors turning with their first speeds, and nothing else.
    pub fn rigid_velocity(&self) -> Vec<f64> {
        let mut velocity = vec![0.0; self.system.size];
        for spin in &self.spins {
            velocity[spin.rigid] = self.rotors[spin.rotor].speed / spin.rotation;
        }
        velocity
    }

    /// The mesh that owns a law, and the law's number there.
    fn mesh_of_law(&self, law: usize) -> Option<(&Mesh, usize)> {
        let mesh = self.meshes.iter().rfind(|mesh| mesh.first_law <= law)?;
        let own = law - mesh.first_law;
        (own < mesh.law_count()).then_some((mesh, own))
    }

    /// The meshes of a gear, and which side of each it is.
    fn sides_of(&self, gear: GearAddress) -> impl Iterator<Item = (usize, usize)> {
        let sides = move |(index, mesh): (usize, &Mesh)| {
            let gears = mesh.gears;
            (0..2)
                .filter(move |&side| gears[side] == gear)
                .map(move |side| (index, side))
        };
        self.meshes.iter().enumerate().flat_map(sides)
    }

    /// Number of modes of each rotor.
    pub fn counts(&self) -> Vec<ModeCounts> {
        self.rotors.iter().map(|rotor| rotor.counts).collect()
    }

    /// Nothing moves and acts from outside but these torques.
    pub fn inputs_at_rest(&self, torques: &[f64]) -> Inputs {
        let loaded = self.housing.iter().flat_map(Housing::loaded).count() / 2;
        let still = vec![BaseMotion::default(); self.bearings().count()];
        Inputs::new(torques, &still, &vec![[0.0; 2]; loaded])
    }

    /// Overwrites the lateral blocks with those at these speeds of the rotors [rad/s].
    fn lateral_blocks_at(&self, speeds: &[f64], blocks: &mut [Block]) {
        let rotors = || self.rotors.iter().zip(speeds);
        for (rotor, &speed) in rotors() {
            rotor.lateral_at(speed, blocks);
        }
        if let Some(housing) = &self.housing {
            let at_speed = |(rotor, &speed): (&Rotor, &f64)| -> Vec<(Planar, Planar)> {
                let bearings = rotor.bearings.iter();
                bearings.map(|bearing| bearing.at_speed(speed)).collect()
            };
            let coefficients: Vec<(Planar, Planar)> = rotors().flat_map(at_speed).collect();
            housing.put(self.bearings(), |input| coefficients[input], blocks);
        }
    }

    /// The bearing at a place among the inputs, with the index of its rotor.
    fn bearing_of(&self, input: usize) -> (usize, &Bearing) {
        let rotors = self.rotors.iter().enumerate();
        let mut all = rotors.flat_map(|(index, rotor)| {
            let bearings = rotor.bearings.iter();
            bearings.map(move |bearing| (index, bearing))
        });
        all.nth(input).expect("inputs count bearings")
    }

    /// All bearings in the order of the inputs.
    pub fn bearings(&self) -> impl Iterator<Item = &Bearing> {
        self.rotors.iter().flat_map(|rotor| &rotor.bearings)
    }

    /// All torque stations in the order of the inputs.
    pub fn torques(&self) -> impl Iterator<Item = &Row> {
        self.rotors.iter().flat_map(|rotor| &rotor.torques)
    }
}

impl Rotor {
    /// Overwrites stiffness and damping of [A, B] with those at another speed [rad/s].
    fn lateral_at(&self, speed: f64, blocks: &mut [Block]) {
        let n = 2 * self.counts.lateral;
        let (mut stiffness, mut damping) = (DMatrix::zeros(n, n), DMatrix::zeros(n, n));
        self.modal.lateral_at(speed, &mut stiffness, &mut damping);
        self.lateral.put(blocks, &stiffness, &damping);
    }
}

impl Bearing {
    /// Stiffness [N/m] and damping [N s/m] at a speed of the rotor [rad/s].
    fn at_speed(&self, speed: f64) -> (Planar, Planar) {
        if self.follows_speed {
            let coefficients = self.bearing.coefficients(speed);
            (coefficients.stiffness, coefficients.damping)
        } else {
            (self.stiffness, self.damping)
        }
    }

    /// The change of both with the speed.
    fn slopes_at(&self, speed: f64) -> (Planar, Planar) {
        if self.follows_speed {
            let slopes = self.bearing.coefficient_slopes(speed);
            (slopes.stiffness, slopes.damping)
        } else {
            (Planar::ZERO, Planar::ZERO)
        }
    }
}

impl Mesh {
    /// Mean of k over the phase [N/m].
    pub fn mean_stiffness(&self) -> f64 {
        self.factor * self.law.mean()
    }

    /// Mesh frequency at the mean speed [Hz].
    pub fn frequency(&self) -> f64 {
        self.phase_rate.abs()
    }

    /// What normal forces of the reference flank and of the back flank [N] do to gear a and b; `printed` is the force
    /// that the torque follows where it follows the printed equation.
    fn loads(&self, [front, back]: [f64; 2], printed: Option<f64>) -> [GearLoad; 2] {
        let torques = self.line.loads(printed.unwrap_or(front));
        let behind = self.line.opposite_flank().loads(back);
        let mut loads = self.line.loads(front);
        for ((load, torque), behind) in loads.iter_mut().zip(torques).zip(behind) {
            load.x += behind.x;
            load.y += behind.y;
            load.torque = torque.torque + behind.torque;
        }
        loads
    }
}
