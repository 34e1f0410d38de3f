//! What drives the gear train in time: the laws of meshes, bearings and free rotations, in the words of the solver.
//!
//! ```text
//!   f(t) = inputs + sum over harmonics of c cos(w t + phi) + s sin(w t + phi)
//!   unbalance   F_x = m e Om^2 cos(phi + d),  F_y = m e Om^2 sin(phi + d),   phi = phi_0 + Om t
//!   bow         Phi'K_s r cos(phi + psi),     Phi'K_s r sin(phi + psi)
//! ```
//!
//! In free spin unbalance and bow follow the state instead ([`super::spin`]).

use super::radial::RadialBearing;
use super::{BaseMotion, Course, ModalModel, Rotor};
use crate::rotor::BowLoad;
use crate::solver::{Block, Forcing, Harmonic, Instant, Lines, Piece, Ramp, Spring};
use crate::train;

use super::spin::Spin;

/// The forcing of a model under a course of its inputs.
#[derive(Debug, Clone, Copy)]
pub struct Excitation<'a> {
    model: &'a ModalModel,
    course: Course<'a>,
    /// What the inputs exert along the system's columns.
    loads: &'a [Ramp],
}

impl<'a> Excitation<'a> {
    /// The forcing of `model` under inputs, which exert `loads` (see [`Course::loads_into`]).
    pub fn new(model: &'a ModalModel, course: Course<'a>, loads: &'a [Ramp]) -> Excitation<'a> {
        Excitation {
            model,
            course,
            loads,
        }
    }

    /// Overwrites all forces, and the tangents of springs where these are wanted.
    fn answer(
        &self,
        at: Instant<'_>,
        pieces: &[Piece],
        forces: &mut [f64],
        mut tangents: Option<&mut [Spring]>,
    ) {
        for mesh in &self.model.meshes {
            mesh.forces_into(at, pieces, forces, tangents.as_deref_mut());
        }
        if self.model.is_straight {
            return;
        }
        let vibration = self.model.vibration.motion(at.time);
        let base = |input| self.course.base(input, at.time).plus(&vibration);
        for bearing in &self.model.radial {
            let tangents = tangents.as_deref_mut();
            bearing.forces_into(at, &base(bearing.input), pieces, forces, tangents);
        }
        for spin in &self.model.spins {
            let load = |number: usize| self.loads[number].after(at.time - self.course.since);
            spin.forces_into(at, load, base, forces);
        }
    }

    /// Motion of the gearbox at a bearing.
    fn base(&self, input: usize, time: f64) -> BaseMotion {
        let vibration = self.model.vibration.motion(time);
        self.course.base(input, time).plus(&vibration)
    }

    /// The bearing whose law has this number.
    fn radial(&self, law: usize) -> Option<&RadialBearing> {
        self.model.radial.iter().find(|bearing| bearing.law == law)
    }
}

/// Unbalance and bow of a rotor turn with it at prescribed speed.
pub(super) fn rotating_load(
    rotor: &train::Rotor,
    modal: &Rotor,
    bows: &[BowLoad],
) -> Option<Harmonic> {
    let n = modal.counts.lateral;
    let mut harmonic = Harmonic {
        frequency: rotor.speed,
        phase: rotor.angle,
        cosine: vec![0.0; 2 * n],
        sine: vec![0.0; 2 * n],
        offset: modal.lateral.range().start,
    };
    let mut add = |load: &[f64], factor: f64, phase: f64| {
        let (sine, cosine) = libm::sincos(phase);
        for (i, &load) in load.iter().enumerate() {
            // cos(phi + d) and sin(phi + d), expanded.
            harmonic.cosine[i] += factor * cosine * load;
            harmonic.sine[i] -= factor * sine * load;
            harmonic.cosine[n + i] += factor * sine * load;
            harmonic.sine[n + i] += factor * cosine * load;
        }
    };
    for (unbalance, row) in rotor.unbalances.iter().zip(&modal.unbalances) {
        add(
            row,
            unbalance.moment * rotor.speed * rotor.speed,
            unbalance.phase,
        );
    }
    for bow in bows {
        add(&bow.load, 1.0, bow.phase);
    }
    let mut entries = harmonic.cosine.iter().chain(&harmonic.sine);
    entries.any(|&value| value != 0.0).then_some(harmonic)
}

impl Forcing for Excitation<'_> {
    fn loads(&self) -> &[Ramp] {
        self.loads
    }

    fn since(&self) -> f64 {
        self.course.since
    }

    fn harmonics(&self) -> &[Harmonic] {
        &self.model.harmonics
    }

    fn follow_time(&self, time: f64, pieces: &mut [Piece]) -> f64 {
        let mut first = f64::INFINITY;
        for mesh in &self.model.meshes {
            let end = mesh.follow_time(time, pieces);
            if end < first {
                first = end;
            }
        }
        first
    }

    fn follow_motion(&self, start: Instant<'_>, pieces: &mut [Piece]) {
        if self.model.is_timed {
            return;
        }
        for mesh in &self.model.meshes {
            mesh.follow_motion(start, pieces);
        }
        for bearing in &self.model.radial {
            let base = self.base(bearing.input, start.time);
            pieces[bearing.law] = bearing.piece(start, &base);
        }
    }

    fn slack(&self, tolerance: f64) -> f64 {
        self.model.slack * tolerance.sqrt().sqrt()
    }

    fn forces_into(&self, at: Instant<'_>, pieces: &[Piece], forces: &mut [f64]) {
        self.answer(at, pieces, forces, None);
    }

    fn springs_into(
        &self,
        at: Instant<'_>,
        pieces: &[Piece],
        forces: &mut [f64],
        tangents: &mut [Spring],
    ) {
        tangents.fill(Spring::default());
        self.answer(at, pieces, forces, Some(tangents));
    }

    fn is_straight(&self) -> bool {
        self.model.is_straight
    }

    #[inline(always)] // into the loops over states, with their vectors
    fn lines_into<const N: usize>(
        &self,
        times: [f64; N],
        pieces: &[Piece],
        lines: &mut [Lines<N>],
    ) {
        for mesh in &self.model.meshes {
            mesh.lines_into(times, pieces, lines);
        }
    }

    fn is_timed(&self) -> bool {
        self.model.is_timed
    }

    fn margin(&self, law: usize, piece: Piece, at: Instant<'_>) -> f64 {
        if let Some((mesh, own)) = self.model.mesh_of_law(law) {
            return mesh.margin(own, piece, at);
        }
        self.radial(law).map_or(f64::INFINITY, |bearing| {
            let base = self.base(bearing.input, at.time);
            bearing.margin(piece, at, &base)
        })
    }

    fn next_piece(&self, law: usize, piece: Piece, at: Instant<'_>) -> Piece {
        match self.model.mesh_of_law(law) {
            Some((mesh, own)) => mesh.next_piece(own, piece, at),
            None => RadialBearing::next_piece(piece),
        }
    }

    fn slow_into(&self, rates: &[f64], slow: &mut [f64]) {
        for (spin, slow) in self.model.spins.iter().zip(slow) {
            *slow = rates[spin.turn];
        }
    }

    fn is_stale(&self, used: &[f64], now: &[f64]) -> bool {
        used.iter()
            .zip(now)
            .any(|(&used, &now)| Spin::is_stale(used, now))
    }

    fn blocks_into(&self, slow: &[f64], blocks: &mut [Block]) {
        self.model.lateral_blocks_at(slow, blocks);
    }
}
