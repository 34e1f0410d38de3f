//! A smooth stretch of time: the pieces that hold in it, and where it ends.

use core::ops::Range;

use super::super::grid::Grid;
use super::super::{Forcing, Piece, State};
use super::{Method, Task};

/// Pieces hold for sure from a time that lies this part of the way to the next breakpoint behind where it was looked for.
const FOR_SURE: f64 = 1e-3;

/// Where a call is to come, and how closely it meets times on the way.
#[derive(Debug, Clone, Copy)]
pub(super) struct Goal {
    pub(super) until: f64,
    /// Less than rounding lets times differ is no stretch of time [s].
    pub(super) rounding: f64,
    /// Breakpoints within this time are as good as reached [s].
    pub(super) slack: f64,
    pub(super) grid: Grid,
}

impl Goal {
    pub(super) fn new<F: Forcing>(task: Task<'_, F>, start: f64, until: f64) -> Goal {
        let rounding = 4.0 * f64::EPSILON * until.abs();
        Goal {
            until,
            rounding,
            slack: task.forcing.slack(task.tolerance).max(rounding),
            grid: Grid::over(start, until),
        }
    }

    /// Where a stretch from a time ends whose pieces last until `next`: there or near there on the grid, or with the call.
    fn stop(&self, time: f64, next: f64) -> f64 {
        if next >= self.until - self.slack {
            return self.until;
        }
        let near = self.grid.near(next);
        let is_met = (near - next).abs() <= self.slack && near > time + self.rounding;
        if is_met && near < self.until {
            near
        } else {
            next
        }
    }
}

/// The pieces of all laws.
#[derive(Debug, Clone)]
pub(super) struct Stretch {
    pub(super) pieces: Vec<Piece>,
    /// Where time alone ends pieces: the stretch of time in which they hold.
    holding: Range<f64>,
}

impl Stretch {
    pub(super) fn new(laws: usize) -> Stretch {
        Stretch {
            pieces: vec![Piece::default(); laws],
            holding: 0.0..0.0,
        }
    }

    /// Chooses the pieces that hold from the state on, and gives until when they do.
    pub(super) fn enter<F: Forcing>(
        &mut self,
        method: &impl Method,
        task: Task<'_, F>,
        state: &State,
        goal: &Goal,
    ) -> f64 {
        if self.holding.start <= state.time && goal.until <= self.holding.end {
            return goal.until;
        }
        let looked_for = state.time + goal.slack;
        let next = task.forcing.follow_time(looked_for, &mut self.pieces);
        let stop = goal.stop(state.time, next);
        let inside = 0.5 * (state.time + stop);
        let is_sure = inside >= looked_for + FOR_SURE * (next - state.time);
        if !is_sure {
            task.forcing.follow_time(inside, &mut self.pieces);
        }
        let start = method.instant(state);
        task.forcing.follow_motion(start, &mut self.pieces);
        self.holding = if is_sure && task.forcing.is_timed() {
            inside..next
        } else {
            0.0..0.0
        };
        stop
    }
}
