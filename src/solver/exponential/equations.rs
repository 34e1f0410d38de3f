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
use super::lanes::{Quad, add_multiple, add_product, are_finite, subtract_multiple};
use super::nodes::{cubic_at_checks, larger};
use super::polynomials::{CHECK_PLACES, CHECKS, END, HERMITE_SLOPES, NODES, PLACES};
use super::sight::{Moved, Sight, at_checks, rates_at_nodes};

/// The most that the forces of a coupling may do to themselves within a step: beyond, they answer to rounding.
pub(super) const MOST_FEEDBACK: f64 = 4.0;
/// Places where laws are evaluated: the nodes, then those for comparison.
pub(super) const PLACES_OF_LINES: usize = NODES + CHECKS;

/// How the force of a spring answers to its movement, at the nodes but the first: nothing answers at the start.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Tangents {
    stiffness: Quad,
    damping: Quad,
}

impl Tangents {
    #[inline(always)]
    fn of(lines: &Lines<PLACES_OF_LINES>) -> Tangents {
        let [_, a, b, end, ..] = lines.stiffness;
        let stiffness = [0.0, a, b, end];
        let [_, a, b, end, ..] = lines.damping;
        let damping = [0.0, a, b, end];
        Tangents { stiffness, damping }
    }

    /// The forces that come from a movement; `rates` are its rates at the nodes.
    #[inline(always)]
    pub(super) fn push(&self, moved: &Moved, rates: &Quad) -> Quad {
        let mut push = [0.0; 4];
        add_product(&mut push, &self.stiffness, moved);
        add_product(&mut push, &self.damping, rates);
        push
    }

    /// How the force at the end changes with deflection and rate there. From these alone: differences of forces would leave
    /// their rounding.
    #[inline(always)]
    pub(super) fn change(&self, [deflection, rate]: [f64; 2]) -> f64 {
        self.stiffness[END] * deflection + self.damping[END] * rate
    }
}

/// The equations of one step, with room for them.
#[derive(Debug, Clone)]
pub(super) struct Equations {
    elimination: Elimination,
    pairs: Vec<Pair>,
    /// The lines of all springs, and their tangents.
    pub(super) lines: Vec<Lines<PLACES_OF_LINES>>,
    pub(super) tangents: Vec<Tangents>,
    /// How the sensor's forces depend on the actuator's: for every pair of springs, then for what fills up.
    pub(super) blocks: Vec<Square>,
}

impl Equations {
    pub(super) fn new(system: &System, exchange: &Exchange) -> Equations {
        let pairs = exchange.of_springs();
        let elimination = Elimination::of(pairs, system.springs);
        Equations {
            pairs: pairs.to_vec(),
            lines: vec![Lines::ZERO; system.springs],
            tangents: vec![Tangents::default(); system.springs],
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
        self.take_tangents();
        PLACES_OF_LINES as u64
    }

    /// Takes the tangents from the lines.
    #[inline(always)]
    pub(super) fn take_tangents(&mut self) {
        for (tangents, lines) in self.tangents.iter_mut().zip(&self.lines) {
            *tangents = Tangents::of(lines);
        }
    }

    /// Prepares for [`Self::solve`] what does not depend on how couplings move; all of them are springs. Gives whether the step is short
    /// enough.
    #[inline(always)]
    pub(super) fn prepare(&mut self, influences: &Influences, sight: &mut Sight) -> bool {
        for (coupling, lines) in self.lines.iter().enumerate() {
            sight.forces[coupling] = without_movement(lines, sight.start(coupling));
        }
        for (pair, ([known, ..], [rates, ..])) in self.pairs.iter().zip(influences.of_springs()) {
            let push = self.tangents[pair.sensor].push(known, rates);
            let force = sight.forces[pair.actuator][0];
            subtract_multiple(&mut sight.forces[pair.sensor], force, &push);
        }
        let is_short = self.set_up(influences) <= MOST_FEEDBACK;
        self.elimination.factorize(&mut self.blocks);
        is_short
    }

    /// Solves for the forces at the nodes. Gives whether they are numbers.
    #[inline(always)]
    pub(super) fn solve(&mut self, step: f64, sight: &mut Sight) -> bool {
        let per_step = 1.0 / step;
        let all = sight.forces.iter_mut().zip(&sight.free).zip(&self.tangents);
        for ((forces, free), tangents) in all {
            let push = tangents.push(free, &rates_at_nodes(free, per_step));
            add_multiple(forces, 1.0, &push);
        }
        self.elimination.substitute(&self.blocks, &mut sight.forces);
        are_finite(&sight.forces)
    }

    /// The tangents of springs at a node.
    pub(super) fn touch(&mut self, node: usize, tangents: &[Spring]) {
        for (own, spring) in self.tangents.iter_mut().zip(tangents) {
            own.stiffness[node] = spring.stiffness;
            own.damping[node] = spring.damping;
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
        self.elimination.factorize(&mut self.blocks);
        self.elimination.substitute(&self.blocks, changes);
        for (change, present) in changes.iter_mut().zip(present) {
            add_multiple(change, 1.0, present);
        }
    }

    /// The blocks. Gives the largest entry of a coupling's own block.
    #[inline(always)]
    fn set_up(&mut self, influences: &Influences) -> f64 {
        let mut feedback = [0.0; 4];
        let (blocks, filling) = self.blocks.split_at_mut(self.pairs.len());
        let all = self.pairs.iter().zip(influences.of_springs()).zip(blocks);
        for ((pair, ([_, moved @ ..], [_, rates @ ..])), block) in all {
            let tangents = &self.tangents[pair.sensor];
            for (column, (moved, rates)) in block.iter_mut().zip(moved.iter().zip(rates)) {
                *column = tangents.push(moved, rates);
            }
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
    pub(super) fn compare(&self, step: f64, sight: &mut Sight) {
        for (coupling, lines) in self.lines.iter().enumerate() {
            let [deflections, rates] =
                at_checks(sight.start(coupling), &sight.moved[coupling], step);
            let cubic = cubic_at_checks(&sight.forces[coupling]);
            sight.missing[coupling] = core::array::from_fn(|check| {
                lines.at(NODES + check, deflections[check], rates[check]) - cubic[check]
            });
        }
    }

    /// How the forces at the end change with deflections and rates there.
    #[inline(always)]
    pub(super) fn change(&self, sight: &mut Sight) {
        let drift = sight.drift.iter().zip(&self.tangents);
        for (change, (drift, tangents)) in sight.change.iter_mut().zip(drift) {
            *change = tangents.change(*drift);
        }
    }
}

/// The forces at all nodes if the coupling moved as it does at the start and no further: those that are right at the start.
#[inline(always)]
pub(super) fn without_movement(
    lines: &Lines<PLACES_OF_LINES>,
    [deflection, rate]: [f64; 2],
) -> Quad {
    let mut forces = [0.0; 4];
    for (node, force) in forces.iter_mut().enumerate() {
        let rate = rate * HERMITE_SLOPES.of_first_slope[node];
        *force = lines.at(node, deflection, rate);
    }
    forces
}
