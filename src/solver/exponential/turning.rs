//! Where the harmonics are in their turns.
//!
//! ```text
//!   e^(i (w (t + h) + phase)) = e^(i (w t + phase)) e^(i w h)
//! ```
//!
//! A product instead of sine and cosine. It is part of the state: every few steps the angles are computed anew from the
//! time, before rounding adds up, and a restored solution has to do so at the same steps. What else adds up is then found anew, too.

use nalgebra::Complex;
use serde::{Deserialize, Serialize};

use super::super::Harmonic;
use super::lanes::Quad;

/// Steps after which the angles are computed anew.
const MOST_TURNS: u32 = 64;

/// e^(i angle) of every harmonic.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub(in super::super) struct Turning {
    /// Cosine and sine of each.
    pub(super) angles: Vec<[f64; 2]>,
    /// Steps since they were computed.
    turns: u32,
}

impl Turning {
    /// Of so many harmonics, at no time yet.
    pub(super) fn unknown(harmonics: usize) -> Turning {
        Turning {
            angles: vec![[0.0; 2]; harmonics],
            turns: MOST_TURNS,
        }
    }

    /// Whether it is time to find anew what has added up.
    pub(super) fn is_due(&self) -> bool {
        self.turns >= MOST_TURNS
    }

    /// Computes the angles from the time where it is due.
    pub(super) fn find(&mut self, harmonics: &[Harmonic], time: f64) {
        if !self.is_due() {
            return;
        }
        self.turns = 0;
        for (angle, harmonic) in self.angles.iter_mut().zip(harmonics) {
            let (sine, cosine) = libm::sincos(harmonic.angle(time));
            *angle = [cosine, sine];
        }
    }

    /// Cosine and sine of the angles of two harmonics, each four times.
    #[inline(always)]
    pub(super) fn of_both(&self, harmonics: [usize; 2]) -> [Quad; 4] {
        let [[a, b], [c, d]] = harmonics.map(|harmonic| self.angles[harmonic]);
        [[a; 4], [b; 4], [c; 4], [d; 4]]
    }

    /// Turns the angles to the end of a step, which is by `excess` longer than the one of the rotations.
    pub(super) fn turn(&mut self, harmonics: &[Harmonic], rotations: &[Complex<f64>], excess: f64) {
        let both = harmonics.iter().zip(rotations);
        for ([cosine, sine], (harmonic, rotation)) in self.angles.iter_mut().zip(both) {
            // e^(i w excess) = 1 + i w excess: rounded lengths differ by 1e-9.
            let more = harmonic.frequency * excess;
            let (c, s) = (
                rotation.re - more * rotation.im,
                rotation.im + more * rotation.re,
            );
            (*cosine, *sine) = (*cosine * c - *sine * s, *cosine * s + *sine * c);
        }
        self.turns += 1;
    }

    /// Cosine and sine of a harmonic's angle at the state's time; `None` before the first step.
    pub(in super::super) fn at(&self, harmonic: usize) -> Option<[f64; 2]> {
        let angle = self.angles.get(harmonic).copied();
        angle.filter(|angle| *angle != [0.0; 2])
    }

    /// Whether another one has as many, and all of them are numbers.
    pub(in super::super) fn is_like(&self, other: &Turning) -> bool {
        self.angles.len() == other.angles.len()
            && self
                .angles
                .as_flattened()
                .iter()
                .all(|part| part.is_finite())
    }

    /// Becomes the same as another one, without allocation.
    pub(in super::super) fn copy_from(&mut self, other: &Turning) {
        self.angles.clone_from(&other.angles);
        self.turns = other.turns;
    }
}
