//! The forces at the nodes of a step.
//!
//! ```text
//!   F_i = F(s_i, d_i, d_i'),   d_i = free response - sum over pairs and nodes j of e_d F_j        unknown: F but at the start
//! ```
//!
//! Where all laws are straight lines these are linear equations (`equations`). Otherwise the laws are asked again and again: springs
//! by Newton's method, since they answer strongly to their own forces, the others as they are.

use super::super::march::{Span, Task};
use super::super::{Forcing, Piece, Spring, System};
use super::equations::Equations;
use super::exchange::{Exchange, Influences};
use super::few;
use super::lanes::Quad;
use super::polynomials::{CHECK_PLACES, CHECKS, END, LAGRANGE_AT_CHECKS, NODES, PLACES};
use super::sight::{Sight, at_checks, instant};

/// Sweeps after which a step counts as too long.
const MOST_SWEEPS: usize = 25;
/// How far answers may be from the forces, relative to the tolerance, and the least that is above rounding.
const ACCURACY: (f64, f64) = (1e-3, 1e-13);

/// What finds the forces, and how good they are.
#[derive(Debug, Clone)]
pub(super) struct Nodes {
    pub(super) equations: Equations,
    /// What laws answer to the present forces at the nodes, and their tangents at one of them.
    answers: Vec<Quad>,
    tangents: Vec<Spring>,
    /// Evaluations of all forces.
    pub(super) evaluations: u64,
}

impl Nodes {
    pub(super) fn new(system: &System, exchange: &Exchange) -> Nodes {
        let couplings = system.couplings.len();
        Nodes {
            equations: Equations::new(system, exchange),
            answers: vec![[0.0; NODES]; couplings],
            tangents: vec![Spring::default(); couplings],
            evaluations: 0,
        }
    }

    /// Straight laws: draws their lines for a step, and prepares to solve for the forces. Gives whether the step is short enough for
    /// that.
    #[inline(always)]
    pub(super) fn prepare(
        &mut self,
        forcing: &impl Forcing,
        span: Span,
        pieces: &[Piece],
        influences: &Influences,
        sight: &mut Sight,
    ) -> bool {
        self.evaluations += self.equations.draw(forcing, span, pieces);
        let equations = &mut self.equations;
        let is_short = match equations.lines.len() {
            1 => few::prepare::<1>(equations, influences, sight),
            2 => few::prepare::<2>(equations, influences, sight),
            3 => few::prepare::<3>(equations, influences, sight),
            _ => None,
        };
        is_short.unwrap_or_else(|| self.equations.prepare(influences, sight))
    }

    /// Straight laws: solves for the forces at the nodes, sees how couplings move under them and looks for errors. Gives whether
    /// the forces are numbers.
    #[inline(always)]
    pub(super) fn solve(
        &mut self,
        between: (&Exchange, &Influences),
        step: f64,
        sight: &mut Sight,
    ) -> bool {
        let equations = &self.equations;
        let are_found = match equations.lines.len() {
            1 => few::solve::<1>(equations, between.1, step, sight),
            2 => few::solve::<2>(equations, between.1, step, sight),
            3 => few::solve::<3>(equations, between.1, step, sight),
            _ => None,
        };
        are_found.unwrap_or_else(|| self.solve_many(between, step, sight))
    }

    /// The same for any number of springs.
    #[inline(always)]
    fn solve_many(
        &mut self,
        (exchange, influences): (&Exchange, &Influences),
        step: f64,
        sight: &mut Sight,
    ) -> bool {
        let are_found = self.equations.solve(step, sight);
        if are_found {
            sight.exert(exchange, influences);
            self.equations.compare(step, sight);
            exchange.exert_missing(influences, &sight.missing, &mut sight.drift);
            self.equations.change(sight);
        }
        are_found
    }

    /// Any laws: asks them until they answer with the forces that they were asked under. Gives whether these were found; the nodes are
    /// shown under them then.
    #[inline(always)]
    pub(super) fn sweep<F: Forcing>(
        &mut self,
        task: Task<'_, F>,
        (span, slow): (Span, &[f64]),
        pieces: &[Piece],
        (exchange, influences): (&Exchange, &Influences),
        sight: &mut Sight,
    ) -> bool {
        let accuracy = accuracy(task.tolerance);
        for (forces, answers) in sight.forces.iter_mut().zip(&mut self.answers) {
            *forces = [forces[0]; NODES];
            answers[0] = forces[0];
        }
        for _ in 0..MOST_SWEEPS {
            sight.exert(exchange, influences);
            sight.show(span.step);
            self.ask(task, (span, slow), pieces, sight);
            if self.is_settled(accuracy, sight) {
                return true;
            }
            self.equations
                .improve(influences, &sight.forces, &mut self.answers);
            sight.forces.copy_from_slice(&self.answers);
        }
        false
    }

    /// What the laws answer at the nodes that are shown.
    fn ask<F: Forcing>(
        &mut self,
        task: Task<'_, F>,
        (span, slow): (Span, &[f64]),
        pieces: &[Piece],
        sight: &mut Sight,
    ) {
        for (node, place) in PLACES.into_iter().enumerate().skip(1) {
            let at = instant(&sight.nodes[node], span.at(place), slow);
            let (present, tangents) = (&mut sight.present, &mut self.tangents);
            task.forcing.springs_into(at, pieces, present, tangents);
            self.equations.touch(node, &self.tangents);
            for (answers, &present) in self.answers.iter_mut().zip(&sight.present) {
                answers[node] = present;
            }
        }
        self.evaluations += END as u64;
    }

    /// Whether the answers are the forces. Neither NaN nor infinity is.
    fn is_settled(&self, accuracy: f64, sight: &Sight) -> bool {
        let least = least_force(sight);
        let mut settled = true;
        for (answers, forces) in self.answers.iter().zip(&sight.forces) {
            for (answer, force) in answers.iter().zip(forces) {
                let size = answer.abs().max(force.abs()).max(least);
                settled &= (answer - force).abs() <= accuracy * size && size < f64::INFINITY;
            }
        }
        settled
    }

    /// What the cubic leaves out at the checks, and how that would change deflections, rates and forces at
    /// the end.
    pub(super) fn look_for_errors<F: Forcing>(
        &mut self,
        task: Task<'_, F>,
        (span, slow): (Span, &[f64]),
        pieces: &[Piece],
        (exchange, influences): (&Exchange, &Influences),
        sight: &mut Sight,
    ) {
        self.compare(task, (span, slow), pieces, sight);
        exchange.exert_missing(influences, &sight.missing, &mut sight.drift);
        let [deflection, rate] = &sight.nodes[END];
        for (coupling, drift) in sight.drift.iter().enumerate() {
            sight.trial[0][coupling] = deflection[coupling] + drift[0];
            sight.trial[1][coupling] = rate[coupling] + drift[1];
        }
        let at = instant(&sight.trial, span.end, slow);
        task.forcing.forces_into(at, pieces, &mut sight.change);
        self.evaluations += 1;
        // The answers: forces are settled up to their accuracy only.
        for (change, answers) in sight.change.iter_mut().zip(&self.answers) {
            *change -= answers[END];
        }
    }

    /// The forces of the laws at the checks, less those of the cubics.
    fn compare<F: Forcing>(
        &mut self,
        task: Task<'_, F>,
        (span, slow): (Span, &[f64]),
        pieces: &[Piece],
        sight: &mut Sight,
    ) {
        for (check, place) in CHECK_PLACES.into_iter().enumerate() {
            for coupling in 0..sight.missing.len() {
                let start = sight.start(coupling);
                let seen = at_checks(start, &sight.moved[coupling], span.step);
                for (trial, seen) in sight.trial.iter_mut().zip(seen) {
                    trial[coupling] = seen[check];
                }
            }
            let at = instant(&sight.trial, span.at(place), slow);
            task.forcing.forces_into(at, pieces, &mut sight.present);
            self.evaluations += 1;
            let forces = sight.present.iter().zip(&sight.forces);
            for (missing, (present, forces)) in sight.missing.iter_mut().zip(forces) {
                missing[check] = present - cubic_at_checks(forces)[check];
            }
        }
    }
}

/// How accurately the forces are to be found, relative to their size.
fn accuracy(tolerance: f64) -> f64 {
    (ACCURACY.0 * tolerance).max(ACCURACY.1)
}

/// Below this part of the largest force changes are rounding.
#[inline(always)]
fn least_force(sight: &Sight) -> f64 {
    let sizes = sight.forces.iter().map(|forces| forces.map(f64::abs));
    let largest = sizes.fold([0.0; 4], |most, sizes| {
        core::array::from_fn(|i| larger(most[i], sizes[i]))
    });
    larger(
        ACCURACY.1 * largest.into_iter().fold(0.0, larger),
        f64::MIN_POSITIVE,
    )
}

/// The larger of two numbers; a NaN is never larger.
#[inline(always)]
pub(super) fn larger(most: f64, one: f64) -> f64 {
    if one > most { one } else { most }
}

/// The cubic through the forces at the nodes, at the places for comparison.
#[inline(always)]
pub(super) fn cubic_at_checks(forces: &Quad) -> [f64; CHECKS] {
    let mut sum = [0.0; CHECKS];
    for (force, weights) in forces.iter().zip(&LAGRANGE_AT_CHECKS) {
        for (sum, weight) in sum.iter_mut().zip(weights) {
            *sum += force * weight;
        }
    }
    sum
}
