//! `[[mesh]]` as plain data.

use serde::{Deserialize, Serialize};

use super::ToothGeometry;

/// `[[mesh]]`: two gears in contact.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Mesh {
    /// Unique identifier.
    pub name: String,
    /// The gears a and b as `rotor.gear`.
    pub gears: [String; 2],
    /// Direction psi from the centre of a to the centre of b [rad].
    pub center_angle: f64,
    /// Operating pressure angle [rad]. (0, pi/2)
    pub pressure_angle: f64,
    /// Whether b is a ring around a.
    pub internal: bool,
    /// Sign of the torque that drives a through the mesh.
    pub flank: Flank,
    /// Mesh phase p0 at zero rotation angle, in tooth pitches; absent: from geometry.
    pub phase: Option<f64>,
    /// Damping of the tooth contact.
    pub damping: MeshDamping,
    /// Whether the teeth can part.
    pub contact: Contact,
    /// Distance that the back flank of a unilateral contact has to travel along its normal [m]. >= 0
    pub backlash: f64,
    /// Which motions the mesh torque follows.
    pub torque_coupling: TorqueCoupling,
    /// Stiffness over the mesh phase.
    pub stiffness: MeshStiffness,
    /// Scales the stiffness law.
    pub stiffness_factor: f64,
    /// Harmonics of the unloaded static transmission error.
    pub transmission_error: Vec<ErrorHarmonic>,
}

/// `[[mesh.transmission_error]]`: amplitude cos(2 pi order p + phase), p the mesh phase.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct ErrorHarmonic {
    /// Periods per tooth pitch. [1, 100]
    pub order: usize,
    /// Amplitude [m]; positive is relief on the reference flank.
    pub amplitude: f64,
    /// Phase [rad].
    pub phase: f64,
}

/// The flank that carries the load: the sign s of the torque that drives gear a through the mesh.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Flank {
    /// s = +1.
    Positive,
    /// s = -1.
    Negative,
}

/// Damping of the tooth contact.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub enum MeshDamping {
    /// Fraction zeta of the critical damping of the gear pair alone. >= 0
    Ratio(f64),
    /// Coefficient c [N s/m]. >= 0
    Coefficient(f64),
}

/// Whether the teeth can part.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Contact {
    /// The teeth hold on to each other: linear, as in the paper.
    Bilateral,
    /// The teeth press only, on either flank.
    Unilateral,
}

/// Which motions the mesh torque follows.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum TorqueCoupling {
    /// The same tooth deflection as the forces: one potential, action = reaction.
    Consistent,
    /// Equation (6) of the paper taken literally: rotations only. For comparison with the paper.
    AsPrinted,
}

/// `[mesh.stiffness]`: stiffness over the mesh phase, one tooth pitch being one period.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum MeshStiffness {
    /// The same at every phase.
    Constant {
        /// Stiffness [N/m]. > 0
        mean: f64,
    },
    /// Steps between the numbers of tooth pairs in contact.
    Rectangular {
        /// Stiffness with floor(contact ratio) pairs [N/m]. > 0
        fewer_pairs: f64,
        /// Stiffness with one pair more [N/m]. >= that
        more_pairs: f64,
        /// Mean number of tooth pairs in contact. >= 1
        contact_ratio: f64,
    },
    /// Harmonics of the tooth pitch: mean (1 + sum of cosine_i cos 2 pi i p + sine_i sin 2 pi i p).
    Fourier {
        /// Mean stiffness [N/m]. > 0
        mean: f64,
        /// Cosine coefficients of the orders 1, 2, ..., relative to the mean.
        cosine: Vec<f64>,
        /// Sine coefficients of the orders 1, 2, ..., relative to the mean.
        sine: Vec<f64>,
    },
    /// Linear between points, periodic; a phase given twice is a jump.
    Table {
        /// Mesh phases in pitches, ascending. [0, 1)
        phase: Vec<f64>,
        /// Stiffness at each of them [N/m]. > 0
        value: Vec<f64>,
    },
    /// Sum over the engaged pairs of what follows from the shape of the teeth.
    ToothGeometry(ToothGeometry),
    /// Sum over the engaged pairs of a polynomial with smooth ends.
    ToothPair {
        /// Stiffness of one pair at mid contact [N/m]. > 0
        pair: f64,
        /// Relative loss at the ends of contact, quadratic term.
        quadratic: f64,
        /// Relative loss at the ends of contact, quartic term.
        quartic: f64,
        /// Length over which a pair takes and leaves its load, in pitches. >= 0
        ramp: f64,
        /// Mean number of tooth pairs in contact. >= 1
        contact_ratio: f64,
    },
}

impl Flank {
    /// The sign s.
    pub fn sign(self) -> f64 {
        match self {
            Flank::Positive => 1.0,
            Flank::Negative => -1.0,
        }
    }
}
