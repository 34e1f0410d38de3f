//! The forces at the nodes of a step where all laws are straight lines: linear equations.
//!
//! ```text
//!   F_i = k_i d_i + c_i d_i' + r_i,   d_i = free response - sum over pairs and nodes j of e_d F_j       unknown: F at three nodes
//! ```
//!
//! Each coupling is solved with itself exactly, three unknowns at a time, and with the others by sweeps (Gauss-Seidel by
//! blocks): what couplings do to each other within a step is little.

use super::super::march::Span;
use super::super::{Forcing, Lines, Piece};
use super::exchange::{Exchange, Influences};
use super::lanes::{Quad, add_multiple, subtract_multiple};
use super::nodes::{MOST_SWEEPS, cubic_at_checks, larger, least_force};
use super::polynomials::{CHECK_PLACES, CHECKS, END, NODES, PLACES};
use super::sight::{Readings, Sight};

/// The most that the forces of a coupling may do to themselves within a step: beyond, they answer to rounding.
const MOST_FEEDBACK: f64 = 4.0;
/// Places where laws are evaluated: the nodes, then those for comparison.
const PLACES_OF_LINES: usize = NODES + CHECKS;
/// Nodes whose forces are to be found: all but the first.
const UNKNOWN: usize = NODES - 1;
/// What the forces of one coupling do to those of another at the nodes: a column per unknown.
type Mutual = [Quad; UNKNOWN];

/// The equations of one step, with room for them.
#[derive(Debug, Clone)]
pub(super) struct Equations {
    /// The lines of all couplings.
    lines: Vec<Lines<PLACES_OF_LINES>>,
    /// For every pair how the sensor's forces depend on the actuator's, its equations with itself solved.
    mutual: Vec<Mutual>,
    /// For every coupling what its forces are without the others.
    alone: Vec<Quad>,
    /// One over the size of its forces, in units of which changes count.
    per_size: Vec<f64>,
}

impl Equations {
    pub(super) fn new(couplings: usize, exchange: &Exchange) -> Equations {
        Equations {
            lines: vec![Lines::ZERO; couplings],
            mutual: vec![Mutual::default(); exchange.pairs.len()],
            alone: vec![[0.0; 4]; couplings],
            per_size: vec![0.0; couplings],
        }
    }

    /// Draws the lines of a step. Gives the number of places they were drawn for.
    pub(super) fn draw(&mut self, forcing: &impl Forcing, span: Span, pieces: &[Piece]) -> u64 {
        let [start, a, b, end] = PLACES.map(|place| span.at(place));
        let [first, second] = CHECK_PLACES.map(|place| span.at(place));
        let times = [start, a, b, end, first, second];
        forcing.lines_into(times, pieces, &mut self.lines);
        PLACES_OF_LINES as u64
    }

    /// Solves for the forces at the nodes. Gives whether they were found.
    #[inline(always)]
    pub(super) fn solve(
        &mut self,
        (exchange, influences): (&Exchange, &Influences),
        accuracy: f64,
        sight: &mut Sight,
    ) -> bool {
        self.let_go(sight);
        let least = least_force(sight);
        let mut feedback = [0.0; 4];
        for coupling in 0..self.lines.len() {
            let between = (exchange, influences);
            let own = self.solve_own(coupling, between, least, sight);
            for (most, own) in feedback.iter_mut().zip(own) {
                *most = larger(*most, own);
            }
        }
        feedback.into_iter().fold(0.0, larger) <= MOST_FEEDBACK
            && self.sweep(exchange, accuracy, sight)
    }

    /// The forces at all nodes if nothing answered to them; those at the start are right, and the first guess of the others.
    #[inline(always)]
    fn let_go(&mut self, sight: &mut Sight) {
        for (coupling, (alone, lines)) in self.alone.iter_mut().zip(&self.lines).enumerate() {
            let start = sight.start(coupling);
            let free = &sight.free[coupling];
            let seen = [0, 1].map(|what| free[what].map(|moved| start[what] + moved));
            let (push, rest) = (push(lines, &seen), &lines.rest);
            *alone = core::array::from_fn(|node| push[node] + rest[node]);
            sight.forces[coupling] = [alone[0]; NODES];
        }
    }

    /// A coupling solved with itself: what its forces are without the others, and how they depend on theirs. Gives the largest
    /// entries of its own equations.
    #[inline(always)]
    fn solve_own(
        &mut self,
        coupling: usize,
        (exchange, influences): (&Exchange, &Influences),
        least: f64,
        sight: &Sight,
    ) -> Quad {
        let lines = &self.lines[coupling];
        let (mut alone, mut inverse, mut largest) = (self.alone[coupling], IDENTITY, [0.0; 4]);
        let range = exchange.pairs_of(coupling);
        let mutual = &mut self.mutual[range.clone()];
        let influences = &influences.of_pairs[range.clone()];
        let pairs = exchange.pairs[range].iter().zip(influences);
        for ((pair, [known, unknown @ ..]), mutual) in pairs.zip(&mut *mutual) {
            let force = sight.forces[pair.actuator][0];
            subtract_multiple(&mut alone, force, &push(lines, known));
            *mutual = unknown.each_ref().map(|moved| push(lines, moved));
            if pair.actuator == coupling {
                let mut own = *mutual;
                for (i, column) in own.iter_mut().enumerate() {
                    for (largest, one) in largest.iter_mut().zip(&*column) {
                        *largest = larger(*largest, one.abs());
                    }
                    column[i + 1] += 1.0;
                }
                inverse = inverse_of(&own);
            }
        }
        let known = alone[0];
        alone = product(&inverse, &alone);
        alone[0] = known;
        let size = alone.map(f64::abs).into_iter().fold(least, larger);
        self.alone[coupling] = alone;
        self.per_size[coupling] = 1.0 / size;
        for mutual in mutual {
            *mutual = mutual.map(|column| product(&inverse, &column));
        }
        largest
    }

    /// Coupling after coupling until nothing changes.
    #[inline(always)]
    fn sweep(&mut self, exchange: &Exchange, accuracy: f64, sight: &mut Sight) -> bool {
        let mut before = 0.0;
        for _ in 0..MOST_SWEEPS {
            let mut changes = [0.0; 4];
            let mut are_alone = true;
            let couplings = self.per_size.iter().zip(&self.alone).enumerate();
            for (coupling, (&per_size, &alone)) in couplings {
                let mut present = alone;
                let range = exchange.pairs_of(coupling);
                let pairs = exchange.pairs[range.clone()].iter();
                for (pair, columns) in pairs.zip(&self.mutual[range]) {
                    if pair.actuator == coupling {
                        continue;
                    }
                    are_alone = false;
                    let [_, forces @ ..] = sight.forces[pair.actuator];
                    for (column, force) in columns.iter().zip(forces) {
                        subtract_multiple(&mut present, force, column);
                    }
                }
                let forces = &mut sight.forces[coupling];
                for ((most, present), force) in changes.iter_mut().zip(&present).zip(&*forces) {
                    *most = worse(*most, (present - force).abs() * per_size);
                }
                *forces = present;
            }
            let changed = changes.into_iter().fold(0.0, worse);
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
            if are_alone || next <= accuracy {
                return true;
            }
            before = changed;
        }
        false
    }

    /// The forces on the lines at the checks, less those of the cubics.
    #[inline(always)]
    pub(super) fn compare(&self, step: f64, sight: &Sight, missing: &mut [[f64; CHECKS]]) {
        let all = missing.iter_mut().zip(&self.lines).zip(&sight.forces);
        for (coupling, ((missing, lines), forces)) in all.enumerate() {
            let [deflections, rates] = sight.at_checks(coupling, step);
            let cubic = cubic_at_checks(forces);
            *missing = core::array::from_fn(|check| {
                lines.at(NODES + check, deflections[check], rates[check]) - cubic[check]
            });
        }
    }

    /// How the forces at the end change with deflections and rates there. From these alone: differences of forces would leave
    /// their rounding.
    #[inline(always)]
    pub(super) fn change(&self, drift: &[[f64; 2]], change: &mut [f64]) {
        let drift = drift.iter().zip(&self.lines);
        for (change, ([deflection, rate], lines)) in change.iter_mut().zip(drift) {
            *change = lines.stiffness[END] * deflection + lines.damping[END] * rate;
        }
    }
}

/// What lines without their rest make of deflections and rates at the nodes.
#[inline(always)]
fn push(lines: &Lines<PLACES_OF_LINES>, [deflections, rates]: &Readings) -> Quad {
    core::array::from_fn(|i| lines.stiffness[i] * deflections[i] + lines.damping[i] * rates[i])
}

/// The larger of two numbers; a NaN is the largest.
#[inline(always)]
fn worse(most: f64, one: f64) -> f64 {
    if one <= most { most } else { one }
}

/// Matrix times the unknowns of a vector.
#[inline(always)]
fn product(columns: &Mutual, [_, x @ ..]: &Quad) -> Quad {
    let mut sum = [0.0; 4];
    for (column, x) in columns.iter().zip(x) {
        add_multiple(&mut sum, *x, column);
    }
    sum
}

/// The equations of a coupling that nothing answers to.
const IDENTITY: Mutual = [
    [0.0, 1.0, 0.0, 0.0],
    [0.0, 0.0, 1.0, 0.0],
    [0.0, 0.0, 0.0, 1.0],
];

/// By cofactors.
#[inline(always)]
fn inverse_of([a, b, c]: &Mutual) -> Mutual {
    let cross = |x: &Quad, y: &Quad| {
        [
            x[2] * y[3] - x[3] * y[2],
            x[3] * y[1] - x[1] * y[3],
            x[1] * y[2] - x[2] * y[1],
        ]
    };
    let rows = [cross(b, c), cross(c, a), cross(a, b)];
    let determinant = a[1] * rows[0][0] + a[2] * rows[0][1] + a[3] * rows[0][2];
    let scale = 1.0 / determinant;
    let column = |j: usize| [0.0, rows[0][j], rows[1][j], rows[2][j]].map(|entry| scale * entry);
    [column(0), column(1), column(2)]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_matrix_times_its_inverse_is_the_identity() {
        let matrix = [
            [0.0, 1.2, -0.3, 0.1],
            [0.0, 0.4, 0.9, -0.2],
            [0.0, 0.05, 0.3, 1.1],
        ];
        let inverse = inverse_of(&matrix);
        for (column, unit) in inverse.iter().zip(IDENTITY) {
            for (found, expected) in product(&matrix, column).into_iter().zip(unit) {
                // 1e-15: rounding.
                assert!((found - expected).abs() < 1e-15);
            }
        }
    }
}
