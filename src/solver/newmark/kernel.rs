//! One step of the Newmark method, and what depends on its length alone.

use nalgebra::DMatrix;

use super::super::{Block, Coupling, Forcing, Part, Piece, Row, StepError, System, Track};
use crate::linalg::{add_scaled, invert_in_place, multiply_add, solve_in_place};

/// Step operators are kept for this many step lengths at the most, and within this memory [bytes].
const OPERATORS: usize = 48;
const OPERATOR_MEMORY: usize = 16 << 20;

/// What both solutions share.
#[derive(Debug, Clone)]
pub(super) struct Kernel {
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
pub(super) struct Work {
    acceleration: Vec<f64>,
    next_acceleration: Vec<f64>,
    predicted_position: Vec<f64>,
    predicted_velocity: Vec<f64>,
    load: Vec<f64>,
}

/// One step: from when, to when, how long.
#[derive(Debug, Clone, Copy)]
pub(super) struct Span {
    pub(super) start: f64,
    pub(super) end: f64,
    pub(super) step: f64,
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

impl Work {
    pub(super) fn new(system: &System) -> Work {
        let zeros = || vec![0.0; system.size];
        Work {
            acceleration: zeros(),
            next_acceleration: zeros(),
            predicted_position: zeros(),
            predicted_velocity: zeros(),
            load: zeros(),
        }
    }

    /// a at the end of the last accepted step.
    pub(super) fn acceleration(&self) -> &[f64] {
        &self.acceleration
    }
}

impl Kernel {
    pub(super) fn new(system: &System) -> Kernel {
        let couplings = system.couplings.len();
        let largest = system.blocks.iter().map(Block::len).max().unwrap_or(0);
        let operators = Operators::unused(system);
        let affordable = OPERATOR_MEMORY / operators.bytes().max(1);
        Kernel {
            operators: vec![operators; affordable.clamp(4, OPERATORS)],
            next_operator: 0,
            factorizations: 0,
            pieces: vec![Piece::default(); couplings],
            forces: vec![0.0; couplings],
            matrix: DMatrix::zeros(couplings, couplings),
            swaps: vec![0; largest],
        }
    }

    /// Step lengths for which operators were computed.
    pub(super) fn factorizations(&self) -> u64 {
        self.factorizations
    }

    /// From now on the laws are those of the pieces that `time` lies in.
    pub(super) fn enter_pieces(&mut self, forcing: &impl Forcing, time: f64) {
        forcing.pieces_into(time, &mut self.pieces);
    }

    /// a0 = f - D v - K q - sum over m of b_m F_m, from the right of a breakpoint.
    pub(super) fn evaluate_acceleration(
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
    pub(super) fn step(
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
pub(super) fn accept(track: &mut Track, work: &mut Work, step: f64) {
    let h = canonical(step);
    core::mem::swap(&mut track.position, &mut work.predicted_position);
    add_scaled(0.25 * h * h, &work.next_acceleration, &mut track.position);
    core::mem::swap(&mut track.velocity, &mut work.predicted_velocity);
    add_scaled(0.5 * h, &work.next_acceleration, &mut track.velocity);
    core::mem::swap(&mut work.acceleration, &mut work.next_acceleration);
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
        let square = |block: &Block| DMatrix::zeros(block.len(), block.len());
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
    fn canonical_steps_absorb_rounding_of_communication_points() {
        let exact = canonical(2e-5);
        // At 10 s a difference of times carries errors of 1e-15 s.
        assert_eq!(canonical((10.0 + 2e-5) - 10.0), exact);
        assert!((exact / 2e-5 - 1.0).abs() < 1e-9);
    }
}
