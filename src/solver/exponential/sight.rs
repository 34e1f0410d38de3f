//! What the couplings see and exert in one step.

use super::super::{Instant, Monitor};
use super::exchange::{Exchange, Influences};
use super::lanes::{Quad, add_multiple, subtract_multiple};
use super::polynomials::{
    CHECKS, END, HERMITE_AT_CHECKS, HERMITE_SLOPES, Hermite, HermiteSlopes, NODES, RATE,
};

/// How far one coupling has moved since the start of a step: its rate at the end, then its deflections at the nodes but the first.
pub(super) type Moved = Quad;

/// One entry per coupling in every list.
#[derive(Debug, Clone)]
pub(super) struct Sight {
    /// Movements without the forces.
    pub(super) free: Vec<Moved>,
    /// Movements.
    pub(super) moved: Vec<Moved>,
    /// Deflections and rates at the nodes, as laws look at them: the start is known, the others when they are shown.
    pub(super) nodes: [[Vec<f64>; 2]; NODES],
    /// Deflections and rates elsewhere.
    pub(super) trial: [Vec<f64>; 2],
    /// Forces at the nodes.
    pub(super) forces: Vec<Quad>,
    /// What the cubics leave out of the forces at the checks.
    pub(super) missing: Vec<[f64; CHECKS]>,
    /// How deflections and rates at the end would change with that.
    pub(super) drift: Vec<[f64; 2]>,
    /// How the forces at the end would change with that.
    pub(super) change: Vec<f64>,
    /// Forces at one instant.
    pub(super) present: Vec<f64>,
}

impl Sight {
    pub(super) fn new(couplings: usize) -> Sight {
        let pair = || [vec![0.0; couplings], vec![0.0; couplings]];
        let still = vec![[0.0; 4]; couplings];
        Sight {
            free: still.clone(),
            moved: still,
            nodes: core::array::from_fn(|_| pair()),
            trial: pair(),
            forces: vec![[0.0; NODES]; couplings],
            missing: vec![[0.0; CHECKS]; couplings],
            drift: vec![[0.0; 2]; couplings],
            change: vec![0.0; couplings],
            present: vec![0.0; couplings],
        }
    }

    /// How far couplings move under the present forces.
    #[inline(always)]
    pub(super) fn exert(&mut self, exchange: &Exchange, influences: &Influences) {
        self.moved.copy_from_slice(&self.free);
        for (pair, influence) in exchange.pairs.iter().zip(&influences.of_pairs) {
            let mut moved = self.moved[pair.sensor];
            for (force, row) in self.forces[pair.actuator].iter().zip(influence) {
                subtract_multiple(&mut moved, *force, row);
            }
            self.moved[pair.sensor] = moved;
        }
    }

    /// Shows the nodes of a step of this length as couplings have moved to them.
    pub(super) fn show(&mut self, step: f64) {
        let [start, others @ ..] = &mut self.nodes;
        let per_step = 1.0 / step;
        for (coupling, moved) in self.moved.iter().enumerate() {
            let start = [start[0][coupling], start[1][coupling]];
            let mut rates = rates_at_nodes(moved, per_step);
            add_multiple(&mut rates, start[1], &HERMITE_SLOPES.of_first_slope);
            for (node, shown) in (1..).zip(&mut *others) {
                shown[0][coupling] = start[0] + moved[node];
                shown[1][coupling] = rates[node];
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
        if node == 0 {
            0.0
        } else {
            self.moved[coupling][node]
        }
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
            *deflection += moved[END];
            *rate += moved[RATE];
        }
        for forces in &mut self.forces {
            forces[0] = forces[END];
        }
    }

    /// Mean over the step of the square of what a monitor watches, by the Lobatto weights 1/12, 5/12, 5/12, 1/12.
    #[inline(always)]
    pub(super) fn mean_square(&self, monitor: &Monitor) -> f64 {
        let square = |[first, second, third, last]: Quad| {
            first * first + last * last + 5.0 * (second * second + third * third)
        };
        let mut sum = 0.0;
        for forces in &self.forces[monitor.couplings.clone()] {
            sum += square(*forces);
        }
        for i in monitor.motion.clone() {
            let start = self.nodes[0][0][i];
            let [_, a, b, end] = self.moved[i].map(|moved| start + moved);
            sum += square([start, a, b, end]);
        }
        sum * (1.0 / 12.0)
    }
}

/// The rates at the nodes of a coupling that moves so from rest.
#[inline(always)]
pub(super) fn rates_at_nodes([rate, a, b, end]: &Moved, per_step: f64) -> Quad {
    let HermiteSlopes {
        of_inner_values,
        of_last_value,
        of_more_slope,
        ..
    } = &HERMITE_SLOPES;
    let mut rates = of_more_slope.map(|per_rate| rate * per_rate);
    add_multiple(&mut rates, (a + b) * per_step, of_inner_values);
    add_multiple(&mut rates, end * per_step, of_last_value);
    rates
}

/// Deflections of a coupling at both places for comparison, then its rates, in a step of this length: from deflection and rate at the
/// start, and how it moves.
#[inline(always)]
pub(super) fn at_checks([d0, v0]: [f64; 2], moved: &Moved, step: f64) -> [[f64; CHECKS]; 2] {
    let Hermite {
        of_values,
        of_slopes: [of_first, of_last],
    } = &HERMITE_AT_CHECKS;
    // Movements, because slopes are differences.
    let [rate, deflections @ ..] = moved;
    let (mut values, mut slopes) = ([0.0; 4], [0.0; 4]);
    for (deflection, weights) in deflections.iter().zip(of_values) {
        add_multiple(&mut values, *deflection, weights);
    }
    add_multiple(&mut slopes, v0, of_first);
    add_multiple(&mut slopes, v0 + rate, of_last);
    let per_step = 1.0 / step;
    let [first, second, first_slope, second_slope] = values;
    [
        [
            d0 + (first + step * slopes[0]),
            d0 + (second + step * slopes[1]),
        ],
        [
            first_slope * per_step + slopes[2],
            second_slope * per_step + slopes[3],
        ],
    ]
}

/// moved += rows' values: one row per value.
#[inline(always)]
pub(super) fn accumulate(moved: &mut Moved, rows: &[Moved], values: &[Quad]) {
    // Two sums side by side, so that one addition need not wait for the last.
    let (mut even, mut odd) = (*moved, [0.0; 4]);
    for (rows, values) in rows.as_chunks::<4>().0.iter().zip(values) {
        add_multiple(&mut even, values[0], &rows[0]);
        add_multiple(&mut odd, values[1], &rows[1]);
        add_multiple(&mut even, values[2], &rows[2]);
        add_multiple(&mut odd, values[3], &rows[3]);
    }
    *moved = core::array::from_fn(|i| even[i] + odd[i]);
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
