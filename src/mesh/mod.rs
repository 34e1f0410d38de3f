//! One pair of meshing gears: how far the teeth are pressed together, and how hard they push back.
//!
//! ```text
//!   alpha = psi + s (pi/2 - p)                   direction of the line of action, from a to b
//!   n     = (cos alpha, sin alpha)
//!   delta = n.(u_a - u_b) + s (R_a th_a + R_b th_b)         [m]    paper (5), minus its bracket
//!   F     = k delta + c delta'                              [N]    from V = k delta^2 / 2
//!   on a: -F n, torque -s F R_a          on b: +F n, torque -s F R_b
//! ```
//!
//! psi is the direction from the centre of a to that of b, p the operating pressure angle, R the base
//! radii, s the flank: the sign of the torque that drives a through the mesh. delta > 0 presses the
//! teeth together. Where b is a ring around a (internal gears), the teeth meet on the side of a that faces
//! away from the centre of b, and both turn the same way:
//!
//! ```text
//!   n = s z x p' cos p + p' sin p,   p' = -(cos psi, sin psi)       psi + pi in the formula above
//!   theta_b enters with -R_b                                       R_b < 0 in the formulas above
//! ```
//!
//! Knows two gears and the line of action between them; knows nothing of shafts, modes
//! or time. The printed forms of (4) to (6) differ from these; see `docs/errata.md`.

mod fourier;
mod gauss;
mod polynomial;
mod stiffness;
mod table;
mod tooth_geometry;
mod tooth_pair;
mod transmission_error;

pub use stiffness::StiffnessLaw;
pub use tooth_geometry::{
    FITTED_BODIES, Iso6336Stiffness, PathOfContact, SpurGear, SpurPair, Tooth,
    theoretical_single_stiffness,
};
pub use tooth_pair::ToothPair;
pub use transmission_error::{ErrorHarmonic, TransmissionError};

use core::f64::consts::{FRAC_PI_2, PI};

/// The line of action between gear a and gear b.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LineOfAction {
    /// Unit normal n from a to b.
    pub normal: [f64; 2],
    /// Unit vector from the centre of a to that of b.
    pub center_line: [f64; 2],
    /// Base radius R_a [m].
    pub radius_a: f64,
    /// Base radius R_b [m], negative where b is a ring.
    pub radius_b: f64,
    /// Flank sign s.
    pub flank: f64,
}

/// Displacement of a gear, or its derivative.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct GearMotion {
    /// x [m].
    pub x: f64,
    /// y [m].
    pub y: f64,
    /// Rotation about z on top of the mean rotation [rad].
    pub theta: f64,
}

/// What the mesh does to a gear.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct GearLoad {
    /// Force in x [N].
    pub x: f64,
    /// Force in y [N].
    pub y: f64,
    /// Torque about z [N m].
    pub torque: f64,
}

impl LineOfAction {
    /// Two external gears: centre line angle psi [rad], pressure angle [rad], flank sign, base radii [m].
    pub fn external(
        psi: f64,
        pressure_angle: f64,
        flank: f64,
        radius_a: f64,
        radius_b: f64,
    ) -> Self {
        let alpha = psi + flank * (FRAC_PI_2 - pressure_angle);
        LineOfAction {
            normal: [libm::cos(alpha), libm::sin(alpha)],
            center_line: [libm::cos(psi), libm::sin(psi)],
            radius_a,
            radius_b,
            flank,
        }
    }

    /// A gear a inside a ring b; as [`LineOfAction::external`], the radius of the ring is given positive.
    pub fn internal(
        psi: f64,
        pressure_angle: f64,
        flank: f64,
        radius_a: f64,
        radius_b: f64,
    ) -> Self {
        LineOfAction {
            center_line: [libm::cos(psi), libm::sin(psi)],
            ..LineOfAction::external(psi + PI, pressure_angle, flank, radius_a, -radius_b)
        }
    }

    /// The line on which the backs of the same teeth would touch: -s, n mirrored at the centre line.
    pub fn opposite_flank(&self) -> Self {
        let ([x, y], [along_x, along_y]) = (self.normal, self.center_line);
        let twice = 2.0 * (x * along_x + y * along_y);
        LineOfAction {
            normal: [twice * along_x - x, twice * along_y - y],
            flank: -self.flank,
            ..*self
        }
    }

    /// Whether b is a ring around a.
    pub fn is_internal(&self) -> bool {
        self.radius_b < 0.0
    }

    /// How delta depends on the motion of a and of b: the gradient with respect to (x, y, theta) of each.
    pub fn gradient(&self) -> [GearMotion; 2] {
        let [x, y] = self.normal;
        [
            GearMotion {
                x,
                y,
                theta: self.flank * self.radius_a,
            },
            GearMotion {
                x: -x,
                y: -y,
                theta: self.flank * self.radius_b,
            },
        ]
    }

    /// Tooth deflection delta along the line of action [m]; positive presses the teeth together.
    pub fn deflection(&self, a: &GearMotion, b: &GearMotion) -> f64 {
        let [gradient_a, gradient_b] = self.gradient();
        gradient_a.dot(a) + gradient_b.dot(b)
    }

    /// What a normal force F [N] does to a and to b.
    pub fn loads(&self, force: f64) -> [GearLoad; 2] {
        self.gradient().map(|gradient| GearLoad {
            x: -force * gradient.x,
            y: -force * gradient.y,
            torque: -force * gradient.theta,
        })
    }
}

impl GearMotion {
    fn dot(&self, other: &GearMotion) -> f64 {
        self.x * other.x + self.y * other.y + self.theta * other.theta
    }
}

/// Damping coefficient c [N s/m] for a fraction of critical damping of the gear pair alone:
/// c = 2 zeta sqrt(k m_eq), 1/m_eq = R_a^2/J_a + R_b^2/J_b. Each gear is (R [m], J [kg m^2]).
pub fn pair_damping(ratio: f64, mean_stiffness: f64, gears: [(f64, f64); 2]) -> f64 {
    let inverse_mass: f64 = gears
        .iter()
        .map(|(radius, inertia)| radius * radius / inertia)
        .sum();
    2.0 * ratio * (mean_stiffness / inverse_mass).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    const PSI: [f64; 4] = [0.0, 0.7, 2.5, -1.9];
    const PRESSURE_ANGLE: f64 = 0.35;

    /// External and internal pairs on both flanks, each with its psi.
    fn pairs() -> Vec<(LineOfAction, f64)> {
        let mut pairs = Vec::new();
        for flank in [1.0, -1.0] {
            for psi in PSI {
                for kind in [LineOfAction::external, LineOfAction::internal] {
                    pairs.push((kind(psi, PRESSURE_ANGLE, flank, 0.11, 0.27), psi));
                }
            }
        }
        pairs
    }

    /// Centre of gear b when a is at the origin: (R_a + R_b) / cos p away, (R_b - R_a) / cos p in a ring.
    fn centre_of_b(pair: &LineOfAction, psi: f64) -> [f64; 2] {
        let distance = (pair.radius_a + pair.radius_b).abs() / libm::cos(PRESSURE_ANGLE);
        [distance * libm::cos(psi), distance * libm::sin(psi)]
    }

    #[test]
    fn forces_balance_and_the_moment_about_any_point_vanishes() {
        for (pair, psi) in pairs() {
            for pair in [pair, pair.opposite_flank()] {
                let [a, b] = pair.loads(1000.0);
                assert_eq!((a.x + b.x, a.y + b.y), (0.0, 0.0));
                let centre = centre_of_b(&pair, psi);
                let moment = a.torque + b.torque + centre[0] * b.y - centre[1] * b.x;
                // 1e-12 of the torques: rounding.
                assert!(moment.abs() < 1e-12 * b.torque.abs(), "moment {moment}");
            }
        }
    }

    #[test]
    fn the_normal_is_that_of_the_equations() {
        // n = s z x p' cos p + p' sin p, p' from a's centre to the pitch point (equations.md, section 3).
        let (sine, cosine) = libm::sincos(PRESSURE_ANGLE);
        for (pair, psi) in pairs() {
            let side = pair.radius_b.signum(); // a ring is touched on the far side
            let to_pitch_point = [side * libm::cos(psi), side * libm::sin(psi)];
            let across = [-to_pitch_point[1], to_pitch_point[0]];
            for axis in 0..2 {
                let expected = pair.flank * across[axis] * cosine + to_pitch_point[axis] * sine;
                assert!((pair.normal[axis] - expected).abs() < 1e-15);
            }
        }
    }

    #[test]
    fn the_opposite_flank_is_the_one_built_with_the_other_sign() {
        for (pair, psi) in pairs() {
            let ring = pair.is_internal();
            let kind = if ring {
                LineOfAction::internal
            } else {
                LineOfAction::external
            };
            let built = kind(psi, PRESSURE_ANGLE, -pair.flank, 0.11, 0.27);
            let found = pair.opposite_flank();
            for axis in 0..2 {
                assert!(
                    (found.normal[axis] - built.normal[axis]).abs() < 1e-15,
                    "rounding"
                );
            }
            assert_eq!(
                LineOfAction {
                    normal: built.normal,
                    ..found
                },
                built
            );
        }
    }

    #[test]
    fn rotation_at_the_speed_ratio_presses_nothing() {
        // z_a = 11, z_b = 27: Om_b = -Om_a 11/27 outside, +Om_a 11/27 in a ring.
        for (pair, _) in pairs() {
            let turn = |theta: f64| GearMotion {
                theta,
                ..GearMotion::default()
            };
            let ratio = -11.0 / (27.0 * pair.radius_b.signum());
            let deflection = pair.deflection(&turn(1.0), &turn(ratio));
            assert!(deflection.abs() < 1e-15, "{deflection}: rounding");
        }
    }

    #[test]
    fn swapping_the_gears_keeps_the_deflection() {
        let motion_a = GearMotion {
            x: 1e-6,
            y: -2e-6,
            theta: 3e-5,
        };
        let motion_b = GearMotion {
            x: -4e-6,
            y: 0.5e-6,
            theta: -1e-5,
        };
        for flank in [1.0, -1.0] {
            let pair = LineOfAction::external(0.7, 0.35, flank, 0.11, 0.27);
            let swapped = LineOfAction::external(0.7 + PI, 0.35, flank, 0.27, 0.11);
            let (one, two) = (
                pair.deflection(&motion_a, &motion_b),
                swapped.deflection(&motion_b, &motion_a),
            );
            assert!((one - two).abs() < 1e-12 * one.abs(), "1e-12: rounding");
        }
    }

    #[test]
    fn the_driving_torque_on_a_has_the_sign_of_the_flank() {
        for (pair, _) in pairs() {
            let [a, _] = pair.loads(1.0);
            assert_eq!(a.torque.signum(), -pair.flank); // the mesh resists what drives
        }
    }

    #[test]
    fn loads_do_the_work_that_the_deflection_takes() {
        // -F dot(delta) = power of the loads on both gears, for any motion.
        let (va, vb) = (
            GearMotion {
                x: 0.3,
                y: -0.2,
                theta: 4.0,
            },
            GearMotion {
                x: 0.1,
                y: 0.6,
                theta: -3.0,
            },
        );
        for (pair, _) in pairs() {
            let [a, b] = pair.loads(7.0);
            let power = a.x * va.x
                + a.y * va.y
                + a.torque * va.theta
                + b.x * vb.x
                + b.y * vb.y
                + b.torque * vb.theta;
            assert!((power + 7.0 * pair.deflection(&va, &vb)).abs() < 1e-12);
        }
    }
}
