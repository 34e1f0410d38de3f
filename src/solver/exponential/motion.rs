//! The motion of all parts in decoupled states.

use core::ops::Range;

use pulp::Simd;

use super::super::Ramp;
use super::super::state::Track;
use super::block_diagonal::{BlockDiagonal, add_pairs};
use super::lanes::{Quad, add_multiple, add_products};
use super::loads::Loads;
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
    latest: Vec<Ramp>,
    loads: Loads,
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
            latest: Vec::with_capacity(loads),
            loads: Loads::on(parts),
            ramps: false,
            dynamics,
        }
    }

    /// The loads from outside.
    #[inline(always)]
    pub(super) fn set_loads<S: Simd>(&mut self, simd: S, ramps: &[Ramp]) {
        if self.latest == ramps {
            return; // nothing has changed since the call before
        }
        self.latest.clear();
        self.latest.extend_from_slice(ramps);
        self.ramps = ramps.iter().any(|ramp| ramp.rate != 0.0);
        self.loads
            .exert(simd, |load| ramps[load].first, &mut self.load);
        if self.ramps {
            self.loads
                .exert(simd, |load| ramps[load].rate, &mut self.load_rate);
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

    /// B eta + load, some seconds after the start of the call.
    #[inline(always)]
    pub(super) fn differentiate<S: Simd>(&mut self, simd: S, elapsed: f64) {
        let quads = self.derivative.iter_mut().zip(&self.states).zip(&self.load);
        for (((derivative, state), load), pairs) in quads.zip(&self.dynamics.pairs) {
            let mut sum = *load;
            add_pairs(simd, pairs, state, &mut sum);
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

    /// eta + h phi_1 (B eta + load) + h^2 phi_2 load', without the larger blocks of both matrices.
    #[inline(always)]
    pub(super) fn advance<S: Simd>(
        &mut self,
        simd: S,
        gain: &BlockDiagonal,
        ramp_gain: &BlockDiagonal,
    ) {
        let derivatives = self.derivative.iter().zip(&gain.pairs);
        for (state, (derivative, gain)) in self.states.iter_mut().zip(derivatives) {
            add_pairs(simd, gain, derivative, state);
        }
        if self.ramps {
            let rates = self.load_rate.iter().zip(&ramp_gain.pairs);
            for (state, (rate, gain)) in self.states.iter_mut().zip(rates) {
                add_pairs(simd, gain, rate, state);
            }
        }
    }

    /// Some states grow by the next columns of a list times factors.
    #[inline(always)]
    pub(super) fn push<S: Simd>(
        &mut self,
        simd: S,
        quads: &Range<usize>,
        columns: &mut &[[Quad; 4]],
        factors: &[Quad; 4],
    ) {
        let states = &mut self.states[quads.clone()];
        let own;
        (own, *columns) = columns.split_at(states.len());
        for (state, columns) in states.iter_mut().zip(own) {
            add_products(simd, factors.each_ref(), columns.each_ref(), state);
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
