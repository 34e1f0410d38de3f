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

mod change;
mod coupled;
mod equilibrium;
mod excitation;
mod inputs;
mod monitors;
mod motion;
mod radial;
mod spin;
mod tooth_contact;

use nalgebra::DMatrix;

use crate::config::{Planar, SpeedMode, TorqueCoupling};
use crate::mesh::{GearLoad, GearMotion, LineOfAction, StiffnessLaw, TransmissionError};
use crate::rotor::{ModalRotor, ModeCounts, ReductionError};
use crate::solver::{Block, Coupling, Harmonic, Row, System};
use crate::train::{self, GearAddress, GearTrain};

pub use change::Change;
pub use coupled::NaturalVibration;
pub use equilibrium::{Equilibrium, NoEquilibrium, equilibrium, equilibrium_change};
pub use excitation::Excitation;
pub use inputs::{BaseMotion, Inputs};
pub use motion::Motion;
pub use radial::RadialBearing;

use inputs::SupportVibration;
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
    /// Bearings with a radial force in addition.
    radial: Vec<RadialBearing>,
    /// In free spin one for every rotor, otherwise none.
    spins: Vec<Spin>,
    /// Everything that excites with a fixed frequency: unbalance and bow at prescribed speed, gearbox vibration.
    harmonics: Vec<Harmonic>,
    /// Motion of all supports in addition to the inputs.
    vibration: SupportVibration,
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
    first_coupling: usize,
    first_law: usize,
}

impl ModalModel {
    /// Reduces every rotor and couples them. `counts` fixes the number of modes of each rotor; otherwise
    /// the train's basis decides.
    pub fn assemble(
        train: &GearTrain,
        counts: Option<&[ModeCounts]>,
    ) -> Result<ModalModel, ReductionError> {
        let free = train.simulation.speed == SpeedMode::Free;
        let mut system = System::default();
        let mut rotors = Vec::new();
        for (index, rotor) in train.rotors.iter().enumerate() {
            let fixed = counts.map(|counts| counts[index]);
            let modal = ModalRotor::reduce(rotor, &train.basis, fixed)?;
            rotors.push(add_rotor(&mut system, rotor, modal, free));
        }
        let mut meshes = Vec::new();
        for mesh in &train.meshes {
            meshes.push(join(&mut system, &rotors, mesh, free));
        }
        let radial = add_radial_bearings(&mut system, &rotors);
        let mut spins = Vec::new();
        let vibration = SupportVibration::new(&train.gearbox_vibration);
        let mut harmonics = Vec::new();
        for (index, rotor) in train.rotors.iter().enumerate() {
            if free {
                spins.push(add_spin(&mut system, &rotors, index, rotor));
            } else {
                let bows = &rotors[index].modal.bows;
                harmonics.extend(excitation::rotating_load(rotor, &rotors[index], bows));
            }
        }
        system.slow = spins.iter().map(|spin| rotors[spin.rotor].speed).collect();
        harmonics.extend(vibration.harmonic(&rotors, system.size));
        system.monitors = monitors::monitors(&system, &rotors, &meshes, &radial, &spins);
        Ok(ModalModel {
            system,
            rotors,
            meshes,
            radial,
            spins,
            harmonics,
            vibration,
        })
    }

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

    /// Number of the lateral block that a bearing holds; `input` is its place among the inputs.
    fn lateral_block_of(&self, input: usize) -> usize {
        let mut before = 0;
        let holds = |rotor: &Rotor| {
            before += rotor.bearings.len();
            input < before
        };
        2 * self.rotors.iter().position(holds).unwrap_or(0)
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
fn add_rotor(system: &mut System, rotor: &train::Rotor, modal: ModalRotor, free: bool) -> Rotor {
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
            follows_speed: free && bearing.depends_on_speed(),
            bearing: bearing.clone(),
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
        mean_rotation: Row::new(
            builder.block + 1,
            offset + 2 * counts.lateral,
            modal.mean_rotation.clone(),
        ),
        lateral_frequencies: modal.lateral_frequencies.clone(),
        torsional_frequencies: modal.torsional_frequencies.clone(),
        modal: modal.clone(),
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

/// A mesh and its couplings on the modal coordinates of its two rotors.
fn join(system: &mut System, rotors: &[Rotor], mesh: &train::Mesh, free: bool) -> Mesh {
    let first_coupling = system.couplings.len();
    let (row, rotation_row) = mesh_rows(rotors, mesh.gears, &mesh.line);
    let both = |row: &Row| Coupling {
        row: row.clone(),
        column: row.clone(),
    };
    match (mesh.torque_coupling, mesh.backlash) {
        (TorqueCoupling::AsPrinted, _) => {
            let mut lateral = row.clone();
            lateral.add(-1.0, &rotation_row);
            system.couplings.push(Coupling {
                row: row.clone(),
                column: lateral,
            });
            system.couplings.push(both(&rotation_row));
        }
        (TorqueCoupling::Consistent, None) => system.couplings.push(both(&row)),
        (TorqueCoupling::Consistent, Some(_)) => {
            let (back, _) = mesh_rows(rotors, mesh.gears, &mesh.line.opposite_flank());
            system.couplings.push(both(&row));
            system.couplings.push(both(&back));
        }
    }
    let turning = free.then(|| {
        let gear = mesh.gears[0];
        system.couplings.push(Coupling {
            row: rotors[gear.rotor].gears[gear.gear].theta.clone(),
            column: Row::default(),
        });
        system.couplings.len() - 1
    });
    let joined = Mesh {
        gears: mesh.gears,
        row,
        rotation_row,
        line: mesh.line,
        torque_coupling: mesh.torque_coupling,
        damping: mesh.damping,
        law: mesh.stiffness.clone(),
        factor: mesh.stiffness_factor,
        error: mesh.transmission_error.clone(),
        backlash: mesh.backlash,
        start_phase: mesh.start_phase,
        pitches: mesh.pitches,
        phase_rate: mesh.phase_rate,
        turning,
        first_coupling,
        first_law: system.laws,
    };
    system.laws += joined.law_count();
    joined
}

/// delta as a row over the modal coordinates, and the part of it that comes from rotations.
fn mesh_rows(rotors: &[Rotor], gears: [GearAddress; 2], line: &LineOfAction) -> (Row, Row) {
    let (mut row, mut rotation_row) = (Row::default(), Row::default());
    for (gear, gradient) in gears.iter().zip(line.gradient()) {
        let station = &rotors[gear.rotor].gears[gear.gear];
        let GearMotion { x, y, theta } = gradient;
        row.add(x, &station.x);
        row.add(y, &station.y);
        row.add(theta, &station.theta);
        rotation_row.add(theta, &station.theta);
    }
    (row, rotation_row)
}

/// Two couplings for every bearing with a radial force.
fn add_radial_bearings(system: &mut System, rotors: &[Rotor]) -> Vec<RadialBearing> {
    let mut radial = Vec::new();
    let bearings = rotors.iter().flat_map(|rotor| &rotor.bearings);
    for (input, bearing) in bearings.enumerate() {
        if let Some(force) = bearing.bearing.nonlinear {
            radial.push(RadialBearing {
                input,
                force,
                first_coupling: system.couplings.len(),
                law: system.laws,
            });
            for row in [&bearing.station.x, &bearing.station.y] {
                system.couplings.push(Coupling {
                    row: row.clone(),
                    column: row.clone(),
                });
            }
            system.laws += 1;
        }
    }
    radial
}

/// The couplings of a rotor that turns freely: two that observe, and one on every lateral coordinate.
fn add_spin(system: &mut System, rotors: &[Rotor], index: usize, rotor: &train::Rotor) -> Spin {
    let modal = &rotors[index];
    let (n, torsional) = (modal.counts.lateral, 2 * index + 1);
    let rigid = modal.offset + 2 * n;
    let rotation = modal.mean_rotation.entry(rigid);
    let torques = system
        .couplings
        .iter()
        .enumerate()
        .map(|(coupling, data)| (coupling, data.column.entry(rigid)))
        .filter(|&(_, entry)| entry != 0.0)
        .collect();
    let drag = &system.blocks[torsional].damping;
    let drag = Row::new(torsional, rigid, drag.row(0).iter().copied().collect());
    let turn = system.couplings.len();
    for row in [modal.mean_rotation.clone(), drag] {
        system.couplings.push(Coupling {
            row,
            column: Row::default(),
        });
    }
    for i in 0..2 * n {
        let mut unit = vec![0.0; 2 * n];
        unit[i] = 1.0;
        let unit = Row::new(2 * index, modal.offset, unit);
        system.couplings.push(Coupling {
            row: unit.clone(),
            column: unit,
        });
    }
    let unbalances = rotor.unbalances.iter().zip(&modal.unbalances);
    let inputs_before: usize = rotors[..index]
        .iter()
        .map(|rotor| rotor.bearings.len())
        .sum();
    let bearings = rotor.bearings.iter().enumerate();
    Spin {
        rotor: index,
        turn,
        drag: turn + 1,
        first: turn + 2,
        n,
        rigid,
        rotation,
        torques,
        angle: rotor.angle,
        gyroscopic: modal.modal.gyroscopic().clone(),
        unbalances: unbalances
            .map(|(one, shape)| (shape.clone(), one.moment, one.phase))
            .collect(),
        bows: modal.modal.bows.clone(),
        bearings: bearings
            .filter(|(_, bearing)| bearing.depends_on_speed())
            .map(|(number, bearing)| {
                let shape = modal.modal.lateral_row(bearing.position);
                (shape, inputs_before + number, bearing.clone())
            })
            .collect(),
    }
}

impl Rotor {
    /// Overwrites stiffness and damping of [A, B], 2n x 2n, with those at another speed [rad/s].
    fn lateral_at(&self, speed: f64, stiffness: &mut DMatrix<f64>, damping: &mut DMatrix<f64>) {
        self.modal.lateral_at(speed, stiffness, damping);
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

    /// The couplings through which the mesh pushes.
    fn couplings(&self) -> core::ops::Range<usize> {
        let two = self.backlash.is_some() || self.torque_coupling == TorqueCoupling::AsPrinted;
        self.first_coupling..self.first_coupling + if two { 2 } else { 1 }
    }
}
