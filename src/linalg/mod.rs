//! The few pieces of dense linear algebra that the floors above share.
//!
//! Factorizations and eigenvalues come from nalgebra. The in-place routines at the end exist because a
//! time step may not allocate, which nalgebra's factorizations do.

mod decoupling;
mod eigenpairs;
mod phi;
mod quadratic;

use nalgebra::{DMatrix, DVector};

pub use decoupling::{Decoupling, Group, decouple};
pub use eigenpairs::{Eigenpair, eigenpairs, eigenvalues};
pub use phi::{Numbers, PHI_ORDERS, PhiFunctions, SmallPhi, exponentials};
pub use quadratic::quadratic_eigenpair;

/// Natural modes of `M u'' + K u = 0`, ascending in frequency, as far as floating point resolves them.
#[derive(Debug, Clone)]
pub struct Modes {
    /// Squared circular frequencies w^2 [rad^2/s^2]; rigid-body modes have exactly 0.
    pub squared_frequencies: Vec<f64>,
    /// One mode per column, n x m, `shapes' M shapes = I`; the largest entry of each column is positive.
    /// m < n when some degrees of freedom have almost no mass.
    pub shapes: DMatrix<f64>,
}

/// Solves `K phi = w^2 M phi` for symmetric K (positive semidefinite) and M (positive definite), n x n.
///
/// ```text
///   (K + s M) phi = (w^2 + s) M phi       K + s M = L L'
///   (L^-1 M L^-T) v = 1/(w^2 + s) v       phi = L^-T v, scaled so that phi' M phi = 1
/// ```
///
/// The inverse form gives the lowest frequencies the full precision that the direct form gives the
/// highest. The shift s makes rigid-body modes regular; it is first min K_ii / M_ii / n^2, the order of the
/// lowest elastic w^2 of a shaft, and then the lowest w^2 found, should that be far below (soft bearings).
/// w^2 below 1e-9 s counts as 0. Modes with more than 1e13 times the w^2 of the lowest one are left out: they
/// are noise. `None` when K or M is not what is asked for.
pub fn natural_modes(stiffness: &DMatrix<f64>, mass: &DMatrix<f64>) -> Option<Modes> {
    let n = mass.nrows();
    let stiffest = |i: usize| stiffness[(i, i)] / mass[(i, i)];
    let softest = (0..n).map(stiffest).fold(f64::INFINITY, f64::min);
    let shift = softest.max(1.0) / (n * n) as f64;
    if !shift.is_finite() || !mass.iter().all(|value| value.is_finite()) {
        return None;
    }
    let modes = modes_with_shift(stiffness, mass, shift)?;
    match modes
        .squared_frequencies
        .iter()
        .find(|&&squared| squared > 0.0)
    {
        Some(&lowest) if lowest < 1e-3 * shift => modes_with_shift(stiffness, mass, lowest),
        _ => Some(modes),
    }
}

fn modes_with_shift(stiffness: &DMatrix<f64>, mass: &DMatrix<f64>, shift: f64) -> Option<Modes> {
    let n = mass.nrows();
    let factor = (stiffness + mass * shift).cholesky()?.unpack();
    let left = factor.solve_lower_triangular(mass)?; // L^-1 M
    let mut compliance = factor.solve_lower_triangular(&left.transpose())?; // L^-1 M L^-T
    compliance.fill_upper_triangle_with_lower_triangle();
    let eigen = compliance.symmetric_eigen();

    let resolved = 1e-13 * eigen.eigenvalues.max();
    let mut order: Vec<usize> = (0..n)
        .filter(|&i| eigen.eigenvalues[i] > resolved)
        .collect();
    order.sort_by(|&i, &j| eigen.eigenvalues[j].total_cmp(&eigen.eigenvalues[i]));
    let mut shapes = DMatrix::zeros(n, order.len());
    let mut squared_frequencies = Vec::with_capacity(order.len());
    for (column, &source) in order.iter().enumerate() {
        let value = eigen.eigenvalues[source];
        let squared = 1.0 / value - shift;
        // Rounding leaves about 1e-13 s on a rigid-body mode; elastic ones are near s or above.
        squared_frequencies.push(if squared < 1e-9 * shift { 0.0 } else { squared });
        let mut shape = factor.tr_solve_lower_triangular(&eigen.eigenvectors.column(source))?;
        shape /= (mass * &shape).dot(&shape).sqrt();
        if largest(&shape) < 0.0 {
            shape.neg_mut();
        }
        shapes.set_column(column, &shape);
    }
    Some(Modes {
        squared_frequencies,
        shapes,
    })
}

impl Modes {
    /// Number of rigid-body modes; they come first.
    pub fn rigid_count(&self) -> usize {
        let rigid = |squared: &&f64| **squared == 0.0;
        self.squared_frequencies.iter().take_while(rigid).count()
    }
}

/// The entry of largest magnitude; the first one of several within rounding.
pub fn largest(vector: &DVector<f64>) -> f64 {
    let peak = vector.amax();
    vector
        .iter()
        .copied()
        .find(|value| value.abs() >= peak * (1.0 - 1e-9))
        .unwrap_or(0.0)
}

/// y += scale A x, without allocation. A is `y.len()` x `x.len()`, column by column.
#[inline(always)]
pub fn multiply_add(scale: f64, matrix: &[f64], x: &[f64], y: &mut [f64]) {
    let n = y.len();
    debug_assert_eq!(matrix.len(), n * x.len());
    if n == 0 {
        return;
    }
    // Four columns at a time: y is loaded and stored a quarter as often.
    let (quads, rest) = matrix.split_at(x.len() / 4 * 4 * n);
    let (x_quads, x_rest) = x.split_at(x.len() / 4 * 4);
    for (columns, x) in quads.chunks_exact(4 * n).zip(x_quads.chunks_exact(4)) {
        let (c0, columns) = columns.split_at(n);
        let (c1, columns) = columns.split_at(n);
        let (c2, c3) = columns.split_at(n);
        let (x0, x1, x2, x3) = (scale * x[0], scale * x[1], scale * x[2], scale * x[3]);
        for ((((target, c0), c1), c2), c3) in y.iter_mut().zip(c0).zip(c1).zip(c2).zip(c3) {
            *target += (c0 * x0 + c1 * x1) + (c2 * x2 + c3 * x3);
        }
    }
    for (column, &factor) in rest.chunks_exact(n).zip(x_rest) {
        add_scaled(scale * factor, column, y);
    }
}

/// y += scale x.
#[inline(always)]
pub fn add_scaled(scale: f64, x: &[f64], y: &mut [f64]) {
    for (target, &value) in y.iter_mut().zip(x) {
        *target += scale * value;
    }
}

/// x' y.
pub fn dot(x: &[f64], y: &[f64]) -> f64 {
    x.iter().zip(y).map(|(&left, &right)| left * right).sum()
}

/// Replaces a square matrix by its inverse (Gauss-Jordan with row pivoting), without allocation.
/// `swaps` needs one entry per row. `false` when the matrix is singular; it then holds no meaning.
#[must_use]
pub fn invert_in_place(matrix: &mut DMatrix<f64>, swaps: &mut [usize]) -> bool {
    let n = matrix.nrows();
    for pivot in 0..n {
        let row = pivot_row(matrix, pivot);
        let value = matrix[(row, pivot)];
        if value == 0.0 || !value.is_finite() {
            return false;
        }
        matrix.swap_rows(pivot, row);
        swaps[pivot] = row;
        matrix[(pivot, pivot)] = 1.0;
        for j in 0..n {
            matrix[(pivot, j)] /= value;
        }
        for i in (0..n).filter(|&i| i != pivot) {
            let factor = matrix[(i, pivot)];
            matrix[(i, pivot)] = 0.0;
            for j in 0..n {
                let change = factor * matrix[(pivot, j)];
                matrix[(i, j)] -= change;
            }
        }
    }
    for pivot in (0..n).rev() {
        matrix.swap_columns(pivot, swaps[pivot]);
    }
    true
}

/// Solves `matrix x = rhs` in place (Gaussian elimination with row pivoting, zeros skipped), without
/// allocation; `rhs` becomes x. `false` when the matrix is singular.
#[must_use]
pub fn solve_in_place(matrix: &mut DMatrix<f64>, rhs: &mut [f64]) -> bool {
    let n = matrix.nrows();
    for pivot in 0..n {
        let row = pivot_row(matrix, pivot);
        let value = matrix[(row, pivot)];
        if value == 0.0 || !value.is_finite() {
            return false;
        }
        matrix.swap_rows(pivot, row);
        rhs.swap(pivot, row);
        for i in pivot + 1..n {
            let factor = matrix[(i, pivot)] / value;
            if factor != 0.0 {
                for j in pivot + 1..n {
                    let change = factor * matrix[(pivot, j)];
                    matrix[(i, j)] -= change;
                }
                rhs[i] -= factor * rhs[pivot];
            }
        }
    }
    for i in (0..n).rev() {
        let known: f64 = (i + 1..n).map(|j| matrix[(i, j)] * rhs[j]).sum();
        rhs[i] = (rhs[i] - known) / matrix[(i, i)];
    }
    true
}

fn pivot_row(matrix: &DMatrix<f64>, pivot: usize) -> usize {
    let size = |row: usize| matrix[(row, pivot)].abs();
    (pivot..matrix.nrows()).fold(
        pivot,
        |best, row| if size(row) > size(best) { row } else { best },
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sample() -> DMatrix<f64> {
        DMatrix::from_row_slice(3, 3, &[0.0, 2.0, 1.0, 4.0, 1.0, -1.0, 2.0, 5.0, 3.0])
    }

    #[test]
    fn inverse_times_matrix_is_identity_although_the_first_pivot_is_zero() {
        let mut inverse = sample();
        assert!(invert_in_place(&mut inverse, &mut [0; 3]));
        // 1e-14: a few roundings of numbers of order one.
        assert!((inverse * sample() - DMatrix::identity(3, 3)).amax() < 1e-14);
    }

    #[test]
    fn solving_in_place_satisfies_the_equations() {
        let mut x = [1.0, -2.0, 0.5];
        assert!(solve_in_place(&mut sample(), &mut x));
        let residual =
            sample() * DVector::from_row_slice(&x) - DVector::from_row_slice(&[1.0, -2.0, 0.5]);
        assert!(residual.amax() < 1e-14);
    }

    #[test]
    fn singular_matrices_are_refused() {
        let mut flat = DMatrix::from_element(2, 2, 1.0);
        assert!(!invert_in_place(&mut flat.clone(), &mut [0; 2]));
        assert!(!solve_in_place(&mut flat, &mut [1.0, 2.0]));
    }

    #[test]
    fn softly_held_bodies_keep_their_frequency_beside_stiff_ones() {
        // Two unit masses on a spring of 1e8 N/m, each held by 1 N/m: 1 and sqrt(1 + 2e8) rad/s.
        let stiffness = DMatrix::from_row_slice(2, 2, &[1e8 + 1.0, -1e8, -1e8, 1e8 + 1.0]);
        let modes = natural_modes(&stiffness, &DMatrix::identity(2, 2)).unwrap();
        // 1e-7: the entries carry 1e-8 of the soft spring.
        assert!(
            (modes.squared_frequencies[0] - 1.0).abs() < 1e-7,
            "{:?}",
            modes.squared_frequencies
        );
    }

    #[test]
    fn free_spring_chain_has_a_rigid_mode_and_the_closed_form_frequencies() {
        // n unit masses on unit springs, both ends free: w_k = 2 sin(k pi / 2n), k = 0 .. n-1.
        let n = 12;
        let mut stiffness = DMatrix::zeros(n, n);
        for i in 0..n - 1 {
            for (row, column, value) in [
                (i, i, 1.0),
                (i + 1, i + 1, 1.0),
                (i, i + 1, -1.0),
                (i + 1, i, -1.0),
            ] {
                stiffness[(row, column)] += value;
            }
        }
        let modes = natural_modes(&stiffness, &DMatrix::identity(n, n)).unwrap();
        assert_eq!(modes.squared_frequencies[0], 0.0);
        for (k, squared) in modes.squared_frequencies.iter().enumerate().skip(1) {
            let exact = 2.0 * libm::sin(k as f64 * core::f64::consts::PI / (2 * n) as f64);
            // 1e-12: rounding of the eigenvalue solver.
            assert!((squared.sqrt() / exact - 1.0).abs() < 1e-12, "mode {k}");
        }
    }
}
