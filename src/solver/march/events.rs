//! The motion ends a piece inside a step: the step is repeated to end there.

use super::super::{Forcing, State, StepError};
use super::{Ending, March, Method, Outcome, Span, Task};

/// Events that lie closer than this part of a step are one, and are now where they lie so close to its start: this part of
/// the tolerance, between these bounds. An impact that is late by it misses the force of the dampers for as long.
const CLOSE: f64 = 1e-2;
const CLOSE_WITHIN: (f64, f64) = (1e-10, 1e-6);
/// In parts of a step shorter than this a piece that has just begun does not end again: it begins where rounding lets it.
const TOO_SHORT_TO_END: f64 = 1e-3;
/// After so many interruptions of one step a law that is to land counts as landed.
const MOST_INTERRUPTIONS: u32 = 20;

/// Which pieces the motion has begun and is about to end.
#[derive(Debug, Clone)]
pub(super) struct Events {
    /// When the piece of each law began because the motion ended the one before, in the present stretch [s].
    begun: Vec<f64>,
    /// The laws whose pieces end with the present step.
    landing: Vec<bool>,
    /// How they may end in it; all are watched when a step is tried first.
    pub(super) endings: Vec<Ending>,
    /// Events so far.
    pub(super) count: u64,
}

impl Events {
    pub(super) fn new(laws: usize) -> Events {
        Events {
            begun: vec![f64::NEG_INFINITY; laws],
            landing: vec![false; laws],
            endings: vec![Ending::Watched; laws],
            count: 0,
        }
    }

    /// All pieces are those of a new stretch.
    pub(super) fn enter_stretch(&mut self) {
        self.begun.fill(f64::NEG_INFINITY);
    }

    /// Only this law lands.
    fn land_only(&mut self, law: usize) {
        self.landing.fill(false);
        self.landing[law] = true;
    }

    /// The step that ends with an event inside `span`, or with it and others that lie within `close` of it.
    fn aim(&mut self, (law, time): (usize, f64), span: Span, close: f64) -> Span {
        let end = time.max(span.start + close);
        let is_earlier = end < span.end - close;
        let again = self.landing[law];
        if is_earlier && !again {
            self.land_only(law);
        }
        self.landing[law] = true;
        if end < span.end && (again || is_earlier) {
            let step = end - span.start;
            return Span { end, step, ..span };
        }
        span
    }

    /// Says how pieces may end in a part of a step that has been interrupted so often.
    fn watch(&mut self, span: Span, whole: Span, interruptions: u32) {
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
    }

    /// Some of those that were to land with the step may be under watch again.
    fn keep_landed(&mut self) {
        for (landing, ending) in self.landing.iter_mut().zip(&self.endings) {
            *landing &= *ending != Ending::Watched;
        }
    }
}

impl March {
    /// A step again that the motion has interrupted: up to the event, where other pieces begin, so that the rest of the stretch
    /// has to be planned anew.
    pub(super) fn step_to_event<F: Forcing>(
        &mut self,
        method: &mut impl Method,
        task: Task<'_, F>,
        state: &mut State,
        (whole, due): (Span, f64),
        first: (usize, f64),
    ) -> Result<(), StepError> {
        self.events.landing.fill(false);
        let landed = self.land(method, task, state, (whole, due), first);
        self.events.endings.fill(Ending::Watched);
        if landed? {
            self.end_pieces(method, task, state);
        }
        Ok(())
    }

    /// Tries shorter and shorter steps until one ends with an event. Gives whether there is one: a step may be rejected.
    fn land<F: Forcing>(
        &mut self,
        method: &mut impl Method,
        task: Task<'_, F>,
        state: &mut State,
        (whole, due): (Span, f64),
        first: (usize, f64),
    ) -> Result<bool, StepError> {
        // No less than what rounding lets times differ by.
        let rounding = 4.0 * f64::EPSILON * whole.start.abs();
        let close = (CLOSE * task.tolerance).clamp(CLOSE_WITHIN.0, CLOSE_WITHIN.1);
        let close = (close * whole.step).max(rounding);
        let (mut span, mut interruptions) = (whole, 0);
        let (mut law, mut time) = first;
        loop {
            // A piece lasts: one that has just begun does not end now.
            if time <= whole.start + close && self.events.begun[law] != whole.start {
                self.events.land_only(law);
                return Ok(true);
            }
            span = self.events.aim((law, time), span, close);
            interruptions += 1;
            self.events.watch(span, whole, interruptions);
            match self.try_step(method, task, state, (span, due))? {
                Outcome::Accepted { .. } => {
                    self.events.keep_landed();
                    return Ok(true);
                }
                Outcome::Rejected { ratio } => {
                    let pieces = &self.stretch.pieces;
                    let decided = state.control.step_in(pieces);
                    state
                        .control
                        .want(span.step * ratio, false, (decided, pieces));
                    return Ok(false);
                }
                Outcome::Interrupted { law: l, time: t } => (law, time) = (l, t),
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
        let pieces = &mut self.stretch.pieces;
        let Events {
            begun,
            landing,
            count,
            ..
        } = &mut self.events;
        let laws = pieces.iter_mut().zip(begun).zip(landing);
        for (law, ((piece, begun), landed)) in laws.enumerate() {
            if *landed {
                *count += 1;
                *begun = state.time;
                *piece = task.forcing.next_piece(law, *piece, method.instant(state));
            }
        }
        method.begin(task, state, pieces);
    }
}
