//! What the outside sees of a state: displacements, mesh forces, bearing forces.
//!
//! ```text
//!   mesh      delta = w q,  F = k(t) delta + c delta'           on b: +F n, torque -s F R_b
//!   bearing   force of the rotor on the gearbox = K (u - u_b) + C (u' - u_b')
//! ```
//!
//! Every quantity is computed when it is asked for, from the state, the inputs and the time.

use super::excitation::product;
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
}

impl Motion<'_> {
    /// Displacement, rotation or deflection along a row.
    pub fn displacement(&self, row: &Row) -> f64 {
        row.dot(&self.state.position)
    }

    fn velocity(&self, row: &Row) -> f64 {
        row.dot(&self.state.velocity)
    }

    /// Rotation angle of a rotor [rad].
    pub fn angle(&self, rotor: usize) -> f64 {
        let rotor = &self.model.rotors[rotor];
        rotor.angle + rotor.speed * self.state.time
    }

    /// k(t) [N/m].
    pub fn mesh_stiffness(&self, mesh: usize) -> f64 {
        self.model.meshes[mesh].stiffness(self.state.time)
    }

    /// delta [m].
    pub fn mesh_deflection(&self, mesh: usize) -> f64 {
        self.displacement(&self.model.meshes[mesh].row)
    }

    /// F, compression positive [N].
    pub fn mesh_force(&self, mesh: usize) -> f64 {
        self.force_along(mesh, &self.model.meshes[mesh].row)
    }

    fn force_along(&self, mesh: usize, row: &Row) -> f64 {
        self.mesh_stiffness(mesh) * self.displacement(row)
            + self.model.meshes[mesh].damping * self.velocity(row)
    }

    /// What a mesh does to gear a and gear b.
    pub fn mesh_loads(&self, mesh: usize) -> [GearLoad; 2] {
        let Mesh {
            line,
            torque_coupling,
            rotation_row,
            ..
        } = &self.model.meshes[mesh];
        let mut loads = line.loads(self.mesh_force(mesh));
        if *torque_coupling == TorqueCoupling::AsPrinted {
            let printed = line.loads(self.force_along(mesh, rotation_row));
            for (load, printed) in loads.iter_mut().zip(printed) {
                load.torque = printed.torque;
            }
        }
        loads
    }

    /// Sum of the mesh torques on a gear [N m].
    pub fn mesh_torque(&self, gear: GearAddress) -> f64 {
        let mut sum = 0.0;
        for (index, mesh) in self.model.meshes.iter().enumerate() {
            for (side, address) in mesh.gears.iter().enumerate() {
                if *address == gear {
                    sum += self.mesh_loads(index)[side].torque;
                }
            }
        }
        sum
    }

    /// Force of the rotor on the gearbox through a bearing [N]; `input` is the bearing's place among the
    /// inputs.
    pub fn bearing_force(&self, bearing: &Bearing, input: usize) -> [f64; 2] {
        let station = &bearing.station;
        let base = self.base_motion(input);
        let relative = |shaft: [f64; 2], base: [f64; 2]| [shaft[0] - base[0], shaft[1] - base[1]];
        let displacement = [self.displacement(&station.x), self.displacement(&station.y)];
        let velocity = [self.velocity(&station.x), self.velocity(&station.y)];
        let spring = product(
            &bearing.stiffness,
            relative(displacement, base.displacement),
        );
        let damper = product(&bearing.damping, relative(velocity, base.velocity));
        [spring[0] + damper[0], spring[1] + damper[1]]
    }

    /// Motion of the gearbox at a bearing: the input plus the gearbox vibration.
    fn base_motion(&self, input: usize) -> BaseMotion {
        let mut base = self.model.vibration.motion(self.state.time);
        let set = &self.inputs.bases[input];
        for axis in 0..2 {
            base.displacement[axis] += set.displacement[axis];
            base.velocity[axis] += set.velocity[axis];
        }
        base
    }
}
