//! What a master sets while the simulation runs, and the vibration of all supports beside it.
//!
//! ```text
//!   f = sum over torques of T w_th + sum over bearings of r' (K u_b + C u_b') + sum over points of the housing of psi' F
//!   u(t) = first + (t - since) rate                             while a call lasts: held, or with input derivatives
//!   gearbox vibration  x_b = a_x sin(w t),  y_b = a_y sin(w t + psi)    at every bearing
//! ```

use core::f64::consts::TAU;

use serde::{Deserialize, Serialize};

use super::{Bearing, Housing, ModalModel, Rotor};
use crate::config::{GearboxVibration, Planar};
use crate::solver::{Harmonic, Ramp, Row, State};

/// Everything a master sets while the simulation runs, or how it changes per second.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Inputs {
    /// External torques [N m], in the order of [`ModalModel::torques`].
    pub torques: Vec<f64>,
    /// Gearbox motion, in the order of [`ModalModel::bearings`]; none where a housing in the model moves the bearing.
    pub bases: Vec<BaseMotion>,
    /// Forces from outside on the points of the housing that take some, in x and y [N].
    pub forces: Vec<[f64; 2]>,
}

/// Motion of the gearbox at one bearing.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct BaseMotion {
    /// Displacement in x and y [m].
    pub displacement: [f64; 2],
    /// Velocity in x and y [m/s].
    pub velocity: [f64; 2],
}

/// One of the inputs: its kind, and the number of the torque, bearing or force.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Place {
    /// A torque.
    Torque(u32),
    /// Displacement of the gearbox in x.
    DisplacementX(u32),
    /// Displacement of the gearbox in y.
    DisplacementY(u32),
    /// Velocity of the gearbox in x.
    VelocityX(u32),
    /// Velocity of the gearbox in y.
    VelocityY(u32),
    /// A force on the housing in x.
    ForceX(u32),
    /// A force on the housing in y.
    ForceY(u32),
}

/// The inputs while a call lasts: first + (t - since) rate.
#[derive(Debug, Clone, Copy)]
pub struct Course<'a> {
    /// The inputs at the start of the call.
    pub first: &'a Inputs,
    /// Their changes per second; `None` where they are held.
    pub rate: Option<&'a Inputs>,
    /// The start of the call [s].
    pub since: f64,
}

/// The sinusoidal motion of all supports.
#[derive(Debug, Clone)]
pub(super) struct SupportVibration {
    amplitude: [f64; 2],
    /// Cosine and sine of the phases.
    phase: [[f64; 2]; 2],
    /// Circular frequency [rad/s].
    frequency: f64,
}

impl Inputs {
    /// The input at a place.
    pub fn at(&self, place: Place) -> f64 {
        match place {
            Place::Torque(torque) => self.torques[torque as usize],
            Place::DisplacementX(bearing) => self.bases[bearing as usize].displacement[0],
            Place::DisplacementY(bearing) => self.bases[bearing as usize].displacement[1],
            Place::VelocityX(bearing) => self.bases[bearing as usize].velocity[0],
            Place::VelocityY(bearing) => self.bases[bearing as usize].velocity[1],
            Place::ForceX(force) => self.forces[force as usize][0],
            Place::ForceY(force) => self.forces[force as usize][1],
        }
    }

    /// Puts a value in its place.
    #[inline(always)]
    pub fn put(&mut self, place: Place, value: f64) {
        let (bases, forces) = (&mut self.bases, &mut self.forces);
        match place {
            Place::Torque(torque) => self.torques[torque as usize] = value,
            Place::DisplacementX(bearing) => bases[bearing as usize].displacement[0] = value,
            Place::DisplacementY(bearing) => bases[bearing as usize].displacement[1] = value,
            Place::VelocityX(bearing) => bases[bearing as usize].velocity[0] = value,
            Place::VelocityY(bearing) => bases[bearing as usize].velocity[1] = value,
            Place::ForceX(force) => forces[force as usize][0] = value,
            Place::ForceY(force) => forces[force as usize][1] = value,
        }
    }

    /// Takes over the values of others of the same shape; allocates nothing.
    pub fn overwrite(&mut self, others: &Inputs) {
        self.torques.copy_from_slice(&others.torques);
        self.bases.copy_from_slice(&others.bases);
        self.forces.copy_from_slice(&others.forces);
    }

    /// Adds what changes in `elapsed` seconds.
    pub fn add_change(&mut self, rate: &Inputs, elapsed: f64) {
        for (torque, rate) in self.torques.iter_mut().zip(&rate.torques) {
            *torque += elapsed * rate;
        }
        for (base, rate) in self.bases.iter_mut().zip(&rate.bases) {
            *base = base.plus(&rate.times(elapsed));
        }
        let forces = self.forces.iter_mut().flatten();
        for (force, rate) in forces.zip(rate.forces.iter().flatten()) {
            *force += elapsed * rate;
        }
    }

    /// Whether there are as many inputs of every kind in both.
    pub fn is_like(&self, other: &Inputs) -> bool {
        self.torques.len() == other.torques.len()
            && self.bases.len() == other.bases.len()
            && self.forces.len() == other.forces.len()
    }

    /// Whether all of them are numbers.
    pub fn is_finite(&self) -> bool {
        let of_bases = self.bases.iter();
        let of_bases = of_bases.flat_map(|base| base.displacement.iter().chain(&base.velocity));
        self.torques
            .iter()
            .chain(of_bases)
            .chain(self.forces.iter().flatten())
            .all(|value| value.is_finite())
    }

    /// Puts down the values along the columns of [`columns`]. Where bearings follow a free speed, the motion of the gearbox
    /// acts through [`super::Excitation`] instead.
    fn exert(&self, model: &ModalModel, loads: &mut [Ramp], put: impl Fn(&mut Ramp, f64)) {
        let (of_torques, others) = loads.split_at_mut(self.torques.len());
        let (of_bearings, of_forces) = others.split_at_mut(2 * self.bases.len());
        for (load, &torque) in of_torques.iter_mut().zip(&self.torques) {
            put(load, torque);
        }
        let mut pairs = of_bearings.as_chunks_mut().0.iter_mut().zip(&self.bases);
        for rotor in &model.rotors {
            for (bearing, ([x, y], base)) in rotor.bearings.iter().zip(&mut pairs) {
                let force = if bearing.follows_speed {
                    [0.0; 2]
                } else {
                    bearing.base_force(base)
                };
                put(x, force[0]);
                put(y, force[1]);
            }
        }
        for (load, &force) in of_forces.iter_mut().zip(self.forces.as_flattened()) {
            put(load, force);
        }
    }

    /// The generalized load of torques, gearbox displacements and forces on the housing.
    pub(super) fn static_load(&self, model: &ModalModel) -> Vec<f64> {
        let mut load = vec![0.0; model.system.size];
        for (row, &torque) in model.torques().zip(&self.torques) {
            row.add_to(torque, &mut load);
        }
        for (bearing, base) in model.bearings().zip(&self.bases) {
            let still = BaseMotion {
                velocity: [0.0; 2],
                ..*base
            };
            bearing.base_load(&still, &mut load);
        }
        let loaded = model.housing.iter().flat_map(Housing::loaded);
        for (row, &force) in loaded.zip(self.forces.iter().flatten()) {
            row.add_to(force, &mut load);
        }
        load
    }
}

impl Course<'_> {
    /// Overwrites `loads` with what the inputs exert along [`crate::solver::System::loads`].
    pub fn loads_into(&self, model: &ModalModel, loads: &mut [Ramp]) {
        let held = |load: &mut Ramp, first: f64| *load = Ramp { first, rate: 0.0 };
        self.first.exert(model, loads, held);
        if let Some(rate) = self.rate {
            rate.exert(model, loads, |load, rate| load.rate = rate);
        }
    }

    /// Motion of the gearbox at a bearing.
    pub(super) fn base(&self, input: usize, time: f64) -> BaseMotion {
        let first = self.first.bases[input];
        match self.rate {
            None => first,
            Some(rate) => first.plus(&rate.bases[input].times(time - self.since)),
        }
    }
}

/// The columns along which the inputs act: external torques, x and y of every bearing, x and y of the housing's loaded points.
pub(super) fn columns(rotors: &[Rotor], housing: Option<&Housing>) -> Vec<Row> {
    let torques = rotors.iter().flat_map(|rotor| &rotor.torques);
    let bearings = rotors.iter().flat_map(|rotor| &rotor.bearings);
    let of_bearings = bearings.flat_map(|bearing| &bearing.relative);
    let of_housing = housing.into_iter().flat_map(Housing::loaded);
    let all = torques.chain(of_bearings).chain(of_housing);
    all.cloned().collect()
}

impl BaseMotion {
    /// A multiple of the motion.
    pub(super) fn times(&self, factor: f64) -> BaseMotion {
        BaseMotion {
            displacement: self.displacement.map(|value| factor * value),
            velocity: self.velocity.map(|value| factor * value),
        }
    }

    /// The sum of two motions.
    pub(super) fn plus(&self, other: &BaseMotion) -> BaseMotion {
        let sum = |one: [f64; 2], two: [f64; 2]| [one[0] + two[0], one[1] + two[1]];
        BaseMotion {
            displacement: sum(self.displacement, other.displacement),
            velocity: sum(self.velocity, other.velocity),
        }
    }
}

impl Bearing {
    /// K u_b + C u_b'.
    pub(super) fn base_force(&self, base: &BaseMotion) -> [f64; 2] {
        let spring = product(&self.stiffness, base.displacement);
        let damper = product(&self.damping, base.velocity);
        [spring[0] + damper[0], spring[1] + damper[1]]
    }

    /// load += r' (K u_b + C u_b').
    fn base_load(&self, base: &BaseMotion, load: &mut [f64]) {
        for (row, force) in self.relative.iter().zip(self.base_force(base)) {
            row.add_to(force, load);
        }
    }
}

/// Cosine and sine of an angle.
fn turned(angle: f64) -> [f64; 2] {
    let (sine, cosine) = libm::sincos(angle);
    [cosine, sine]
}

/// K u or C u'.
pub(super) fn product(matrix: &Planar, motion: [f64; 2]) -> [f64; 2] {
    matrix
        .rows()
        .map(|[per_x, per_y]| per_x * motion[0] + per_y * motion[1])
}

impl SupportVibration {
    pub(super) fn new(vibration: &GearboxVibration) -> SupportVibration {
        SupportVibration {
            amplitude: [vibration.amplitude_x, vibration.amplitude_y],
            phase: [0.0, vibration.phase_y].map(turned),
            frequency: TAU * vibration.frequency,
        }
    }

    /// Motion of every support at `time`.
    pub(super) fn motion(&self, time: f64) -> BaseMotion {
        if self.amplitude == [0.0, 0.0] {
            return BaseMotion::default();
        }
        self.at(turned(self.frequency * time))
    }

    /// Motion of every support in a state; of the harmonics it is the last one.
    pub(super) fn in_state(&self, state: &State, harmonics: &[Harmonic]) -> BaseMotion {
        let last = harmonics.len().wrapping_sub(1);
        match state.turned(last) {
            Some(angle) if self.amplitude != [0.0, 0.0] => self.at(angle),
            _ => self.motion(state.time),
        }
    }

    /// Rate of that motion at `time`: velocity and acceleration.
    pub(super) fn rate(&self, time: f64) -> BaseMotion {
        if self.amplitude == [0.0, 0.0] {
            return BaseMotion::default();
        }
        // A quarter turn ahead, times the circular frequency.
        let [cosine, sine] = turned(self.frequency * time);
        self.at([-sine, cosine]).times(self.frequency)
    }

    /// Motion where w t has this cosine and sine.
    pub(super) fn at(&self, [cosine, sine]: [f64; 2]) -> BaseMotion {
        let mut motion = BaseMotion::default();
        for (axis, [c, s]) in self.phase.into_iter().enumerate() {
            motion.displacement[axis] = self.amplitude[axis] * (sine * c + cosine * s);
            motion.velocity[axis] = self.amplitude[axis] * self.frequency * (cosine * c - sine * s);
        }
        motion
    }

    /// The load of the vibration through all bearings: its values at angle 0 and at a quarter turn.
    pub(super) fn harmonic(&self, rotors: &[Rotor], size: usize) -> Option<Harmonic> {
        if self.amplitude == [0.0, 0.0] {
            return None;
        }
        let load_at = |turned: [f64; 2]| {
            let mut load = vec![0.0; size];
            let motion = self.at(turned);
            let bearings = rotors.iter().flat_map(|rotor| &rotor.bearings);
            for bearing in bearings.filter(|bearing| !bearing.follows_speed) {
                bearing.base_load(&motion, &mut load);
            }
            load
        };
        Some(Harmonic {
            frequency: self.frequency,
            phase: 0.0,
            cosine: load_at([1.0, 0.0]),
            sine: load_at([0.0, 1.0]),
            offset: 0,
        })
    }
}
