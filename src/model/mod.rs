//! The whole gear train in modal coordinates, immutable once assembled.
//!
//! ```text
//!   q = [A_1 B_1 At_1 | A_2 B_2 At_2 | ...]        per rotor: x plane, y plane, torsion
//!   q'' + D q' + K q = f(t) - sum over the meshes of b (k(t) delta + c delta'),   delta = w q
//! ```
//!
//! D and K are the modal matrices of [`crate::rotor`], block by block; w collects the gradient of delta
//! (paper (16)-(18), corrected) on the modal coordinates of both rotors, and b = w, because mesh forces and
//! torques come from one potential. With `torque_coupling = "as_printed"` a mesh becomes two couplings:
//! forces follow delta, torques only its rotational part.
//!
//! Nothing here changes in time: see [`Excitation`] for f(t) and k(t), [`equilibrium`] for the start and
//! [`Motion`] for what the outside sees. Knows no FMI and no solver but its [`System`].

mod coupled;
mod equilibrium;
mod excitation;
mod monitors;
mod motion;

use crate::config::{Planar, TorqueCoupling};
use crate::mesh::{GearMotion, LineOfAction, StiffnessLaw};
use crate::rotor::{ModalRotor, ModeCounts, ReductionError};
use crate::solver::{Block, Coupling, Piece, Row, System};
use crate::train::{self, GearAddress, GearTrain};

pub use coupled::NaturalVibration;
pub use equilibrium::{Equilibrium, NoEquilibrium, equilibrium};
pub use excitation::{BaseMotion, Excitation, Inputs};
pub use motion::Motion;

use excitation::Harmonic;

/// An assembled gear train.
#[derive(Debug, Clone)]
pub struct ModalModel {
    /// The constant part of the equations of motion.
    pub system: System,
    /// The shafts.
    pub rotors: Vec<Rotor>,
    /// The meshes.
    pub meshes: Vec<Mesh>,
    /// The mesh of each coupling of the system.
    coupling_mesh: Vec<usize>,
    /// Everything that excites with a fixed frequency: unbalance, gearbox vibration.
    harmonics: Vec<Harmonic>,
    /// Motion of all supports in addition to the inputs.
    vibration: excitation::SupportVibration,
}

/// One rotor: where its coordinates are and what sits on it.
#[derive(Debug, Clone)]
pub struct Rotor {
    /// Index of A_1 in q.
    pub offset: usize,
    /// Number of modes and static shapes.
    pub counts: ModeCounts,
    /// Whether the first torsional coordinate is the rigid rotation.
    pub has_rigid_rotation: bool,
    /// Natural frequencies of the lateral basis modes [Hz].
    pub lateral_frequencies: Vec<f64>,
    /// Natural frequencies of the torsional basis modes, 0 for the rigid rotation [Hz].
    pub torsional_frequencies: Vec<f64>,
    /// Mean speed [rad/s].
    pub speed: f64,
    /// Rotation angle at time 0 [rad].
    pub angle: f64,
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
    /// Stiffness [N/m].
    pub stiffness: Planar,
    /// Damping [N s/m].
    pub damping: Planar,
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
    start_phase: f64,
    phase_rate: f64,
}

impl ModalModel {
    /// Reduces every rotor and couples them. `counts` fixes the number of modes of each rotor; otherwise
    /// the train's basis decides.
    pub fn assemble(
        train: &GearTrain,
        counts: Option<&[ModeCounts]>,
    ) -> Result<ModalModel, ReductionError> {
        let mut system = System::default();
        let mut rotors = Vec::new();
        for (index, rotor) in train.rotors.iter().enumerate() {
            let fixed = counts.map(|counts| counts[index]);
            let modal = ModalRotor::reduce(rotor, &train.basis, fixed)?;
            rotors.push(add_rotor(&mut system, rotor, modal));
        }
        let mut meshes = Vec::new();
        let mut coupling_mesh = Vec::new();
        for (index, mesh) in train.meshes.iter().enumerate() {
            let mesh = join(&rotors, mesh);
            system.couplings.extend(couplings(&rotors, &mesh));
            coupling_mesh.resize(system.couplings.len(), index);
            meshes.push(mesh);
        }
        system.monitors = monitors::monitors(&system, &rotors, &meshes);
        let vibration = excitation::SupportVibration::new(&train.gearbox_vibration);
        let mut harmonics = excitation::unbalance_harmonics(train, &rotors);
        harmonics.extend(vibration.harmonic(&rotors, system.size));
        Ok(ModalModel {
            system,
            rotors,
            meshes,
            coupling_mesh,
            harmonics,
            vibration,
        })
    }

    /// Number of modes of each rotor.
    pub fn counts(&self) -> Vec<ModeCounts> {
        self.rotors.iter().map(|rotor| rotor.counts).collect()
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

/// Appends the rotor's two blocks to the system.
fn add_rotor(system: &mut System, rotor: &train::Rotor, modal: ModalRotor) -> Rotor {
    let offset = system.size;
    let counts = modal.counts();
    let builder = StationBuilder {
        modal: &modal,
        offset,
        block: system.blocks.len(),
    };
    let station = |position: f64| builder.station(position);
    let bearing = |bearing: &train::Bearing| {
        let coefficients = bearing.coefficients(rotor.speed);
        Bearing {
            station: station(bearing.position),
            stiffness: coefficients.stiffness,
            damping: coefficients.damping,
        }
    };
    let added = Rotor {
        offset,
        counts,
        has_rigid_rotation: modal.has_rigid_rotation(),
        speed: rotor.speed,
        angle: rotor.angle,
        gears: rotor
            .gears
            .iter()
            .map(|gear| station(gear.body.position))
            .collect(),
        bearings: rotor.bearings.iter().map(bearing).collect(),
        torques: rotor
            .torques
            .iter()
            .map(|torque| station(torque.position).theta)
            .collect(),
        unbalances: rotor
            .unbalances
            .iter()
            .map(|one| modal.lateral_row(one.position))
            .collect(),
        probes: rotor
            .probes
            .iter()
            .map(|probe| station(probe.position))
            .collect(),
        lateral_frequencies: modal.lateral_frequencies.clone(),
        torsional_frequencies: modal.torsional_frequencies.clone(),
    };
    let torsional_offset = offset + 2 * counts.lateral;
    system.blocks.push(Block {
        offset,
        damping: modal.lateral_damping,
        stiffness: modal.lateral_stiffness,
    });
    system.blocks.push(Block {
        offset: torsional_offset,
        damping: modal.torsional_damping,
        stiffness: modal.torsional_stiffness,
    });
    system.size = torsional_offset + counts.torsional;
    added
}

/// Makes rows over the coordinates of one rotor, whose lateral block is number `block`.
struct StationBuilder<'a> {
    modal: &'a ModalRotor,
    offset: usize,
    block: usize,
}

impl StationBuilder<'_> {
    fn station(&self, position: f64) -> Station {
        let phi = self.modal.lateral_row(position);
        let none = vec![0.0; phi.len()];
        let torsional_offset = self.offset + 2 * phi.len();
        let lateral = |values: [&[f64]; 2]| Row::new(self.block, self.offset, values.concat());
        Station {
            x: lateral([&phi, &none]),
            y: lateral([&none, &phi]),
            theta: Row::new(
                self.block + 1,
                torsional_offset,
                self.modal.torsional_row(position),
            ),
        }
    }
}

/// The mesh on the modal coordinates of its two rotors.
fn join(rotors: &[Rotor], mesh: &train::Mesh) -> Mesh {
    let mut row = Row::default();
    let mut rotation_row = Row::default();
    for (gear, gradient) in mesh.gears.iter().zip(mesh.line.gradient()) {
        let station = &rotors[gear.rotor].gears[gear.gear];
        let GearMotion { x, y, theta } = gradient;
        row.add(x, &station.x);
        row.add(y, &station.y);
        row.add(theta, &station.theta);
        rotation_row.add(theta, &station.theta);
    }
    Mesh {
        gears: mesh.gears,
        row,
        rotation_row,
        line: mesh.line,
        torque_coupling: mesh.torque_coupling,
        damping: mesh.damping,
        law: mesh.stiffness.clone(),
        factor: mesh.stiffness_factor,
        start_phase: mesh.start_phase,
        phase_rate: mesh.phase_rate,
    }
}

fn couplings(rotors: &[Rotor], mesh: &Mesh) -> Vec<Coupling> {
    match mesh.torque_coupling {
        TorqueCoupling::Consistent => {
            vec![Coupling {
                row: mesh.row.clone(),
                column: mesh.row.clone(),
            }]
        }
        TorqueCoupling::AsPrinted => {
            let mut lateral = Row::default();
            for (gear, gradient) in mesh.gears.iter().zip(mesh.line.gradient()) {
                let station = &rotors[gear.rotor].gears[gear.gear];
                lateral.add(gradient.x, &station.x);
                lateral.add(gradient.y, &station.y);
            }
            let rotation = mesh.rotation_row.clone();
            vec![
                Coupling {
                    row: mesh.row.clone(),
                    column: lateral,
                },
                Coupling {
                    row: rotation.clone(),
                    column: rotation,
                },
            ]
        }
    }
}

impl Mesh {
    /// Mean of k over the phase [N/m].
    pub fn mean_stiffness(&self) -> f64 {
        self.factor * self.law.mean()
    }

    /// Mesh frequency [Hz].
    pub fn frequency(&self) -> f64 {
        self.phase_rate.abs()
    }

    /// k at `time` [N/m]; at a jump the value that holds from then on.
    pub fn stiffness(&self, time: f64) -> f64 {
        self.stiffness_in(self.piece_ahead(time), time)
    }

    fn stiffness_in(&self, piece: Piece, time: f64) -> f64 {
        self.factor * self.law.value(self.phase(time) - piece.origin, piece.index)
    }

    fn phase(&self, time: f64) -> f64 {
        self.start_phase + self.phase_rate * time
    }
}
