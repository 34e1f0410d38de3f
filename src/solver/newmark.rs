//! The Newmark-beta method of the paper with variable steps: average acceleration (beta 1/4, gamma 1/2),
//! implicit in the blocks and in the couplings.
//!
//! ```text
//!   q1 = q~ + h^2/4 a1        q~ = q0 + h v0 + h^2/4 a0
//!   v1 = v~ + h/2 a1          v~ = v0 + h/2 a0
//!   a1 = y - sum over m of z_m F_m         y = A^-1 (f1 - D v~ - K q~)
//!   A  = I + h/2 D + h^2/4 K               z_m = A^-1 b_m
//!   F_m = k_m w_m q1 + c_m w_m v1          (I + kappa Z) F = k w (q~ + h^2/4 y) + c w (v~ + h/2 y)
//!                                          Z_ml = w_m z_l,  kappa = h^2/4 k + h/2 c
//! ```
//!
//! A depends on h alone and is inverted block by block once per step length; a step then costs products
//! with small matrices and one linear system with as many unknowns as there are couplings.
//!
//! **Error control.** The method solves the equations with every displacement's error driven by
//! h^2/12 q'' (its local error is h^3/12 q''' per step, which a motion of frequency w turns into
//! h^2/12 q'' over 1/w). Each monitored displacement d keeps
//!
//! ```text
//!   C h^2/12 |d''|_recent <= tolerance x RMS of d over the run so far
//! ```
//!
//! where C is the system's amplification of a persistent error. The bound is a calibration, not a proof;
//! `tests/integration_in_time.rs` holds it against converged solutions. Second order, A-stable, no numerical
//! damping. Source: Newmark, J. Eng. Mech. Div. ASCE 85 (1959); error term: Zienkiewicz and Xie,
//! Earthquake Eng. Struct. Dyn. 20 (1991).

use nalgebra::DMatrix;

use super::{Counts, Coupling, Forcing, Monitor, Part, Piece, Row, State, StepError, System};
use crate::linalg::{add_scaled, invert_in_place, multiply_add, solve_in_place};

/// How much of a peak of d'' is remembered per step, so that its zero crossings do not lengthen steps.
const PEAK_MEMORY: f64 = 0.95;
/// Monitored displacements [m or rad] below this count as zero.
const DISPLACEMENT_FLOOR: f64 = 1e-12;
/// Step operators are kept for this many step lengths at the most, and within this memory [bytes].
const OPERATORS: usize = 48;
const OPERATOR_MEMORY: usize = 16 << 20;

/// The integrator with its workspace. It holds nothing that influences a result: everything that does
/// is in the [`State`].
#[derive(Debug, Clone)]
pub struct Newmark {
    operators: Vec<Operators>,
    next_operator: usize,
    pieces: Vec<Piece>,
    before: State,
    work: Work,
    counts: Counts,
}

/// Vectors of one step.
#[derive(Debug, Clone)]
struct Work {
    acceleration: Vec<f64>,
    next_acceleration: Vec<f64>,
    predicted_position: Vec<f64>,
    predicted_velocity: Vec<f64>,
    load: Vec<f64>,
    forces: Vec<f64>,
    matrix: DMatrix<f64>,
    swaps: Vec<usize>,
}

/// What depends on the step length alone.
#[derive(Debug, Clone)]
struct Operators {
    /// h [s]; 0 while unused.
    step: f64,
    /// A^-1 of each block.
    inverse: Vec<DMatrix<f64>>,
    /// z_m.
    responses: Vec<Row>,
    /// Z.
    compliance: DMatrix<f64>,
}

impl Newmark {
    /// A workspace for this system.
    pub fn new(system: &System) -> Newmark {
        let (size, couplings) = (system.size, system.couplings.len());
        let largest = system
            .blocks
            .iter()
            .map(super::Block::len)
            .max()
            .unwrap_or(0);
        let zeros = || vec![0.0; size];
        let operators = Operators::unused(system);
        let affordable = OPERATOR_MEMORY / operators.bytes().max(1);
        Newmark {
            operators: vec![operators; affordable.clamp(4, OPERATORS)],
            next_operator: 0,
            pieces: vec![Piece::default(); couplings],
            before: system.rest(0.0),
            work: Work {
                acceleration: zeros(),
                next_acceleration: zeros(),
                predicted_position: zeros(),
                predicted_velocity: zeros(),
                load: zeros(),
                forces: vec![0.0; couplings],
                matrix: DMatrix::zeros(couplings, couplings),
                swaps: vec![0; largest],
            },
            counts: Counts::default(),
        }
    }

    /// Work done since the workspace was made.
    pub fn counts(&self) -> Counts {
        self.counts
    }

    /// Advances the state to exactly `until`. After an error the state is the one before the call.
    pub fn advance_to(
        &mut self,
        system: &System,
        forcing: &impl Forcing,
        state: &mut State,
        until: f64,
        tolerance: f64,
    ) -> Result<(), StepError> {
        self.before.clone_from(state);
        let result = self.advance(system, forcing, state, until, tolerance);
        if result.is_err() {
            state.clone_from(&self.before);
        }
        result
    }

    fn advance(
        &mut self,
        system: &System,
        forcing: &impl Forcing,
        state: &mut State,
        until: f64,
        tolerance: f64,
    ) -> Result<(), StepError> {
        while state.time < until {
            let stop = forcing.next_breakpoint(state.time).min(until);
            self.cross_smooth_stretch(system, forcing, state, stop, tolerance)?;
        }
        Ok(())
    }

    /// From the state's time to `stop` with equal steps, replanned when the error estimate asks for it.
    fn cross_smooth_stretch(
        &mut self,
        system: &System,
        forcing: &impl Forcing,
        state: &mut State,
        stop: f64,
        tolerance: f64,
    ) -> Result<(), StepError> {
        forcing.pieces_into(0.5 * (state.time + stop), &mut self.pieces);
        self.evaluate_acceleration(system, forcing, state);
        if state.control.wanted_step == 0.0 {
            state.control.wanted_step = (stop - state.time) / 16.0;
        }
        while state.time < stop {
            let (start, length) = (state.time, stop - state.time);
            let count = equal_steps(length / state.control.wanted_step);
            let step = length / count as f64;
            if start + step == start {
                return Err(StepError::StepTooSmall { time: start, step });
            }
            for number in 1..=count {
                let last = number == count;
                let end = if last {
                    stop
                } else {
                    start + length * (number as f64 / count as f64)
                };
                self.step(system, forcing, state, end, step)?;
                let error = self.error(system, state, step) / tolerance;
                if !error.is_finite() {
                    return Err(StepError::NotFinite { time: end });
                }
                // The estimate grows with h^2; a factor between aims a little below the bound.
                let ratio = (0.8 / error.sqrt()).clamp(0.2, 1.5);
                if error > 1.5 {
                    self.counts.rejected += 1;
                    state.control.wanted_step = step * ratio;
                    break;
                }
                self.accept(system, state, end, step);
                state.control.wanted_step = step * ratio;
                if error > 1.0 || (ratio > 1.4 && !last) {
                    break;
                }
            }
        }
        Ok(())
    }

    /// a0 = f - D v - K q - sum over m of b_m F_m, from the right of a breakpoint.
    fn evaluate_acceleration(&mut self, system: &System, forcing: &impl Forcing, state: &State) {
        let acceleration = &mut self.work.acceleration;
        forcing.load_into(state.time, acceleration);
        for block in &system.blocks {
            let range = block.range();
            let target = &mut acceleration[range.clone()];
            multiply_add(-1.0, &block.damping, &state.velocity[range.clone()], target);
            multiply_add(-1.0, &block.stiffness, &state.position[range], target);
        }
        for (m, Coupling { row, column }) in system.couplings.iter().enumerate() {
            let spring = forcing.spring(m, self.pieces[m], state.time);
            let force = spring.stiffness * row.dot(&state.position)
                + spring.damping * row.dot(&state.velocity);
            column.add_to(-force, acceleration);
        }
    }

    /// One step: leaves a1, q~, v~ in the workspace and the state untouched.
    fn step(
        &mut self,
        system: &System,
        forcing: &impl Forcing,
        state: &State,
        end: f64,
        step: f64,
    ) -> Result<(), StepError> {
        let index = self.operators_for(system, step, state.time)?;
        let (operators, work) = (&self.operators[index], &mut self.work);
        let h = operators.step;
        predict(state, h, work);
        forcing.load_into(end, &mut work.load);
        for (block, inverse) in system.blocks.iter().zip(&operators.inverse) {
            let range = block.range();
            let load = &mut work.load[range.clone()];
            multiply_add(
                -1.0,
                &block.damping,
                &work.predicted_velocity[range.clone()],
                load,
            );
            multiply_add(
                -1.0,
                &block.stiffness,
                &work.predicted_position[range.clone()],
                load,
            );
            let y = &mut work.next_acceleration[range];
            y.fill(0.0);
            multiply_add(1.0, inverse, load, y);
        }
        for (m, Coupling { row, .. }) in system.couplings.iter().enumerate() {
            let spring = forcing.spring(m, self.pieces[m], end);
            let y = row.dot(&work.next_acceleration);
            let deflection = row.dot(&work.predicted_position) + 0.25 * h * h * y;
            let rate = row.dot(&work.predicted_velocity) + 0.5 * h * y;
            work.forces[m] = spring.stiffness * deflection + spring.damping * rate;
            let kappa = 0.25 * h * h * spring.stiffness + 0.5 * h * spring.damping;
            for l in 0..system.couplings.len() {
                let identity = if l == m { 1.0 } else { 0.0 };
                work.matrix[(m, l)] = identity + kappa * operators.compliance[(m, l)];
            }
        }
        if !solve_in_place(&mut work.matrix, &mut work.forces) {
            return Err(StepError::Singular {
                time: state.time,
                step,
            });
        }
        for (response, &force) in operators.responses.iter().zip(&work.forces) {
            response.add_to(-force, &mut work.next_acceleration);
        }
        Ok(())
    }

    /// The largest error of a monitored displacement relative to its RMS.
    fn error(&self, system: &System, state: &State, h: f64) -> f64 {
        let control = &state.control;
        let mut worst: f64 = 0.0;
        for (index, Monitor { row, amplification }) in system.monitors.iter().enumerate() {
            let start = row.dot(&state.position);
            let mean_square = (control.squares[index] + h * start * start) / (control.elapsed + h);
            let now = row.dot(&self.work.next_acceleration).abs();
            let held = PEAK_MEMORY * control.peaks[index];
            // f64::max would drop a NaN.
            let peak = if now <= held { held } else { now };
            let error = amplification * h * h / 12.0 * peak;
            let relative = error / mean_square.sqrt().max(DISPLACEMENT_FLOOR);
            worst = if relative <= worst { worst } else { relative };
        }
        worst
    }

    /// Moves the state to the end of the step just computed.
    fn accept(&mut self, system: &System, state: &mut State, end: f64, step: f64) {
        let work = &mut self.work;
        let h = canonical(step);
        state.position.copy_from_slice(&work.predicted_position);
        add_scaled(0.25 * h * h, &work.next_acceleration, &mut state.position);
        state.velocity.copy_from_slice(&work.predicted_velocity);
        add_scaled(0.5 * h, &work.next_acceleration, &mut state.velocity);
        core::mem::swap(&mut work.acceleration, &mut work.next_acceleration);
        state.time = end;
        state.control.elapsed += h;
        for (index, Monitor { row, .. }) in system.monitors.iter().enumerate() {
            let value = row.dot(&state.position);
            state.control.squares[index] += h * value * value;
            let peak = &mut state.control.peaks[index];
            *peak = row.dot(&work.acceleration).abs().max(PEAK_MEMORY * *peak);
        }
        self.counts.steps += 1;
    }

    /// The operators for this step length, computed unless they are kept from earlier steps.
    fn operators_for(&mut self, system: &System, step: f64, time: f64) -> Result<usize, StepError> {
        let h = canonical(step);
        if let Some(index) = self
            .operators
            .iter()
            .position(|operators| operators.step == h)
        {
            return Ok(index);
        }
        let index = self.next_operator;
        self.next_operator = (index + 1) % self.operators.len();
        self.counts.factorizations += 1;
        if self.operators[index].compute(system, h, &mut self.work.swaps) {
            Ok(index)
        } else {
            self.operators[index].step = 0.0;
            Err(StepError::Singular { time, step })
        }
    }
}

/// q~ and v~.
fn predict(state: &State, h: f64, work: &mut Work) {
    work.predicted_position.copy_from_slice(&state.position);
    add_scaled(h, &state.velocity, &mut work.predicted_position);
    add_scaled(
        0.25 * h * h,
        &work.acceleration,
        &mut work.predicted_position,
    );
    work.predicted_velocity.copy_from_slice(&state.velocity);
    add_scaled(0.5 * h, &work.acceleration, &mut work.predicted_velocity);
}

/// The number of equal steps for a stretch of `lengths` wanted steps: 1, 2, 3, 4, 6, 8, 12, 16, 24 ...,
/// so that few different step lengths occur.
fn equal_steps(lengths: f64) -> u64 {
    let needed = (lengths * (1.0 - 1e-9)).ceil().max(1.0);
    if needed <= 3.0 {
        return needed as u64;
    }
    let mut power: u64 = 2;
    while (power as f64) < needed && power < 1 << 60 {
        power *= 2;
    }
    let between = power / 4 * 3;
    if between as f64 >= needed {
        between
    } else {
        power
    }
}

/// The step length with its last 22 bits rounded away (relative 1e-9): communication points computed by
/// additions then lead to the same operators, whatever was computed before.
fn canonical(step: f64) -> f64 {
    const DROPPED: u32 = 22;
    let bits = step.to_bits() + (1 << (DROPPED - 1));
    f64::from_bits(bits >> DROPPED << DROPPED)
}

impl Operators {
    fn unused(system: &System) -> Operators {
        let square = |block: &super::Block| DMatrix::zeros(block.len(), block.len());
        let count = system.couplings.len();
        let responses = system
            .couplings
            .iter()
            .map(|coupling| coupling.column.clone());
        Operators {
            step: 0.0,
            inverse: system.blocks.iter().map(square).collect(),
            responses: responses.collect(),
            compliance: DMatrix::zeros(count, count),
        }
    }

    fn bytes(&self) -> usize {
        let entries: usize = self.inverse.iter().map(DMatrix::len).sum();
        (entries + self.compliance.len()) * size_of::<f64>()
    }

    fn compute(&mut self, system: &System, h: f64, swaps: &mut [usize]) -> bool {
        self.step = h;
        for (block, inverse) in system.blocks.iter().zip(&mut self.inverse) {
            let n = block.len();
            for j in 0..n {
                for i in 0..n {
                    let identity = if i == j { 1.0 } else { 0.0 };
                    inverse[(i, j)] = identity
                        + 0.5 * h * block.damping[(i, j)]
                        + 0.25 * h * h * block.stiffness[(i, j)];
                }
            }
            if !invert_in_place(inverse, &mut swaps[..n]) {
                return false;
            }
        }
        for (response, Coupling { column, .. }) in self.responses.iter_mut().zip(&system.couplings)
        {
            for (Part { block, values, .. }, source) in response.parts.iter_mut().zip(&column.parts)
            {
                values.fill(0.0);
                multiply_add(1.0, &self.inverse[*block], &source.values, values);
            }
        }
        for (m, Coupling { row, .. }) in system.couplings.iter().enumerate() {
            for (l, response) in self.responses.iter().enumerate() {
                self.compliance[(m, l)] = row.dot_row(response);
            }
        }
        true
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn step_counts_are_the_next_of_a_small_set() {
        let counts = [0.3, 1.0, 1.0 + 1e-12, 2.5, 3.5, 4.5, 6.1, 9.0, 13.0, 17.0].map(equal_steps);
        assert_eq!(counts, [1, 1, 1, 3, 4, 6, 8, 12, 16, 24]);
    }

    #[test]
    fn canonical_steps_absorb_rounding_of_communication_points() {
        let exact = canonical(2e-5);
        // At 10 s a difference of times carries errors of 1e-15 s.
        assert_eq!(canonical((10.0 + 2e-5) - 10.0), exact);
        assert!((exact / 2e-5 - 1.0).abs() < 1e-9);
    }
}
