//! The motion of all parts in decoupled states.

use super::super::{Ramp, State};
use super::block_diagonal::BlockDiagonal;
use super::part::Part;
use crate::linalg::{add_scaled, multiply_add};

/// One entry per state of all parts in every list.
#[derive(Debug, Clone)]
pub(super) struct Motion {
    /// eta.
    pub(super) states: Vec<f64>,
    /// B eta + load.
    pub(super) derivative: Vec<f64>,
    /// The load from outside at the start of the call, and its change per second.
    load: Vec<f64>,
    pub(super) load_rate: Vec<f64>,
    /// Whether it changes.
    pub(super) ramps: bool,
    /// Displacements and velocities of one part.
    together: Vec<f64>,
    /// B.
    dynamics: BlockDiagonal,
}

impl Motion {
    /// At rest.
    pub(super) fn new(parts: &[Part]) -> Motion {
        let zeros = || vec![0.0; parts.iter().map(Part::len).sum()];
        let mut dynamics = BlockDiagonal::zero(parts);
        for part in parts {
            for group in &part.groups {
                dynamics.set(part, group, 1.0, group.matrix.as_slice());
            }
        }
        Motion {
            states: zeros(),
            derivative: zeros(),
            load: zeros(),
            load_rate: zeros(),
            ramps: false,
            together: zeros(),
            dynamics,
        }
    }

    /// The loads from outside.
    pub(super) fn set_loads(&mut self, parts: &[Part], ramps: &[Ramp]) {
        self.ramps = ramps.iter().any(|ramp| ramp.rate != 0.0);
        self.load.fill(0.0);
        self.load_rate.fill(0.0);
        for part in parts {
            let own = part.states();
            for (number, column) in &part.loads {
                let Ramp { first, rate } = ramps[*number];
                if first != 0.0 {
                    add_scaled(first, column, &mut self.load[own.clone()]);
                }
                if rate != 0.0 {
                    add_scaled(rate, column, &mut self.load_rate[own.clone()]);
                }
            }
        }
    }

    /// Decoupled states from displacements and velocities.
    pub(super) fn take_apart(&mut self, parts: &[Part], state: &State) {
        self.states.fill(0.0);
        for part in parts {
            let (range, n) = (part.coordinates.clone(), part.len() / 2);
            let own = &mut self.states[part.states()];
            let (per_position, per_velocity) = part.inverse.as_slice().split_at(n * part.len());
            multiply_add(1.0, per_position, &state.position[range.clone()], own);
            multiply_add(1.0, per_velocity, &state.velocity[range], own);
        }
    }

    /// Displacements and velocities from decoupled states.
    pub(super) fn put_together(&mut self, parts: &[Part], state: &mut State) {
        for part in parts {
            let range = part.coordinates.clone();
            let together = &mut self.together[..part.len()];
            together.fill(0.0);
            let own = &self.states[part.states()];
            multiply_add(1.0, part.shapes.as_slice(), own, together);
            let (position, velocity) = together.split_at(range.len());
            state.position[range.clone()].copy_from_slice(position);
            state.velocity[range].copy_from_slice(velocity);
        }
    }

    /// B eta + load, some seconds after the start of the call.
    pub(super) fn differentiate(&mut self, elapsed: f64) {
        self.derivative.copy_from_slice(&self.load);
        if self.ramps {
            add_scaled(elapsed, &self.load_rate, &mut self.derivative);
        }
        self.dynamics
            .multiply_add(&self.states, &mut self.derivative);
    }

    /// eta + h phi_1 (B eta + load) + h^2 phi_2 load': the step without forces.
    pub(super) fn advance(&mut self, gain: &BlockDiagonal, ramp_gain: &BlockDiagonal) {
        gain.multiply_add(&self.derivative, &mut self.states);
        if self.ramps {
            ramp_gain.multiply_add(&self.load_rate, &mut self.states);
        }
    }
}
