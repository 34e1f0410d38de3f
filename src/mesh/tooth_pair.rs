//! The law `tooth_pair`: one pair of teeth while it passes through the contact.
//!
//! ```text
//!   k(x) = pair (1 - quadratic xi^2 - quartic xi^4) r(u)         x in [0, eps] pitches after first contact
//!   xi = 2 x / eps - 1,  u = clamp(min(x, eps - x) / ramp, 0, 1),  r = u^3 (10 - 15 u + 6 u^2)
//! ```

use super::gauss::integral;

/// Parameters of the law `tooth_pair`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ToothPair {
    /// Stiffness of one pair at mid contact [N/m].
    pub pair: f64,
    /// Relative loss at the ends of contact, quadratic term.
    pub quadratic: f64,
    /// Relative loss at the ends of contact, quartic term.
    pub quartic: f64,
    /// Length over which a pair takes and leaves its load [pitches].
    pub ramp: f64,
    /// Mean number of tooth pairs in contact eps.
    pub contact_ratio: f64,
}

/// The law with what its evaluation needs again and again.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct PairCurve {
    pub(super) law: ToothPair,
    /// 2 / eps.
    per_contact: f64,
    /// 1 / ramp; 0 without a ramp.
    per_ramp: f64,
}

impl PairCurve {
    pub(super) fn of(law: ToothPair) -> PairCurve {
        PairCurve {
            per_contact: 2.0 / law.contact_ratio,
            per_ramp: if law.ramp > 0.0 { 1.0 / law.ramp } else { 0.0 },
            law,
        }
    }

    /// Mean of the sum over the pairs: over a pitch that is the integral over one pair's contact.
    pub(super) fn mean(&self) -> f64 {
        let eps = self.law.contact_ratio;
        let ramp = self.law.ramp.min(0.5 * eps);
        [[0.0, ramp], [ramp, eps - ramp], [eps - ramp, eps]]
            .iter()
            // Five points are exact: one pair's stiffness is a polynomial of degree 9.
            .map(|&[from, to]| integral(|x| self.one_pair(x), from, to))
            .sum()
    }

    /// Stiffness of one pair [N/m] at distance x [pitches] after its first contact.
    pub(super) fn one_pair(&self, x: f64) -> f64 {
        let law = &self.law;
        let xi = x * self.per_contact - 1.0;
        let near = x.min(law.contact_ratio - x);
        let load_share = if near >= law.ramp || law.ramp == 0.0 {
            1.0
        } else {
            let u = (near * self.per_ramp).max(0.0);
            u * u * u * (10.0 - u * (15.0 - 6.0 * u))
        };
        law.pair * law.profile(xi * xi) * load_share
    }

    /// dk/dx [N/m per pitch]; at the end of a ramp both sides agree.
    pub(super) fn one_pair_slope(&self, x: f64) -> f64 {
        let (law, eps) = (&self.law, self.law.contact_ratio);
        let (xi, xi_slope) = (x * self.per_contact - 1.0, self.per_contact);
        let profile_slope = -2.0 * xi * xi_slope * (law.quadratic + 2.0 * xi * xi * law.quartic);
        let near = x.min(eps - x);
        if law.ramp == 0.0 || near >= law.ramp {
            return law.pair * profile_slope;
        }
        let u = (near * self.per_ramp).max(0.0);
        let share = u * u * u * (10.0 - u * (15.0 - 6.0 * u));
        let towards = if x <= 0.5 * eps { 1.0 } else { -1.0 };
        let share_slope = 30.0 * u * u * (1.0 - u) * (1.0 - u) * towards * self.per_ramp;
        law.pair * (profile_slope * share + law.profile(xi * xi) * share_slope)
    }
}

impl ToothPair {
    /// 1 - quadratic xi^2 - quartic xi^4 over xi^2.
    fn profile(&self, xi_squared: f64) -> f64 {
        1.0 - xi_squared * (self.quadratic + xi_squared * self.quartic)
    }

    /// The smallest value of the profile over the contact: must not be negative.
    pub fn weakest(&self) -> f64 {
        let vertex = (-0.5 * self.quadratic / self.quartic).clamp(0.0, 1.0);
        let inside = if vertex.is_finite() {
            self.profile(vertex)
        } else {
            1.0
        };
        self.profile(1.0).min(inside).min(1.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn weakest_point_of_a_pair_is_found_inside_and_at_the_ends() {
        let example = ToothPair {
            pair: 5e8,
            quadratic: 0.4,
            quartic: 0.1,
            ramp: 0.1,
            contact_ratio: 1.6,
        };
        assert!((example.weakest() - 0.5).abs() < 1e-15);
        let hollow = ToothPair {
            quadratic: 2.4,
            quartic: -1.2,
            ..example
        };
        assert!((hollow.weakest() + 0.2).abs() < 1e-15);
    }
}
