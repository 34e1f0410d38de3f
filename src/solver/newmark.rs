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
//! **Two solutions.** The equations are solved twice side by side, with steps h (coarse) and h/2 (fine). The
//! method is symmetric, its error has even powers of h only, so that
//!
//! ```text
//!   q = (4 q_fine - q_coarse) / 3
//! ```
//!
//! is of fourth order. The extrapolation is passive: neither solution is changed by it, and the method stays
//! A-stable and without numerical damping.
//!
//! **Error control.** Newmark's rule slows a motion of frequency w down: its phase is off by w h^2 w^2 / 12 per
//! time, p = C h^2 w^2 / 12 in all, where C = w t grows until damping has made the motion forget, at 1 / (2 zeta).
//! The extrapolation leaves p^2/8 of its amplitude. Each monitored displacement d therefore keeps, with a safety factor of 4,
//!
//! ```text
//!   4 C^2 h^4 / 1152 |d''''|_recent <= tolerance x RMS of d over the run so far
//!   d'''' = (d''_start - 2 d''_middle + d''_end) / (h/2)^2                    of the fine solution
//!   w^2   = |d''''|_recent / |d''|_recent,   10 <= C <= 1 / (2 zeta)
//! ```
//!
//! and that (1 + w c/k) times where a damper c beside the spring k belongs to the force. One frequency w stands
//! for all that d contains: the bound is an estimate, and a train without any damping that rings for long can
//! exceed it. `tests/integration_in_time.rs` holds the result against converged solutions. Sources: Newmark, J. Eng. Mech.
//! Div. ASCE 85 (1959); period elongation: Hughes, The Finite Element Method (1987), 9.1; extrapolation:
//! Hairer, Norsett, Wanner, Solving Ordinary Differential Equations I, II.9.

use nalgebra::DMatrix;

use super::{
    Control, Counts, Coupling, Forcing, Monitor, Part, Piece, Row, State, StepError, System, Track,
    copy_tracks,
};
use crate::linalg::{add_scaled, invert_in_place, multiply_add, solve_in_place};

/// How much of a peak of d'''' is remembered per step, so that its zero crossings do not lengthen steps.
const PEAK_MEMORY: f64 = 0.95;
/// Ratio of the bound to the estimate of the error.
const SAFETY: f64 = 4.0;
/// Monitored displacements [m or rad] below this count as zero.
const DISPLACEMENT_FLOOR: f64 = 1e-12;
/// Step operators are kept for this many step lengths at the most, and within this memory [bytes].
const OPERATORS: usize = 48;
const OPERATOR_MEMORY: usize = 16 << 20;

/// After this many steps of one call their average length must be useful [s]: no machine vibrates in the GHz.
const PATIENCE: u64 = 1_000_000;
const SMALLEST_USEFUL_STEP: f64 = 1e-11;
/// No call takes more steps: some minutes of work.
const MOST_STEPS: u64 = 100_000_000;

/// The integrator with its workspace. It holds nothing that influences a result: everything that does
/// is in the [`State`].
#[derive(Debug, Clone)]
pub struct Newmark {
    kernel: Kernel,
    work: [Work; 2],
    before: State,
    retry: [Track; 2],
    differences: Vec<f64>,
    next_control: Control,
    counts: Counts,
    /// Steps tried since `since`, the start of the present call.
    tried: u64,
    since: f64,
}

/// What both solutions share.
#[derive(Debug, Clone)]
struct Kernel {
    operators: Vec<Operators>,
    next_operator: usize,
    factorizations: u64,
    pieces: Vec<Piece>,
    forces: Vec<f64>,
    matrix: DMatrix<f64>,
    swaps: Vec<usize>,
}

/// Vectors of one step of one solution.
#[derive(Debug, Clone)]
struct Work {
    acceleration: Vec<f64>,
    next_acceleration: Vec<f64>,
    predicted_position: Vec<f64>,
    predicted_velocity: Vec<f64>,
    load: Vec<f64>,
}

/// One step: from when, to when, how long.
#[derive(Debug, Clone, Copy)]
struct Span {
    start: f64,
    end: f64,
    step: f64,
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
        let work = Work {
            acceleration: zeros(),
            next_acceleration: zeros(),
            predicted_position: zeros(),
            predicted_velocity: zeros(),
            load: zeros(),
        };
        let before = system.state_at(0.0, zeros());
        Newmark {
            kernel: Kernel {
                operators: vec![operators; affordable.clamp(4, OPERATORS)],
                next_operator: 0,
                factorizations: 0,
                pieces: vec![Piece::default(); couplings],
                forces: vec![0.0; couplings],
                matrix: DMatrix::zeros(couplings, couplings),
                swaps: vec![0; largest],
            },
            work: [work.clone(), work],
            retry: before.tracks.clone(),
            next_control: before.control.clone(),
            differences: vec![0.0; system.monitors.len()],
            before,
            counts: Counts::default(),
            tried: 0,
            since: 0.0,
        }
    }

    /// Work done since the workspace was made.
    pub fn counts(&self) -> Counts {
        Counts {
            factorizations: self.kernel.factorizations,
            ..self.counts
        }
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
        self.before.copy_from(state);
        let result = self.advance(system, forcing, state, until, tolerance);
        if result.is_err() {
            state.copy_from(&self.before);
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
        (self.tried, self.since) = (0, state.time);
        // Less than rounding lets times differ is no stretch of time.
        let rounding = 4.0 * f64::EPSILON * until.abs();
        while state.time < until - rounding {
            let next = forcing.next_breakpoint(state.time + rounding);
            let stop = if next < until - rounding { next } else { until };
            self.cross_smooth_stretch(system, forcing, state, stop, tolerance)?;
        }
        state.time = until;
        let [coarse, fine] = &state.tracks;
        extrapolate(&fine.position, &coarse.position, &mut state.position);
        extrapolate(&fine.velocity, &coarse.velocity, &mut state.velocity);
        if state
            .position
            .iter()
            .chain(&state.velocity)
            .all(|value| value.is_finite())
        {
            Ok(())
        } else {
            Err(StepError::NotFinite { time: until })
        }
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
        forcing.pieces_into(0.5 * (state.time + stop), &mut self.kernel.pieces);
        self.evaluate_accelerations(system, forcing, state);
        if state.control.wanted_step == 0.0 {
            state.control.wanted_step = (stop - state.time) / 16.0;
        }
        while state.time < stop {
            let (start, length) = (state.time, stop - state.time);
            let count = equal_steps(length / state.control.wanted_step);
            let step = length / count as f64;
            if start + 0.5 * step == start {
                return Err(StepError::StepTooSmall { time: start, step });
            }
            for number in 1..=count {
                self.check_progress(state.time, step)?;
                let last = number == count;
                let end = if last {
                    stop
                } else {
                    start + length * (number as f64 / count as f64)
                };
                let span = Span {
                    start: state.time,
                    end,
                    step,
                };
                let error = self.try_step(system, forcing, state, span, tolerance)?;
                // The estimate grows with h^4; the factor aims a little below the bound.
                let ratio = (0.8 / error.sqrt().sqrt()).clamp(0.2, 1.5);
                state.control.wanted_step = step * ratio;
                if error > 1.0 || (ratio > 1.4 && !last) {
                    break;
                }
            }
        }
        Ok(())
    }

    /// A call has to end: refuses to go on without end with steps that lead nowhere.
    fn check_progress(&self, time: f64, step: f64) -> Result<(), StepError> {
        let average = (time - self.since) / self.tried as f64;
        if self.tried >= PATIENCE && average < SMALLEST_USEFUL_STEP {
            return Err(StepError::StepTooSmall { time, step });
        }
        if self.tried >= MOST_STEPS {
            return Err(StepError::TooManySteps {
                time,
                steps: self.tried,
            });
        }
        Ok(())
    }

    /// One coarse step and two fine ones, taken back if their error is more than 1.5 of the bound. Gives the
    /// error relative to the bound.
    fn try_step(
        &mut self,
        system: &System,
        forcing: &impl Forcing,
        state: &mut State,
        span: Span,
        tolerance: f64,
    ) -> Result<f64, StepError> {
        self.tried += 1;
        copy_tracks(&mut self.retry, &state.tracks);
        let [coarse, fine] = &mut self.work;
        self.kernel
            .step(system, forcing, &state.tracks[0], span, coarse)?;
        accept(&mut state.tracks[0], coarse, span.step);
        let (middle, step) = (0.5 * (span.start + span.end), 0.5 * span.step);
        self.differences.fill(0.0);
        differentiate(system, &mut self.differences, &fine.acceleration, 1.0);
        for (half, weight) in [
            (
                Span {
                    end: middle,
                    step,
                    ..span
                },
                -2.0,
            ),
            (
                Span {
                    start: middle,
                    step,
                    ..span
                },
                1.0,
            ),
        ] {
            self.kernel
                .step(system, forcing, &state.tracks[1], half, fine)?;
            accept(&mut state.tracks[1], fine, step);
            differentiate(system, &mut self.differences, &fine.acceleration, weight);
        }
        let next = &mut self.next_control;
        let error =
            control_error(system, state, fine, &self.differences, span.step, next) / tolerance;
        if !error.is_finite() {
            return Err(StepError::NotFinite { time: span.end });
        }
        if error > 1.5 {
            self.counts.rejected += 1;
            copy_tracks(&mut state.tracks, &self.retry);
            self.evaluate_accelerations(system, forcing, state);
        } else {
            self.counts.steps += 1;
            state.time = span.end;
            core::mem::swap(&mut state.control, next);
        }
        Ok(error)
    }

    fn evaluate_accelerations(&mut self, system: &System, forcing: &impl Forcing, state: &State) {
        for (track, work) in state.tracks.iter().zip(&mut self.work) {
            self.kernel
                .evaluate_acceleration(system, forcing, track, state.time, work);
        }
    }
}

impl Kernel {
    /// a0 = f - D v - K q - sum over m of b_m F_m, from the right of a breakpoint.
    fn evaluate_acceleration(
        &self,
        system: &System,
        forcing: &impl Forcing,
        track: &Track,
        time: f64,
        work: &mut Work,
    ) {
        let acceleration = &mut work.acceleration;
        forcing.load_into(time, acceleration);
        for block in &system.blocks {
            let range = block.range();
            let target = &mut acceleration[range.clone()];
            multiply_add(-1.0, &block.damping, &track.velocity[range.clone()], target);
            multiply_add(-1.0, &block.stiffness, &track.position[range], target);
        }
        for (m, Coupling { row, column }) in system.couplings.iter().enumerate() {
            let spring = forcing.spring(m, self.pieces[m], time);
            let force = spring.stiffness * row.dot(&track.position)
                + spring.damping * row.dot(&track.velocity);
            column.add_to(-force, acceleration);
        }
    }

    /// One step: leaves a1, q~, v~ in the workspace and the track untouched.
    fn step(
        &mut self,
        system: &System,
        forcing: &impl Forcing,
        track: &Track,
        span: Span,
        work: &mut Work,
    ) -> Result<(), StepError> {
        let index = self.operators_for(system, span)?;
        let operators = &self.operators[index];
        let h = operators.step;
        predict(track, h, work);
        forcing.load_into(span.end, &mut work.load);
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
            let spring = forcing.spring(m, self.pieces[m], span.end);
            let y = row.dot(&work.next_acceleration);
            let deflection = row.dot(&work.predicted_position) + 0.25 * h * h * y;
            let rate = row.dot(&work.predicted_velocity) + 0.5 * h * y;
            self.forces[m] = spring.stiffness * deflection + spring.damping * rate;
            let kappa = 0.25 * h * h * spring.stiffness + 0.5 * h * spring.damping;
            for l in 0..system.couplings.len() {
                let identity = if l == m { 1.0 } else { 0.0 };
                self.matrix[(m, l)] = identity + kappa * operators.compliance[(m, l)];
            }
        }
        if !solve_in_place(&mut self.matrix, &mut self.forces) {
            return Err(StepError::Singular {
                time: span.start,
                step: span.step,
            });
        }
        for (response, &force) in operators.responses.iter().zip(&self.forces) {
            response.add_to(-force, &mut work.next_acceleration);
        }
        Ok(())
    }

    /// The operators for this step length, computed unless they are kept from earlier steps.
    fn operators_for(&mut self, system: &System, span: Span) -> Result<usize, StepError> {
        let h = canonical(span.step);
        if let Some(index) = self
            .operators
            .iter()
            .position(|operators| operators.step == h)
        {
            return Ok(index);
        }
        let index = self.next_operator;
        self.next_operator = (index + 1) % self.operators.len();
        self.factorizations += 1;
        if self.operators[index].compute(system, h, &mut self.swaps) {
            Ok(index)
        } else {
            self.operators[index].step = 0.0;
            Err(StepError::Singular {
                time: span.start,
                step: span.step,
            })
        }
    }
}

/// q~ and v~.
fn predict(track: &Track, h: f64, work: &mut Work) {
    work.predicted_position.copy_from_slice(&track.position);
    add_scaled(h, &track.velocity, &mut work.predicted_position);
    add_scaled(
        0.25 * h * h,
        &work.acceleration,
        &mut work.predicted_position,
    );
    work.predicted_velocity.copy_from_slice(&track.velocity);
    add_scaled(0.5 * h, &work.acceleration, &mut work.predicted_velocity);
}

/// Moves a track to the end of the step just computed.
fn accept(track: &mut Track, work: &mut Work, step: f64) {
    let h = canonical(step);
    core::mem::swap(&mut track.position, &mut work.predicted_position);
    add_scaled(0.25 * h * h, &work.next_acceleration, &mut track.position);
    core::mem::swap(&mut track.velocity, &mut work.predicted_velocity);
    add_scaled(0.5 * h, &work.next_acceleration, &mut track.velocity);
    core::mem::swap(&mut work.acceleration, &mut work.next_acceleration);
}

/// Adds `weight` times the second derivative of every monitored displacement.
fn differentiate(system: &System, differences: &mut [f64], acceleration: &[f64], weight: f64) {
    for (Monitor { row, .. }, difference) in system.monitors.iter().zip(differences) {
        *difference += weight * row.dot(acceleration);
    }
}

/// Keeps the squares and peaks of the monitored displacements with the step just computed, and gives the
/// largest error relative to the RMS.
fn control_error(
    system: &System,
    state: &State,
    work: &Work,
    differences: &[f64],
    h: f64,
    next: &mut Control,
) -> f64 {
    let control = &state.control;
    next.elapsed = control.elapsed + h;
    let mut worst: f64 = 0.0;
    for (
        index,
        Monitor {
            row,
            damping_ratio,
            rate_weight,
        },
    ) in system.monitors.iter().enumerate()
    {
        let value = row.dot(&state.tracks[1].position);
        next.squares[index] = control.squares[index] + h * value * value;
        let now = [
            row.dot(&work.acceleration).abs(),
            differences[index].abs() / (0.25 * h * h),
        ];
        let [second, fourth] = [0, 1].map(|order| {
            let held = PEAK_MEMORY * control.peaks[index][order];
            // f64::max would drop a NaN.
            if now[order] <= held { held } else { now[order] }
        });
        next.peaks[index] = [second, fourth];
        let frequency = (fourth / second.max(f64::MIN_POSITIVE)).sqrt();
        let turns = frequency * next.elapsed;
        let amplification = turns.clamp(10.0, (0.5 / damping_ratio).max(10.0));
        let scale = (next.squares[index] / next.elapsed)
            .sqrt()
            .max(DISPLACEMENT_FLOOR);
        let phase = amplification * h * h;
        let with_rate = 1.0 + rate_weight * frequency;
        let relative = SAFETY * phase * phase / 1152.0 * fourth * with_rate / scale;
        if !relative.is_finite() {
            return f64::NAN;
        }
        worst = worst.max(relative);
    }
    worst
}

/// (4 fine - coarse) / 3.
fn extrapolate(fine: &[f64], coarse: &[f64], result: &mut [f64]) {
    for ((value, fine), coarse) in result.iter_mut().zip(fine).zip(coarse) {
        *value = fine + (fine - coarse) / 3.0;
    }
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
