//! Eigenvalues and eigenvectors of a real matrix without symmetry.
//!
//! ```text
//!   A = Q T Q'        T quasi-triangular: real eigenvalues and 2 x 2 blocks of complex pairs on its diagonal
//!   (T - lambda) y = 0  by back substitution,   v = Q y
//! ```
//!
//! as in Golub, Van Loan, Matrix Computations, 4th ed., 7.6.4. Where back substitution divides by the
//! difference of equal eigenvalues, the difference is replaced by rounding of the matrix: eigenvalues that
//! occur several times get different vectors of their common space when it has as many dimensions, and nearly the
//! same vector when it has not (a free rotation).

use nalgebra::{Complex, DMatrix, DVector, Schur};

/// More sweeps than any matrix needs that is not full of absurd numbers.
const SWEEPS: usize = 10_000;

/// One eigenvalue of each complex pair (the one with positive imaginary part) and every real one.
#[derive(Debug, Clone)]
pub struct Eigenpair {
    /// lambda, Im lambda >= 0.
    pub value: Complex<f64>,
    /// A v = lambda v, |v| = 1.
    pub vector: DVector<Complex<f64>>,
}

/// All eigenpairs with Im lambda >= 0; `None` when the iteration does not converge.
pub fn eigenpairs(matrix: DMatrix<f64>) -> Option<Vec<Eigenpair>> {
    let n = matrix.nrows();
    let (q, t) = Schur::try_new(matrix, f64::EPSILON, SWEEPS)?.unpack();
    let rounding = (f64::EPSILON * t.norm()).max(f64::MIN_POSITIVE);
    let mut pairs = Vec::with_capacity(n);
    let mut row = 0;
    while row < n {
        let size = block_size(&t, row);
        let (value, start) = if size == 1 {
            (Complex::new(t[(row, row)], 0.0), [ONE, ZERO])
        } else {
            let value = upper_root(&t, row);
            // (T - lambda) [T_12, lambda - T_11]' = 0 in the first row of the block.
            let second = value - t[(row, row)];
            (value, [Complex::new(t[(row, row + 1)], 0.0), second])
        };
        let y = substitute_back(&t, row, &start[..size], value, rounding);
        let re = &q * y.map(|entry| entry.re);
        let im = &q * y.map(|entry| entry.im);
        let size_of = (re.norm_squared() + im.norm_squared()).sqrt();
        let vector = re.zip_map(&im, |re, im| Complex::new(re, im) / size_of);
        pairs.push(Eigenpair { value, vector });
        row += size;
    }
    Some(pairs)
}

/// The eigenvalues with Im lambda >= 0 alone; `None` when the iteration does not converge.
pub fn eigenvalues(matrix: DMatrix<f64>) -> Option<Vec<Complex<f64>>> {
    let (_, t) = Schur::try_new(matrix, f64::EPSILON, SWEEPS)?.unpack();
    let mut values = Vec::new();
    let mut row = 0;
    while row < t.nrows() {
        let size = block_size(&t, row);
        values.push(match size {
            1 => Complex::new(t[(row, row)], 0.0),
            _ => upper_root(&t, row),
        });
        row += size;
    }
    Some(values)
}

const ONE: Complex<f64> = Complex::new(1.0, 0.0);
const ZERO: Complex<f64> = Complex::new(0.0, 0.0);

/// 2 where T holds a complex pair at this row. Two real eigenvalues that share a block are found by
/// [`upper_root`] to have no imaginary part; nalgebra splits such blocks.
fn block_size(t: &DMatrix<f64>, row: usize) -> usize {
    let below = row + 1 < t.nrows() && t[(row + 1, row)] != 0.0;
    1 + usize::from(below)
}

/// The eigenvalue of the 2 x 2 block at `row` with the larger imaginary part.
fn upper_root(t: &DMatrix<f64>, row: usize) -> Complex<f64> {
    let (a, b) = (t[(row, row)], t[(row, row + 1)]);
    let (c, d) = (t[(row + 1, row)], t[(row + 1, row + 1)]);
    let (middle, half) = (0.5 * (a + d), 0.5 * (a - d));
    let square = half * half + b * c;
    if square < 0.0 {
        Complex::new(middle, (-square).sqrt())
    } else {
        Complex::new(middle + square.sqrt(), 0.0)
    }
}

/// Solves (T - lambda) y = 0 upward from the block at `row`, where y is `start`; zero below it.
fn substitute_back(
    t: &DMatrix<f64>,
    row: usize,
    start: &[Complex<f64>],
    value: Complex<f64>,
    rounding: f64,
) -> DVector<Complex<f64>> {
    let mut y = DVector::from_element(t.nrows(), ZERO);
    y.as_mut_slice()[row..row + start.len()].copy_from_slice(start);
    let known = row + start.len();
    let sum = |y: &DVector<Complex<f64>>, i: usize, from: usize| -> Complex<f64> {
        (from..known).map(|k| y[k] * t[(i, k)]).sum()
    };
    let mut next = row;
    while next > 0 {
        let last = next - 1;
        if last > 0 && t[(last, last - 1)] != 0.0 {
            let first = last - 1;
            let rhs = [-sum(&y, first, next), -sum(&y, last, next)];
            let (a, d) = (t[(first, first)] - value, t[(last, last)] - value);
            let (b, c) = (t[(first, last)], t[(last, first)]);
            let determinant = apart_from_zero(a * d - b * c, rounding * rounding);
            y[first] = (rhs[0] * d - rhs[1] * b) / determinant;
            y[last] = (rhs[1] * a - rhs[0] * c) / determinant;
            next = first;
        } else {
            let rhs = -sum(&y, last, next);
            y[last] = rhs / apart_from_zero(t[(last, last)] - value, rounding);
            next = last;
        }
        let peak = y[next].norm_sqr();
        if peak > 1e100 {
            y /= Complex::new(peak.sqrt(), 0.0);
        }
    }
    y
}

/// The number itself, or the smallest one allowed as a divisor.
fn apart_from_zero(number: Complex<f64>, least: f64) -> Complex<f64> {
    if number.norm_sqr() < least * least {
        Complex::new(least, 0.0)
    } else {
        number
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn residual(matrix: &DMatrix<f64>, pair: &Eigenpair) -> f64 {
        let complex = matrix.map(|entry| Complex::new(entry, 0.0));
        let difference = complex * &pair.vector - &pair.vector * pair.value;
        difference.iter().map(Complex::norm_sqr).sum::<f64>().sqrt()
    }

    #[test]
    fn pairs_satisfy_their_equation() {
        // A damped chain in state form: complex pairs of very different size.
        let n = 9;
        let matrix = DMatrix::from_fn(2 * n, 2 * n, |i, j| match (i < n, j < n) {
            (true, true) => 0.0,
            (true, false) => f64::from(u8::from(j == i + n)),
            (false, true) if i - n == j => -2.5 - (j * j) as f64,
            (false, true) if (i - n).abs_diff(j) == 1 => 1.0 + 0.2 * j as f64,
            (false, true) => 0.0,
            (false, false) => -0.01 * f64::from(u8::from(i == j)),
        });
        let pairs = eigenpairs(matrix.clone()).unwrap();
        let plain = eigenvalues(matrix.clone()).unwrap();
        assert_eq!(pairs.len(), n);
        for (pair, value) in pairs.iter().zip(plain) {
            // 1e-13: rounding of a matrix of norm 100.
            assert!(residual(&matrix, pair) < 1e-12, "{}", pair.value);
            assert!((pair.value - value).norm_sqr() < 1e-24);
        }
    }

    #[test]
    fn an_eigenvalue_that_occurs_twice_gets_two_directions() {
        // x and y vibrate alike and independently: two equal pairs.
        let matrix = DMatrix::from_row_slice(
            4,
            4,
            &[
                0.0, 0.0, 2.0, 0.0, 0.0, 0.0, 0.0, 2.0, -2.0, 0.0, 0.0, 0.0, 0.0, -2.0, 0.0, 0.0,
            ],
        );
        let pairs = eigenpairs(matrix.clone()).unwrap();
        assert_eq!(pairs.len(), 2);
        let along: Complex<f64> = pairs[0].vector.dotc(&pairs[1].vector);
        assert!(along.norm_sqr() < 0.99, "the vectors differ: {along}");
        for pair in &pairs {
            assert!((pair.value - Complex::new(0.0, 2.0)).norm_sqr() < 1e-28);
            assert!(residual(&matrix, pair) < 1e-14);
        }
    }

    #[test]
    fn a_free_rotation_has_one_direction_and_no_overflow() {
        let matrix = DMatrix::from_row_slice(2, 2, &[0.0, 1.0, 0.0, 0.0]);
        for pair in eigenpairs(matrix).unwrap() {
            assert!((pair.vector[0].norm_sqr() - 1.0).abs() < 1e-12);
        }
    }
}
