//! How what the outside sees changes with the motion: exact derivatives of everything in [`Motion`].
//!
//! ```text
//!   mesh      dF = dk d + k dd + c dd',    dk = k'(p) dp,   dd = w dq - e'(p) dp
//!   bearing   dF = K du + C du' + (dK/dOm u + dC/dOm u') dOm + (tangent of F_r) du,     u relative to the gearbox
//! ```
//!
//! The same formulas serve two questions: along the inputs at a fixed instant (directional derivatives), and along time
//! (output derivatives).

use super::inputs::product;
use super::radial::Stiffness;
use super::tooth_contact::Phase;
use super::{BaseMotion, Bearing, Inputs, Mesh, Motion};
use crate::config::TorqueCoupling;
use crate::mesh::GearLoad;
use crate::solver::Row;
use crate::train::GearAddress;

/// A motion, and a direction in which it changes.
#[derive(Debug, Clone, Copy)]
pub struct Change<'a> {
    /// The motion.
    pub motion: Motion<'a>,
    /// dq, one entry per coordinate.
    pub position: &'a [f64],
    /// dq'.
    pub velocity: &'a [f64],
    /// Change of the inputs.
    pub inputs: &'a Inputs,
    /// Change of time [s per unit]: 1 along time, 0 at a fixed instant.
    pub time: f64,
}

impl Change<'_> {
    /// Of a displacement, rotation or deflection along a row.
    pub fn displacement(&self, row: &Row) -> f64 {
        row.dot(self.position)
    }

    pub(super) fn velocity(&self, row: &Row) -> f64 {
        row.dot(self.velocity)
    }

    /// Of the rotation angle of a rotor [rad].
    pub fn angle(&self, rotor: usize) -> f64 {
        let data = &self.motion.model.rotors[rotor];
        if self.motion.model.is_free() {
            self.displacement(&data.mean_rotation)
        } else {
            data.speed * self.time
        }
    }

    /// Of the mean speed of a rotor [rad/s].
    pub fn speed(&self, rotor: usize) -> f64 {
        if self.motion.model.is_free() {
            self.velocity(&self.motion.model.rotors[rotor].mean_rotation)
        } else {
            0.0
        }
    }

    /// Of the torsional vibration of a station on top of the mean rotation [rad].
    pub fn torsion(&self, rotor: usize, theta: &Row) -> f64 {
        let mean = if self.motion.model.is_free() {
            self.angle(rotor)
        } else {
            0.0
        };
        self.displacement(theta) - mean
    }

    /// Change of the phase and of its rate.
    fn phase(&self, mesh: &Mesh) -> Phase {
        if self.motion.model.is_free() {
            let gear = mesh.gears[0];
            let theta = &self.motion.model.rotors[gear.rotor].gears[gear.gear].theta;
            Phase {
                value: mesh.pitches * self.displacement(theta),
                rate: mesh.pitches * self.velocity(theta),
            }
        } else {
            Phase {
                value: mesh.phase_rate * self.time,
                rate: 0.0,
            }
        }
    }

    /// Of k(t) [N/m].
    pub fn mesh_stiffness(&self, mesh: usize) -> f64 {
        let mesh = &self.motion.model.meshes[mesh];
        mesh.stiffness_slope(self.motion.phase(mesh)) * self.phase(mesh).value
    }

    /// Of delta [m].
    pub fn mesh_deflection(&self, mesh: usize) -> f64 {
        let mesh = &self.motion.model.meshes[mesh];
        let seen = [self.displacement(&mesh.row), self.velocity(&mesh.row)];
        mesh.compression_change(0, self.motion.phase(mesh), self.phase(mesh), seen)
            .depth
    }

    /// Of F [N].
    pub fn mesh_force(&self, mesh: usize) -> f64 {
        let [front, back] = self.flank_forces(mesh);
        front - back
    }

    /// Of the normal forces of the reference flank and of the back flank [N]; an open flank stays open.
    fn flank_forces(&self, index: usize) -> [f64; 2] {
        let (motion, mesh) = (&self.motion, &self.motion.model.meshes[index]);
        let (phase, phase_change) = (motion.phase(mesh), self.phase(mesh));
        let (k, k_change) = (mesh.stiffness(phase), self.mesh_stiffness(index));
        let (forces, error) = (motion.flank_forces(mesh), mesh.error_at(phase));
        [0, 1].map(|flank| {
            let absent = flank == 1 && mesh.backlash.is_none();
            let open = mesh.backlash.is_some() && forces[flank] == 0.0;
            if absent || open {
                return 0.0;
            }
            let row = &motion.model.system.couplings[mesh.couplings.start + flank].row;
            let seen = motion.state.seen(mesh.couplings.start + flank);
            let change = [self.displacement(row), self.velocity(row)];
            let depth = mesh.compression(flank, error, seen).depth;
            let change = mesh.compression_change(flank, phase, phase_change, change);
            k_change * depth + k * change.depth + mesh.damping * change.rate
        })
    }

    /// Of what a mesh does to gear a and gear b.
    pub fn mesh_loads(&self, index: usize) -> [GearLoad; 2] {
        let mesh = &self.motion.model.meshes[index];
        let forces = self.flank_forces(index);
        let printed = (mesh.torque_coupling == TorqueCoupling::AsPrinted).then(|| {
            let row = &mesh.rotation_row;
            let k = mesh.stiffness(self.motion.phase(mesh));
            self.mesh_stiffness(index) * self.motion.displacement(row)
                + k * self.displacement(row)
                + mesh.damping * self.velocity(row)
        });
        mesh.loads(forces, printed)
    }

    /// Of the sum of the mesh torques on a gear [N m].
    pub fn mesh_torque(&self, gear: GearAddress) -> f64 {
        let model = self.motion.model;
        model
            .sides_of(gear)
            .map(|(mesh, side)| self.mesh_loads(mesh)[side].torque)
            .sum()
    }

    /// Of the force of the rotor on the gearbox through a bearing [N]; `input` is the bearing's place among the
    /// inputs.
    pub fn bearing_force(&self, rotor: usize, bearing: &Bearing, input: usize) -> [f64; 2] {
        let motion = &self.motion;
        let speed = motion.speed(rotor);
        let (stiffness, damping) = bearing.at_speed(speed);
        let base = self.base(input);
        let [x, y] = &bearing.relative;
        let displacement = [
            self.displacement(x) - base.displacement[0],
            self.displacement(y) - base.displacement[1],
        ];
        let velocity = [
            self.velocity(x) - base.velocity[0],
            self.velocity(y) - base.velocity[1],
        ];
        let seen = motion.relative_to_gearbox(bearing, input);
        let (stiffness_slope, damping_slope) = bearing.slopes_at(speed);
        let with_speed = self.speed(rotor);
        let parts = [
            product(&stiffness, displacement),
            product(&damping, velocity),
            product(&stiffness_slope, seen.displacement).map(|force| force * with_speed),
            product(&damping_slope, seen.velocity).map(|force| force * with_speed),
            self.radial_force(input, seen.displacement, displacement),
        ];
        [0, 1].map(|axis| parts.iter().map(|part| part[axis]).sum())
    }

    /// The same for the bearing at a place among the inputs.
    pub fn force_on_gearbox(&self, input: usize) -> [f64; 2] {
        let (rotor, bearing) = self.motion.model.bearing_of(input);
        self.bearing_force(rotor, bearing, input)
    }

    /// Change of the radial force beside the linear bearing: F_r' along the displacement, F_r / r across.
    fn radial_force(&self, input: usize, [x, y]: [f64; 2], change: [f64; 2]) -> [f64; 2] {
        let mut radial = self.motion.model.radial.iter();
        let radius = libm::hypot(x, y);
        let Some(radial) = radial.find(|one| one.input == input && radius > 0.0) else {
            return [0.0; 2];
        };
        let Stiffness {
            slope: along,
            secant: across,
        } = Stiffness::of(&radial.force, radius);
        let outward = (x * change[0] + y * change[1]) / (radius * radius);
        [
            across * change[0] + (along - across) * outward * x,
            across * change[1] + (along - across) * outward * y,
        ]
    }

    /// Change of the gearbox's motion at a bearing.
    fn base(&self, input: usize) -> BaseMotion {
        let vibration = self.motion.model.vibration.rate(self.motion.state.time);
        self.inputs.base(input).plus(&vibration.times(self.time))
    }
}
