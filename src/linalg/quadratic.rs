//! One eigenpair of a quadratic eigenproblem, from a guess.
//!
//! ```text
//!   T(l) x = (l^2 + l D + K) x = 0
//!   T(l) u = T'(l) x,   l <- l - (x* x) / (x* u),   x <- u / |u|          Newton's method, quadratic
//! ```
//!
//! Nonlinear inverse iteration; Guettel, Tisseur, Acta Numerica 26 (2017), 4.2.

use nalgebra::{Complex, DMatrix, DVector};

/// Steps before the guess counts as too far away.
const STEPS: usize = 12;
/// Relative change of the eigenvalue that ends the iteration; the next step would square it.
const CONVERGED: f64 = 1e-9;

/// The eigenpair of l^2 + l D + K that Newton's method finds from (l, x), |x| = 1; `None` when it finds none.
pub fn quadratic_eigenpair(
    stiffness: &DMatrix<f64>,
    damping: &DMatrix<f64>,
    guess: (Complex<f64>, &DVector<Complex<f64>>),
) -> Option<(Complex<f64>, DVector<Complex<f64>>)> {
    let (mut value, mut vector) = (guess.0, guess.1.clone());
    let derivative = damping.map(|entry| Complex::new(entry, 0.0));
    for _ in 0..STEPS {
        let mut matrix = stiffness.zip_map(damping, |k, d| value * d + k);
        for i in 0..matrix.nrows() {
            matrix[(i, i)] += value * value;
        }
        let rhs = &derivative * &vector + &vector * (value * 2.0);
        // A singular matrix means that the guess is an eigenvalue to the last bit.
        let Some(next) = matrix.lu().solve(&rhs) else {
            return Some((value, vector));
        };
        let change = Complex::new(1.0, 0.0) / vector.dotc(&next);
        let size = next.iter().map(Complex::norm_sqr).sum::<f64>().sqrt();
        if !size.is_finite() || size == 0.0 {
            return None;
        }
        value -= change;
        vector = next / Complex::new(size, 0.0);
        if change.norm_sqr() <= CONVERGED * CONVERGED * value.norm_sqr() {
            return Some((value, vector));
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_damped_pair_is_found_from_a_neighbouring_guess() {
        // Two oscillators that do not know each other: l = -zeta w + i w sqrt(1 - zeta^2).
        let stiffness = DMatrix::from_diagonal(&DVector::from_row_slice(&[4.0, 9.0]));
        let damping = DMatrix::from_diagonal(&DVector::from_row_slice(&[0.4, 0.3]));
        let half = Complex::new(0.5_f64.sqrt(), 0.0);
        let start = DVector::from_row_slice(&[half, half * 0.9]);
        let guess = (Complex::new(0.0, 2.2), &start);
        let (value, vector) = quadratic_eigenpair(&stiffness, &damping, guess).unwrap();
        let exact = Complex::new(-0.2, (4.0_f64 - 0.04).sqrt());
        // 1e-14: the last change was below 1e-9 and its square is rounding.
        assert!((value - exact).norm_sqr() < 1e-28, "{value}");
        assert!(vector[1].norm_sqr() < 1e-18);
    }
}
