//! Polynomials of the degree that the stiffness of a tooth pair has: at most nine.
//!
//! ```text
//!   p(t) = a_0 + a_1 t + ... = (a_0 + a_2 t^2 + ...) + t (a_1 + a_3 t^2 + ...)      the halves need not wait for each other
//! ```

/// Number of coefficients.
const TERMS: usize = 10;

/// A polynomial by its coefficients, the constant first.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Polynomial([f64; TERMS]);

impl Polynomial {
    /// level + slope t.
    pub(super) fn line(level: f64, slope: f64) -> Polynomial {
        let mut coefficients = [0.0; TERMS];
        (coefficients[0], coefficients[1]) = (level, slope);
        Polynomial(coefficients)
    }

    /// The same number everywhere.
    pub(super) fn constant(level: f64) -> Polynomial {
        Polynomial::line(level, 0.0)
    }

    /// The sum with `scale` times another one.
    pub(super) fn plus(&self, scale: f64, other: &Polynomial) -> Polynomial {
        Polynomial(core::array::from_fn(|i| self.0[i] + scale * other.0[i]))
    }

    /// The product; its degree must not be above nine.
    pub(super) fn times(&self, other: &Polynomial) -> Polynomial {
        let coefficient = |k: usize| (0..=k).map(|i| self.0[i] * other.0[k - i]).sum();
        Polynomial(core::array::from_fn(coefficient))
    }

    /// p(t) at some places.
    #[inline(always)]
    pub(super) fn values<const N: usize>(&self, places: [f64; N]) -> [f64; N] {
        let squares = places.map(|t| t * t);
        let [lower @ .., highest_even, highest_odd] = self.0;
        let (mut even, mut odd) = ([highest_even; N], [highest_odd; N]);
        for pair in lower.chunks_exact(2).rev() {
            for i in 0..N {
                even[i] = even[i] * squares[i] + pair[0];
                odd[i] = odd[i] * squares[i] + pair[1];
            }
        }
        core::array::from_fn(|i| even[i] + places[i] * odd[i])
    }

    /// dp/dt.
    pub(super) fn slope(&self, t: f64) -> f64 {
        let terms = (1..TERMS).rev();
        terms.fold(0.0, |sum, k| sum * t + k as f64 * self.0[k])
    }

    /// Integral between two places.
    pub(super) fn integral(&self, from: f64, to: f64) -> f64 {
        let until = |t: f64| {
            let terms = (0..TERMS).rev();
            t * terms.fold(0.0, |sum, k| sum * t + self.0[k] / (k + 1) as f64)
        };
        until(to) - until(from)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn products_slopes_and_integrals_are_those_of_the_formula() {
        // (2 - t)(1 + 3 t) = 2 + 5 t - 3 t^2
        let one = Polynomial::line(2.0, -1.0);
        let both = one.times(&Polynomial::constant(1.0).plus(1.0, &Polynomial::line(0.0, 3.0)));
        assert_eq!(both.values([0.0, 1.0, -2.0]), [2.0, 4.0, -20.0]);
        assert_eq!(both.slope(0.5), 2.0);
        assert_eq!(both.integral(0.0, 2.0), 4.0 + 10.0 - 8.0);
    }
}
