//! The loops that run over all states.
//!
//! ```text
//!   compute        the coefficients of a step length
//!   take loads     load = sum of columns times inputs
//!   observe        deflections and rates = rows eta
//!   look ahead     free responses at the nodes = rows (B eta + load) + rows load' + response to the harmonics
//!   solve lines    the forces at the nodes from these, where all laws are straight lines
//!   sweep          the same for any laws
//!   move           eta + h phi_1 (B eta + load) + h^2 phi_2 load' - sum over j of f_j F_j + response to the harmonics
//!   read off       the readings of the system = rows eta
//! ```
//!
//! Each is one operation for `pulp`, compiled once for every width of vectors.

use pulp::{Simd, WithSimd};

use super::super::march::{Span, Task};
use super::super::{Forcing, Piece, Ramp};
use super::coefficients::Coefficients;
use super::exchange::Exchange;
use super::lanes::{Quad, add_product, add_products, are_finite, sum};
use super::motion::Motion;
use super::nodes::Nodes;
use super::panel::Panels;
use super::part::Part;
use super::rows::Rows;
use super::scratch::Scratch;
use super::sight::{Moved, Sight, accumulate};
use super::turning::Turning;

/// The coefficients of a step length.
pub(super) struct Compute<'a> {
    pub(super) coefficients: &'a mut Coefficients,
    pub(super) parts: &'a [Part],
    pub(super) panels: &'a Panels,
    pub(super) exchange: &'a Exchange,
    /// The length [s].
    pub(super) step: f64,
    /// Those of all harmonics [rad/s].
    pub(super) frequencies: &'a [f64],
    pub(super) scratch: &'a mut Scratch,
}

/// The loads of a call.
pub(super) struct TakeLoads<'a> {
    pub(super) motion: &'a mut Motion,
    pub(super) ramps: &'a [Ramp],
}

/// What the couplings see at the start of a step.
pub(super) struct Observe<'a> {
    pub(super) panels: &'a Panels,
    pub(super) states: &'a [Quad],
    pub(super) sight: &'a mut Sight,
}

/// What the couplings see at the nodes without forces.
pub(super) struct LookAhead<'a> {
    pub(super) panels: &'a Panels,
    pub(super) coefficients: &'a Coefficients,
    pub(super) motion: &'a mut Motion,
    pub(super) sight: &'a mut Sight,
    pub(super) turning: &'a Turning,
    /// Seconds since the start of the call.
    pub(super) elapsed: f64,
}

/// The same, and the forces of laws that are straight lines. Gives whether they were found.
pub(super) struct SolveLines<'a, F> {
    pub(super) ahead: LookAhead<'a>,
    pub(super) nodes: &'a mut Nodes,
    pub(super) forcing: &'a F,
    pub(super) span: Span,
    pub(super) pieces: &'a [Piece],
    pub(super) exchange: &'a Exchange,
}

/// The forces of any laws. Gives whether they were found.
pub(super) struct Sweep<'a, F> {
    pub(super) ahead: LookAhead<'a>,
    pub(super) nodes: &'a mut Nodes,
    pub(super) task: Task<'a, F>,
    /// The step, with the slow parameters in it.
    pub(super) at: (Span, &'a [f64]),
    pub(super) pieces: &'a [Piece],
    pub(super) exchange: &'a Exchange,
}

/// From the start of the step to its end.
pub(super) struct Move<'a> {
    pub(super) panels: &'a Panels,
    pub(super) coefficients: &'a Coefficients,
    pub(super) motion: &'a mut Motion,
    pub(super) sight: &'a Sight,
    pub(super) turning: &'a Turning,
}

/// The readings at the end of a call. Gives whether the states are numbers.
pub(super) struct ReadOff<'a> {
    pub(super) motion: &'a Motion,
    pub(super) rows: &'a Rows,
    pub(super) numbers: &'a mut [f64],
}

impl WithSimd for Compute<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let parts = (self.parts, self.panels, self.exchange);
        self.coefficients
            .compute(parts, self.step, self.frequencies, self.scratch);
    }
}

impl WithSimd for TakeLoads<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        self.motion.set_loads(simd, self.ramps);
    }
}

impl WithSimd for ReadOff<'_> {
    type Output = bool;

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) -> bool {
        let states = &self.motion.states;
        self.rows.read(states, self.numbers);
        are_finite(states)
    }
}

impl WithSimd for Observe<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let [deflections, rates] = &mut self.sight.nodes[0];
        deflections.fill(0.0);
        rates.fill(0.0);
        let mut rows = &self.panels.rows[..];
        for look in &self.panels.looks {
            let own = self.states[look.quads.clone()].iter();
            let looked;
            (looked, rows) = rows.split_at(own.len());
            let (mut deflection, mut rate) = ([0.0; 4], [0.0; 4]);
            for (states, [per_deflection, per_rate]) in own.zip(looked) {
                add_product(&mut deflection, per_deflection, states);
                add_product(&mut rate, per_rate, states);
            }
            deflections[look.coupling] += sum(&deflection);
            rates[look.coupling] += sum(&rate);
        }
    }
}

impl LookAhead<'_> {
    #[inline(always)]
    fn look<S: Simd>(&mut self, simd: S) {
        let (panels, coefficients) = (self.panels, self.coefficients);
        let (motion, sight) = (&mut *self.motion, &mut *self.sight);
        motion.differentiate(simd, self.elapsed);
        sight.free.fill([0.0; 4]);
        look(panels, &coefficients.free, &motion.derivative, sight);
        if motion.ramps {
            look(panels, &coefficients.ramp, &motion.load_rate, sight);
        }
        for (turn, columns) in panels.turns.iter().zip(&coefficients.turning) {
            let moved = &mut sight.free[turn.coupling];
            let factors = self.turning.of_both(turn.harmonics);
            add_products(simd, factors.each_ref(), columns.each_ref(), moved);
        }
    }
}

/// What couplings see of numbers of the states: one row per look and state.
#[inline(always)]
fn look(panels: &Panels, rows: &[Moved], numbers: &[Quad], sight: &mut Sight) {
    let mut rows = rows;
    for look in &panels.looks {
        let own;
        (own, rows) = rows.split_at(4 * look.quads.len());
        accumulate(
            &mut sight.free[look.coupling],
            own,
            &numbers[look.quads.clone()],
        );
    }
}

impl<F: Forcing> WithSimd for SolveLines<'_, F> {
    type Output = bool;

    #[inline(always)]
    fn with_simd<S: Simd>(mut self, simd: S) -> bool {
        let (nodes, influences) = (self.nodes, &self.ahead.coefficients.influences);
        // The equations first: while they wait for each other, the CPU looks ahead.
        let sight = &mut *self.ahead.sight;
        let is_short = nodes.prepare(self.forcing, self.span, self.pieces, influences, sight);
        self.ahead.look(simd);
        is_short
            && nodes.solve(
                (self.exchange, influences),
                self.span.step,
                self.ahead.sight,
            )
    }
}

impl<F: Forcing> WithSimd for Sweep<'_, F> {
    type Output = bool;

    #[inline(always)]
    fn with_simd<S: Simd>(mut self, simd: S) -> bool {
        self.ahead.look(simd);
        let between = (self.exchange, &self.ahead.coefficients.influences);
        let (nodes, sight) = (self.nodes, self.ahead.sight);
        nodes.sweep(self.task, self.at, self.pieces, between, sight)
    }
}

impl WithSimd for Move<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let (coefficients, motion) = (self.coefficients, self.motion);
        let (gain, ramp_gain) = (&coefficients.gain, &coefficients.ramp_gain);
        motion.advance(simd, gain, ramp_gain);
        motion.advance_others(gain, ramp_gain);
        let (panels, sight, turning) = (self.panels, self.sight, self.turning);
        let mut columns = &coefficients.pushes[..];
        for push in &panels.pushes {
            let factors = sight.forces[push.coupling].map(|force| [force; 4]);
            motion.push(simd, &push.quads, &mut columns, &factors);
        }
        let mut columns = &coefficients.responses[..];
        for response in &panels.responses {
            let factors = turning.of_both(response.harmonics);
            motion.push(simd, &response.quads, &mut columns, &factors);
        }
    }
}
