//! The shape of an involute spur tooth, and where two of them touch.
//!
//! ```text
//!   r_b = m z cos(alpha) / 2          theta_b = pi/2z + 2 x tan(alpha)/z + inv(alpha)     half angle at the base circle
//!   point of the flank at roll angle v, tooth centre line along X:
//!     X = r_b (cos(v - theta_b) + v sin(v - theta_b))
//!     Y = r_b (v cos(v - theta_b) - sin(v - theta_b))             half thickness
//! ```
//!
//! The normal to the flank there is the line of action; v - theta_b is its angle to the perpendicular of the
//! centre line, and r_b v its length to where it touches the base circle. Where the root circle is inside the
//! base circle, the flank goes on from the base circle parallel to the centre line (Liang, Zuo, Pandey 2014).

use core::f64::consts::{FRAC_PI_2, PI};

use super::SpurGear;

/// One tooth of a spur gear, symmetric about its centre line.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Tooth {
    /// Radius of the base circle r_b [m].
    pub base_radius: f64,
    /// Radius of the root circle r_f [m].
    pub root_radius: f64,
    /// Radius of the tip circle r_a [m].
    pub tip_radius: f64,
    /// Half of the angle that the tooth takes up on the base circle theta_b [rad].
    pub half_base_angle: f64,
    /// Angle between neighbouring teeth [rad].
    pub pitch_angle: f64,
}

/// The part of the line of action on which the teeth touch.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PathOfContact {
    /// Distance between the axes [m].
    pub centre_distance: f64,
    /// Length of the line of action between the base circles [m].
    pub tangent: f64,
    /// Distance from the base circle of a, of b, at which the tip of the other gear touches [m]. Where it is negative,
    /// that tip cuts into the tooth below its base circle.
    pub lowest: [f64; 2],
    /// Distance between the flanks of neighbouring teeth along the line of action [m].
    pub base_pitch: f64,
}

impl Tooth {
    pub(super) fn new(gear: &SpurGear, module: f64, rack_pressure_angle: f64) -> Tooth {
        let (z, x, alpha) = (gear.teeth, gear.profile_shift, rack_pressure_angle);
        Tooth {
            base_radius: 0.5 * module * z * libm::cos(alpha),
            root_radius: module * (0.5 * z + x - gear.dedendum),
            tip_radius: module * (0.5 * z + x + gear.addendum),
            half_base_angle: (FRAC_PI_2 + 2.0 * x * libm::tan(alpha)) / z + involute(alpha),
            pitch_angle: 2.0 * PI / z,
        }
    }

    /// Roll angle v [rad] at a radius outside the base circle [m]; 0 inside it.
    pub fn roll_at(&self, radius: f64) -> f64 {
        let ratio = radius / self.base_radius;
        (ratio * ratio - 1.0).max(0.0).sqrt()
    }

    /// The point X, Y [m] of the flank at roll angle v.
    pub fn flank(&self, roll: f64) -> [f64; 2] {
        let (sine, cosine) = libm::sincos(roll - self.half_base_angle);
        [
            self.base_radius * (cosine + roll * sine),
            self.base_radius * (roll * cosine - sine),
        ]
    }

    /// Half of the angle that the tooth takes up on a circle [rad], base circle or larger; negative beyond a pointed tip.
    pub fn half_angle_at(&self, radius: f64) -> f64 {
        self.half_base_angle - involute(libm::atan(self.roll_at(radius)))
    }

    /// Half of the angle that the tooth takes up on the root circle theta_f [rad].
    pub fn half_root_angle(&self) -> f64 {
        if self.root_radius > self.base_radius {
            self.half_angle_at(self.root_radius)
        } else {
            let [_, half_thickness] = self.flank(0.0);
            libm::asin(half_thickness / self.root_radius)
        }
    }
}

impl PathOfContact {
    pub(super) fn new(teeth: &[Tooth; 2], pressure_angle: f64) -> PathOfContact {
        let [a, b] = teeth;
        let centre_distance = (a.base_radius + b.base_radius) / libm::cos(pressure_angle);
        let tangent = centre_distance * libm::sin(pressure_angle);
        let tip_roll_length = |tooth: &Tooth| tooth.base_radius * tooth.roll_at(tooth.tip_radius);
        PathOfContact {
            centre_distance,
            tangent,
            lowest: [tangent - tip_roll_length(b), tangent - tip_roll_length(a)],
            base_pitch: a.base_radius * a.pitch_angle,
        }
    }

    /// Mean number of tooth pairs in contact eps.
    pub fn contact_ratio(&self) -> f64 {
        let [from_a, from_b] = self.lowest;
        (self.tangent - from_a - from_b) / self.base_pitch
    }

    /// Roll angles [rad] of the touching points of a and b, x pitches after the tip of b first touches.
    pub(super) fn roll_angles(&self, teeth: &[Tooth; 2], x: f64) -> [f64; 2] {
        let from_a = self.lowest[0] + x * self.base_pitch;
        [
            from_a / teeth[0].base_radius,
            (self.tangent - from_a) / teeth[1].base_radius,
        ]
    }
}

/// inv(alpha) = tan(alpha) - alpha.
fn involute(angle: f64) -> f64 {
    libm::tan(angle) - angle
}
