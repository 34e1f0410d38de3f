//! One step of the collocation method.

use nalgebra::Complex;

use super::super::march::{Ending, Method, Outcome, Span, Task, canonical};
use super::super::{Block, Counts, Forcing, Harmonic, Instant, Piece, State, StepError, System};
use super::coefficients::{Coefficients, Scratch};
use super::events::Sighting;
use super::exchange::Exchange;
use super::part::{Part, PartMotion, take_apart};
use super::polynomials::{END, NODES, PLACES, POINTS};
use super::sight::{Sight, copy, instant};
use crate::linalg::{add_scaled, dot, multiply_add};

/// Coefficients are kept for this many step lengths at the most, and within this memory [bytes].
const LENGTHS: usize = 64;
const MEMORY: usize = 16 << 20;
/// Sweeps after which a step counts as too long, and what part of it is tried then.
const MOST_SWEEPS: usize = 25;
const SHORTER: f64 = 0.4;
/// Change of the forces in the last sweep relative to the tolerance, and the smallest one above rounding.
const SWEEP_ACCURACY: (f64, f64) = (1e-4, 1e-13);
/// Order of the accumulated error in the step.
const ORDER: f64 = 6.0;
/// Steps with more than the bound are still accepted up to here: the estimate is no sharper.
const ACCEPTED: f64 = 1.5;

/// Everything a step needs.
#[derive(Debug, Clone)]
pub(super) struct Kernel {
    /// The blocks at the slow parameters in use.
    blocks: Vec<Block>,
    used_slow: Vec<f64>,
    present_slow: Vec<f64>,
    parts: Vec<Part>,
    motion: Vec<PartMotion>,
    /// Whether loads from outside change in this call.
    ramps: bool,
    pub(super) exchange: Exchange,
    frequencies: Vec<f64>,
    pub(super) lengths: Vec<Coefficients>,
    next_length: usize,
    scratch: Scratch,
    pub(super) sight: Sight,
    pub(super) counts: Counts,
}

impl Kernel {
    pub(super) fn new(system: &System, harmonics: &[Harmonic]) -> Kernel {
        let parts = take_apart(system, &system.blocks, harmonics);
        let exchange = Exchange::between(&parts);
        let unused = Coefficients::unused(&parts, &exchange);
        let affordable = (MEMORY / unused.bytes().max(1)).clamp(4, LENGTHS);
        Kernel {
            blocks: system.blocks.clone(),
            used_slow: system.slow.clone(),
            present_slow: system.slow.clone(),
            motion: parts.iter().map(PartMotion::at_rest).collect(),
            ramps: false,
            frequencies: harmonics.iter().map(|one| one.frequency).collect(),
            lengths: vec![unused; affordable],
            next_length: 0,
            scratch: Scratch::new(&parts),
            sight: Sight::new(system.couplings.len(), harmonics.len()),
            counts: Counts::default(),
            exchange,
            parts,
        }
    }

    /// Decoupled states from displacements and velocities.
    pub(super) fn take_over<F: Forcing>(&mut self, task: Task<'_, F>, state: &mut State) {
        self.follow_slow(task, state);
        for (part, motion) in self.parts.iter().zip(&mut self.motion) {
            motion.take_over(part, state, task.forcing.loads());
        }
        self.ramps = task.forcing.loads().iter().any(|load| load.rate != 0.0);
    }

    /// Displacements and velocities from decoupled states.
    pub(super) fn hand_back(&self, state: &mut State) -> Result<(), StepError> {
        for (part, motion) in self.parts.iter().zip(&self.motion) {
            motion.hand_back(part, state);
        }
        let mut values = state.position.iter().chain(&state.velocity);
        if values.all(|value| value.is_finite()) {
            Ok(())
        } else {
            Err(StepError::NotFinite { time: state.time })
        }
    }

    /// Makes the blocks anew where the slow parameters of the state ask for it.
    fn follow_slow<F: Forcing>(&mut self, task: Task<'_, F>, state: &mut State) {
        let present = &mut self.present_slow;
        task.forcing
            .slow_into(&state.position, &state.velocity, present);
        if task.forcing.is_stale(&state.slow, present) {
            state.slow.clone_from(present);
        }
        if self.used_slow != state.slow {
            self.used_slow.clone_from(&state.slow);
            task.forcing.blocks_into(&self.used_slow, &mut self.blocks);
            self.parts = take_apart(task.system, &self.blocks, task.forcing.harmonics());
            self.scratch = Scratch::new(&self.parts);
            let unused = Coefficients::unused(&self.parts, &self.exchange);
            self.lengths.fill(unused);
            self.counts.refreshes += 1;
        }
    }

    /// The coefficients for this step length, computed unless they are kept from earlier steps.
    fn coefficients_for(&mut self, h: f64) -> usize {
        if let Some(index) = self.lengths.iter().position(|length| length.step == h) {
            return index;
        }
        let index = self.next_length;
        self.next_length = (index + 1) % self.lengths.len();
        self.counts.factorizations += 1;
        let parts = (self.parts.as_slice(), &self.exchange);
        self.lengths[index].compute(parts, h, &self.frequencies, &mut self.scratch);
        index
    }

    /// What the couplings see at the points without forces.
    fn look_ahead(&mut self, index: usize, elapsed: f64) {
        let sight = &mut self.sight;
        for free in &mut sight.free {
            copy(&sight.start, free);
        }
        let parts = self.parts.iter().zip(&self.lengths[index].parts);
        for ((part, coefficients), motion) in parts.zip(&mut self.motion) {
            motion.differentiate(part, elapsed);
            motion.readings.fill(0.0);
            multiply_add(
                1.0,
                &coefficients.free,
                &motion.derivative,
                &mut motion.readings,
            );
            if self.ramps {
                let (ramp, rate) = (&coefficients.ramp, &motion.load_rate);
                multiply_add(1.0, ramp, rate, &mut motion.readings);
            }
            let turning = coefficients.turning.chunks_exact(part.readings().max(1));
            for ((harmonic, _), turning) in part.harmonics.iter().zip(turning) {
                let angle = sight.angles[*harmonic];
                for (reading, turned) in motion.readings.iter_mut().zip(turning) {
                    *reading += (angle * turned).re;
                }
            }
            for (point, free) in sight.free.iter_mut().enumerate() {
                for (what, free) in free.iter_mut().enumerate() {
                    let first = part.reading(point, what, 0);
                    for (reading, &sensor) in motion.readings[first..].iter().zip(&part.sensors) {
                        free[sensor] += reading;
                    }
                }
            }
        }
    }

    /// Solves for the forces at the nodes. Gives whether they were found.
    fn sweep<F: Forcing>(
        &mut self,
        task: Task<'_, F>,
        slow: &[f64],
        span: Span,
        pieces: &[Piece],
        index: usize,
    ) -> bool {
        let accuracy = (SWEEP_ACCURACY.0 * task.tolerance).max(SWEEP_ACCURACY.1);
        let influences = &self.lengths[index].influences;
        for forces in &mut self.sight.forces {
            *forces = [forces[0]; NODES];
        }
        for _ in 0..MOST_SWEEPS {
            // Changes of one coupling count relative to its own force, those of all to the largest.
            let sizes = self.sight.forces.iter().flatten().map(|force| force.abs());
            let least = SWEEP_ACCURACY.1 * sizes.fold(0.0, f64::max);
            let mut settled = true;
            for point in 0..=END {
                self.sight.look(&self.exchange, influences, point);
            }
            for point in 0..=END {
                let sight = &mut self.sight;
                let at = instant(&sight.points[point], span.at(PLACES[point]), slow);
                task.forcing.forces_into(at, pieces, &mut sight.present);
                for (forces, &present) in sight.forces.iter_mut().zip(&sight.present) {
                    let force = &mut forces[point + 1];
                    let size = present.abs().max(force.abs()).max(least);
                    // Written so that neither NaN nor infinity is settled.
                    settled &= (present - *force).abs() <= accuracy * size && size < f64::INFINITY;
                    *force = present;
                }
            }
            self.counts.evaluations += NODES as u64 - 1;
            if settled {
                // The points follow the last forces.
                for point in 0..POINTS {
                    self.sight.look(&self.exchange, influences, point);
                }
                return true;
            }
        }
        false
    }

    /// Moves to the end of the step.
    fn accept(&mut self, system: &System, state: &mut State, span: Span, index: usize) {
        let sight = &mut self.sight;
        let parts = self.parts.iter().zip(&self.lengths[index].parts);
        for ((part, coefficients), motion) in parts.zip(&mut self.motion) {
            motion.advance(part, coefficients, self.ramps);
            for (node, columns) in coefficients.columns.iter().enumerate() {
                for (column, &actuator) in columns.chunks_exact(part.len()).zip(&part.actuators) {
                    let force = sight.forces[actuator][node];
                    add_scaled(-force, column, &mut motion.states);
                }
            }
            let turning = coefficients.turning_end.chunks_exact(part.len().max(1));
            for ((harmonic, _), turning) in part.harmonics.iter().zip(turning) {
                let angle = sight.angles[*harmonic];
                for (state, turned) in motion.states.iter_mut().zip(turning) {
                    *state += (angle * turned).re;
                }
            }
        }
        for (monitor, squares) in system.monitors.iter().zip(&mut state.control.squares) {
            *squares += span.step * sight.mean_square(monitor);
        }
        sight.move_on(END);
        state.control.elapsed += span.step;
        state.time = span.end;
        self.counts.steps += 1;
    }
}

impl Method for Kernel {
    fn observe<F: Forcing>(&mut self, _: Task<'_, F>, _: &mut State) {
        for target in &mut self.sight.start {
            target.fill(0.0);
        }
        for (part, motion) in self.parts.iter().zip(&self.motion) {
            for (rows, target) in part.sensor_rows.iter().zip(&mut self.sight.start) {
                for (row, &sensor) in rows.column_iter().zip(&part.sensors) {
                    target[sensor] += dot(row.as_slice(), &motion.states);
                }
            }
        }
    }

    fn instant<'a>(&'a self, state: &'a State) -> Instant<'a> {
        instant(&self.sight.start, state.time, &state.slow)
    }

    fn begin<F: Forcing>(&mut self, task: Task<'_, F>, state: &State, pieces: &[Piece]) {
        let sight = &mut self.sight;
        let at = instant(&sight.start, state.time, &state.slow);
        task.forcing.forces_into(at, pieces, &mut sight.present);
        for (forces, &present) in sight.forces.iter_mut().zip(&sight.present) {
            forces[0] = present;
        }
        self.counts.evaluations += 1;
    }

    fn try_step<F: Forcing>(
        &mut self,
        task: Task<'_, F>,
        state: &mut State,
        span: Span,
        pieces: &[Piece],
        endings: &mut [Ending],
    ) -> Result<Outcome, StepError> {
        let index = self.coefficients_for(canonical(span.step));
        for (angle, harmonic) in self.sight.angles.iter_mut().zip(task.forcing.harmonics()) {
            let (sine, cosine) = libm::sincos(harmonic.angle(span.start));
            *angle = Complex::new(cosine, sine);
        }
        self.look_ahead(index, span.start - task.forcing.since());
        if !self.sweep(task, &state.slow, span, pieces, index) {
            self.counts.rejected += 1;
            if self.sight.forces.iter().all(|forces| forces[0].is_finite()) {
                return Ok(Outcome::Rejected { ratio: SHORTER });
            }
            return Err(StepError::NotFinite { time: span.start });
        }
        match self.sight_events(task, &state.slow, span, pieces, endings) {
            Sighting::Ends { law, time } => return Ok(Outcome::Interrupted { law, time }),
            Sighting::Unclear { ratio } => {
                self.counts.rejected += 1;
                return Ok(Outcome::Rejected { ratio });
            }
            Sighting::Clear => {}
        }
        let error = self.error(task, state, span, pieces, index);
        if !error.is_finite() {
            return Err(StepError::NotFinite { time: span.end });
        }
        let ratio = libm::pow(0.8 / error.max(1e-12), 1.0 / ORDER).clamp(0.2, 2.0);
        if error > ACCEPTED {
            self.counts.rejected += 1;
            return Ok(Outcome::Rejected { ratio });
        }
        self.accept(task.system, state, span, index);
        // A step that was too long asks for a new plan, one that was not goes on.
        let ratio = if error > 1.0 {
            ratio.min(0.99)
        } else {
            ratio.max(1.0)
        };
        Ok(Outcome::Accepted { ratio })
    }
}
