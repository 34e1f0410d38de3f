//! Bearings with a radial force that is not proportional to the displacement.
//!
//! ```text
//!   r = |u - u_b|,   F_r = C max(0, r - clearance)^n,   force on the rotor -F_r (u - u_b) / r
//! ```
//!
//! n = 1 is a spring behind a clearance, 3 a cubic spring, 10/9 or 3/2 the contact of rollers or balls (Hertz).

use super::BaseMotion;
use crate::config::RadialForce;
use crate::solver::{Instant, Piece, Spring};

/// Shaft and bearing apart, and in contact: pieces of the law.
const APART: usize = 0;
const TOUCHING: usize = 1;

/// A radial force between shaft and gearbox, in addition to the linear bearing.
#[derive(Debug, Clone)]
pub struct RadialBearing {
    /// The bearing's place among the inputs.
    pub(super) input: usize,
    /// The block that it holds.
    pub(super) block: usize,
    /// Its law.
    pub(super) force: RadialForce,
    /// The couplings of x and y are this one and the next.
    pub(super) first_coupling: usize,
    /// The number of its law among all with pieces.
    pub(super) law: usize,
}

impl RadialBearing {
    /// Displacement of the shaft relative to the gearbox [m].
    fn relative(&self, at: Instant<'_>, base: &BaseMotion) -> [f64; 2] {
        [0, 1].map(|axis| at.deflection[self.first_coupling + axis] - base.displacement[axis])
    }

    /// Overwrites the forces of the two couplings.
    pub(super) fn forces_into(
        &self,
        at: Instant<'_>,
        base: &BaseMotion,
        pieces: &[Piece],
        forces: &mut [f64],
    ) {
        let [x, y] = self.relative(at, base);
        let touching = pieces[self.law].index == TOUCHING;
        let secant = if touching {
            secant(&self.force, libm::hypot(x, y))
        } else {
            0.0
        };
        forces[self.first_coupling] = secant * x;
        forces[self.first_coupling + 1] = secant * y;
    }

    /// Overwrites the tangents of the two couplings.
    pub(super) fn tangents_into(
        &self,
        at: Instant<'_>,
        base: &BaseMotion,
        pieces: &[Piece],
        tangents: &mut [Spring],
    ) {
        let motion = self.relative(at, base);
        let radius = libm::hypot(motion[0], motion[1]);
        let touching = pieces[self.law].index == TOUCHING && radius > 0.0;
        for (tangent, part) in tangents[self.first_coupling..][..2].iter_mut().zip(motion) {
            let along = (part / radius) * (part / radius);
            let stiffness = if touching {
                let (secant, slope) = (secant(&self.force, radius), slope(&self.force, radius));
                slope * along + secant * (1.0 - along)
            } else {
                0.0
            };
            *tangent = Spring {
                stiffness,
                damping: 0.0,
            };
        }
    }

    /// The piece in a motion.
    pub(super) fn piece(&self, at: Instant<'_>, base: &BaseMotion) -> Piece {
        let [x, y] = self.relative(at, base);
        let touching = self.force.clearance == 0.0 || libm::hypot(x, y) > self.force.clearance;
        Piece {
            origin: 0.0,
            index: if touching { TOUCHING } else { APART },
        }
    }

    /// Positive while the motion keeps the law in its piece [m].
    pub(super) fn margin(&self, piece: Piece, at: Instant<'_>, base: &BaseMotion) -> f64 {
        if self.force.clearance == 0.0 {
            return f64::INFINITY;
        }
        let [x, y] = self.relative(at, base);
        let depth = libm::hypot(x, y) - self.force.clearance;
        if piece.index == TOUCHING {
            depth
        } else {
            -depth
        }
    }

    /// The piece that follows when the motion has ended one.
    pub(super) fn next_piece(piece: Piece) -> Piece {
        Piece {
            index: if piece.index == TOUCHING {
                APART
            } else {
                TOUCHING
            },
            ..piece
        }
    }
}

/// F_r / r [N/m]: what the force is per displacement in its direction.
pub(super) fn secant(force: &RadialForce, radius: f64) -> f64 {
    let depth = radius - force.clearance;
    if depth <= 0.0 {
        0.0
    } else {
        force.coefficient * libm::pow(depth, force.exponent) / radius
    }
}

/// dF_r/dr [N/m].
pub(super) fn slope(force: &RadialForce, radius: f64) -> f64 {
    let depth = radius - force.clearance;
    if depth <= 0.0 {
        0.0
    } else {
        force.coefficient * force.exponent * libm::pow(depth, force.exponent - 1.0)
    }
}
