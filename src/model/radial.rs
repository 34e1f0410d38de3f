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

    /// Overwrites the forces of the two couplings, and their tangents where these are wanted.
    pub(super) fn forces_into(
        &self,
        at: Instant<'_>,
        base: &BaseMotion,
        pieces: &[Piece],
        forces: &mut [f64],
        tangents: Option<&mut [Spring]>,
    ) {
        let own = self.first_coupling..self.first_coupling + 2;
        if pieces[self.law].index == APART {
            forces[own].fill(0.0);
            return;
        }
        let motion = self.relative(at, base);
        let radius = libm::hypot(motion[0], motion[1]);
        let Stiffness { secant, slope } = Stiffness::of(&self.force, radius);
        for (force, part) in forces[own.clone()].iter_mut().zip(motion) {
            *force = secant * part;
        }
        let Some(tangents) = tangents.filter(|_| radius > 0.0) else {
            return;
        };
        for (tangent, part) in tangents[own].iter_mut().zip(motion) {
            let along = (part / radius) * (part / radius);
            tangent.stiffness = slope * along + secant * (1.0 - along);
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

/// How a radial force answers to a displacement.
#[derive(Debug, Clone, Copy)]
pub(super) struct Stiffness {
    /// F_r / r [N/m]: what the force is per displacement in its direction.
    pub(super) secant: f64,
    /// dF_r/dr [N/m].
    pub(super) slope: f64,
}

impl Stiffness {
    /// At a distance from the middle [m].
    pub(super) fn of(force: &RadialForce, radius: f64) -> Stiffness {
        let depth = radius - force.clearance;
        if depth <= 0.0 {
            return Stiffness {
                secant: 0.0,
                slope: 0.0,
            };
        }
        let per_depth = force.coefficient * libm::pow(depth, force.exponent - 1.0);
        Stiffness {
            secant: per_depth * depth / radius,
            slope: force.exponent * per_depth,
        }
    }
}
