//! One step of the collocation method.

use std::sync::Arc;

use pulp::Arch;

use super::super::march::{Ending, Method, Outcome, Span, Task};
use super::super::{Block, Counts, Forcing, Harmonic, Instant, Piece, State, StepError, System};
use super::coefficients::Coefficients;
use super::control::growth;
use super::events::Sighting;
use super::exchange::Exchange;
use super::motion::Motion;
use super::nodes::Nodes;
use super::panel::Panels;
use super::part::{Part, take_apart};
use super::passes::{Compute, LookAhead, Move, Observe, ReadOff, SolveLines, Sweep, TakeLoads};
use super::rows::Rows;
use super::scratch::Scratch;
use super::shapes::Shapes;
use super::sight::{Sight, instant};

/// Coefficients are kept for this many step lengths at the most, numbered by bytes, and within this memory [bytes].
const LENGTHS: usize = 160;
const _: () = assert!(LENGTHS <= 256);
const MEMORY: usize = 16 << 20;
/// Lengths are looked up by so many values of their bits.
const LENGTHS_TOLD_APART: usize = 256;
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
    panels: Panels,
    /// How displacements and velocities follow from the states.
    shapes: Arc<Shapes>,
    /// How the readings follow from them, and room for those.
    reading: Rows,
    read: Vec<f64>,
    motion: Motion,
    pub(super) exchange: Exchange,
    frequencies: Vec<f64>,
    lengths: Vec<Coefficients>,
    /// The lengths themselves [s]; 0 while unused.
    steps: Vec<f64>,
    next_length: usize,
    /// Where lengths were found last, by some of their bits.
    found: [u8; LENGTHS_TOLD_APART],
    scratch: Scratch,
    pub(super) sight: Sight,
    /// Whether the couplings have seen the motion as it is.
    is_seen: bool,
    pub(super) nodes: Nodes,
    /// Mean squares over the present step of what the monitors watch.
    pub(super) squares: Vec<f64>,
    counts: Counts,
    /// The CPU's vectors.
    arch: Arch,
}

impl Kernel {
    pub(super) fn new(system: &System, harmonics: &[Harmonic]) -> Kernel {
        let parts = take_apart(system, &system.blocks, harmonics);
        let exchange = Exchange::between(&parts, system.springs);
        let panels = Panels::of(&parts);
        let unused = Coefficients::unused(&parts, &panels, &exchange, harmonics.len());
        let affordable = (MEMORY / unused.bytes().max(1)).clamp(4, LENGTHS);
        let couplings = system.couplings.len();
        let reading = reading(system, &parts);
        Kernel {
            blocks: system.blocks.clone(),
            used_slow: system.slow.clone(),
            present_slow: system.slow.clone(),
            shapes: Arc::new(Shapes::of(&parts)),
            read: reading.room(),
            reading,
            motion: Motion::new(&parts, system.loads.len()),
            frequencies: harmonics.iter().map(|one| one.frequency).collect(),
            lengths: vec![unused; affordable],
            steps: vec![0.0; affordable],
            next_length: 0,
            found: [0; LENGTHS_TOLD_APART],
            scratch: Scratch::new(&parts, harmonics.len()),
            sight: Sight::new(couplings),
            is_seen: false,
            nodes: Nodes::new(system, &exchange),
            squares: vec![0.0; system.monitors.len()],
            counts: Counts::default(),
            arch: Arch::new(),
            exchange,
            panels,
            parts,
        }
    }

    /// Number of states in fours.
    pub(super) fn states(&self) -> usize {
        self.motion.states.len()
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
        let slow_moved = self.follow_slow(task, state);
        match state.pose.decoupled().filter(|_| !slow_moved) {
            Some(states) => self.motion.states.copy_from_slice(states),
            None => self.motion.take_apart(&self.parts, state.pose.whole()),
        }
        for (target, seen) in self.sight.nodes[0].iter_mut().zip(&state.seen) {
            target.copy_from_slice(seen);
        }
        self.is_seen = true;
        self.arch.dispatch(TakeLoads {
            motion: &mut self.motion,
            ramps: task.forcing.loads(),
        });
    }

    /// Ends the call: writes the state.
    pub(super) fn hand_back<F: Forcing>(
        &mut self,
        task: Task<'_, F>,
        state: &mut State,
    ) -> Result<(), StepError> {
        self.observe(task, state);
        let numbers = self.arch.dispatch(ReadOff {
            motion: &self.motion,
            rows: &self.reading,
            numbers: &mut self.read,
        });
        if !numbers {
            return Err(StepError::NotFinite { time: state.time });
        }
        for (list, seen) in state.seen.iter_mut().zip(&self.sight.nodes[0]) {
            list.copy_from_slice(seen);
        }
        let (readings, _) = self.read.split_at(state.readings.len());
        state.readings.copy_from_slice(readings);
        state.pose.decouple(&self.motion.states, &self.shapes);
        Ok(())
    }

    /// Makes the blocks anew where the slow parameters of the state ask for it. Gives whether its decoupled states belong to
    /// other ones.
    fn follow_slow<F: Forcing>(&mut self, task: Task<'_, F>, state: &mut State) -> bool {
        let present = &mut self.present_slow;
        task.forcing.slow_into(&state.seen[1], present);
        let stale = task.forcing.is_stale(&state.slow, present);
        if stale {
            state.slow.clone_from(present);
        }
        if self.used_slow != state.slow {
            self.used_slow.clone_from(&state.slow);
            task.forcing.blocks_into(&self.used_slow, &mut self.blocks);
            self.parts = take_apart(task.system, &self.blocks, task.forcing.harmonics());
            self.panels = Panels::of(&self.parts);
            self.shapes = Arc::new(Shapes::of(&self.parts));
            self.reading = reading(task.system, &self.parts);
            self.motion = Motion::new(&self.parts, task.system.loads.len());
            let harmonics = self.frequencies.len();
            self.scratch = Scratch::new(&self.parts, harmonics);
            for coefficients in &mut self.lengths {
                coefficients.forget(&self.parts);
            }
            self.steps.fill(0.0);
            self.counts.refreshes += 1;
        }
        stale
    }

    /// The coefficients for this step length, computed unless they are kept from earlier steps.
    fn coefficients_for(&mut self, h: f64) -> usize {
        // The bits that few lengths share: the product spreads them to the top.
        let told_apart = h.to_bits().wrapping_mul(0x9e37_79b9_7f4a_7c15) >> 56;
        let found = &mut self.found[told_apart as usize];
        if self.steps[usize::from(*found)] == h {
            return usize::from(*found);
        }
        if let Some(index) = self.steps.iter().position(|&step| step == h) {
            *found = index as u8;
            return index;
        }
        let index = self.next_length;
        self.next_length = (index + 1) % self.lengths.len();
        *found = index as u8;
        self.counts.factorizations += 1;
        self.steps[index] = h;
        self.arch.dispatch(Compute {
            coefficients: &mut self.lengths[index],
            parts: &self.parts,
            panels: &self.panels,
            exchange: &self.exchange,
            step: h,
            frequencies: &self.frequencies,
            scratch: &mut self.scratch,
        });
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
            panels: &self.panels,
            coefficients: &self.lengths[index],
            motion: &mut self.motion,
            sight: &self.sight,
            turning: &state.turning,
        });
        let (sight, coefficients) = (&mut self.sight, &self.lengths[index]);
        let excess = (span.end - span.start) - span.step;
        let harmonics = task.forcing.harmonics();
        state
            .turning
            .turn(harmonics, &coefficients.rotations, excess);
        for (squares, mean) in state.control.squares.iter_mut().zip(&self.squares) {
            *squares += span.step * mean;
        }
        sight.move_on();
        // Movements add up to the motion: rounding does, too, and at once where rotations grow without end.
        self.is_seen = task.forcing.is_timed() && !state.turning.is_due();
        state.control.elapsed += span.step;
        state.time = span.end;
        self.counts.steps += 1;
    }
}

impl Method for Kernel {
    fn observe<F: Forcing>(&mut self, _: Task<'_, F>, _: &mut State) {
        if !self.is_seen {
            self.arch.dispatch(Observe {
                panels: &self.panels,
                states: &self.motion.states,
                sight: &mut self.sight,
            });
            self.is_seen = true;
        }
    }

    fn instant<'a>(&'a self, state: &'a State) -> Instant<'a> {
        instant(&self.sight.nodes[0], state.time, &state.slow)
    }

    fn begin<F: Forcing>(&mut self, task: Task<'_, F>, state: &State, pieces: &[Piece]) {
        if task.forcing.is_straight() {
            return; // lines are drawn at the start of every step
        }
        let sight = &mut self.sight;
        let at = instant(&sight.nodes[0], state.time, &state.slow);
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
        let index = self.coefficients_for(span.step);
        state.turning.find(task.forcing.harmonics(), span.start);
        let straight = task.forcing.is_straight();
        let coefficients = &self.lengths[index];
        let ahead = LookAhead {
            panels: &self.panels,
            coefficients,
            motion: &mut self.motion,
            sight: &mut self.sight,
            turning: &state.turning,
            elapsed: span.start - task.forcing.since(),
        };
        let found = if straight {
            self.arch.dispatch(SolveLines {
                ahead,
                nodes: &mut self.nodes,
                forcing: task.forcing,
                span,
                pieces,
                exchange: &self.exchange,
            })
        } else {
            self.arch.dispatch(Sweep {
                ahead,
                nodes: &mut self.nodes,
                task,
                at: (span, &state.slow),
                pieces,
                exchange: &self.exchange,
            })
        };
        if !found {
            self.counts.rejected += 1;
            if self.sight.is_start_finite() {
                return Ok(Outcome::Rejected { ratio: SHORTER });
            }
            return Err(StepError::NotFinite { time: span.start });
        }
        let sighting = if task.forcing.is_timed() {
            Sighting::Clear
        } else {
            if straight {
                self.sight.show(span.step);
            }
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
        if !straight {
            let at = (span, state.slow.as_slice());
            let between = (&self.exchange, &self.lengths[index].influences);
            self.nodes
                .look_for_errors(task, at, pieces, between, &mut self.sight);
        }
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

/// Rows of the readings.
fn reading(system: &System, parts: &[Part]) -> Rows {
    let readings = system.readings.iter();
    let numbers = readings.map(|reading| [&reading.position, &reading.velocity]);
    Rows::over(parts, &numbers.collect::<Vec<_>>())
}
