//! The forces at the nodes of a step.
//!
//! ```text
//!   F_i = F(s_i, d_i, d_i'),   d_i = free response - sum over pairs and nodes j of e_d F_j        unknown: F at three nodes
//! ```
//!
//! Where all laws are straight lines F = k d + c d' + r these are linear equations. Each coupling is solved with itself exactly,
//! three unknowns at a time, and with the others by sweeps (Gauss-Seidel by blocks): what couplings do to each other
//! within a step is little. Other laws are swept as they are.

use super::super::march::{Span, Task};
use super::super::{Forcing, Line, Piece};
use super::exchange::{Exchange, Influences};
use super::polynomials::{CHECKS, END, LAGRANGE_AT_CHECKS, NODES, PLACES, POINTS};
use super::sight::{Sight, copy, instant};
use crate::linalg::dot;

/// Sweeps after which a step counts as too long.
const MOST_SWEEPS: usize = 25;
/// Change of the forces in the last sweep relative to the tolerance, and the smallest one above rounding.
const ACCURACY: (f64, f64) = (1e-3, 1e-13);
/// The most that the forces of a coupling may do to themselves within a step: beyond, they answer to rounding.
const MOST_FEEDBACK: f64 = 4.0;
/// The nodes behind the first, whose force is known.
const UNKNOWN: usize = NODES - 1;

/// The equations of one step, with room for them.
#[derive(Debug, Clone)]
pub(super) struct Nodes {
    /// The lines of all couplings at the points.
    lines: [Vec<Line>; POINTS],
    /// For every pair how the sensor's forces depend on the actuator's.
    mutual: Vec<[[f64; UNKNOWN]; UNKNOWN]>,
    /// For every coupling the inverse of its own equations, and their right-hand side.
    inverse: Vec<[[f64; UNKNOWN]; UNKNOWN]>,
    right: Vec<[f64; UNKNOWN]>,
    /// What the cubic leaves out of the forces at the checks.
    missing: Vec<[f64; CHECKS.len()]>,
    /// How the forces at the end change with that.
    pub(super) change: Vec<f64>,
    /// Evaluations of all forces.
    pub(super) evaluations: u64,
}

impl Nodes {
    pub(super) fn new(couplings: usize, exchange: &Exchange) -> Nodes {
        Nodes {
            lines: core::array::from_fn(|_| vec![Line::default(); couplings]),
            mutual: vec![[[0.0; UNKNOWN]; UNKNOWN]; exchange.pairs.len()],
            inverse: vec![[[0.0; UNKNOWN]; UNKNOWN]; couplings],
            right: vec![[0.0; UNKNOWN]; couplings],
            missing: vec![[0.0; CHECKS.len()]; couplings],
            change: vec![0.0; couplings],
            evaluations: 0,
        }
    }

    /// Solves for the forces at the nodes and shows the points under them. Gives whether they were found.
    pub(super) fn solve<F: Forcing>(
        &mut self,
        task: Task<'_, F>,
        (span, slow): (Span, &[f64]),
        pieces: &[Piece],
        (exchange, influences): (&Exchange, &Influences),
        sight: &mut Sight,
    ) -> bool {
        for forces in &mut sight.forces {
            *forces = [forces[0]; NODES];
        }
        let accuracy = (ACCURACY.0 * task.tolerance).max(ACCURACY.1);
        let found = if task.forcing.is_straight() {
            for (lines, place) in self.lines.iter_mut().zip(PLACES) {
                task.forcing.lines_into(span.at(place), pieces, lines);
            }
            self.evaluations += POINTS as u64;
            self.set_up(exchange, influences, sight) <= MOST_FEEDBACK
                && self.sweep_blocks(exchange, accuracy, sight)
        } else {
            let at = (span, slow);
            self.sweep(task, at, pieces, (exchange, influences), accuracy, sight)
        };
        if found {
            sight.look(exchange, influences);
        }
        found
    }

    /// The linear equations of this step. Gives the largest entry of a coupling's own.
    fn set_up(&mut self, exchange: &Exchange, influences: &Influences, sight: &Sight) -> f64 {
        let mut feedback: f64 = 0.0;
        for (coupling, (right, free)) in self.right.iter_mut().zip(&sight.free).enumerate() {
            let [deflection, rate] = [0, 1].map(|what| sight.start[what][coupling]);
            for (point, right) in right.iter_mut().enumerate() {
                let seen = [deflection + free[point], rate + free[POINTS + point]];
                *right = self.lines[point][coupling].at(seen[0], seen[1]);
            }
            self.inverse[coupling] = IDENTITY;
        }
        let pairs = exchange.pairs.iter().zip(&influences.of_pairs);
        for ((pair, influence), mutual) in pairs.zip(&mut self.mutual) {
            let spring = [0, 1, END].map(|point| self.lines[point][pair.sensor].spring);
            let push = |node: usize, point: usize| {
                spring[point].stiffness * influence[node][point]
                    + spring[point].damping * influence[node][POINTS + point]
            };
            let known = sight.forces[pair.actuator][0];
            for (point, right) in self.right[pair.sensor].iter_mut().enumerate() {
                *right -= push(0, point) * known;
            }
            *mutual =
                core::array::from_fn(|point| core::array::from_fn(|node| push(node + 1, point)));
            if pair.sensor == pair.actuator {
                let mut own = *mutual;
                for (i, row) in own.iter_mut().enumerate() {
                    feedback = row.iter().fold(feedback, |most, one| most.max(one.abs()));
                    row[i] += 1.0;
                }
                self.inverse[pair.sensor] = inverse(&own);
            }
        }
        feedback
    }

    /// Block by block until nothing changes.
    fn sweep_blocks(&self, exchange: &Exchange, accuracy: f64, sight: &mut Sight) -> bool {
        let (mut before, least) = (0.0, least_force(sight));
        for _ in 0..MOST_SWEEPS {
            let mut changed: f64 = 0.0;
            let mut pairs = exchange.pairs.iter().zip(&self.mutual).peekable();
            let equations = self.right.iter().zip(&self.inverse);
            let (mut alone, mut sound) = (true, true);
            for (coupling, (right, inverse)) in equations.enumerate() {
                let mut right = *right;
                while let Some((pair, mutual)) = pairs.next_if(|(pair, _)| pair.sensor == coupling)
                {
                    if pair.actuator != coupling {
                        alone = false;
                        let [_, f1, f2, f3] = sight.forces[pair.actuator];
                        for (right, row) in right.iter_mut().zip(mutual) {
                            *right -= product(row, &[f1, f2, f3]);
                        }
                    }
                }
                let present = inverse.map(|row| product(&row, &right));
                let forces = &mut sight.forces[coupling][1..];
                let (mut size, mut change) = (least, 0.0);
                for (force, present) in forces.iter_mut().zip(present) {
                    size = present.abs().max(size);
                    change = (present - *force).abs().max(change);
                    sound &= present.is_finite();
                    *force = present;
                }
                if change > changed * size {
                    changed = change / size;
                }
            }
            if !sound {
                return false;
            }
            // The next sweep would change them by as much less again; after the first nothing is known yet.
            let next = if changed < before {
                changed * (changed / before)
            } else {
                changed
            };
            if alone || next <= accuracy {
                return true;
            }
            before = changed;
        }
        false
    }

    /// All laws as they are, node after node, until nothing changes.
    fn sweep<F: Forcing>(
        &mut self,
        task: Task<'_, F>,
        (span, slow): (Span, &[f64]),
        pieces: &[Piece],
        (exchange, influences): (&Exchange, &Influences),
        accuracy: f64,
        sight: &mut Sight,
    ) -> bool {
        for _ in 0..MOST_SWEEPS {
            let least = least_force(sight);
            let mut settled = true;
            sight.look(exchange, influences);
            for point in 0..=END {
                let at = instant(&sight.points[point], span.at(PLACES[point]), slow);
                task.forcing.forces_into(at, pieces, &mut sight.present);
                for (forces, &present) in sight.forces.iter_mut().zip(&sight.present) {
                    let force = &mut forces[point + 1];
                    let size = present.abs().max(force.abs()).max(least);
                    // Written so that neither NaN nor infinity is settled.
                    settled &= (present - *force).abs() <= accuracy * size && size < f64::INFINITY;
                    *force = present;
                }
            }
            self.evaluations += UNKNOWN as u64;
            if settled {
                return true;
            }
        }
        false
    }

    /// What the cubic leaves out at the checks, and how that would change deflections, rates (`sight.trial`) and forces at
    /// the end.
    pub(super) fn look_for_errors<F: Forcing>(
        &mut self,
        task: Task<'_, F>,
        (span, slow): (Span, &[f64]),
        pieces: &[Piece],
        (exchange, influences): (&Exchange, &Influences),
        sight: &mut Sight,
    ) {
        let straight = task.forcing.is_straight();
        for (check, (point, weights)) in CHECKS.into_iter().zip(LAGRANGE_AT_CHECKS).enumerate() {
            let seen = &sight.points[point];
            if straight {
                forces_on(&self.lines[point], seen, &mut sight.present);
            } else {
                let at = instant(seen, span.at(PLACES[point]), slow);
                task.forcing.forces_into(at, pieces, &mut sight.present);
                self.evaluations += 1;
            }
            let forces = sight.present.iter().zip(&sight.forces);
            for (missing, (present, forces)) in self.missing.iter_mut().zip(forces) {
                missing[check] = present - dot(forces, &weights);
            }
        }
        let trial = &mut sight.trial;
        copy(&sight.points[END], trial);
        exchange.exert_missing(influences, &self.missing, trial);
        if straight {
            // From the differences: forces themselves would leave their rounding.
            for (coupling, change) in self.change.iter_mut().enumerate() {
                let [deflection, rate] =
                    [0, 1].map(|what| trial[what][coupling] - sight.points[END][what][coupling]);
                let spring = self.lines[END][coupling].spring;
                *change = spring.stiffness * deflection + spring.damping * rate;
            }
        } else {
            let at = instant(trial, span.end, slow);
            task.forcing.forces_into(at, pieces, &mut self.change);
            self.evaluations += 1;
            for (change, forces) in self.change.iter_mut().zip(&sight.forces) {
                *change -= forces[NODES - 1];
            }
        }
    }
}

/// Below this part of the largest force changes are rounding.
fn least_force(sight: &Sight) -> f64 {
    let sizes = sight.forces.iter().flatten().map(|force| force.abs());
    ACCURACY.1 * sizes.fold(0.0, f64::max)
}

/// The forces on the lines at one point.
fn forces_on(lines: &[Line], [deflection, rate]: &[Vec<f64>; 2], forces: &mut [f64]) {
    let seen = deflection.iter().zip(rate);
    for ((line, (deflection, rate)), force) in lines.iter().zip(seen).zip(forces) {
        *force = line.at(*deflection, *rate);
    }
}

/// x' y.
fn product(x: &[f64; UNKNOWN], y: &[f64; UNKNOWN]) -> f64 {
    x[0] * y[0] + x[1] * y[1] + x[2] * y[2]
}

/// The equations of a coupling that nothing answers to.
const IDENTITY: [[f64; UNKNOWN]; UNKNOWN] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];

/// By cofactors.
fn inverse([a, b, c]: &[[f64; UNKNOWN]; UNKNOWN]) -> [[f64; UNKNOWN]; UNKNOWN] {
    let cross = |x: &[f64; UNKNOWN], y: &[f64; UNKNOWN]| {
        [
            x[1] * y[2] - x[2] * y[1],
            x[2] * y[0] - x[0] * y[2],
            x[0] * y[1] - x[1] * y[0],
        ]
    };
    let columns = [cross(b, c), cross(c, a), cross(a, b)];
    let scale = 1.0 / product(a, &columns[0]);
    core::array::from_fn(|i| core::array::from_fn(|j| scale * columns[j][i]))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_matrix_times_its_inverse_is_the_identity() {
        let matrix = [[1.2, -0.3, 0.1], [0.4, 0.9, -0.2], [0.05, 0.3, 1.1]];
        let inverse = inverse(&matrix);
        for (i, row) in matrix.iter().enumerate() {
            for j in 0..3 {
                let entry: f64 = (0..3).map(|k| row[k] * inverse[k][j]).sum();
                // 1e-15: rounding.
                assert!((entry - IDENTITY[i][j]).abs() < 1e-15);
            }
        }
    }
}
