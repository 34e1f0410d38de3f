//! What the outside sees of a state: displacements, mesh forces, bearing forces.
//!
//! ```text
//!   mesh      delta = w q - e,  F = k(t) delta + c delta'       on b: +F n, torque -s F R_b
//!   bearing   force of the rotor on the gearbox = K (u - u_b) + C (u' - u_b') + F_r (u - u_b) / r
//! ```
//!
//! Every quantity is computed when it is asked for, from the state, the inputs and the time. Of the state, what meshes and
//! linear bearings need is always there; displacements and velocities are put together for the rest.

use super::tooth_contact::Phase;
use super::{BaseMotion, Bearing, Inputs, Mesh, ModalModel};
use crate::config::TorqueCoupling;
use crate::mesh::GearLoad;
use crate::solver::{Row, State};
use crate::train::GearAddress;

/// A view of the model in one state under given inputs.
#[derive(Debug, Clone, Copy)]
pub struct Motion<'a> {
    /// The model.
    pub model: &'a ModalModel,
    /// Its state.
    pub state: &'a State,
    /// What is set from outside.
    pub inputs: &'a Inputs,
    /// Motion of all supports in addition.
    pub(super) vibration: BaseMotion,
}

impl<'a> Motion<'a> {
    /// The model in this state under these inputs.
    pub fn new(model: &'a ModalModel, state: &'a State, inputs: &'a Inputs) -> Motion<'a> {
        Motion {
            vibration: model.vibration.in_state(state, &model.harmonics),
            model,
            state,
            inputs,
        }
    }
}

impl Motion<'_> {
    /// Displacement, rotation or deflection along a row.
    pub fn displacement(&self, row: &Row) -> f64 {
        row.dot(self.state.position())
    }

    pub(super) fn velocity(&self, row: &Row) -> f64 {
        row.dot(self.state.velocity())
    }

    /// Rotation angle of a rotor [rad].
    pub fn angle(&self, rotor: usize) -> f64 {
        let data = &self.model.rotors[rotor];
        let turned = if self.model.is_free() {
            self.displacement(&data.mean_rotation)
        } else {
            data.speed * self.state.time
        };
        data.angle + turned
    }

    /// Mean speed of a rotor [rad/s].
    pub fn speed(&self, rotor: usize) -> f64 {
        let data = &self.model.rotors[rotor];
        if self.model.is_free() {
            self.velocity(&data.mean_rotation)
        } else {
            data.speed
        }
    }

    /// Torsional vibration of a station of a rotor on top of the mean rotation [rad].
    pub fn torsion(&self, rotor: usize, theta: &Row) -> f64 {
        let mean = if self.model.is_free() {
            self.displacement(&self.model.rotors[rotor].mean_rotation)
        } else {
            0.0
        };
        self.displacement(theta) - mean
    }

    pub(super) fn phase(&self, mesh: &Mesh) -> Phase {
        match mesh.turning {
            Some(coupling) => {
                let [angle, velocity] = self.state.seen(coupling);
                mesh.phase_of(angle, velocity)
            }
            None => mesh.phase_at(self.state.time),
        }
    }

    /// k(t) [N/m].
    pub fn mesh_stiffness(&self, mesh: usize) -> f64 {
        let mesh = &self.model.meshes[mesh];
        mesh.stiffness(self.phase(mesh))
    }

    /// delta, transmission error included [m].
    pub fn mesh_deflection(&self, mesh: usize) -> f64 {
        let mesh = &self.model.meshes[mesh];
        let seen = self.state.seen(mesh.couplings.start);
        let error = mesh.error_at(self.phase(mesh));
        mesh.compression(0, error, seen).depth
    }

    /// F, compression positive, negative where the back flank carries it [N].
    pub fn mesh_force(&self, mesh: usize) -> f64 {
        let [front, back] = self.flank_forces(&self.model.meshes[mesh]);
        front - back
    }

    /// Normal force of the reference flank and of the back flank [N].
    pub(super) fn flank_forces(&self, mesh: &Mesh) -> [f64; 2] {
        let phase = self.phase(mesh);
        let (k, error) = (mesh.stiffness(phase), mesh.error_at(phase));
        [0, 1].map(|flank| {
            if flank == 1 && mesh.backlash.is_none() {
                return 0.0;
            }
            let seen = self.state.seen(mesh.couplings.start + flank);
            mesh.flank_force(k, mesh.compression(flank, error, seen))
        })
    }

    /// What a mesh does to gear a and gear b.
    pub fn mesh_loads(&self, mesh: usize) -> [GearLoad; 2] {
        let mesh = &self.model.meshes[mesh];
        let printed = (mesh.torque_coupling == TorqueCoupling::AsPrinted).then(|| {
            let row = &mesh.rotation_row;
            let k = mesh.stiffness(self.phase(mesh));
            k * self.displacement(row) + mesh.damping * self.velocity(row)
        });
        mesh.loads(self.flank_forces(mesh), printed)
    }

    /// Sum of the mesh torques on a gear [N m].
    pub fn mesh_torque(&self, gear: GearAddress) -> f64 {
        let sides = self.model.sides_of(gear);
        sides
            .map(|(mesh, side)| self.mesh_loads(mesh)[side].torque)
            .sum()
    }

    /// Motion of the shaft at a bearing relative to the gearbox.
    pub(super) fn relative_to_gearbox(&self, bearing: &Bearing, input: usize) -> BaseMotion {
        let rows = bearing.relative.each_ref();
        let shaft = BaseMotion {
            displacement: rows.map(|row| self.displacement(row)),
            velocity: rows.map(|row| self.velocity(row)),
        };
        shaft.plus(&self.gearbox(input).times(-1.0))
    }

    /// Motion of the gearbox at a bearing.
    fn gearbox(&self, input: usize) -> BaseMotion {
        self.inputs.base(input).plus(&self.vibration)
    }
}
