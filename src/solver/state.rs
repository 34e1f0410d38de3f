//! Everything that moves.

use serde::{Deserialize, Serialize};

use super::control::Control;
use super::exponential::Turning;

/// Everything that moves: what a snapshot has to keep so that the continuation is the same to the bit.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct State {
    /// Time [s].
    pub time: f64,
    /// q: the best value the solver has.
    pub position: Vec<f64>,
    /// q'.
    pub velocity: Vec<f64>,
    /// The solutions of Newmark's method, from which that value comes; none for the other one.
    pub(super) tracks: Vec<Track>,
    /// The same motion in the decoupled states of the exponential method.
    pub(super) decoupled: Vec<[f64; 4]>,
    /// Whether these say how it moves: not before the first step, nor when displacements and velocities are to be taken apart
    /// anew.
    pub(super) is_decoupled: bool,
    /// Where that method has turned the harmonics.
    pub(super) turning: Turning,
    /// The slow parameters that the blocks in use belong to.
    pub(super) slow: Vec<f64>,
    pub(super) control: Control,
}

/// One numerical solution.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(super) struct Track {
    pub(super) position: Vec<f64>,
    pub(super) velocity: Vec<f64>,
}

impl State {
    /// Cosine and sine of the angle of a harmonic at the state's time, where the solver has them.
    pub fn turned(&self, harmonic: usize) -> Option<[f64; 2]> {
        self.turning.at(harmonic)
    }

    /// Whether another state has the same shape and consists of finite numbers.
    pub fn is_like(&self, other: &State) -> bool {
        let lengths = |state: &State| {
            let tracks = state.tracks.iter();
            let own = [state.position.len(), state.velocity.len()];
            let own = own
                .into_iter()
                .chain([state.decoupled.len(), state.slow.len()]);
            let control = state.control.lengths();
            tracks
                .flat_map(|track| [track.position.len(), track.velocity.len()])
                .chain(own)
                .chain(control)
                .collect::<Vec<usize>>()
        };
        let tracks = self
            .tracks
            .iter()
            .flat_map(|track| track.position.iter().chain(&track.velocity));
        let numbers = tracks
            .chain(&self.position)
            .chain(&self.velocity)
            .chain(self.decoupled.as_flattened())
            .chain(&self.slow);
        lengths(self) == lengths(other)
            && self.turning.is_like(&other.turning)
            && self.time.is_finite()
            && numbers.copied().all(f64::is_finite)
            && self.control.is_valid()
    }

    /// Becomes the same as another state of the same system, without allocation.
    pub fn copy_from(&mut self, other: &State) {
        self.time = other.time;
        self.position.clone_from(&other.position);
        self.velocity.clone_from(&other.velocity);
        self.decoupled.clone_from(&other.decoupled);
        self.is_decoupled = other.is_decoupled;
        self.turning.copy_from(&other.turning);
        self.slow.clone_from(&other.slow);
        self.control.copy_from(&other.control);
        copy_tracks(&mut self.tracks, &other.tracks);
    }
}

/// Copies solutions without allocation, which the derived `clone_from` would need.
pub(super) fn copy_tracks(target: &mut [Track], source: &[Track]) {
    for (target, source) in target.iter_mut().zip(source) {
        target.position.clone_from(&source.position);
        target.velocity.clone_from(&source.velocity);
    }
}
