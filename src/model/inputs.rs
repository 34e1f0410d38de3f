//! What a master sets while the simulation runs, and the vibration of all supports beside it.
//!
//! ```text
//!   f = sum over torques of T w_th + sum over bearings of r' (K u_b + C u_b') + sum over points of the housing of psi' F
//!   u(t) = first + (t - since) rate                             while a call lasts: held, or with input derivatives
//!   gearbox vibration  x_b = a_x sin(w t),  y_b = a_y sin(w t + psi)    at every bearing
//! ```

use core::f64::consts::TAU;

use serde::{Deserialize, Serialize};

use super::{Housing, ModalModel, Rotor};
use crate::config::{GearboxVibration, Planar};
use crate::solver::{Harmonic, Ramp, Row, State};

/// Everything a master sets while the simulation runs, or how it changes per second, as one list of numbers:
///
/// ```text
///   torques | x y x' y' of the gearbox at every bearing | x y of every force on the housing
/// ```
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Inputs {
    values: Vec<f64>,
    /// Number of torques.
    torques: usize,
    /// Number of bearings.
    bases: usize,
}

/// Motion of the gearbox at one bearing.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct BaseMotion {
    /// Displacement in x and y [m].
    pub displacement: [f64; 2],
    /// Velocity in x and y [m/s].
    pub velocity: [f64; 2],
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
    /// External torques [N m] in the order of [`ModalModel::torques`]; gearbox motion in the order of [`ModalModel::bearings`],
    /// none where a housing in the model moves the bearing; forces from outside on the points of the housing that take some, in
    /// x and y [N].
    pub fn new(torques: &[f64], bases: &[BaseMotion], forces: &[[f64; 2]]) -> Inputs {
        let of_bases = bases.iter().flat_map(BaseMotion::numbers);
        let values = torques.iter().copied().chain(of_bases);
        Inputs {
            values: values.chain(forces.iter().flatten().copied()).collect(),
            torques: torques.len(),
            bases: bases.len(),
        }
    }

    /// External torques [N m].
    pub fn torques(&self) -> &[f64] {
        &self.values[..self.torques]
    }

    /// The same, to be changed.
    pub fn torques_mut(&mut self) -> &mut [f64] {
        &mut self.values[..self.torques]
    }

    /// Motion of the gearbox at a bearing.
    pub fn base(&self, bearing: usize) -> BaseMotion {
        let (start, _) = self.values[self.torques + 4 * bearing..].as_chunks();
        BaseMotion::of(start[0])
    }

    /// Changes the motion of the gearbox at a bearing.
    pub fn set_base(&mut self, bearing: usize, base: BaseMotion) {
        self.bases_mut()[bearing] = base.numbers();
    }

    /// x, y, x' and y' of the gearbox at every bearing [m, m/s].
    pub fn bases(&self) -> &[[f64; 4]] {
        self.values[self.torques..][..4 * self.bases].as_chunks().0
    }

    /// The same, to be changed.
    pub fn bases_mut(&mut self) -> &mut [[f64; 4]] {
        let bases = &mut self.values[self.torques..][..4 * self.bases];
        bases.as_chunks_mut().0
    }

    /// Forces on the housing in x and y [N].
    pub fn forces(&self) -> &[[f64; 2]] {
        let forces = &self.values[self.torques + 4 * self.bases..];
        forces.as_chunks().0
    }

    /// The same, to be changed.
    pub fn forces_mut(&mut self) -> &mut [[f64; 2]] {
        let forces = &mut self.values[self.torques + 4 * self.bases..];
        forces.as_chunks_mut().0
    }

    /// The whole list.
    pub fn values(&self) -> &[f64] {
        &self.values
    }

    /// The same, to be changed.
    pub fn values_mut(&mut self) -> &mut [f64] {
        &mut self.values
    }

    /// Where in the list a torque is.
    pub fn place_of_torque(&self, torque: usize) -> usize {
        torque
    }

    /// Where the gearbox's displacement at a bearing is, in x (0) or y (1).
    pub fn place_of_displacement(&self, bearing: usize, axis: usize) -> usize {
        self.torques + 4 * bearing + axis
    }

    /// Where its velocity is.
    pub fn place_of_velocity(&self, bearing: usize, axis: usize) -> usize {
        self.place_of_displacement(bearing, 2 + axis)
    }

    /// Where a force on the housing is.
    pub fn place_of_force(&self, force: usize, axis: usize) -> usize {
        self.torques + 4 * self.bases + 2 * force + axis
    }

    /// Takes over the values of others of the same shape; allocates nothing.
    #[inline]
    pub fn overwrite(&mut self, others: &Inputs) {
        self.values.copy_from_slice(&others.values);
    }

    /// Adds what changes in `elapsed` seconds.
    pub fn add_change(&mut self, rate: &Inputs, elapsed: f64) {
        for (value, rate) in self.values.iter_mut().zip(&rate.values) {
            *value += elapsed * rate;
        }
    }

    /// Whether there are as many inputs of every kind in both.
    pub fn is_like(&self, other: &Inputs) -> bool {
        let lengths = |inputs: &Inputs| (inputs.torques, inputs.bases, inputs.values.len());
        lengths(self) == lengths(other)
    }

    /// Whether all of them are numbers.
    pub fn is_finite(&self) -> bool {
        self.values.iter().all(|value| value.is_finite())
    }

    /// Puts down the values along the columns of [`columns`].
    fn exert(&self, model: &ModalModel, loads: &mut [Ramp], put: impl Fn(&mut Ramp, f64)) {
        let (of_torques, others) = loads.split_at_mut(self.torques);
        let (of_bearings, of_forces) = others.split_at_mut(2 * self.bases);
        for (load, &torque) in of_torques.iter_mut().zip(self.torques()) {
            put(load, torque);
        }
        let pairs = of_bearings.as_chunks_mut().0.iter_mut();
        let bases = self.bases().iter().zip(&model.bearing_forces);
        for ([x, y], (&base, bearing)) in pairs.zip(bases) {
            let force = bearing.by_gearbox(base);
            put(x, force[0]);
            put(y, force[1]);
        }
        for (load, &force) in of_forces.iter_mut().zip(self.forces().as_flattened()) {
            put(load, force);
        }
    }

    /// The generalized load of torques, gearbox displacements and forces on the housing.
    pub(super) fn static_load(&self, model: &ModalModel) -> Vec<f64> {
        let mut load = vec![0.0; model.system.size];
        for (row, &torque) in model.torques().zip(self.torques()) {
            row.add_to(torque, &mut load);
        }
        for (bearing, &[x, y, ..]) in model.bearings().zip(self.bases()) {
            bearing.base_load(BaseMotion::of([x, y, 0.0, 0.0]), &mut load);
        }
        let loaded = model.housing.iter().flat_map(Housing::loaded);
        for (row, &force) in loaded.zip(self.forces().as_flattened()) {
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
        let first = self.first.base(input);
        match self.rate {
            None => first,
            Some(rate) => first.plus(&rate.base(input).times(time - self.since)),
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
    /// From x, y, x' and y'.
    pub(super) fn of([x, y, x_rate, y_rate]: [f64; 4]) -> BaseMotion {
        BaseMotion {
            displacement: [x, y],
            velocity: [x_rate, y_rate],
        }
    }

    /// x, y, x' and y'.
    pub(super) fn numbers(&self) -> [f64; 4] {
        let ([x, y], [x_rate, y_rate]) = (self.displacement, self.velocity);
        [x, y, x_rate, y_rate]
    }

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
        if self.amplitude == [0.0, 0.0] {
            return BaseMotion::default();
        }
        let last = harmonics.len().wrapping_sub(1);
        let turned = state.turned(last).map(|angle| self.at(angle));
        turned.unwrap_or_else(|| self.motion(state.time))
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
                bearing.base_load(motion, &mut load);
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
