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
use super::polynomials::{CHECK_PLACES, CHECKS, END, LAGRANGE_AT_CHECKS, NODES, PLACES, POINTS};
use super::sight::{Readings, Sight, instant};
use crate::linalg::dot;

/// Sweeps after which a step counts as too long.
const MOST_SWEEPS: usize = 25;
/// Change of the forces in the last sweep relative to the tolerance, and the smallest one above rounding.
const ACCURACY: (f64, f64) = (1e-3, 1e-13);
/// The most that the forces of a coupling may do to themselves within a step: beyond, they answer to rounding.
const MOST_FEEDBACK: f64 = 4.0;
/// Places where laws are evaluated: the points, then those for comparison.
const LINES: usize = POINTS + CHECKS;
/// Of one coupling at all points.
type Vector = [f64; POINTS];
/// What the forces of one coupling do to those of another: a column per node.
type Mutual = [Vector; POINTS];

/// The equations of one step, with room for them.
#[derive(Debug, Clone)]
pub(super) struct Nodes {
    /// The lines of all couplings.
    lines: Vec<[Line; LINES]>,
    /// For every pair how the sensor's forces depend on the actuator's.
    mutual: Vec<Mutual>,
    /// For every coupling the inverse of its own equations, and their right-hand side.
    inverse: Vec<Mutual>,
    right: Vec<Vector>,
    /// One over the size of its forces, in units of which changes count.
    per_size: Vec<f64>,
    /// What the cubic leaves out of the forces at the checks.
    missing: Vec<[f64; CHECKS]>,
    /// How the forces at the end change with that.
    pub(super) change: Vec<f64>,
    /// Evaluations of all forces.
    pub(super) evaluations: u64,
}

impl Nodes {
    pub(super) fn new(couplings: usize, exchange: &Exchange) -> Nodes {
        Nodes {
            lines: vec![[Line::default(); LINES]; couplings],
            mutual: vec![Mutual::default(); exchange.pairs.len()],
            inverse: vec![IDENTITY; couplings],
            right: vec![[0.0; POINTS]; couplings],
            per_size: vec![0.0; couplings],
            missing: vec![[0.0; CHECKS]; couplings],
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
            let [a, b, end] = PLACES.map(|place| span.at(place));
            let [first, second] = CHECK_PLACES.map(|place| span.at(place));
            let times = [a, b, end, first, second];
            task.forcing.lines_into(times, pieces, &mut self.lines);
            self.evaluations += LINES as u64;
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
        let unknown = self.right.iter_mut().zip(&sight.free).zip(&self.lines);
        for (coupling, ((right, free), lines)) in unknown.enumerate() {
            let [deflection, rate] = [0, 1].map(|what| sight.start[what][coupling]);
            *right = core::array::from_fn(|point| {
                lines[point].at(deflection + free[point], rate + free[POINTS + point])
            });
        }
        let pairs = exchange.pairs.iter().zip(&influences.of_pairs);
        for ((pair, [known, unknown @ ..]), mutual) in pairs.zip(&mut self.mutual) {
            let lines = &self.lines[pair.sensor];
            let push = |moved: &Readings| -> Vector {
                core::array::from_fn(|point| {
                    let spring = lines[point].spring;
                    spring.stiffness * moved[point] + spring.damping * moved[POINTS + point]
                })
            };
            let force = sight.forces[pair.actuator][0];
            subtract(force, &push(known), &mut self.right[pair.sensor]);
            *mutual = unknown.each_ref().map(push);
            if pair.sensor == pair.actuator {
                let mut own = *mutual;
                for (i, column) in own.iter_mut().enumerate() {
                    let most = column
                        .iter()
                        .fold(0.0, |most: f64, one| most.max(one.abs()));
                    feedback = feedback.max(most);
                    column[i] += 1.0;
                }
                self.inverse[pair.sensor] = inverse(&own);
            }
        }
        feedback
    }

    /// Every coupling solved with itself: what its forces are without the others, and how they depend on theirs.
    fn solve_own(&mut self, exchange: &Exchange, sight: &Sight) {
        let least = least_force(sight);
        for (coupling, inverse) in self.inverse.iter().enumerate() {
            let alone = product(inverse, &self.right[coupling]);
            let first = sight.forces[coupling][0].abs().max(least);
            let size = alone
                .iter()
                .fold(first, |most, force| most.max(force.abs()));
            self.per_size[coupling] = 1.0 / size;
            self.right[coupling] = alone;
            for &(pair, _) in &exchange.others[coupling] {
                let mutual = &mut self.mutual[pair];
                *mutual = mutual.map(|column| product(inverse, &column));
            }
        }
    }

    /// Coupling after coupling until nothing changes.
    fn sweep_blocks(&mut self, exchange: &Exchange, accuracy: f64, sight: &mut Sight) -> bool {
        self.solve_own(exchange, sight);
        let mut before = 0.0;
        for _ in 0..MOST_SWEEPS {
            let mut changed: f64 = 0.0;
            let mut alone = true;
            for (coupling, others) in exchange.others.iter().enumerate() {
                let mut present = self.right[coupling];
                for &(pair, actuator) in others {
                    let [_, forces @ ..] = sight.forces[actuator];
                    for (column, force) in self.mutual[pair].iter().zip(forces) {
                        subtract(force, column, &mut present);
                    }
                }
                alone &= others.is_empty();
                let forces = &mut sight.forces[coupling][1..];
                for (force, present) in forces.iter_mut().zip(present) {
                    let change = (present - *force).abs() * self.per_size[coupling];
                    // Written so that a NaN stays one.
                    changed = if change <= changed { changed } else { change };
                    *force = present;
                }
            }
            // Neither NaN nor infinity is a solution.
            if !changed.is_finite() {
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
            self.evaluations += POINTS as u64;
            if settled {
                return true;
            }
        }
        false
    }

    /// What the cubic leaves out at the checks, and how that would change deflections, rates (`sight.drift`) and forces at
    /// the end.
    pub(super) fn look_for_errors<F: Forcing>(
        &mut self,
        task: Task<'_, F>,
        at: (Span, &[f64]),
        pieces: &[Piece],
        (exchange, influences): (&Exchange, &Influences),
        sight: &mut Sight,
    ) {
        let straight = task.forcing.is_straight();
        if straight {
            self.compare_lines(at.0.step, sight);
        } else {
            self.compare_laws(task, at, pieces, sight);
        }
        exchange.exert_missing(influences, &self.missing, &mut sight.drift);
        if straight {
            // From the drift alone: differences of forces would leave their rounding.
            let drift = sight.drift.iter().zip(&self.lines);
            for (change, ([deflection, rate], lines)) in self.change.iter_mut().zip(drift) {
                let spring = lines[END].spring;
                *change = spring.stiffness * deflection + spring.damping * rate;
            }
        } else {
            let [deflection, rate] = &sight.points[END];
            for (coupling, drift) in sight.drift.iter().enumerate() {
                sight.trial[0][coupling] = deflection[coupling] + drift[0];
                sight.trial[1][coupling] = rate[coupling] + drift[1];
            }
            let (span, slow) = at;
            let at = instant(&sight.trial, span.end, slow);
            task.forcing.forces_into(at, pieces, &mut self.change);
            self.evaluations += 1;
            for (change, forces) in self.change.iter_mut().zip(&sight.forces) {
                *change -= forces[NODES - 1];
            }
        }
    }

    /// The forces on the lines at the checks, less those of the cubics.
    fn compare_lines(&mut self, step: f64, sight: &Sight) {
        let all = self.missing.iter_mut().zip(&self.lines).zip(&sight.forces);
        for (coupling, ((missing, lines), forces)) in all.enumerate() {
            *missing = core::array::from_fn(|check| {
                let [deflection, rate] = sight.at_check(check, coupling, step);
                let force = lines[POINTS + check].at(deflection, rate);
                force - dot(forces, &LAGRANGE_AT_CHECKS[check])
            });
        }
    }

    /// The forces of the laws at the checks, less those of the cubics.
    fn compare_laws<F: Forcing>(
        &mut self,
        task: Task<'_, F>,
        (span, slow): (Span, &[f64]),
        pieces: &[Piece],
        sight: &mut Sight,
    ) {
        for (check, weights) in LAGRANGE_AT_CHECKS.iter().enumerate() {
            for coupling in 0..self.missing.len() {
                let seen = sight.at_check(check, coupling, span.step);
                [sight.trial[0][coupling], sight.trial[1][coupling]] = seen;
            }
            let at = instant(&sight.trial, span.at(CHECK_PLACES[check]), slow);
            task.forcing.forces_into(at, pieces, &mut sight.present);
            self.evaluations += 1;
            let forces = sight.present.iter().zip(&sight.forces);
            for (missing, (present, forces)) in self.missing.iter_mut().zip(forces) {
                missing[check] = present - dot(forces, weights);
            }
        }
    }
}

/// Below this part of the largest force changes are rounding.
fn least_force(sight: &Sight) -> f64 {
    let sizes = sight.forces.iter().flatten().map(|force| force.abs());
    (ACCURACY.1 * sizes.fold(0.0, f64::max)).max(f64::MIN_POSITIVE)
}

/// target -= scale x.
fn subtract(scale: f64, x: &Vector, target: &mut Vector) {
    for (target, x) in target.iter_mut().zip(x) {
        *target -= scale * x;
    }
}

/// Matrix times vector.
fn product([a, b, c]: &Mutual, x: &Vector) -> Vector {
    core::array::from_fn(|i| a[i] * x[0] + b[i] * x[1] + c[i] * x[2])
}

/// The equations of a coupling that nothing answers to.
const IDENTITY: Mutual = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];

/// By cofactors.
fn inverse([a, b, c]: &Mutual) -> Mutual {
    let cross = |x: &Vector, y: &Vector| {
        [
            x[1] * y[2] - x[2] * y[1],
            x[2] * y[0] - x[0] * y[2],
            x[0] * y[1] - x[1] * y[0],
        ]
    };
    let rows = [cross(b, c), cross(c, a), cross(a, b)];
    let determinant = a[0] * rows[0][0] + a[1] * rows[0][1] + a[2] * rows[0][2];
    let scale = 1.0 / determinant;
    core::array::from_fn(|j| core::array::from_fn(|i| scale * rows[i][j]))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_matrix_times_its_inverse_is_the_identity() {
        let matrix = [[1.2, -0.3, 0.1], [0.4, 0.9, -0.2], [0.05, 0.3, 1.1]];
        let inverse = inverse(&matrix);
        for (column, unit) in inverse.iter().zip(IDENTITY) {
            for (found, expected) in product(&matrix, column).into_iter().zip(unit) {
                // 1e-15: rounding.
                assert!((found - expected).abs() < 1e-15);
            }
        }
    }
}
