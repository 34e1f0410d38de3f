//! The loops that run over all states.
//!
//! ```text
//!   compute        the coefficients of a step length
//!   take loads     load = sum of columns times inputs
//!   observe        deflections and rates = rows eta
//!   look ahead     free responses at the nodes = rows (B eta + load) + rows load' + response to the harmonics
//!   solve lines    the forces at the nodes from these, where all laws are straight lines
//!   move           eta + h phi_1 (B eta + load) + h^2 phi_2 load' - sum over j of f_j F_j + response to the harmonics
//!   read off       deflections, rates and readings of the system = rows eta
//! ```
//!
//! Each is one operation for `pulp`, compiled once for every width of vectors.

use pulp::{Simd, WithSimd};

use super::super::Ramp;
use super::coefficients::Coefficients;
use super::exchange::Exchange;
use super::lanes::{Quad, add_product, sum};
use super::motion::Motion;
use super::nodes::Nodes;
use super::panel::{Panel, Panels};
use super::part::Part;
use super::rows::Rows;
use super::scratch::Scratch;
use super::sight::{STILL, Sight, accumulate, accumulate_all};
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
    pub(super) panels: &'a [Panel],
    pub(super) states: &'a [Quad],
    pub(super) sight: &'a mut Sight,
}

/// What the couplings see at the nodes without forces.
pub(super) struct LookAhead<'a> {
    pub(super) panels: &'a [Panel],
    pub(super) coefficients: &'a Coefficients,
    pub(super) motion: &'a mut Motion,
    pub(super) sight: &'a mut Sight,
    pub(super) turning: &'a Turning,
    /// Seconds since the start of the call.
    pub(super) elapsed: f64,
}

/// The same, and the forces of laws that are straight lines. Gives whether they were found.
pub(super) struct SolveLines<'a> {
    pub(super) ahead: LookAhead<'a>,
    pub(super) nodes: &'a mut Nodes,
    pub(super) exchange: &'a Exchange,
    /// The length of the step [s], and how accurate the forces are to be.
    pub(super) asked: (f64, f64),
}

/// From the start of the step to its end.
pub(super) struct Move<'a> {
    pub(super) parts: &'a [Part],
    pub(super) coefficients: &'a Coefficients,
    pub(super) motion: &'a mut Motion,
    pub(super) sight: &'a Sight,
    pub(super) turning: &'a Turning,
}

/// What is known of the motion at the end of a call. Gives whether the states are numbers.
pub(super) struct ReadOff<'a> {
    pub(super) parts: &'a [Part],
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
        self.rows.read(self.parts, states, self.numbers);
        self.motion.is_finite()
    }
}

impl WithSimd for Observe<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let [deflections, rates] = &mut self.sight.nodes[0];
        deflections.fill(0.0);
        rates.fill(0.0);
        for panel in self.panels {
            let own = &self.states[panel.quads.clone()];
            let mut rows = panel.rows.as_slice();
            for &sensor in &panel.sensors {
                let (mut deflection, mut rate) = ([0.0; 4], [0.0; 4]);
                for (states, [per_deflection, per_rate]) in own.iter().zip(rows) {
                    add_product(&mut deflection, per_deflection, states);
                    add_product(&mut rate, per_rate, states);
                }
                rows = &rows[own.len()..];
                deflections[sensor] += sum(&deflection);
                rates[sensor] += sum(&rate);
            }
        }
    }
}

impl LookAhead<'_> {
    #[inline(always)]
    fn look<S: Simd>(&mut self, simd: S) {
        let (motion, sight) = (&mut *self.motion, &mut *self.sight);
        motion.differentiate(simd, self.elapsed);
        sight.free.fill(STILL);
        let Coefficients {
            free,
            ramp,
            turning,
            ..
        } = self.coefficients;
        let (mut free, mut ramp, mut turning) = (&free[..], &ramp[..], &turning[..]);
        for panel in self.panels {
            let derivative = &motion.derivative[panel.quads.clone()];
            for &sensor in &panel.sensors {
                let mut seen = sight.free[sensor];
                accumulate_all(&mut seen, take(&mut free, panel.len()), derivative);
                let ramp = take(&mut ramp, panel.len());
                if motion.ramps {
                    accumulate_all(&mut seen, ramp, &motion.load_rate[panel.quads.clone()]);
                }
                let turning = take(&mut turning, panel.harmonics.len());
                for (&harmonic, [per_cosine, per_sine]) in panel.harmonics.iter().zip(turning) {
                    let [cosine, sine] = self.turning.angles[harmonic];
                    accumulate(&mut seen, cosine, per_cosine);
                    accumulate(&mut seen, sine, per_sine);
                }
                sight.free[sensor] = seen;
            }
        }
    }
}

/// The first entries of a list, which then begins behind them.
#[inline(always)]
fn take<'a, T>(list: &mut &'a [T], count: usize) -> &'a [T] {
    let (first, others) = list.split_at(count);
    *list = others;
    first
}

impl WithSimd for LookAhead<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(mut self, simd: S) {
        self.look(simd);
    }
}

impl WithSimd for SolveLines<'_> {
    type Output = bool;

    #[inline(always)]
    fn with_simd<S: Simd>(mut self, simd: S) -> bool {
        self.ahead.look(simd);
        let between = (self.exchange, &self.ahead.coefficients.influences);
        self.nodes.solve(between, self.asked, self.ahead.sight)
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
        let mut pushes = coefficients.pushes.as_slice();
        let mut responses = coefficients.responses.as_slice();
        for part in self.parts {
            let quads = part.quads().len();
            for &actuator in &part.actuators {
                let forces = &self.sight.forces[actuator];
                motion.push(simd, part, take(&mut pushes, quads), forces);
            }
            for (harmonic, _) in &part.harmonics {
                let angle = &self.turning.angles[*harmonic];
                motion.push(simd, part, take(&mut responses, quads), angle);
            }
        }
    }
}
