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
//! teeth together. Knows two gears and the line of action between them; knows nothing of shafts, modes
//! or time. The printed forms of (4) to (6) differ from these; see `docs/errata.md`.

mod gauss;
mod stiffness;

pub use stiffness::{StiffnessLaw, ToothPair};

/// The line of action between gear a and gear b.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LineOfAction {
    /// Unit normal n from a to b.
    pub normal: [f64; 2],
    /// Base radius R_a [m].
    pub radius_a: f64,
    /// Base radius R_b [m].
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
        let alpha = psi + flank * (core::f64::consts::FRAC_PI_2 - pressure_angle);
        LineOfAction {
            normal: [libm::cos(alpha), libm::sin(alpha)],
            radius_a,
            radius_b,
            flank,
        }
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
    use core::f64::consts::PI;

    use super::*;

    fn pairs() -> Vec<LineOfAction> {
        let mut pairs = Vec::new();
        for flank in [1.0, -1.0] {
            for psi in [0.0, 0.7, 2.5, -1.9] {
                pairs.push(LineOfAction::external(psi, 0.35, flank, 0.11, 0.27));
            }
        }
        pairs
    }

    /// Centre of gear b when a is at the origin and the pressure angle is 0.35.
    fn centre_of_b(psi: f64) -> [f64; 2] {
        let distance = (0.11 + 0.27) / libm::cos(0.35);
        [distance * libm::cos(psi), distance * libm::sin(psi)]
    }

    #[test]
    fn forces_balance_and_the_moment_about_any_point_vanishes() {
        for (pair, psi) in pairs().iter().zip([0.0, 0.7, 2.5, -1.9].iter().cycle()) {
            let [a, b] = pair.loads(1000.0);
            assert_eq!((a.x + b.x, a.y + b.y), (0.0, 0.0));
            let centre = centre_of_b(*psi);
            let moment = a.torque + b.torque + centre[0] * b.y - centre[1] * b.x;
            // 1e-12 of the torques: rounding.
            assert!(moment.abs() < 1e-12 * b.torque.abs(), "moment {moment}");
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
        for pair in pairs() {
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
        for pair in pairs() {
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
