//! One cylindrical shaft element between two stations: Timoshenko beam and torsion bar.
//!
//! ```text
//!   planar degrees of freedom   [u1, b1, u2, b2],   b = du/dz of the undeformed section normal
//!   torsion                     [th1, th2]
//!   Phi = 12 E I / (kappa G A L^2)                            shear parameter
//!   kappa = 6 (1+nu) (1+m^2)^2 / ((7+6nu) (1+m^2)^2 + (20+12nu) m^2),  m = d/D     Cowper (1966)
//! ```
//!
//! With b = dx/dz in the x-z plane and b = dy/dz in the y-z plane both planes have the same matrices
//! (`docs/theory.md`, conventions). Matrices are those of Przemieniecki, Theory of Matrix Structural
//! Analysis (1968), 11.5, and Nelson, J. Mech. Des. 102 (1980): exact static stiffness, consistent mass.
//! Knows no model file, no rotor, no support.

use core::f64::consts::PI;

use nalgebra::{Matrix2, Matrix4};

/// Geometry and material of an element.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Shaft {
    /// Length L [m].
    pub length: f64,
    /// Outer diameter D [m].
    pub outer_diameter: f64,
    /// Inner diameter d [m].
    pub inner_diameter: f64,
    /// Young's modulus E [Pa].
    pub youngs_modulus: f64,
    /// Poisson's ratio nu.
    pub poisson_ratio: f64,
    /// Density rho [kg/m^3].
    pub density: f64,
}

impl Shaft {
    /// Cross-section area A [m^2].
    pub fn area(&self) -> f64 {
        let (outer, inner) = (self.outer_diameter, self.inner_diameter);
        PI / 4.0 * (outer * outer - inner * inner)
    }

    /// Second moment of area about a diameter I [m^4].
    pub fn second_moment(&self) -> f64 {
        let (outer, inner) = (self.outer_diameter, self.inner_diameter);
        PI / 64.0 * (outer * outer * outer * outer - inner * inner * inner * inner)
    }

    /// Shear modulus G [Pa].
    pub fn shear_modulus(&self) -> f64 {
        self.youngs_modulus / (2.0 * (1.0 + self.poisson_ratio))
    }

    /// Shear coefficient kappa of a circular ring. Cowper, J. Appl. Mech. 33 (1966), table 1.
    pub fn shear_coefficient(&self) -> f64 {
        let nu = self.poisson_ratio;
        let m2 = (self.inner_diameter / self.outer_diameter)
            * (self.inner_diameter / self.outer_diameter);
        let sum = (1.0 + m2) * (1.0 + m2);
        6.0 * (1.0 + nu) * sum / ((7.0 + 6.0 * nu) * sum + (20.0 + 12.0 * nu) * m2)
    }

    /// Shear parameter Phi: ratio of shear to bending flexibility.
    fn shear_parameter(&self) -> f64 {
        let shear = self.shear_coefficient() * self.shear_modulus() * self.area();
        12.0 * self.youngs_modulus * self.second_moment() / (shear * self.length * self.length)
    }

    /// Bending stiffness in one plane [N/m, N, N m].
    #[rustfmt::skip]
    pub fn stiffness(&self) -> Matrix4<f64> {
        let (l, phi) = (self.length, self.shear_parameter());
        let factor = self.youngs_modulus * self.second_moment() / ((1.0 + phi) * l * l * l);
        factor * Matrix4::new(
             12.0,     6.0 * l,             -12.0,     6.0 * l,
            6.0 * l, (4.0 + phi) * l * l, -6.0 * l, (2.0 - phi) * l * l,
            -12.0,    -6.0 * l,              12.0,    -6.0 * l,
            6.0 * l, (2.0 - phi) * l * l, -6.0 * l, (4.0 + phi) * l * l,
        )
    }

    /// Consistent mass in one plane, rotary inertia included [kg, kg m, kg m^2].
    pub fn mass(&self) -> Matrix4<f64> {
        self.translational_mass() + self.rotary_mass()
    }

    #[rustfmt::skip]
    fn translational_mass(&self) -> Matrix4<f64> {
        let (l, phi) = (self.length, self.shear_parameter());
        let poly = |c0: f64, c1: f64, c2: f64| c0 + phi * (c1 + phi * c2);
        let m1 = poly(312.0, 588.0, 280.0);
        let m2 = poly(44.0, 77.0, 35.0) * l;
        let m3 = poly(108.0, 252.0, 140.0);
        let m4 = -poly(26.0, 63.0, 35.0) * l;
        let m5 = poly(8.0, 14.0, 7.0) * l * l;
        let m6 = -poly(6.0, 14.0, 7.0) * l * l;
        let factor = self.density * self.area() * l / (840.0 * (1.0 + phi) * (1.0 + phi));
        factor * Matrix4::new(
            m1,  m2,  m3,  m4,
            m2,  m5, -m4,  m6,
            m3, -m4,  m1, -m2,
            m4,  m6, -m2,  m5,
        )
    }

    /// The part of the mass that comes from the tilting of sections.
    #[rustfmt::skip]
    fn rotary_mass(&self) -> Matrix4<f64> {
        let (l, phi) = (self.length, self.shear_parameter());
        let m7 = 36.0;
        let m8 = (3.0 - 15.0 * phi) * l;
        let m9 = (4.0 + phi * (5.0 + phi * 10.0)) * l * l;
        let m10 = (-1.0 + phi * (-5.0 + phi * 5.0)) * l * l;
        let factor = self.density * self.second_moment() / (30.0 * l * (1.0 + phi) * (1.0 + phi));
        factor * Matrix4::new(
             m7,  m8, -m7,  m8,
             m8,  m9, -m8, m10,
            -m7, -m8,  m7, -m8,
             m8, m10, -m8,  m9,
        )
    }

    /// G: the force in one plane per spin rate and per velocity in the other plane. The polar inertia of
    /// a section is twice the diametral one.
    pub fn gyroscopic(&self) -> Matrix4<f64> {
        2.0 * self.rotary_mass()
    }

    /// Torsional stiffness [N m/rad].
    pub fn torsional_stiffness(&self) -> Matrix2<f64> {
        let factor = self.shear_modulus() * 2.0 * self.second_moment() / self.length;
        factor * Matrix2::new(1.0, -1.0, -1.0, 1.0)
    }

    /// Consistent polar inertia [kg m^2].
    pub fn polar_inertia(&self) -> Matrix2<f64> {
        let factor = self.density * 2.0 * self.second_moment() * self.length / 6.0;
        factor * Matrix2::new(2.0, 1.0, 1.0, 2.0)
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::Vector4;

    use super::*;

    fn stub() -> Shaft {
        Shaft {
            length: 0.13,
            outer_diameter: 0.08,
            inner_diameter: 0.03,
            youngs_modulus: 2.07e11,
            poisson_ratio: 0.3,
            density: 7830.0,
        }
    }

    fn relative(found: f64, exact: f64) -> f64 {
        (found / exact - 1.0).abs()
    }

    #[test]
    fn cantilever_tip_deflection_is_bending_plus_shear() {
        // F L^3 / 3 E I + F L / kappa G A; 1e-12: the element is exact for end loads.
        let (shaft, l) = (stub(), stub().length);
        let tip = shaft
            .stiffness()
            .fixed_view::<2, 2>(2, 2)
            .try_inverse()
            .unwrap()[(0, 0)];
        let bending = l * l * l / (3.0 * shaft.youngs_modulus * shaft.second_moment());
        let shear = l / (shaft.shear_coefficient() * shaft.shear_modulus() * shaft.area());
        assert!(relative(tip, bending + shear) < 1e-12);
    }

    #[test]
    fn rigid_motions_cost_no_force_and_carry_the_rigid_inertia() {
        let (shaft, l) = (stub(), stub().length);
        let shift = Vector4::new(1.0, 0.0, 1.0, 0.0);
        let tilt = Vector4::new(-l / 2.0, 1.0, l / 2.0, 1.0);
        let mass = shaft.density * shaft.area() * l;
        let rotary = shaft.density * shaft.second_moment() * l;
        for motion in [shift, tilt] {
            // 1e-12 of the largest stiffness: rounding.
            assert!((shaft.stiffness() * motion).amax() < 1e-12 * shaft.stiffness().amax());
        }
        assert!(relative(shift.dot(&(shaft.mass() * shift)), mass) < 1e-12);
        assert!(
            relative(
                tilt.dot(&(shaft.mass() * tilt)),
                mass * l * l / 12.0 + rotary
            ) < 1e-12
        );
        assert!(relative(tilt.dot(&(shaft.gyroscopic() * tilt)), 2.0 * rotary) < 1e-12);
        assert!(relative(shaft.polar_inertia().sum(), 2.0 * rotary) < 1e-12);
    }

    #[test]
    fn masses_are_the_integrals_of_the_static_deflection_shapes() {
        // The deflection under end loads: u'' = (M - ...)/EI, section tilt b = u' - shear angle. With
        // z = xi L the shapes for unit end displacements follow from the element's own stiffness.
        let shaft = stub();
        let (l, phi) = (shaft.length, shaft.shear_parameter());
        let (mut translation, mut rotation) = (Matrix4::zeros(), Matrix4::zeros());
        // Five-point Gauss rule: exact for the products of cubics.
        let (r1, r2) = (
            (5.0 - 2.0 * (10.0_f64 / 7.0).sqrt()).sqrt() / 3.0,
            (5.0 + 2.0 * (10.0_f64 / 7.0).sqrt()).sqrt() / 3.0,
        );
        let (w1, w2) = (
            (322.0 + 13.0 * 70.0_f64.sqrt()) / 900.0,
            (322.0 - 13.0 * 70.0_f64.sqrt()) / 900.0,
        );
        for (node, weight) in [
            (0.0, 128.0 / 225.0),
            (r1, w1),
            (-r1, w1),
            (r2, w2),
            (-r2, w2),
        ] {
            let x = 0.5 * (1.0 + node);
            let n = 1.0 / (1.0 + phi);
            let u = n * Vector4::new(
                1.0 - 3.0 * x * x + 2.0 * x * x * x + phi * (1.0 - x),
                l * (x - 2.0 * x * x + x * x * x + phi * (x - x * x) / 2.0),
                3.0 * x * x - 2.0 * x * x * x + phi * x,
                l * (-x * x + x * x * x + phi * (x * x - x) / 2.0),
            );
            let b = n * Vector4::new(
                6.0 * (x * x - x) / l,
                1.0 - 4.0 * x + 3.0 * x * x + phi * (1.0 - x),
                6.0 * (x - x * x) / l,
                -2.0 * x + 3.0 * x * x + phi * x,
            );
            translation += 0.5 * weight * l * shaft.density * shaft.area() * u * u.transpose();
            rotation +=
                0.5 * weight * l * shaft.density * shaft.second_moment() * b * b.transpose();
        }
        // 1e-12: rounding.
        assert!(
            (translation - shaft.translational_mass()).amax()
                < 1e-12 * shaft.translational_mass().amax()
        );
        assert!((rotation - shaft.rotary_mass()).amax() < 1e-12 * shaft.rotary_mass().amax());
    }

    #[test]
    fn solid_and_thin_rings_have_cowpers_limits() {
        // Cowper's table 1: solid circle 6(1+nu)/(7+6nu); thin ring 2(1+nu)/(4+3nu).
        let solid = Shaft {
            inner_diameter: 0.0,
            ..stub()
        };
        assert!(relative(solid.shear_coefficient(), 6.0 * 1.3 / 8.8) < 1e-15);
        let thin = Shaft {
            inner_diameter: stub().outer_diameter * (1.0 - 1e-9),
            ..stub()
        };
        assert!(relative(thin.shear_coefficient(), 2.0 * 1.3 / 4.9) < 1e-9);
    }
}
