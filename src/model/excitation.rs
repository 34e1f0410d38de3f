//! What drives the gear train: inputs, unbalance, gearbox vibration, and the passing of the teeth.
//!
//! ```text
//!   f(t) = sum over torques of T w_th  +  sum over bearings of w' (K u_b + C u_b')
//!        + sum over harmonics of c cos(w t + phi) + s sin(w t + phi)
//!   unbalance          F_x = m e Om^2 cos(phi + d),  F_y = m e Om^2 sin(phi + d),   phi = phi_0 + Om t
//!   gearbox vibration  x_b = a_x sin(w t),  y_b = a_y sin(w t + psi)    at every bearing
//!   mesh phase         p = s z_a phi_a / 2 pi + p_0
//! ```

use core::f64::consts::TAU;

use super::{Bearing, Mesh, ModalModel, Rotor};
use crate::config::{GearboxVibration, Planar};
use crate::solver::{Forcing, Piece, Spring};
use crate::train::GearTrain;

/// Everything a master sets while the simulation runs, held between communication points.
#[derive(Debug, Clone, PartialEq)]
pub struct Inputs {
    /// External torques [N m], in the order of [`ModalModel::torques`].
    pub torques: Vec<f64>,
    /// Gearbox motion, in the order of [`ModalModel::bearings`].
    pub bases: Vec<BaseMotion>,
}

/// Motion of the gearbox at one bearing.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct BaseMotion {
    /// Displacement in x and y [m].
    pub displacement: [f64; 2],
    /// Velocity in x and y [m/s].
    pub velocity: [f64; 2],
}

/// The sinusoidal motion of all supports.
#[derive(Debug, Clone)]
pub(super) struct SupportVibration {
    amplitude: [f64; 2],
    phase: [f64; 2],
    /// Circular frequency [rad/s].
    frequency: f64,
}

/// A load that turns with a fixed circular frequency.
#[derive(Debug, Clone)]
pub(super) struct Harmonic {
    frequency: f64,
    phase: f64,
    cosine: Vec<f64>,
    sine: Vec<f64>,
    /// First coordinate of both.
    offset: usize,
}

/// The forcing of a model under given inputs.
#[derive(Debug, Clone)]
pub struct Excitation<'a> {
    model: &'a ModalModel,
    /// The part of f that the inputs hold.
    held: &'a [f64],
}

impl Inputs {
    /// No gearbox motion, and the given torques.
    pub fn at_rest(torques: Vec<f64>, bearings: usize) -> Inputs {
        Inputs {
            torques,
            bases: vec![BaseMotion::default(); bearings],
        }
    }

    /// The generalized load of the inputs: overwrites `load`.
    pub fn load_into(&self, model: &ModalModel, load: &mut [f64]) {
        load.fill(0.0);
        for (row, &torque) in model.torques().zip(&self.torques) {
            row.add_to(torque, load);
        }
        for (bearing, base) in model.bearings().zip(&self.bases) {
            bearing.base_load(base, load);
        }
    }
}

impl Bearing {
    /// load += w' (K u_b + C u_b').
    fn base_load(&self, base: &BaseMotion, load: &mut [f64]) {
        let spring = product(&self.stiffness, base.displacement);
        let damper = product(&self.damping, base.velocity);
        self.station.x.add_to(spring[0] + damper[0], load);
        self.station.y.add_to(spring[1] + damper[1], load);
    }
}

/// K u or C u'.
pub(super) fn product(matrix: &Planar, motion: [f64; 2]) -> [f64; 2] {
    matrix
        .rows()
        .map(|[per_x, per_y]| per_x * motion[0] + per_y * motion[1])
}

impl SupportVibration {
    pub(super) fn new(vibration: &GearboxVibration) -> SupportVibration {
        SupportVibration {
            amplitude: [vibration.amplitude_x, vibration.amplitude_y],
            phase: [0.0, vibration.phase_y],
            frequency: TAU * vibration.frequency,
        }
    }

    /// Motion of every support at `time`.
    pub(super) fn motion(&self, time: f64) -> BaseMotion {
        let angle = self.frequency * time;
        self.at_angles(self.phase.map(|phase| angle + phase))
    }

    fn at_angles(&self, angles: [f64; 2]) -> BaseMotion {
        let mut motion = BaseMotion::default();
        for (axis, angle) in angles.into_iter().enumerate() {
            let (sine, cosine) = libm::sincos(angle);
            motion.displacement[axis] = self.amplitude[axis] * sine;
            motion.velocity[axis] = self.amplitude[axis] * self.frequency * cosine;
        }
        motion
    }

    /// The load of the vibration through all bearings: its values at angle 0 and at a quarter turn.
    pub(super) fn harmonic(&self, rotors: &[Rotor], size: usize) -> Option<Harmonic> {
        if self.amplitude == [0.0, 0.0] {
            return None;
        }
        let load_at = |angle: f64| {
            let mut load = vec![0.0; size];
            let motion = self.at_angles(self.phase.map(|phase| angle + phase));
            for bearing in rotors.iter().flat_map(|rotor| &rotor.bearings) {
                bearing.base_load(&motion, &mut load);
            }
            load
        };
        Some(Harmonic {
            frequency: self.frequency,
            phase: 0.0,
            cosine: load_at(0.0),
            sine: load_at(TAU / 4.0),
            offset: 0,
        })
    }
}

/// The unbalances of each rotor turn with it.
pub(super) fn unbalance_harmonics(train: &GearTrain, rotors: &[Rotor]) -> Vec<Harmonic> {
    let mut harmonics = Vec::new();
    for (rotor, modal) in train.rotors.iter().zip(rotors) {
        let n = modal.counts.lateral;
        let mut harmonic = Harmonic {
            frequency: rotor.speed,
            phase: rotor.angle,
            cosine: vec![0.0; 2 * n],
            sine: vec![0.0; 2 * n],
            offset: modal.offset,
        };
        for (unbalance, row) in rotor.unbalances.iter().zip(&modal.unbalances) {
            let force = unbalance.moment * rotor.speed * rotor.speed;
            let (sine, cosine) = libm::sincos(unbalance.phase);
            for (i, &shape) in row.iter().enumerate() {
                // cos(phi + d) and sin(phi + d), expanded.
                harmonic.cosine[i] += force * cosine * shape;
                harmonic.sine[i] -= force * sine * shape;
                harmonic.cosine[n + i] += force * sine * shape;
                harmonic.sine[n + i] += force * cosine * shape;
            }
        }
        if harmonic
            .cosine
            .iter()
            .chain(&harmonic.sine)
            .any(|&value| value != 0.0)
        {
            harmonics.push(harmonic);
        }
    }
    harmonics
}

impl<'a> Excitation<'a> {
    /// The forcing of `model` while the inputs hold the load `held` (see [`Inputs::load_into`]).
    pub fn new(model: &'a ModalModel, held: &'a [f64]) -> Excitation<'a> {
        Excitation { model, held }
    }
}

impl Forcing for Excitation<'_> {
    fn load_into(&self, time: f64, load: &mut [f64]) {
        load.copy_from_slice(self.held);
        for harmonic in &self.model.harmonics {
            let (sine, cosine) = libm::sincos(harmonic.frequency * time + harmonic.phase);
            let target = &mut load[harmonic.offset..];
            for ((entry, c), s) in target.iter_mut().zip(&harmonic.cosine).zip(&harmonic.sine) {
                *entry += c * cosine + s * sine;
            }
        }
    }

    fn next_breakpoint(&self, time: f64) -> f64 {
        let next = self
            .model
            .meshes
            .iter()
            .map(|mesh| mesh.next_breakpoint(time));
        next.fold(f64::INFINITY, f64::min)
    }

    fn pieces_into(&self, time: f64, pieces: &mut [Piece]) {
        for (piece, &mesh) in pieces.iter_mut().zip(&self.model.coupling_mesh) {
            *piece = self.model.meshes[mesh].piece(time);
        }
    }

    fn spring(&self, coupling: usize, piece: Piece, time: f64) -> Spring {
        let mesh = &self.model.meshes[self.model.coupling_mesh[coupling]];
        Spring {
            stiffness: mesh.stiffness_in(piece, time),
            damping: mesh.damping,
        }
    }
}

/// Breakpoints closer than this [pitches] to the present phase are behind, and closer than rounding of the
/// phase, which grows over a long run.
const PASSED: f64 = 1e-9;

impl Mesh {
    /// The smooth piece of the law that `time` lies in.
    fn piece(&self, time: f64) -> Piece {
        self.piece_of(self.phase(time))
    }

    /// The smooth piece that holds from `time` on.
    pub(super) fn piece_ahead(&self, time: f64) -> Piece {
        self.piece_of(self.phase_ahead(time))
    }

    fn piece_of(&self, phase: f64) -> Piece {
        let origin = phase.floor();
        Piece {
            origin,
            index: self.law.piece(phase - origin),
        }
    }

    /// The phase a moment later, beyond a breakpoint that has just been reached.
    fn phase_ahead(&self, time: f64) -> f64 {
        let phase = self.phase(time);
        phase + self.phase_rate.signum() * PASSED.max(8.0 * f64::EPSILON * phase.abs())
    }

    fn next_breakpoint(&self, time: f64) -> f64 {
        if self.law.is_smooth() || self.phase_rate == 0.0 {
            return f64::INFINITY;
        }
        let Piece { origin, index } = self.piece_ahead(time);
        let starts = self.law.starts();
        let next = if self.phase_rate > 0.0 {
            starts.get(index + 1).copied().unwrap_or(1.0)
        } else {
            starts[index]
        };
        (origin + next - self.start_phase) / self.phase_rate
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::config::TorqueCoupling;
    use crate::mesh::{LineOfAction, StiffnessLaw};
    use crate::solver::Row;
    use crate::train::GearAddress;

    fn mesh(phase_rate: f64) -> Mesh {
        Mesh {
            gears: [GearAddress { rotor: 0, gear: 0 }; 2],
            row: Row::default(),
            rotation_row: Row::default(),
            line: LineOfAction::external(0.0, 0.3, 1.0, 1.0, 1.0),
            torque_coupling: TorqueCoupling::Consistent,
            damping: 0.0,
            law: StiffnessLaw::rectangular(1.0, 2.0, 1.6),
            factor: 1.0,
            start_phase: 0.25,
            phase_rate,
        }
    }

    #[test]
    fn breakpoints_follow_each_other_in_either_direction() {
        // Phase 0.25 + rate t reaches 0.6, 1.0, 1.6 upwards and 0.0, -0.4, -1.0 downwards.
        for (rate, phases) in [(10.0, [0.6, 1.0, 1.6]), (-10.0, [0.0, -0.4, -1.0])] {
            let (mesh, mut time) = (mesh(rate), 0.0);
            for phase in phases {
                time = mesh.next_breakpoint(time);
                assert!((mesh.phase(time) - phase).abs() < 1e-12, "rounding only");
            }
        }
    }

    #[test]
    fn breakpoints_never_repeat_however_long_the_run() {
        for start in [0.0, 1e3, 1e6, 1e9, -1e6] {
            let (mesh, mut time) = (mesh(1800.0), start);
            for _ in 0..20 {
                let next = mesh.next_breakpoint(time);
                assert!(next > time, "{next} after {time}");
                time = next;
            }
        }
    }

    #[test]
    fn a_piece_is_continued_to_both_of_its_ends() {
        for rate in [10.0, -10.0] {
            let mesh = mesh(rate);
            let first = mesh.next_breakpoint(0.0);
            let second = mesh.next_breakpoint(first);
            let before = mesh.piece(0.5 * first);
            let after = mesh.piece(0.5 * (first + second));
            let value = |piece: Piece| {
                mesh.law
                    .value(mesh.phase(first) - piece.origin, piece.index)
            };
            assert_ne!(value(before), value(after));
        }
    }
}
