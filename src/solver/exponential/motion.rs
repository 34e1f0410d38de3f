//! The motion of all parts in decoupled states.

use super::super::Ramp;
use super::super::state::Track;
use super::block_diagonal::{BlockDiagonal, add_pairs};
use super::lanes::{Quad, add_multiple};
use super::part::Part;
use crate::linalg::multiply_add;

/// The states of all parts in every list.
#[derive(Debug, Clone)]
pub(super) struct Motion {
    /// eta.
    pub(super) states: Vec<Quad>,
    /// B eta + load.
    pub(super) derivative: Vec<Quad>,
    /// The load from outside at the start of the call, and its change per second.
    load: Vec<Quad>,
    pub(super) load_rate: Vec<Quad>,
    /// What these belong to.
    loads: Vec<Ramp>,
    /// Whether it changes.
    pub(super) ramps: bool,
    /// B.
    dynamics: BlockDiagonal,
}

impl Motion {
    /// At rest.
    pub(super) fn new(parts: &[Part], loads: usize) -> Motion {
        let quads = parts.iter().map(|part| part.quads().len()).sum();
        let zeros = || vec![[0.0; 4]; quads];
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
            loads: Vec::with_capacity(loads),
            ramps: false,
            dynamics,
        }
    }

    /// The loads from outside.
    #[inline(always)]
    pub(super) fn set_loads(&mut self, parts: &[Part], ramps: &[Ramp]) {
        if self.loads == ramps {
            return; // nothing has changed since the call before
        }
        self.loads.clear();
        self.loads.extend_from_slice(ramps);
        self.ramps = ramps.iter().any(|ramp| ramp.rate != 0.0);
        for part in parts {
            exert(part, ramps, |ramp| ramp.first, &mut self.load[part.quads()]);
            if self.ramps {
                let own = &mut self.load_rate[part.quads()];
                exert(part, ramps, |ramp| ramp.rate, own);
            }
        }
    }

    /// Decoupled states from displacements and velocities.
    pub(super) fn take_apart(&mut self, parts: &[Part], whole: &Track) {
        self.states.fill([0.0; 4]);
        for part in parts {
            let range = part.coordinates.clone();
            let own = self.states[part.quads()].as_flattened_mut();
            let (per_position, per_velocity) =
                part.inverse.as_slice().split_at(range.len() * own.len());
            multiply_add(1.0, per_position, &whole.position[range.clone()], own);
            multiply_add(1.0, per_velocity, &whole.velocity[range], own);
        }
    }

    /// Whether all states are numbers.
    #[inline(always)]
    pub(super) fn is_finite(&self) -> bool {
        let mut zeros = [0.0; 4];
        for state in &self.states {
            add_multiple(&mut zeros, 0.0, state);
        }
        zeros == [0.0; 4]
    }

    /// B eta + load, some seconds after the start of the call.
    #[inline(always)]
    pub(super) fn differentiate(&mut self, elapsed: f64) {
        let quads = self.derivative.iter_mut().zip(&self.states).zip(&self.load);
        for (((derivative, state), load), pairs) in quads.zip(&self.dynamics.pairs) {
            let mut sum = *load;
            add_pairs(pairs, state, &mut sum);
            *derivative = sum;
        }
        if self.ramps {
            for (derivative, rate) in self.derivative.iter_mut().zip(&self.load_rate) {
                add_multiple(derivative, elapsed, rate);
            }
        }
        let states = self.states.as_flattened();
        self.dynamics
            .add_others(states, self.derivative.as_flattened_mut());
    }

    /// The step of one part: eta + h phi_1 (B eta + load) + h^2 phi_2 load' + columns times what acts, without the larger blocks of
    /// both matrices.
    #[inline(always)]
    pub(super) fn advance(
        &mut self,
        part: &Part,
        [gain, ramp_gain]: [&BlockDiagonal; 2],
        columns: &[Quad],
        acting: &[[f64; 2]],
    ) {
        let range = part.quads();
        let states = self.states[range.clone()].iter_mut();
        let derivatives = &self.derivative[range.clone()];
        let gains = &gain.pairs[range.clone()];
        let mut columns = columns;
        for ((state, derivative), gain) in states.zip(derivatives).zip(gains) {
            // Two sums, so that one addition need not wait for the last.
            let (mut one, mut two) = (*state, [0.0; 4]);
            add_pairs(gain, derivative, &mut two);
            let (own, others) = columns.split_at(2 * acting.len());
            for (columns, factors) in own.as_chunks::<2>().0.iter().zip(acting) {
                add_multiple(&mut one, factors[0], &columns[0]);
                add_multiple(&mut two, factors[1], &columns[1]);
            }
            columns = others;
            *state = core::array::from_fn(|i| one[i] + two[i]);
        }
        if self.ramps {
            let states = self.states[range.clone()].iter_mut();
            let rates = &self.load_rate[range.clone()];
            for ((state, rate), gain) in states.zip(rates).zip(&ramp_gain.pairs[range]) {
                add_pairs(gain, rate, state);
            }
        }
    }

    /// What larger blocks of both matrices add to that.
    pub(super) fn advance_others(&mut self, gain: &BlockDiagonal, ramp_gain: &BlockDiagonal) {
        let states = self.states.as_flattened_mut();
        gain.add_others(self.derivative.as_flattened(), states);
        if self.ramps {
            ramp_gain.add_others(self.load_rate.as_flattened(), states);
        }
    }
}

/// Overwrites the states of a part with what a value of each load exerts on them.
#[inline(always)]
fn exert(part: &Part, ramps: &[Ramp], value: impl Fn(&Ramp) -> f64, target: &mut [Quad]) {
    target.fill([0.0; 4]);
    let columns = part.load_columns.chunks_exact(target.len().max(1));
    for (column, &number) in columns.zip(&part.loads) {
        let factor = value(&ramps[number]);
        for (sum, column) in target.iter_mut().zip(column) {
            add_multiple(sum, factor, column);
        }
    }
}
