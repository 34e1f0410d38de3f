//! How far a force of 1 N on each metre of face width moves the flanks together: compliances.
//!
//! A force F along the line of action meets the tooth at (X_c, Y_c), at the angle beta = v - theta_b to the
//! perpendicular of the centre line. The energy it stores in a slice of half thickness y at height X (Yang and Lin
//! 1987, with shear after Tian 2004) gives, per face width L,
//!
//! ```text
//!   1/k_bending = integral ((X_c - X) cos beta - Y_c sin beta)^2 / (E I) dX        I = 2/3 y^3 L
//!   1/k_shear   = integral 1.2 cos^2 beta / (G A) dX                                A = 2 y L,  G = E / 2 (1 + nu)
//!   1/k_axial   = integral sin^2 beta / (E A) dX
//!   1/k_h       = 2 ((1 - nu_a^2) / E_a + (1 - nu_b^2) / E_b) / (pi L)              (Yang and Sun 1985; 4 (1 - nu^2) / (pi E L) for equal gears)
//!   1/k_body    = cos^2 beta / (E L) (L* (u/S)^2 + M* u/S + P* (1 + Q* tan^2 beta))  (Sainsot, Velex, Duverger 2004)
//! ```
//!
//! The integrals run from the chord of the root circle to X_c. u is the height, above the root circle, at which the line of
//! action crosses the centre line, S = 2 r_f theta_f the thickness at the root. The values of this file are per face width;
//! those of [`tooth`] and [`body`] are multiplied by E, too.

use core::f64::consts::PI;

use super::super::gauss::integral;
use super::{SpurGear, Tooth};

/// Panels of the Gauss rule along the flank: 1e-9 of the compliance for the thinnest tips (`quadrature_has_converged`).
const PANELS: usize = 24;

/// Coefficients A to F of the polynomials L*, M*, P*, Q* of the gear body. Sainsot, Velex, Duverger 2004, as all public programs
/// that were looked at have them (ROSS, `ross/multi_rotor/gear_element.py`, and nine others); the paper was not at hand.
const BODY: [[f64; 6]; 4] = [
    [-5.574e-5, -1.9986e-3, -2.3015e-4, 4.7702e-3, 0.0271, 6.8045],
    [60.111e-5, 28.100e-3, -83.431e-4, -9.9256e-3, 0.1624, 0.9086],
    [-50.952e-5, 185.50e-3, 0.0538e-4, 53.300e-3, 0.2895, 0.9236],
    [
        -6.2042e-5, 9.0889e-3, -4.0964e-4, 7.8297e-3, -0.1472, 0.6904,
    ],
];

/// Half root angles theta_f [rad] for which the polynomials are held to be fitted.
const FITTED_ANGLES: [f64; 2] = [0.01, 0.12];

/// Ratios of root radius to bore radius for which the polynomials of the gear body are held to be fitted.
pub const FITTED_BODIES: [f64; 2] = [1.4, 7.0];

/// A force on a cantilever.
struct Load {
    /// Distance X_c along the centre line [m].
    along: f64,
    /// Distance Y_c from the centre line [m].
    beside: f64,
    /// sin beta and cos beta of its angle to the perpendicular of the centre line.
    direction: (f64, f64),
}

impl Load {
    /// Compliance of a slice of half thickness y [m] at height X [m], times E and face width, per height [1/m].
    fn on_slice(&self, x: f64, y: f64, poisson_ratio: f64) -> f64 {
        let (sine, cosine) = self.direction;
        let lever = (self.along - x) * cosine - self.beside * sine;
        let bending = lever * lever / (2.0 / 3.0 * y * y * y);
        let shear = 1.2 * cosine * cosine * 2.0 * (1.0 + poisson_ratio) / (2.0 * y);
        let axial = sine * sine / (2.0 * y);
        bending + shear + axial
    }
}

/// Bending, shear and axial compression of one tooth loaded at a roll angle [rad], times E and face width.
pub(super) fn tooth(tooth: &Tooth, roll: f64, poisson_ratio: f64) -> f64 {
    flank_by_panels(tooth, roll, poisson_ratio, PANELS)
}

fn flank_by_panels(tooth: &Tooth, roll: f64, poisson_ratio: f64, panels: usize) -> f64 {
    let [along, beside] = tooth.flank(roll);
    let load = Load {
        along,
        beside,
        direction: libm::sincos(roll - tooth.half_base_angle),
    };
    let root_angle = tooth.half_root_angle();
    let foot = tooth.root_radius * libm::cos(root_angle);
    // Below the base circle the flank is parallel to the centre line. There is nothing of this where the
    // root circle is the larger one.
    let start = tooth.roll_at(tooth.root_radius);
    let [first, half_thickness] = tooth.flank(start);
    let parallel = integral(
        |x| load.on_slice(x, half_thickness, poisson_ratio),
        foot,
        first,
    );
    let on_flank = |v: f64| {
        let [x, y] = tooth.flank(v);
        let slope = tooth.base_radius * v * libm::cos(v - tooth.half_base_angle); // dX/dv
        load.on_slice(x, y, poisson_ratio) * slope
    };
    // Panels shrink towards the load: near a thin tip the integrand changes most steeply.
    let end = |panel: usize| {
        let left = (panels - panel) as f64 / panels as f64;
        roll - (roll - start) * left * left
    };
    let flank: f64 = (0..panels)
        .map(|panel| integral(on_flank, end(panel), end(panel + 1)))
        .sum();
    parallel + flank
}

/// The gear body below one tooth loaded at a roll angle [rad], times E and face width. The bore radius [m] is that of the hub
/// that holds the body. Outside the range of the fit the polynomials keep the values at its ends.
pub(super) fn body(tooth: &Tooth, roll: f64, bore_radius: f64) -> f64 {
    let half_angle = tooth.half_root_angle();
    let [l, m, p, q] = body_polynomials(half_angle, tooth.root_radius / bore_radius);
    let beta = roll - tooth.half_base_angle;
    let (cosine, tangent) = (libm::cos(beta), libm::tan(beta));
    // The line of action touches the base circle: it crosses the centre line at r_b / cos beta.
    let height = tooth.base_radius / cosine - tooth.root_radius;
    let ratio = height / (2.0 * tooth.root_radius * half_angle);
    cosine * cosine * ((l * ratio + m) * ratio + p * (1.0 + q * tangent * tangent))
}

/// L*, M*, P*, Q* = A/theta_f^2 + B h^2 + C h/theta_f + D/theta_f + E h + F with h = root radius / bore radius.
fn body_polynomials(half_angle: f64, ratio: f64) -> [f64; 4] {
    let theta = half_angle.clamp(FITTED_ANGLES[0], FITTED_ANGLES[1]);
    let h = ratio.clamp(FITTED_BODIES[0], FITTED_BODIES[1]);
    BODY.map(|[a, b, c, d, e, f]| {
        a / (theta * theta) + b * h * h + c * h / theta + d / theta + e * h + f
    })
}

/// Flattening of the two flanks where they touch, times face width [1/Pa].
pub(super) fn contact(gears: &[SpurGear; 2]) -> f64 {
    let plane_strain =
        |gear: &SpurGear| (1.0 - gear.poisson_ratio * gear.poisson_ratio) / gear.youngs_modulus;
    2.0 * (plane_strain(&gears[0]) + plane_strain(&gears[1])) / PI
}

#[cfg(test)]
mod tests {
    use super::super::tests::{gear, pairs};
    use super::*;

    #[test]
    fn a_rectangular_tooth_is_a_timoshenko_cantilever() {
        // Half thickness 1, height 3; a force at the top across (beta = 0) and along (beta = pi/2) the tooth.
        let (y, height, poisson_ratio) = (1.0, 3.0, 0.3);
        let compliance = |beside: f64, direction: (f64, f64)| {
            let load = Load {
                along: height,
                beside,
                direction,
            };
            integral(|x| load.on_slice(x, y, poisson_ratio), 0.0, height)
        };
        let (inertia, area) = (2.0 / 3.0 * y * y * y, 2.0 * y);
        let across = height * height * height / (3.0 * inertia)
            + 1.2 * 2.0 * (1.0 + poisson_ratio) * height / area;
        let along = height / area + y * y * height / inertia; // compression and the moment of the eccentric force
        // 1e-14: rounding, the rule is exact for the square of the lever.
        assert!((compliance(y, (0.0, 1.0)) / across - 1.0).abs() < 1e-14);
        assert!((compliance(y, (1.0, 0.0)) / along - 1.0).abs() < 1e-14);
    }

    #[test]
    fn quadrature_has_converged() {
        for pair in pairs() {
            let (teeth, path) = (pair.teeth(), pair.path_of_contact());
            for step in 0..=20 {
                let rolls = path.roll_angles(&teeth, path.contact_ratio() * f64::from(step) / 20.0);
                for (tooth, roll) in teeth.iter().zip(rolls) {
                    let exact = flank_by_panels(tooth, roll, 0.3, 16 * PANELS);
                    let found = flank_by_panels(tooth, roll, 0.3, PANELS);
                    assert!(
                        (found / exact - 1.0).abs() < 1e-9,
                        "{tooth:?} at {roll}: {}",
                        found / exact - 1.0
                    );
                }
            }
        }
    }

    #[test]
    fn body_polynomials_keep_to_the_ranges_of_the_fit() {
        // Least and greatest value of each, beyond which ROSS (`gear_element.py`) warns. 3 %: the polynomials are a fit;
        // at the corners (30 teeth on a thin rim, 300 teeth) they stray further.
        let ranges = [[6.82, 6.94], [1.08, 3.29], [2.56, 13.47], [0.141, 0.62]];
        let mut greatest = [0.0_f64; 4];
        for i in 0..=100 {
            for j in 0..=100 {
                let (theta, h) = (0.05 + 0.0007 * f64::from(i), 2.0 + 0.05 * f64::from(j));
                let values = body_polynomials(theta, h);
                for (([low, high], value), greatest) in ranges.iter().zip(values).zip(&mut greatest)
                {
                    assert!(
                        (0.97 * low..1.03 * high).contains(&value),
                        "{values:?} at {theta}, {h}"
                    );
                    *greatest = greatest.max(value);
                }
            }
        }
        assert!(
            (greatest[0] / 6.94 - 1.0).abs() < 1e-3,
            "L*: {}",
            greatest[0]
        );
    }

    #[test]
    fn contact_of_equal_gears_is_the_formula_of_yang_and_sun() {
        let steel = gear(20.0);
        let (e, nu) = (steel.youngs_modulus, steel.poisson_ratio);
        let published = PI * e / (4.0 * (1.0 - nu * nu));
        assert!((contact(&[steel, steel]) * published - 1.0).abs() < 1e-14);
        // A rigid partner leaves half of the compliance.
        let rigid = SpurGear {
            youngs_modulus: 1e30,
            ..steel
        };
        assert!((contact(&[steel, rigid]) * published - 0.5).abs() < 1e-14);
    }
}
