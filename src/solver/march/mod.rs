//! How a solver gets from one communication point to the next: smooth stretches, equal steps, events.
//!
//! ```text
//!   advance_to(until)
//!     stretch   up to the next breakpoint known in advance, or `until`      laws choose their pieces (`stretch`)
//!       steps   equal ones, as long as the control of the method wants       replanned when it changes its mind
//!         event   the motion ends a piece inside a step: the step is repeated to end there, the next piece follows (`events`)
//! ```
//!
//! Knows no method: what a step is and how good it was, a [`Method`] says.

mod events;
mod progress;
mod stretch;

use super::grid::canonical;
use super::{Counts, Forcing, Instant, Piece, State, StepError, System};
use events::Events;
use progress::Progress;
use stretch::{Goal, Stretch};

/// A step that could be this many times longer says no more than that.
const MOST_SAID: f64 = 2.0;
/// The rest of a stretch is planned anew where steps could be this many times longer.
const WORTH_A_PLAN: f64 = 1.4;
/// A stretch begins with a guess of this part of it.
const FIRST_STEP: f64 = 1.0 / 4.0;
/// No step makes up for more than this part of itself, where the motion is ahead of time or behind.
const MADE_UP: f64 = 1e-3;

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
    stretch: Stretch,
    events: Events,
    progress: Progress,
}

impl March {
    pub(super) fn new(system: &System) -> March {
        March {
            stretch: Stretch::new(system.laws),
            events: Events::new(system.laws),
            progress: Progress::since(0.0),
        }
    }

    /// Work done, with the events.
    pub(super) fn counts(&self, counts: Counts) -> Counts {
        Counts {
            events: self.events.count,
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
        self.progress = Progress::since(state.time);
        let goal = Goal::new(task, state.time, until);
        while state.time < until - goal.rounding {
            method.observe(task, state);
            let stop = self.stretch.enter(method, task, state, &goal);
            if !task.forcing.is_timed() {
                self.events.enter_stretch();
            }
            method.begin(task, state, &self.stretch.pieces);
            self.cross_stretch(method, task, state, (stop, &goal))?;
        }
        state.time = until;
        Ok(())
    }

    /// From the state's time to `stop` with equal steps, replanned when the method asks for it.
    fn cross_stretch<F: Forcing>(
        &mut self,
        method: &mut impl Method,
        task: Task<'_, F>,
        state: &mut State,
        (stop, goal): (f64, &Goal),
    ) -> Result<(), StepError> {
        if state.control.wanted_step == 0.0 {
            state.control.wanted_step = (stop - state.time) * FIRST_STEP;
        }
        while state.time < stop {
            let (start, length) = (state.time, goal.grid.length(stop - state.time));
            let mut wanted = state.control.step_in(&self.stretch.pieces);
            let count = equal_steps(length / wanted);
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
                if self.take_step(method, task, state, span, (wanted, last))? {
                    break;
                }
                wanted = state.control.wanted_step;
            }
        }
        Ok(())
    }

    /// One step, or a part of it up to an event; these pieces have `wanted` steps so far. Gives whether the rest of the stretch has to
    /// be planned anew.
    fn take_step<F: Forcing>(
        &mut self,
        method: &mut impl Method,
        task: Task<'_, F>,
        state: &mut State,
        span: Span,
        (wanted, last): (f64, bool),
    ) -> Result<bool, StepError> {
        let due = state.control.due(span.step, task.tolerance);
        let outcome = self.try_step(method, task, state, (span, due))?;
        let in_these = (wanted, self.stretch.pieces.as_slice());
        match outcome {
            Outcome::Accepted { ratio } => {
                let at_least = ratio >= MOST_SAID;
                state.control.want(span.step * ratio, at_least, in_these);
                Ok(ratio < 1.0 || (ratio > WORTH_A_PLAN && !last))
            }
            Outcome::Rejected { ratio } => {
                state.control.want(span.step * ratio, false, in_these);
                Ok(true)
            }
            Outcome::Interrupted { law, time } => {
                self.step_to_event(method, task, state, (span, due), (law, time))?;
                Ok(true)
            }
        }
    }

    /// Tries a step that makes up for what is due, with endings as they are.
    fn try_step<F: Forcing>(
        &mut self,
        method: &mut impl Method,
        task: Task<'_, F>,
        state: &mut State,
        (span, due): (Span, f64),
    ) -> Result<Outcome, StepError> {
        self.progress.try_another(state.time, span.step)?;
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
        let (pieces, endings) = (&self.stretch.pieces, &mut self.events.endings);
        let outcome = method.try_step(task, state, tried, pieces, endings)?;
        if let Outcome::Accepted { .. } = outcome {
            state.control.took(length, span.end - span.start);
        }
        Ok(outcome)
    }
}

/// The number of equal steps for a stretch of `lengths` wanted steps: 1, 2, 3, 4, 6, 8, 12, 16, 24 ...,
/// so that few different step lengths occur.
fn equal_steps(lengths: f64) -> u64 {
    let needed = lengths * (1.0 - 1e-9);
    for few in 1..=3 {
        if needed <= few as f64 {
            return few;
        }
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
