//! One step of the collocation method.

use super::super::grid::canonical;
use super::super::march::{Ending, Method, Outcome, Span, Task};
use super::super::{Block, Counts, Forcing, Harmonic, Instant, Piece, State, StepError, System};
use super::coefficients::{Coefficients, Scratch};
use super::events::Sighting;
use super::exchange::Exchange;
use super::motion::Motion;
use super::nodes::Nodes;
use super::part::{Part, take_apart};
use super::polynomials::NODES;
use super::sight::{Sight, accumulate, both, instant};
use super::turning::Turning;
use crate::linalg::add_scaled;

/// Coefficients are kept for this many step lengths at the most, and within this memory [bytes].
const LENGTHS: usize = 160;
const MEMORY: usize = 16 << 20;
/// What part of a step is tried whose forces are not found.
const SHORTER: f64 = 0.4;
/// Steps with more than the bound are still accepted up to here: the estimate is no sharper.
const ACCEPTED: f64 = 1.5;
/// The next step is at most so many times longer; its accumulated error grows with the sixth power of that.
const GROWTH: f64 = 2.0;

/// Everything a step needs.
#[derive(Debug, Clone)]
pub(super) struct Kernel {
    /// The blocks at the slow parameters in use.
    blocks: Vec<Block>,
    used_slow: Vec<f64>,
    present_slow: Vec<f64>,
    parts: Vec<Part>,
    motion: Motion,
    pub(super) exchange: Exchange,
    frequencies: Vec<f64>,
    lengths: Vec<Coefficients>,
    /// The lengths themselves [s]; 0 while unused.
    steps: Vec<f64>,
    next_length: usize,
    scratch: Scratch,
    pub(super) sight: Sight,
    pub(super) nodes: Nodes,
    counts: Counts,
}

impl Kernel {
    pub(super) fn new(system: &System, harmonics: &[Harmonic]) -> Kernel {
        let parts = take_apart(system, &system.blocks, harmonics);
        let exchange = Exchange::between(&parts);
        let unused = Coefficients::unused(&parts, &exchange, harmonics.len());
        let affordable = (MEMORY / unused.bytes().max(1)).clamp(4, LENGTHS);
        let couplings = system.couplings.len();
        Kernel {
            blocks: system.blocks.clone(),
            used_slow: system.slow.clone(),
            present_slow: system.slow.clone(),
            motion: Motion::new(&parts),
            frequencies: harmonics.iter().map(|one| one.frequency).collect(),
            lengths: vec![unused; affordable],
            steps: vec![0.0; affordable],
            next_length: 0,
            scratch: Scratch::new(&parts, harmonics.len()),
            sight: Sight::new(couplings),
            nodes: Nodes::new(couplings, &exchange),
            counts: Counts::default(),
            exchange,
            parts,
        }
    }

    /// Work done so far.
    pub(super) fn counts(&self) -> Counts {
        Counts {
            evaluations: self.counts.evaluations + self.nodes.evaluations,
            ..self.counts
        }
    }

    /// Prepares for a call that begins with this state.
    pub(super) fn take_over<F: Forcing>(&mut self, task: Task<'_, F>, state: &mut State) {
        self.follow_slow(task, state);
        if state.decoupled.is_empty() {
            self.motion.take_apart(&self.parts, state);
        } else {
            self.motion.states.copy_from_slice(&state.decoupled);
        }
        self.motion.set_loads(&self.parts, task.forcing.loads());
    }

    /// Ends the call: writes the state.
    pub(super) fn hand_back(&mut self, state: &mut State) -> Result<(), StepError> {
        state.decoupled.clone_from(&self.motion.states);
        self.motion.put_together(&self.parts, state);
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
            state.decoupled.clear();
        }
        if self.used_slow != state.slow {
            self.used_slow.clone_from(&state.slow);
            task.forcing.blocks_into(&self.used_slow, &mut self.blocks);
            self.parts = take_apart(task.system, &self.blocks, task.forcing.harmonics());
            self.motion = Motion::new(&self.parts);
            let harmonics = self.frequencies.len();
            self.scratch = Scratch::new(&self.parts, harmonics);
            for coefficients in &mut self.lengths {
                coefficients.forget(&self.parts);
            }
            self.steps.fill(0.0);
            self.counts.refreshes += 1;
        }
    }

    /// The coefficients for this step length, computed unless they are kept from earlier steps.
    fn coefficients_for(&mut self, h: f64) -> usize {
        if let Some(index) = self.steps.iter().position(|&step| step == h) {
            return index;
        }
        let index = self.next_length;
        self.next_length = (index + 1) % self.lengths.len();
        self.counts.factorizations += 1;
        let parts = (self.parts.as_slice(), &self.exchange);
        self.steps[index] = h;
        self.lengths[index].compute(parts, h, &self.frequencies, &mut self.scratch);
        index
    }

    /// What the couplings see at the points without forces, some seconds after the start of the call.
    fn look_ahead(&mut self, index: usize, elapsed: f64, turning: &Turning) {
        let (motion, sight) = (&mut self.motion, &mut self.sight);
        let coefficients = &self.lengths[index];
        motion.differentiate(elapsed);
        sight.stand_still();
        let (mut first, mut turned) = (0, coefficients.turning.iter());
        for part in &self.parts {
            let (states, own) = (part.len(), part.states());
            for &sensor in &part.sensors {
                let (rows, free) = (first..first + states, &mut sight.free[sensor]);
                accumulate(
                    free,
                    &coefficients.free[rows.clone()],
                    &motion.derivative[own.clone()],
                );
                if motion.ramps {
                    accumulate(
                        free,
                        &coefficients.ramp[rows],
                        &motion.load_rate[own.clone()],
                    );
                }
                first += states;
            }
            for (harmonic, _) in &part.harmonics {
                let angle = &turning.angles[*harmonic];
                for (&sensor, turned) in part.sensors.iter().zip(&mut turned) {
                    accumulate(&mut sight.free[sensor], turned, angle);
                }
            }
        }
    }

    /// Moves to the end of the step.
    fn accept<F: Forcing>(
        &mut self,
        task: Task<'_, F>,
        state: &mut State,
        span: Span,
        index: usize,
    ) {
        let (motion, sight) = (&mut self.motion, &mut self.sight);
        let coefficients = &self.lengths[index];
        motion.advance(&coefficients.gain, &coefficients.ramp_gain);
        let (mut column, mut turned) = (0, 0);
        for part in &self.parts {
            let own = &mut motion.states[part.states()];
            let states = own.len();
            for &actuator in &part.actuators {
                let rows = column..column + states;
                let columns = coefficients
                    .columns
                    .each_ref()
                    .map(|one| &one[rows.clone()]);
                push(own, columns, sight.forces[actuator]);
                column += states;
            }
            for (harmonic, _) in &part.harmonics {
                let [cosine, sine] = &coefficients.turning_end;
                let (rows, angle) = (turned..turned + states, state.turning.angles[*harmonic]);
                add_scaled(angle[0], &cosine[rows.clone()], own);
                add_scaled(angle[1], &sine[rows], own);
                turned += states;
            }
        }
        let excess = (span.end - span.start) - self.steps[index];
        let harmonics = task.forcing.harmonics();
        state
            .turning
            .turn(harmonics, &coefficients.rotations, excess);
        for (monitor, squares) in task.system.monitors.iter().zip(&mut state.control.squares) {
            *squares += span.step * sight.mean_square(monitor);
        }
        sight.move_on();
        state.control.elapsed += span.step;
        state.time = span.end;
        self.counts.steps += 1;
    }
}

/// states -= sum over nodes of column F.
fn push(states: &mut [f64], [c0, c1, c2, c3]: [&[f64]; NODES], [f0, f1, f2, f3]: [f64; NODES]) {
    let columns = c0.iter().zip(c1).zip(c2.iter().zip(c3));
    for (state, ((c0, c1), (c2, c3))) in states.iter_mut().zip(columns) {
        *state -= (c0 * f0 + c1 * f1) + (c2 * f2 + c3 * f3);
    }
}

/// By how much longer the next step may be, for an error in units of the bound.
fn growth(error: f64) -> f64 {
    let room = 0.8 / error.max(1e-12);
    if room >= GROWTH * GROWTH * GROWTH * GROWTH * GROWTH * GROWTH {
        GROWTH
    } else {
        libm::cbrt(room.sqrt()).max(0.2)
    }
}

impl Method for Kernel {
    fn observe<F: Forcing>(&mut self, _: Task<'_, F>, _: &mut State) {
        let [deflection, rate] = &mut self.sight.start;
        deflection.fill(0.0);
        rate.fill(0.0);
        for part in &self.parts {
            let own = &self.motion.states[part.states()];
            let rows = part.sensor_rows.chunks_exact(own.len().max(1));
            for (rows, &sensor) in rows.zip(&part.sensors) {
                let seen = both(rows, own);
                deflection[sensor] += seen[0];
                rate[sensor] += seen[1];
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
        state.turning.find(task.forcing.harmonics(), span.start);
        let elapsed = span.start - task.forcing.since();
        self.look_ahead(index, elapsed, &state.turning);
        let at = (span, state.slow.as_slice());
        let exchange = (&self.exchange, &self.lengths[index].influences);
        let found = self
            .nodes
            .solve(task, at, pieces, exchange, &mut self.sight);
        if !found {
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
        let at = (span, state.slow.as_slice());
        let exchange = (&self.exchange, &self.lengths[index].influences);
        self.nodes
            .look_for_errors(task, at, pieces, exchange, &mut self.sight);
        let error = self.error(task, state, span);
        if !error.is_finite() {
            return Err(StepError::NotFinite { time: span.end });
        }
        let ratio = growth(error);
        if error > ACCEPTED {
            self.counts.rejected += 1;
            return Ok(Outcome::Rejected { ratio });
        }
        self.accept(task, state, span, index);
        // A step that was too long asks for a new plan, one that was not goes on.
        let ratio = if error > 1.0 {
            ratio.min(0.99)
        } else {
            ratio.max(1.0)
        };
        Ok(Outcome::Accepted { ratio })
    }
}
