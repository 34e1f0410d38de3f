//! How a solver gets from one communication point to the next: smooth stretches, equal steps, events.
//!
//! ```text
//!   advance_to(until)
//!     stretch   up to the next breakpoint known in advance, or `until`      laws choose their pieces
//!       steps   equal ones, as long as the control of the method wants       replanned when it changes its mind
//!         event   the motion ends a piece inside a step: the step is repeated to end there, the next piece follows
//! ```
//!
//! Knows no method: what a step is and how good it was, a [`Method`] says.

use core::ops::Range;

use super::grid::{Grid, canonical};
use super::{Counts, Forcing, Instant, Piece, State, StepError, System};

/// After so many steps of one call their average length must be at least this [s]: machines vibrate below the GHz, though
/// events may lie close for a while.
const PATIENCE: [(u64, f64); 2] = [(5_000, 1e-11), (50_000, 1e-9)];
/// No call takes more steps: some minutes of work.
const MOST_STEPS: u64 = 100_000_000;
/// Events that lie closer than this part of a step are one, and are now where they lie so close to its start: this part of
/// the tolerance, between these bounds. An impact that is late by it misses the force of the dampers for as long.
const CLOSE: f64 = 1e-2;
const CLOSE_WITHIN: (f64, f64) = (1e-10, 1e-6);
/// In parts of a step shorter than this a piece that has just begun does not end again: it begins where rounding lets it.
const TOO_SHORT_TO_END: f64 = 1e-3;
/// After so many interruptions of one step a law that is to land counts as landed.
const MOST_INTERRUPTIONS: u32 = 20;
/// A step that could be this many times longer says no more than that.
const MOST_SAID: f64 = 2.0;
/// A stretch begins with a guess of this part of it.
const FIRST_STEP: f64 = 1.0 / 16.0;
/// No step makes up for more than this part of itself, where the motion is ahead of time or behind.
const MADE_UP: f64 = 1e-3;

/// Pieces hold for sure from a place that lies this part of the way to the next breakpoint behind where it was looked for.
const FOR_SURE: f64 = 1e-3;

/// What stays the same during one call.
#[derive(Debug)]
pub(super) struct Task<'a, F> {
    pub(super) system: &'a System,
    pub(super) forcing: &'a F,
    pub(super) tolerance: f64,
}

// Deriving would ask the same of F.
impl<F> Clone for Task<'_, F> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<F> Copy for Task<'_, F> {}

/// One step: from when, to when, how long. A method steps by the length, which is [`canonical`]; it differs from the time
/// between by rounding and by what [`super::Control::due`] makes up for.
#[derive(Debug, Clone, Copy)]
pub(super) struct Span {
    pub(super) start: f64,
    pub(super) end: f64,
    pub(super) step: f64,
}

impl Span {
    /// The time at a part of the step.
    #[inline(always)]
    pub(super) fn at(&self, part: f64) -> f64 {
        if part == 1.0 {
            self.end
        } else {
            self.start + part * (self.end - self.start)
        }
    }
}

/// What became of a step.
#[derive(Debug, Clone, Copy)]
pub(super) enum Outcome {
    /// The state is at the end of the step.
    Accepted {
        /// Length the next step should have relative to this one.
        ratio: f64,
    },
    /// The state is unchanged: the step was too long.
    Rejected {
        /// Length the step should have had relative to this one.
        ratio: f64,
    },
    /// The state is unchanged: the motion ends the piece of a law first.
    Interrupted {
        /// The law.
        law: usize,
        /// When [s].
        time: f64,
    },
}

/// How the piece of a law may end in a step.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Ending {
    /// Inside the step, which interrupts it.
    Watched,
    /// With the step.
    Landing,
    /// Not at all: it has just begun.
    Excused,
}

/// A way to take steps.
pub(super) trait Method {
    /// Looks at the state: what the couplings see.
    fn observe<F: Forcing>(&mut self, task: Task<'_, F>, state: &mut State);
    /// What the couplings see in the state observed, or reached by a step since.
    fn instant<'a>(&'a self, state: &'a State) -> Instant<'a>;
    /// Prepares for steps from there with these pieces.
    fn begin<F: Forcing>(&mut self, task: Task<'_, F>, state: &State, pieces: &[Piece]);
    /// Tries a step. A law that was to land and has not is put under watch again.
    fn try_step<F: Forcing>(
        &mut self,
        task: Task<'_, F>,
        state: &mut State,
        span: Span,
        pieces: &[Piece],
        endings: &mut [Ending],
    ) -> Result<Outcome, StepError>;
}

/// The way from point to point with its workspace.
#[derive(Debug, Clone)]
pub(super) struct March {
    pieces: Vec<Piece>,
    /// Where time alone ends pieces: the stretch of time in which those above hold.
    holding: Range<f64>,
    /// When the piece of each law began because the motion ended the one before [s].
    begun: Vec<f64>,
    /// The laws whose pieces end with the present step.
    landing: Vec<bool>,
    endings: Vec<Ending>,
    /// Steps tried since `since`, the start of the present call.
    tried: u64,
    since: f64,
    /// Events so far.
    pub(super) events: u64,
}

impl March {
    pub(super) fn new(system: &System) -> March {
        March {
            pieces: vec![Piece::default(); system.laws],
            holding: 0.0..0.0,
            begun: vec![f64::NEG_INFINITY; system.laws],
            landing: vec![false; system.laws],
            endings: vec![Ending::Watched; system.laws],
            tried: 0,
            since: 0.0,
            events: 0,
        }
    }

    /// Work done, with the events.
    pub(super) fn counts(&self, counts: Counts) -> Counts {
        Counts {
            events: self.events,
            ..counts
        }
    }

    /// Advances the state to exactly `until`, which lies ahead. After an error the state means nothing.
    pub(super) fn advance<F: Forcing>(
        &mut self,
        method: &mut impl Method,
        task: Task<'_, F>,
        state: &mut State,
        until: f64,
    ) -> Result<(), StepError> {
        (self.tried, self.since) = (0, state.time);
        // Less than rounding lets times differ is no stretch of time.
        let rounding = 4.0 * f64::EPSILON * until.abs();
        let slack = task.forcing.slack(task.tolerance).max(rounding);
        let grid = Grid::over(state.time, until);
        while state.time < until - rounding {
            self.begun.fill(f64::NEG_INFINITY);
            method.observe(task, state);
            let stop = if self.holding.start <= state.time && until <= self.holding.end {
                until
            } else {
                self.enter_stretch(method, task, state, (until, rounding, slack), grid)
            };
            method.begin(task, state, &self.pieces);
            self.cross_smooth_stretch(method, task, state, (stop, grid))?;
        }
        state.time = until;
        Ok(())
    }

    /// Chooses pieces and gives when the stretch ends: at the next breakpoint or `until`. Breakpoints within `slack` are as good as
    /// reached.
    fn enter_stretch<F: Forcing>(
        &mut self,
        method: &mut impl Method,
        task: Task<'_, F>,
        state: &State,
        (until, rounding, slack): (f64, f64, f64),
        grid: Grid,
    ) -> f64 {
        let looked_for = state.time + slack;
        let next = task.forcing.next_breakpoint(looked_for);
        let stop = if next < until - slack {
            let near = grid.near(next);
            let met = (near - next).abs() <= slack && near > state.time + rounding;
            if met && near < until { near } else { next }
        } else {
            until
        };
        let inside = 0.5 * (state.time + stop);
        let start = method.instant(state);
        task.forcing.enter(start, inside, &mut self.pieces);
        let sure = inside >= looked_for + FOR_SURE * (next - state.time);
        self.holding = if sure && task.forcing.is_timed() {
            inside..next
        } else {
            0.0..0.0
        };
        stop
    }

    /// From the state's time to `stop` with equal steps, replanned when the method asks for it.
    fn cross_smooth_stretch<F: Forcing>(
        &mut self,
        method: &mut impl Method,
        task: Task<'_, F>,
        state: &mut State,
        (stop, grid): (f64, Grid),
    ) -> Result<(), StepError> {
        if state.control.wanted_step == 0.0 {
            state.control.wanted_step = (stop - state.time) * FIRST_STEP;
        }
        while state.time < stop {
            let (start, length) = (state.time, grid.length(stop - state.time));
            let count = equal_steps(length / state.control.step_in(&self.pieces));
            let step = length / count as f64;
            if start + 0.5 * step == start {
                return Err(StepError::StepTooSmall { time: start, step });
            }
            for number in 1..=count {
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
                if self.take_step(method, task, state, span, last)? {
                    break;
                }
            }
        }
        Ok(())
    }

    /// One step, or a part of it up to an event. Gives whether the rest of the stretch has to be planned anew.
    fn take_step<F: Forcing>(
        &mut self,
        method: &mut impl Method,
        task: Task<'_, F>,
        state: &mut State,
        span: Span,
        last: bool,
    ) -> Result<bool, StepError> {
        let (whole, mut span, mut interruptions) = (span, span, 0);
        self.landing.fill(false);
        let due = state.control.due(span.step, task.tolerance);
        loop {
            self.check_progress(state.time, span.step)?;
            self.tried += 1;
            let short = span.step < TOO_SHORT_TO_END * whole.step;
            let laws = self.endings.iter_mut().zip(&self.begun).zip(&self.landing);
            for ((ending, begun), landing) in laws {
                *ending = match landing {
                    // Rounding may keep it from ever landing exactly.
                    true if interruptions > MOST_INTERRUPTIONS => Ending::Excused,
                    true => Ending::Landing,
                    false if short && *begun == span.start => Ending::Excused,
                    false => Ending::Watched,
                };
            }
            let made_up = if due.abs() < MADE_UP * span.step {
                due
            } else {
                0.0
            };
            let length = canonical(span.step - made_up);
            let tried = Span {
                step: length,
                ..span
            };
            match method.try_step(task, state, tried, &self.pieces, &mut self.endings)? {
                Outcome::Accepted { ratio } => {
                    state.control.took(length, span.end - span.start);
                    if self.landing.contains(&true) {
                        for (landing, ending) in self.landing.iter_mut().zip(&self.endings) {
                            *landing &= *ending != Ending::Watched;
                        }
                        self.end_pieces(method, task, state);
                        return Ok(true);
                    }
                    let pieces = &self.pieces;
                    state
                        .control
                        .want(span.step * ratio, ratio >= MOST_SAID, pieces);
                    return Ok(ratio < 1.0 || (ratio > 1.4 && !last));
                }
                Outcome::Rejected { ratio } => {
                    state.control.want(span.step * ratio, false, &self.pieces);
                    return Ok(true);
                }
                Outcome::Interrupted { law, time } => {
                    // No less than what rounding lets times differ by.
                    let rounding = 4.0 * f64::EPSILON * span.start.abs();
                    let close = (CLOSE * task.tolerance).clamp(CLOSE_WITHIN.0, CLOSE_WITHIN.1);
                    let least = (close * whole.step).max(rounding);
                    // A piece lasts: one that has just begun does not end now.
                    if time <= span.start + least && self.begun[law] != span.start {
                        self.landing.fill(false);
                        self.landing[law] = true;
                        self.end_pieces(method, task, state);
                        return Ok(true);
                    }
                    let end = time.max(span.start + least);
                    let again = self.landing[law];
                    if !again && end < span.end - least {
                        self.landing.fill(false);
                    }
                    // Events that lie closer are one, and so is an event with the end of the step.
                    if end < span.end && (again || end < span.end - least) {
                        let step = end - span.start;
                        span = Span { end, step, ..span };
                    }
                    self.landing[law] = true;
                    interruptions += 1;
                }
            }
        }
    }

    /// The pieces of the laws that the step has landed on give way to the next ones.
    fn end_pieces<F: Forcing>(
        &mut self,
        method: &mut impl Method,
        task: Task<'_, F>,
        state: &State,
    ) {
        let laws = self
            .pieces
            .iter_mut()
            .zip(&mut self.begun)
            .zip(&self.landing);
        for (law, ((piece, begun), landed)) in laws.enumerate() {
            if *landed {
                self.events += 1;
                *begun = state.time;
                *piece = task.forcing.next_piece(law, *piece, method.instant(state));
            }
        }
        method.begin(task, state, &self.pieces);
    }

    /// A call has to end: refuses to go on without end with steps that lead nowhere.
    fn check_progress(&self, time: f64, step: f64) -> Result<(), StepError> {
        let average = (time - self.since) / self.tried as f64;
        let lost = |&(tried, least): &(u64, f64)| self.tried >= tried && average < least;
        if PATIENCE.iter().any(lost) {
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn step_counts_are_the_next_of_a_small_set() {
        let counts = [0.3, 1.0, 1.0 + 1e-12, 2.5, 3.5, 4.5, 6.1, 9.0, 13.0, 17.0].map(equal_steps);
        assert_eq!(counts, [1, 1, 1, 3, 4, 6, 8, 12, 16, 24]);
    }
}
