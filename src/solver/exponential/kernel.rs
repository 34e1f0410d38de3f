//! One step of the collocation method.

use pulp::Arch;

use super::super::grid::canonical;
use super::super::march::{Ending, Method, Outcome, Span, Task};
use super::super::{Block, Counts, Forcing, Harmonic, Instant, Piece, State, StepError, System};
use super::coefficients::{Coefficients, Scratch};
use super::control::growth;
use super::events::Sighting;
use super::exchange::Exchange;
use super::lanes::Quad;
use super::motion::Motion;
use super::nodes::Nodes;
use super::part::{Part, take_apart};
use super::passes::{LookAhead, Move, PutTogether, TakeLoads};
use super::sight::{Sight, both, instant};

/// Coefficients are kept for this many step lengths at the most, and within this memory [bytes].
const LENGTHS: usize = 160;
const MEMORY: usize = 16 << 20;
/// What part of a step is tried whose forces are not found.
const SHORTER: f64 = 0.4;
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
    motion: Motion,
    pub(super) exchange: Exchange,
    frequencies: Vec<f64>,
    lengths: Vec<Coefficients>,
    /// The lengths themselves [s]; 0 while unused.
    steps: Vec<f64>,
    next_length: usize,
    /// The one used last.
    latest: usize,
    scratch: Scratch,
    /// What acts on one part in a step.
    acting: Vec<[f64; 2]>,
    pub(super) sight: Sight,
    pub(super) nodes: Nodes,
    counts: Counts,
    /// The CPU's vectors.
    arch: Arch,
}

impl Kernel {
    pub(super) fn new(system: &System, harmonics: &[Harmonic]) -> Kernel {
        let parts = take_apart(system, &system.blocks, harmonics);
        let exchange = Exchange::between(&parts, system.couplings.len());
        let unused = Coefficients::unused(&parts, &exchange, harmonics.len());
        let affordable = (MEMORY / unused.bytes().max(1)).clamp(4, LENGTHS);
        let couplings = system.couplings.len();
        Kernel {
            blocks: system.blocks.clone(),
            used_slow: system.slow.clone(),
            present_slow: system.slow.clone(),
            motion: Motion::new(&parts, system.loads.len()),
            frequencies: harmonics.iter().map(|one| one.frequency).collect(),
            lengths: vec![unused; affordable],
            steps: vec![0.0; affordable],
            next_length: 0,
            latest: 0,
            scratch: Scratch::new(&parts, harmonics.len()),
            acting: vec![[0.0; 2]; parts.iter().map(Part::columns).max().unwrap_or(0)],
            sight: Sight::new(couplings),
            nodes: Nodes::new(couplings, &exchange),
            counts: Counts::default(),
            arch: Arch::new(),
            exchange,
            parts,
        }
    }

    /// As many states as the parts have, all zero.
    pub(super) fn states(&self) -> Vec<Quad> {
        vec![[0.0; 4]; self.motion.states.len()]
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
        if state.is_decoupled {
            self.motion.states.copy_from_slice(&state.decoupled);
        } else {
            self.motion.take_apart(&self.parts, state);
        }
        self.arch.dispatch(TakeLoads {
            parts: &self.parts,
            motion: &mut self.motion,
            ramps: task.forcing.loads(),
        });
    }

    /// Ends the call: writes the state.
    pub(super) fn hand_back(&mut self, state: &mut State) -> Result<(), StepError> {
        state.decoupled.copy_from_slice(&self.motion.states);
        state.is_decoupled = true;
        let numbers = self.arch.dispatch(PutTogether {
            parts: &self.parts,
            motion: &mut self.motion,
            state,
        });
        if numbers {
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
            state.is_decoupled = false;
        }
        if self.used_slow != state.slow {
            self.used_slow.clone_from(&state.slow);
            task.forcing.blocks_into(&self.used_slow, &mut self.blocks);
            self.parts = take_apart(task.system, &self.blocks, task.forcing.harmonics());
            self.motion = Motion::new(&self.parts, task.system.loads.len());
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
        if self.steps[self.latest] == h {
            return self.latest;
        }
        if let Some(index) = self.steps.iter().position(|&step| step == h) {
            self.latest = index;
            return index;
        }
        let index = self.next_length;
        self.next_length = (index + 1) % self.lengths.len();
        self.latest = index;
        self.counts.factorizations += 1;
        let parts = (self.parts.as_slice(), &self.exchange);
        self.steps[index] = h;
        self.lengths[index].compute(parts, h, &self.frequencies, &mut self.scratch);
        index
    }

    /// Moves to the end of the step.
    fn accept<F: Forcing>(
        &mut self,
        task: Task<'_, F>,
        state: &mut State,
        span: Span,
        index: usize,
    ) {
        self.arch.dispatch(Move {
            parts: &self.parts,
            coefficients: &self.lengths[index],
            motion: &mut self.motion,
            sight: &self.sight,
            turning: &state.turning,
            acting: &mut self.acting,
        });
        let (sight, coefficients) = (&mut self.sight, &self.lengths[index]);
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

impl Method for Kernel {
    fn observe<F: Forcing>(&mut self, _: Task<'_, F>, _: &mut State) {
        let [deflection, rate] = &mut self.sight.start;
        deflection.fill(0.0);
        rate.fill(0.0);
        for part in &self.parts {
            let own = self.motion.states[part.quads()].as_flattened();
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
        self.arch.dispatch(LookAhead {
            parts: &self.parts,
            coefficients: &self.lengths[index],
            motion: &mut self.motion,
            sight: &mut self.sight,
            turning: &state.turning,
            elapsed,
        });
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
        let sighting = if task.forcing.is_timed() {
            Sighting::Clear
        } else {
            self.sight_events(task, &state.slow, span, pieces, endings)
        };
        match sighting {
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
