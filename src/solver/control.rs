//! What the control of the step length remembers from step to step.

use serde::{Deserialize, Serialize};

/// Memory of the step control; one entry per monitor in each list.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(super) struct Control {
    /// Step that the last error estimates ask for [s]; 0 before the first step.
    pub(super) wanted_step: f64,
    /// Time over which the mean squares run [s].
    pub(super) elapsed: f64,
    /// Time integral of the square of what is monitored.
    pub(super) squares: Vec<f64>,
    /// Recent peaks of two derivatives of what is monitored, where the method needs them.
    pub(super) peaks: Vec<[f64; 2]>,
}

impl Control {
    /// Nothing remembered.
    pub(super) fn new(monitors: usize) -> Control {
        Control {
            wanted_step: 0.0,
            elapsed: 0.0,
            squares: vec![0.0; monitors],
            peaks: vec![[0.0; 2]; monitors],
        }
    }

    /// Lengths of the lists.
    pub(super) fn lengths(&self) -> [usize; 2] {
        [self.squares.len(), self.peaks.len()]
    }

    /// Whether all numbers are finite and none is negative.
    pub(super) fn is_valid(&self) -> bool {
        let numbers = self.squares.iter().chain(self.peaks.iter().flatten());
        let mut numbers = numbers.chain([&self.wanted_step, &self.elapsed]);
        numbers.all(|number| number.is_finite() && *number >= 0.0)
    }

    /// Becomes the same as another one of the same system, without allocation.
    pub(super) fn copy_from(&mut self, other: &Control) {
        self.wanted_step = other.wanted_step;
        self.elapsed = other.elapsed;
        self.squares.clone_from(&other.squares);
        self.peaks.clone_from(&other.peaks);
    }
}
