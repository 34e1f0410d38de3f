//! One step of the Newmark method, and what depends on its length alone.

use nalgebra::DMatrix;

use super::super::march::{Span, Task};
use super::super::row::Part;
use super::super::{
    Block, Coupling, Forcing, Instant, Piece, Row, Spring, StepError, System, Track,
};
use crate::linalg::{add_scaled, invert_in_place, multiply_add, solve_in_place};

/// Step operators are kept for this many step lengths at the most, and within this memory [bytes].
const OPERATORS: usize = 48;
const OPERATOR_MEMORY: usize = 16 << 20;
/// Iterations after which the forces of a step count as not to be found, and what counts as found.
const MOST_ITERATIONS: usize = 50;
const SETTLED: f64 = 1e-12;

/// What both solutions share.
#[derive(Debug, Clone)]
pub(super) struct Kernel {
    operators: Vec<Operators>,
    next_operator: usize,
    factorizations: u64,
    evaluations: u64,
    forces: Vec<f64>,
    /// Forces by the laws, then the change of the forces.
    change: Vec<f64>,
    tangents: Vec<Spring>,
    /// Deflections and rates without forces, and with the present ones.
    predicted: [Vec<f64>; 2],
    present: [Vec<f64>; 2],
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
            evaluations: 0,
            forces: vec![0.0; couplings],
            change: vec![0.0; couplings],
            tangents: vec![Spring::default(); couplings],
            predicted: [vec![0.0; couplings], vec![0.0; couplings]],
            present: [vec![0.0; couplings], vec![0.0; couplings]],
            matrix: DMatrix::zeros(couplings, couplings),
            swaps: vec![0; largest],
        }
    }

    /// Step lengths for which operators were computed.
    pub(super) fn factorizations(&self) -> u64 {
        self.factorizations
    }

    /// Evaluations of all forces.
    pub(super) fn evaluations(&self) -> u64 {
        self.evaluations
    }

    /// a0 = f - D v - K q - sum over m of b_m F_m, from the right of a breakpoint.
    pub(super) fn evaluate_acceleration<F: Forcing>(
        &mut self,
        task: Task<'_, F>,
        track: &Track,
        state: (f64, &[f64]),
        pieces: &[Piece],
        work: &mut Work,
    ) {
        let Task {
            system, forcing, ..
        } = task;
        let (time, slow) = state;
        let acceleration = &mut work.acceleration;
        forcing.load_into(system, time, acceleration);
        for block in &system.blocks {
            let range = block.range();
            let target = &mut acceleration[range.clone()];
            multiply_add(
                -1.0,
                block.damping.as_slice(),
                &track.velocity[range.clone()],
                target,
            );
            multiply_add(
                -1.0,
                block.stiffness.as_slice(),
                &track.position[range],
                target,
            );
        }
        let [deflection, rate] = &mut self.present;
        system.deflections_into(&track.position, &track.velocity, deflection, rate);
        let at = Instant {
            time,
            deflection,
            rate,
            slow,
        };
        forcing.forces_into(at, pieces, &mut self.forces);
        self.evaluations += 1;
        for (Coupling { column, .. }, force) in system.couplings.iter().zip(&self.forces) {
            column.add_to(-force, acceleration);
        }
    }

    /// One step: leaves a1, q~, v~ in the workspace and the track untouched.
    pub(super) fn step<F: Forcing>(
        &mut self,
        task: Task<'_, F>,
        (track, slow): (&Track, &[f64]),
        span: Span,
        pieces: &[Piece],
        work: &mut Work,
    ) -> Result<(), StepError> {
        let Task {
            system, forcing, ..
        } = task;
        let index = self.operators_for(system, span)?;
        let operators = &self.operators[index];
        let h = operators.step;
        predict(track, h, work);
        forcing.load_into(system, span.end, &mut work.load);
        for (block, inverse) in system.blocks.iter().zip(&operators.inverse) {
            let range = block.range();
            let load = &mut work.load[range.clone()];
            multiply_add(
                -1.0,
                block.damping.as_slice(),
                &work.predicted_velocity[range.clone()],
                load,
            );
            multiply_add(
                -1.0,
                block.stiffness.as_slice(),
                &work.predicted_position[range.clone()],
                load,
            );
            let y = &mut work.next_acceleration[range];
            y.fill(0.0);
            multiply_add(1.0, inverse.as_slice(), load, y);
        }
        for (m, Coupling { row, .. }) in system.couplings.iter().enumerate() {
            let y = row.dot(&work.next_acceleration);
            self.predicted[0][m] = row.dot(&work.predicted_position) + 0.25 * h * h * y;
            self.predicted[1][m] = row.dot(&work.predicted_velocity) + 0.5 * h * y;
        }
        self.solve_forces(task, slow, span, pieces, index)?;
        let responses = &self.operators[index].responses;
        for (response, &force) in responses.iter().zip(&self.forces) {
            response.add_to(-force, &mut work.next_acceleration);
        }
        Ok(())
    }

    /// F = F(d~ - h^2/4 Z F, v~ - h/2 Z F) by Newton's method with the tangents of the laws.
    fn solve_forces<F: Forcing>(
        &mut self,
        task: Task<'_, F>,
        slow: &[f64],
        span: Span,
        pieces: &[Piece],
        index: usize,
    ) -> Result<(), StepError> {
        let singular = StepError::Singular {
            time: span.start,
            step: span.step,
        };
        let Operators {
            step: h,
            compliance,
            ..
        } = &self.operators[index];
        let (quarter, half) = (0.25 * h * h, 0.5 * h);
        self.forces.fill(0.0);
        for _ in 0..MOST_ITERATIONS {
            for (present, predicted) in self.present.iter_mut().zip(&self.predicted) {
                present.copy_from_slice(predicted);
            }
            for (column, force) in compliance.column_iter().zip(&self.forces) {
                add_scaled(-quarter * force, column.as_slice(), &mut self.present[0]);
                add_scaled(-half * force, column.as_slice(), &mut self.present[1]);
            }
            let at = Instant {
                time: span.end,
                deflection: &self.present[0],
                rate: &self.present[1],
                slow,
            };
            let (change, tangents) = (&mut self.change, &mut self.tangents);
            task.forcing.springs_into(at, pieces, change, tangents);
            self.evaluations += 1;
            let sizes = self.change.iter().map(|force| force.abs());
            let largest = sizes.fold(0.0, f64::max);
            for (m, tangent) in self.tangents.iter().enumerate() {
                self.change[m] -= self.forces[m];
                let kappa = quarter * tangent.stiffness + half * tangent.damping;
                for l in 0..self.forces.len() {
                    let identity = if l == m { 1.0 } else { 0.0 };
                    self.matrix[(m, l)] = identity + kappa * compliance[(m, l)];
                }
            }
            if !solve_in_place(&mut self.matrix, &mut self.change) {
                return Err(singular);
            }
            let mut settled = true;
            for (force, change) in self.forces.iter_mut().zip(&self.change) {
                *force += change;
                settled &= change.abs() <= SETTLED * force.abs().max(SETTLED * largest);
            }
            if settled {
                return Ok(());
            }
        }
        Err(singular)
    }

    /// The operators for this step length, computed unless they are kept from earlier steps.
    fn operators_for(&mut self, system: &System, span: Span) -> Result<usize, StepError> {
        let h = span.step;
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
pub(super) fn accept(track: &mut Track, work: &mut Work, h: f64) {
    core::mem::swap(&mut track.position, &mut work.predicted_position);
    add_scaled(0.25 * h * h, &work.next_acceleration, &mut track.position);
    core::mem::swap(&mut track.velocity, &mut work.predicted_velocity);
    add_scaled(0.5 * h, &work.next_acceleration, &mut track.velocity);
    core::mem::swap(&mut work.acceleration, &mut work.next_acceleration);
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
                multiply_add(1.0, self.inverse[*block].as_slice(), &source.values, values);
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
