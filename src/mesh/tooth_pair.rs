//! The law `tooth_pair`: one pair of teeth while it passes through the contact.
//!
//! ```text
//!   k(x) = pair (1 - quadratic xi^2 - quartic xi^4) r(u)         x in [0, eps] pitches after first contact
//!   xi = 2 x / eps - 1,  u = clamp(min(x, eps - x) / ramp, 0, 1),  r = u^3 (10 - 15 u + 6 u^2)
//! ```

use super::polynomial::Polynomial;

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

impl ToothPair {
    /// Stiffness of one pair [N/m] over the pitches since it was at x in [0, eps]: the polynomial of the piece around there.
    pub(super) fn around(&self, x: f64) -> Polynomial {
        let per_contact = 2.0 / self.contact_ratio;
        let xi = Polynomial::line(x * per_contact - 1.0, per_contact);
        let squared = xi.times(&xi);
        let loss = Polynomial::constant(self.quadratic).plus(self.quartic, &squared);
        let profile = Polynomial::constant(self.pair).plus(-self.pair, &squared.times(&loss));
        let near = x.min(self.contact_ratio - x);
        if near >= self.ramp || self.ramp == 0.0 {
            return profile;
        }
        let towards = if x < 0.5 * self.contact_ratio {
            1.0
        } else {
            -1.0
        };
        let u = Polynomial::line(near / self.ramp, towards / self.ramp);
        let curve = Polynomial::constant(-15.0).plus(6.0, &u);
        let share = Polynomial::constant(10.0).plus(1.0, &u.times(&curve));
        profile.times(&u.times(&u).times(&u).times(&share))
    }

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
