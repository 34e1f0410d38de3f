//! What the couplings see and exert in one step.

use super::super::{Instant, Monitor};
use super::exchange::{Exchange, Influences};
use super::polynomials::{END, HERMITE_AT_CHECKS, NODES, POINTS};
use crate::linalg::dot;

/// How far the deflection of one coupling has moved from the start at all points of a step, then its rate.
pub(super) type Readings = [f64; 2 * POINTS];

/// One entry per coupling in every list.
#[derive(Debug, Clone)]
pub(super) struct Sight {
    /// Deflections and rates at the start of the step.
    pub(super) start: [Vec<f64>; 2],
    /// Movements without the forces.
    pub(super) free: Vec<Readings>,
    /// Movements.
    moved: Vec<Readings>,
    /// Deflections and rates at the points, as laws look at them.
    pub(super) points: [[Vec<f64>; 2]; POINTS],
    /// Deflections and rates elsewhere.
    pub(super) trial: [Vec<f64>; 2],
    /// How deflections and rates at the end would change with what the cubics leave out of the forces.
    pub(super) drift: Vec<[f64; 2]>,
    /// Forces at the nodes.
    pub(super) forces: Vec<[f64; NODES]>,
    /// Forces at one instant.
    pub(super) present: Vec<f64>,
}

impl Sight {
    pub(super) fn new(couplings: usize) -> Sight {
        let pair = || [vec![0.0; couplings], vec![0.0; couplings]];
        let readings = vec![[0.0; 2 * POINTS]; couplings];
        Sight {
            start: pair(),
            free: readings.clone(),
            moved: readings,
            points: core::array::from_fn(|_| pair()),
            trial: pair(),
            drift: vec![[0.0; 2]; couplings],
            forces: vec![[0.0; NODES]; couplings],
            present: vec![0.0; couplings],
        }
    }

    /// Nothing has moved yet at any point.
    pub(super) fn stand_still(&mut self) {
        self.free.fill([0.0; 2 * POINTS]);
    }

    /// Deflections and rates at all points under the present forces.
    pub(super) fn look(&mut self, exchange: &Exchange, influences: &Influences) {
        self.moved.copy_from_slice(&self.free);
        exchange.exert(influences, &self.forces, &mut self.moved);
        for (point, place) in self.points.iter_mut().enumerate() {
            for (what, (values, start)) in place.iter_mut().zip(&self.start).enumerate() {
                let values = values.iter_mut().zip(start).zip(&self.moved);
                for ((value, start), moved) in values {
                    *value = start + moved[what * POINTS + point];
                }
            }
        }
    }

    /// How far the deflection of a coupling has moved at a point, without the rounding of large deflections.
    pub(super) fn moved(&self, coupling: usize, point: usize) -> f64 {
        self.moved[coupling][point]
    }

    /// Deflection and rate of a coupling at a place for comparison, in a step of this length.
    pub(super) fn at_check(&self, check: usize, coupling: usize, step: f64) -> [f64; 2] {
        let [d0, v0] = [0, 1].map(|what| self.start[what][coupling]);
        let [d1, d2, d3, v1, v2, v3] = self.moved[coupling];
        let slopes = [v0, v0 + v1, v0 + v2, v0 + v3];
        let hermite = &HERMITE_AT_CHECKS[check];
        // Movements, because slopes are differences: the start has not moved.
        let along = |[of_values, of_slopes]: &[[f64; NODES]; 2], per_slope: f64| {
            let values = of_values[1] * d1 + of_values[2] * d2 + of_values[3] * d3;
            values + per_slope * dot(of_slopes, &slopes)
        };
        [
            d0 + along(&hermite.value, step),
            along(&hermite.slope, step) / step,
        ]
    }

    /// The step ends: the end becomes the start.
    pub(super) fn move_on(&mut self) {
        copy(&self.points[END], &mut self.start);
        for forces in &mut self.forces {
            forces[0] = forces[NODES - 1];
        }
    }

    /// Mean over the step of the square of what a monitor watches, by the Lobatto weights 1/12, 5/12, 5/12, 1/12.
    pub(super) fn mean_square(&self, monitor: &Monitor) -> f64 {
        let mean = |[first, second, third, last]: [f64; NODES]| {
            (first * first + last * last + 5.0 * (second * second + third * third)) / 12.0
        };
        let [second, third, last] = [0, 1, END].map(|point| &self.points[point][0]);
        let of_motion = |i: usize| mean([self.start[0][i], second[i], third[i], last[i]]);
        let forces = self.forces[monitor.couplings.clone()].iter();
        forces.map(|&forces| mean(forces)).sum::<f64>()
            + monitor.motion.clone().map(of_motion).sum::<f64>()
    }
}

/// readings += rows' values: one row per value, an even number of them.
#[inline(always)]
pub(super) fn accumulate(readings: &mut Readings, rows: &[Readings], values: &[f64]) {
    // Two sums side by side, so that one addition need not wait for the last.
    let (mut even, mut odd) = (*readings, [0.0; 2 * POINTS]);
    for (rows, values) in rows.chunks_exact(2).zip(values.chunks_exact(2)) {
        for i in 0..2 * POINTS {
            even[i] += values[0] * rows[0][i];
            odd[i] += values[1] * rows[1][i];
        }
    }
    for i in 0..2 * POINTS {
        readings[i] = even[i] + odd[i];
    }
}

/// Deflection and rate of a sensor in these states.
pub(super) fn both(rows: &[[f64; 2]], states: &[f64]) -> [f64; 2] {
    let mut seen = [0.0; 2];
    for (row, state) in rows.iter().zip(states) {
        seen[0] += row[0] * state;
        seen[1] += row[1] * state;
    }
    seen
}

/// Copies deflections and rates.
pub(super) fn copy(source: &[Vec<f64>; 2], target: &mut [Vec<f64>; 2]) {
    for (target, source) in target.iter_mut().zip(source) {
        target.copy_from_slice(source);
    }
}

/// Deflections and rates as the laws see them.
pub(super) fn instant<'a>(seen: &'a [Vec<f64>; 2], time: f64, slow: &'a [f64]) -> Instant<'a> {
    Instant {
        time,
        deflection: &seen[0],
        rate: &seen[1],
        slow,
    }
}
