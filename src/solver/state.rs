//! Everything that moves.

use serde::{Deserialize, Serialize};

use super::System;
use super::control::Control;
use super::exponential::Turning;
use super::pose::Pose;

/// Everything that moves: what a snapshot has to keep so that the continuation is the same to the bit.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct State {
    /// Time [s].
    pub time: f64,
    /// The best displacements and velocities that the solver has.
    pub(super) pose: Pose,
    /// What the couplings see there: d and d'.
    pub(super) seen: [Vec<f64>; 2],
    /// The readings of the system there.
    pub(super) readings: Vec<f64>,
    /// The solutions of Newmark's method, from which these values come; none for the other one.
    pub(super) tracks: Vec<Track>,
    /// Where the exponential method has turned the harmonics.
    pub(super) turning: Turning,
    /// The slow parameters that the blocks in use belong to.
    pub(super) slow: Vec<f64>,
    pub(super) control: Control,
}

/// One numerical solution.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct Track {
    pub(super) position: Vec<f64>,
    pub(super) velocity: Vec<f64>,
}

impl State {
    /// q, put together when first asked for.
    pub fn position(&self) -> &[f64] {
        &self.pose.whole().position
    }

    /// q', likewise.
    pub fn velocity(&self) -> &[f64] {
        &self.pose.whole().velocity
    }

    /// d and d' of a coupling.
    pub fn seen(&self, coupling: usize) -> [f64; 2] {
        let [deflection, rate] = &self.seen;
        [deflection[coupling], rate[coupling]]
    }

    /// The value of [`System::readings`] number `reading`.
    pub fn reading(&self, reading: usize) -> f64 {
        self.readings[reading]
    }

    /// Cosine and sine of the angle of a harmonic, where the solver has them.
    pub fn turned(&self, harmonic: usize) -> Option<[f64; 2]> {
        self.turning.at(harmonic)
    }

    /// Reads off what follows from displacements and velocities.
    pub(super) fn read_off(&mut self, system: &System) {
        let Track { position, velocity } = self.pose.whole();
        let [deflection, rate] = &mut self.seen;
        system.deflections_into(position, velocity, deflection, rate);
        for (value, reading) in self.readings.iter_mut().zip(&system.readings) {
            *value = reading.position.dot(position) + reading.velocity.dot(velocity);
        }
    }

    /// Whether another state has the same shape and consists of finite numbers.
    pub fn is_like(&self, other: &State) -> bool {
        let lengths = |state: &State| {
            let tracks = state.tracks.iter();
            let [deflection, rate] = &state.seen;
            let own = [deflection, rate, &state.readings, &state.slow].map(Vec::len);
            tracks
                .flat_map(|track| [track.position.len(), track.velocity.len()])
                .chain(own)
                .chain(state.pose.lengths())
                .chain(state.control.lengths())
                .collect::<Vec<usize>>()
        };
        let tracks = self
            .tracks
            .iter()
            .flat_map(|track| track.position.iter().chain(&track.velocity));
        let mut numbers = tracks
            .chain(self.seen.iter().flatten())
            .chain(&self.readings)
            .chain(&self.slow);
        lengths(self) == lengths(other)
            && self.turning.is_like(&other.turning)
            && self.time.is_finite()
            && self.pose.is_finite()
            && numbers.all(|number| number.is_finite())
            && self.control.is_valid()
    }

    /// Becomes the same as another state of the same system, without allocation.
    pub fn copy_from(&mut self, other: &State) {
        self.time = other.time;
        self.pose.copy_from(&other.pose);
        for (target, source) in self.seen.iter_mut().zip(&other.seen) {
            target.clone_from(source);
        }
        self.readings.clone_from(&other.readings);
        self.turning.copy_from(&other.turning);
        self.slow.clone_from(&other.slow);
        self.control.copy_from(&other.control);
        copy_tracks(&mut self.tracks, &other.tracks);
    }
}

impl Track {
    /// Becomes the same as another one without allocation, which the derived `clone_from` would need.
    pub(super) fn copy_from(&mut self, other: &Track) {
        self.position.clone_from(&other.position);
        self.velocity.clone_from(&other.velocity);
    }
}

/// The same for several solutions.
pub(super) fn copy_tracks(target: &mut [Track], source: &[Track]) {
    for (target, source) in target.iter_mut().zip(source) {
        target.copy_from(source);
    }
}
