//! The forces of springs at the nodes of a step, where their laws are straight lines: linear equations.
//!
//! ```text
//!   F_i = k_i d_i + c_i d_i' + r_i,   d_i = free response - sum over pairs and nodes j of e_d F_j       unknown: F at three nodes
//! ```
//!
//! Solved by elimination (`elimination`). Laws that are no lines are replaced by their tangents, again and again.

use super::super::march::Span;
use super::super::{Forcing, Lines, Piece, Spring, System};
use super::elimination::{Elimination, Square};
use super::exchange::{Exchange, Influences, Pair};
use super::lanes::{Quad, add_multiple, are_finite, subtract_multiple};
use super::nodes::{cubic_at_checks, larger};
use super::polynomials::{CHECK_PLACES, CHECKS, END, NODES, PLACES};
use super::sight::{Readings, Sight};

/// The most that the forces of a coupling may do to themselves within a step: beyond, they answer to rounding.
const MOST_FEEDBACK: f64 = 4.0;
/// Places where laws are evaluated: the nodes, then those for comparison.
const PLACES_OF_LINES: usize = NODES + CHECKS;

/// The equations of one step, with room for them.
#[derive(Debug, Clone)]
pub(super) struct Equations {
    elimination: Elimination,
    /// The pairs of springs, with their numbers among all pairs.
    pairs: Vec<(usize, Pair)>,
    /// The lines of all springs.
    lines: Vec<Lines<PLACES_OF_LINES>>,
    /// How the sensor's forces depend on the actuator's: for every pair of springs, then for what fills up.
    blocks: Vec<Square>,
}

impl Equations {
    pub(super) fn new(system: &System, exchange: &Exchange) -> Equations {
        let are_springs = |pair: &Pair| pair.sensor.max(pair.actuator) < system.springs;
        let numbered = exchange.pairs.iter().copied().enumerate();
        let pairs: Vec<(usize, Pair)> = numbered.filter(|(_, pair)| are_springs(pair)).collect();
        let springs: Vec<Pair> = pairs.iter().map(|&(_, pair)| pair).collect();
        let elimination = Elimination::of(&springs, system.springs);
        Equations {
            pairs,
            lines: vec![Lines::ZERO; system.springs],
            blocks: vec![Square::default(); elimination.blocks()],
            elimination,
        }
    }

    /// Draws the lines of a step. Gives the number of places they were drawn for.
    #[inline(always)]
    pub(super) fn draw(&mut self, forcing: &impl Forcing, span: Span, pieces: &[Piece]) -> u64 {
        let [start, a, b, end] = PLACES.map(|place| span.at(place));
        let [first, second] = CHECK_PLACES.map(|place| span.at(place));
        let times = [start, a, b, end, first, second];
        forcing.lines_into(times, pieces, &mut self.lines);
        PLACES_OF_LINES as u64
    }

    /// Solves for the forces at the nodes; all couplings are springs. Gives whether they were found.
    #[inline(always)]
    pub(super) fn solve(&mut self, influences: &Influences, sight: &mut Sight) -> bool {
        self.let_go(sight);
        if self.set_up(influences) > MOST_FEEDBACK {
            return false;
        }
        for (number, pair) in &self.pairs {
            let [known, ..] = &influences.of_pairs[*number];
            let push = push(&self.lines[pair.sensor], known);
            let force = sight.forces[pair.actuator][0];
            subtract_multiple(&mut sight.forces[pair.sensor], force, &push);
        }
        self.elimination.solve(&mut self.blocks, &mut sight.forces);
        are_finite(&sight.forces)
    }

    /// The tangents of springs at a node.
    pub(super) fn touch(&mut self, node: usize, tangents: &[Spring]) {
        for (lines, tangent) in self.lines.iter_mut().zip(tangents) {
            lines.stiffness[node] = tangent.stiffness;
            lines.damping[node] = tangent.damping;
        }
    }

    /// A step of Newton's method: `answers` are the forces of the laws in the motion under the present ones; those of springs become
    /// the forces on the tangents.
    ///
    /// ```text
    ///   c_i + sum over j of A_ij c_j = answer_i - F_i,   F_i + c_i         changes: forces themselves would bring rounding back
    /// ```
    #[inline(always)]
    pub(super) fn improve(
        &mut self,
        influences: &Influences,
        present: &[Quad],
        answers: &mut [Quad],
    ) {
        self.set_up(influences);
        let springs = self.elimination.couplings();
        let (changes, present) = (&mut answers[..springs], &present[..springs]);
        for (change, present) in changes.iter_mut().zip(present) {
            subtract_multiple(change, 1.0, present);
        }
        self.elimination.solve(&mut self.blocks, changes);
        for (change, present) in changes.iter_mut().zip(present) {
            add_multiple(change, 1.0, present);
        }
    }

    /// The forces at all nodes if nothing answered to them; those at the start are right.
    #[inline(always)]
    fn let_go(&self, sight: &mut Sight) {
        for (coupling, lines) in self.lines.iter().enumerate() {
            let start = sight.start(coupling);
            let free = &sight.free[coupling];
            let seen = [0, 1].map(|what| free[what].map(|moved| start[what] + moved));
            let (push, rest) = (push(lines, &seen), &lines.rest);
            sight.forces[coupling] = core::array::from_fn(|node| push[node] + rest[node]);
        }
    }

    /// The blocks. Gives the largest entry of a coupling's own block.
    #[inline(always)]
    fn set_up(&mut self, influences: &Influences) -> f64 {
        let mut feedback = [0.0; 4];
        let (blocks, filling) = self.blocks.split_at_mut(self.pairs.len());
        for ((number, pair), block) in self.pairs.iter().zip(blocks) {
            let lines = &self.lines[pair.sensor];
            let [_, unknown @ ..] = &influences.of_pairs[*number];
            *block = unknown.each_ref().map(|moved| push(lines, moved));
            if pair.actuator == pair.sensor {
                for column in &*block {
                    for (most, one) in feedback.iter_mut().zip(column) {
                        *most = larger(*most, one.abs());
                    }
                }
            }
        }
        filling.fill(Square::default());
        feedback.into_iter().fold(0.0, larger)
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
