//! What the couplings see and exert in one step.

use super::super::{Instant, Monitor};
use super::exchange::{Exchange, Influences};
use super::lanes::{Quad, add_multiple};
use super::polynomials::{CHECKS, END, HERMITE_AT_CHECKS, Hermite, NODES};

/// How far the deflection of one coupling has moved from the start at every node of a step, then its rate.
pub(super) type Readings = [Quad; 2];
/// Nothing has moved.
pub(super) const STILL: Readings = [[0.0; 4]; 2];

/// One entry per coupling in every list.
#[derive(Debug, Clone)]
pub(super) struct Sight {
    /// Movements without the forces.
    pub(super) free: Vec<Readings>,
    /// Movements.
    moved: Vec<Readings>,
    /// Deflections and rates at the nodes, as laws look at them: the start is known, the others when they are shown.
    pub(super) nodes: [[Vec<f64>; 2]; NODES],
    /// Deflections and rates elsewhere.
    pub(super) trial: [Vec<f64>; 2],
    /// How deflections and rates at the end would change with what the cubics leave out of the forces.
    pub(super) drift: Vec<[f64; 2]>,
    /// Forces at the nodes.
    pub(super) forces: Vec<Quad>,
    /// Forces at one instant.
    pub(super) present: Vec<f64>,
}

impl Sight {
    pub(super) fn new(couplings: usize) -> Sight {
        let pair = || [vec![0.0; couplings], vec![0.0; couplings]];
        let readings = vec![STILL; couplings];
        Sight {
            free: readings.clone(),
            moved: readings,
            nodes: core::array::from_fn(|_| pair()),
            trial: pair(),
            drift: vec![[0.0; 2]; couplings],
            forces: vec![[0.0; NODES]; couplings],
            present: vec![0.0; couplings],
        }
    }

    /// How far couplings move under the present forces.
    #[inline(always)]
    pub(super) fn exert(&mut self, exchange: &Exchange, influences: &Influences) {
        self.moved.copy_from_slice(&self.free);
        for (pair, influence) in exchange.pairs.iter().zip(&influences.of_pairs) {
            let mut readings = self.moved[pair.sensor];
            for (force, row) in self.forces[pair.actuator].iter().zip(influence) {
                accumulate(&mut readings, -force, row);
            }
            self.moved[pair.sensor] = readings;
        }
    }

    /// Shows the nodes as couplings have moved to them.
    pub(super) fn show(&mut self) {
        let [start, others @ ..] = &mut self.nodes;
        for (coupling, moved) in self.moved.iter().enumerate() {
            for (what, [_, moved @ ..]) in moved.iter().enumerate() {
                let start = start[what][coupling];
                for (node, moved) in others.iter_mut().zip(moved) {
                    node[what][coupling] = start + moved;
                }
            }
        }
    }

    /// Deflection and rate of a coupling at the start.
    #[inline(always)]
    pub(super) fn start(&self, coupling: usize) -> [f64; 2] {
        let [deflection, rate] = &self.nodes[0];
        [deflection[coupling], rate[coupling]]
    }

    /// How far the deflection of a coupling has moved at a node, without the rounding of large deflections.
    pub(super) fn moved(&self, coupling: usize, node: usize) -> f64 {
        self.moved[coupling][0][node]
    }

    /// Deflections of a coupling at both places for comparison, then its rates, in a step of this length.
    #[inline(always)]
    pub(super) fn at_checks(&self, coupling: usize, step: f64) -> [[f64; CHECKS]; 2] {
        let [d0, v0] = self.start(coupling);
        let Hermite {
            of_values,
            of_slopes,
        } = &HERMITE_AT_CHECKS;
        let [deflections, rates] = &self.moved[coupling];
        // Movements, because slopes are differences.
        let (mut values, mut slopes) = ([0.0; 4], [0.0; 4]);
        for node in 0..NODES {
            add_multiple(&mut values, deflections[node], &of_values[node]);
            add_multiple(&mut slopes, v0 + rates[node], &of_slopes[node]);
        }
        let per_step = 1.0 / step;
        [
            [0, 1].map(|i| d0 + (values[i] + step * slopes[i])),
            [2, 3].map(|i| values[i] * per_step + slopes[i]),
        ]
    }

    /// Whether the forces at the start are numbers.
    pub(super) fn is_start_finite(&self) -> bool {
        self.forces.iter().all(|forces| forces[0].is_finite())
    }

    /// The step ends: the end becomes the start.
    pub(super) fn move_on(&mut self) {
        let [deflections, rates] = &mut self.nodes[0];
        let both = deflections.iter_mut().zip(rates).zip(&self.moved);
        for ((deflection, rate), moved) in both {
            *deflection += moved[0][END];
            *rate += moved[1][END];
        }
        for forces in &mut self.forces {
            forces[0] = forces[END];
        }
    }

    /// Mean over the step of the square of what a monitor watches, by the Lobatto weights 1/12, 5/12, 5/12, 1/12.
    pub(super) fn mean_square(&self, monitor: &Monitor) -> f64 {
        let mean = |[first, second, third, last]: Quad| {
            (first * first + last * last + 5.0 * (second * second + third * third)) / 12.0
        };
        let of_motion = |i: usize| {
            let start = self.nodes[0][0][i];
            mean(self.moved[i][0].map(|moved| start + moved))
        };
        let forces = self.forces[monitor.couplings.clone()].iter();
        forces.map(|&forces| mean(forces)).sum::<f64>()
            + monitor.motion.clone().map(of_motion).sum::<f64>()
    }
}

/// readings += value row.
#[inline(always)]
pub(super) fn accumulate(readings: &mut Readings, value: f64, row: &Readings) {
    for (sum, part) in readings.iter_mut().zip(row) {
        add_multiple(sum, value, part);
    }
}

/// readings += rows' values: one row per value.
#[inline(always)]
pub(super) fn accumulate_all(readings: &mut Readings, rows: &[Readings], values: &[Quad]) {
    // Two sums side by side, so that one addition need not wait for the last.
    let (mut even, mut odd) = (*readings, STILL);
    for (rows, values) in rows.as_chunks::<4>().0.iter().zip(values) {
        accumulate(&mut even, values[0], &rows[0]);
        accumulate(&mut odd, values[1], &rows[1]);
        accumulate(&mut even, values[2], &rows[2]);
        accumulate(&mut odd, values[3], &rows[3]);
    }
    for ((readings, even), odd) in readings.iter_mut().zip(&even).zip(&odd) {
        *readings = core::array::from_fn(|i| even[i] + odd[i]);
    }
}

/// Deflection and rate of a sensor in these states.
#[inline(always)]
pub(super) fn both(rows: &[[f64; 2]], states: &[f64]) -> [f64; 2] {
    let mut seen = [0.0; 2];
    for (row, state) in rows.iter().zip(states) {
        seen[0] += row[0] * state;
        seen[1] += row[1] * state;
    }
    seen
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
