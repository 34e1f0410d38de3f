//! How large the variables of a train usually are: nominal values for step controls, plots and masters' windows.
//!
//! ```text
//!   mesh force F_m         of the static equilibrium under the file's torques; without one, the largest torque / base radius
//!   deflection             F_m / mean k
//!   forces at bearings     the largest F_m                        displacements   the largest in equilibrium
//!   velocity of the gearbox displacement x 2 pi f, f the highest mesh frequency or else the fastest rotation
//! ```
//!
//! One digit each. A scale that a train does not give (no torque, no speed) stays open.

use core::f64::consts::TAU;

use crate::interface::{Direction, Quantity};
use crate::model::{ModalModel, equilibrium};
use crate::train::GearTrain;

/// The scales of a train.
pub(super) struct Nominals<'a> {
    train: &'a GearTrain,
    model: &'a ModalModel,
    torque: f64,
    /// Of every mesh.
    forces: Vec<f64>,
    displacement: f64,
    rotation: f64,
    /// [rad/s]
    vibration: f64,
    speed: f64,
}

impl<'a> Nominals<'a> {
    pub(super) fn of(train: &'a GearTrain, model: &'a ModalModel) -> Nominals<'a> {
        let torques = train.rotors.iter().flat_map(|rotor| &rotor.torques);
        let torques: Vec<f64> = torques.map(|torque| torque.value).collect();
        let torque = largest(torques.iter().copied());
        let inputs = model.inputs_at_rest(&torques);
        let equilibrium = equilibrium(model, &inputs).ok();
        let force = |index: usize| {
            let statically = equilibrium
                .as_ref()
                .map_or(0.0, |found| found.mesh_forces[index]);
            let line = &train.meshes[index].line;
            let radius = line.radius_a.abs().min(line.radius_b.abs());
            if statically == 0.0 {
                torque / radius
            } else {
                statically.abs()
            }
        };
        let forces = (0..train.meshes.len()).map(force).collect();
        let position = equilibrium.map(|found| found.position).unwrap_or_default();
        let moved = |row: &crate::solver::Row| {
            if position.is_empty() {
                0.0
            } else {
                row.dot(&position)
            }
        };
        let stations = || {
            let rotors = model.rotors.iter();
            rotors.flat_map(|rotor| {
                let bearings = rotor.bearings.iter().map(|bearing| &bearing.station);
                rotor.gears.iter().chain(&rotor.probes).chain(bearings)
            })
        };
        let speed = largest(model.rotors.iter().map(|rotor| rotor.speed));
        let meshing = largest(model.meshes.iter().map(|mesh| TAU * mesh.frequency()));
        Nominals {
            displacement: largest(stations().flat_map(|one| [moved(&one.x), moved(&one.y)])),
            rotation: largest(stations().map(|one| moved(&one.theta))),
            vibration: if meshing > 0.0 { meshing } else { speed },
            train,
            model,
            torque,
            forces,
            speed,
        }
    }

    /// The scale of an input or output; `None` for everything else, and where the train gives none.
    pub(super) fn value(&self, quantity: Quantity) -> Option<f64> {
        let value = match quantity {
            Quantity::Torque { .. } => self.torque,
            Quantity::BaseDisplacement { .. }
            | Quantity::BearingMotion { .. }
            | Quantity::PointDisplacement { .. } => self.displacement,
            Quantity::BaseVelocity { .. } | Quantity::PointVelocity { .. } => {
                self.displacement * self.vibration
            }
            Quantity::PointAcceleration { .. } => {
                self.displacement * self.vibration * self.vibration
            }
            Quantity::MeshForce { mesh } | Quantity::MeshForceOnB { mesh, .. } => self.forces[mesh],
            Quantity::MeshDeflection { mesh } => self.forces[mesh] / self.stiffness(mesh),
            Quantity::MeshStiffness { mesh } => self.stiffness(mesh),
            Quantity::GearMotion { direction, .. } | Quantity::ProbeMotion { direction, .. } => {
                match direction {
                    Direction::X | Direction::Y => self.displacement,
                    Direction::Theta => self.rotation,
                }
            }
            Quantity::GearTorque { gear } => {
                let meshes = self.train.meshes.iter().zip(&self.forces);
                let own = meshes.filter(|(mesh, _)| mesh.gears.contains(&gear));
                largest(own.map(|(_, force)| force * self.train.gear(gear).base_radius))
            }
            Quantity::BearingForce { .. } | Quantity::PointForce { .. } => {
                largest(self.forces.iter().copied())
            }
            Quantity::Speed { rotor } if self.model.rotors[rotor].speed != 0.0 => {
                self.model.rotors[rotor].speed.abs()
            }
            Quantity::Speed { .. } => self.speed,
            Quantity::Angle { .. } => TAU,
            _ => return None,
        };
        let digit: f64 = format!("{value:.0e}").parse().ok()?;
        (digit.is_finite() && digit > 0.0).then_some(digit)
    }

    fn stiffness(&self, mesh: usize) -> f64 {
        self.model.meshes[mesh].mean_stiffness()
    }
}

fn largest(values: impl Iterator<Item = f64>) -> f64 {
    values
        .map(f64::abs)
        .filter(|value| value.is_finite())
        .fold(0.0, f64::max)
}
