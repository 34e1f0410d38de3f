//! A square matrix taken apart into small independent groups of states.
//!
//! ```text
//!   A V = V B,   B block diagonal, nearly all blocks 1 x 1 or 2 x 2
//! ```
//!
//! States that no chain of entries joins are separate from the start. Each such part becomes quasi-triangular
//! by its real Schur form A = Q T Q', whose diagonal blocks are then decoupled by Sylvester equations
//! T_ii X - X T_jj = -T_ij. Where X would be large the two blocks are nearly one defective block (a rigid rotation
//! with a weak load slope, a critically damped bearing): they are made neighbours by orthogonal swaps and stay
//! together. V is therefore always well conditioned, whatever the eigenvalues.
//!
//! Sources: Golub, Van Loan, Matrix Computations, 7.6.3; swapping: Bai, Demmel, Linear Algebra Appl. 186 (1993).

use nalgebra::{DMatrix, DMatrixView};

/// Largest entry of a decoupling transformation: with a larger one states would lose more than two digits, and stay together.
const LARGEST_COUPLING: f64 = 1e2;

/// A matrix in block diagonal form.
#[derive(Debug, Clone)]
pub struct Decoupling {
    /// V, n x n.
    pub shapes: DMatrix<f64>,
    /// V^-1, n x n.
    pub inverse: DMatrix<f64>,
    /// The diagonal blocks in order.
    pub groups: Vec<Group>,
}

/// One diagonal block of B: states `first .. first + m`.
#[derive(Debug, Clone)]
pub struct Group {
    /// Index of the first state.
    pub first: usize,
    /// The block, m x m.
    pub matrix: DMatrix<f64>,
}

/// Takes a square matrix apart.
pub fn decouple(matrix: &DMatrix<f64>) -> Decoupling {
    let n = matrix.nrows();
    let mut whole = Decoupling {
        shapes: DMatrix::zeros(n, n),
        inverse: DMatrix::zeros(n, n),
        groups: Vec::new(),
    };
    let mut first = 0;
    for states in connected(matrix) {
        let m = states.len();
        let part = DMatrix::from_fn(m, m, |i, j| matrix[(states[i], states[j])]);
        let (shapes, inverse, groups) = decouple_connected(&part);
        for (i, &state) in states.iter().enumerate() {
            for j in 0..m {
                whole.shapes[(state, first + j)] = shapes[(i, j)];
                whole.inverse[(first + j, state)] = inverse[(j, i)];
            }
        }
        whole.groups.extend(groups.into_iter().map(|group| Group {
            first: first + group.first,
            ..group
        }));
        first += m;
    }
    whole
}

/// The states that chains of entries join, each set ascending.
fn connected(matrix: &DMatrix<f64>) -> Vec<Vec<usize>> {
    let n = matrix.nrows();
    let mut label: Vec<Option<usize>> = vec![None; n];
    let mut sets: Vec<Vec<usize>> = Vec::new();
    for start in 0..n {
        if label[start].is_some() {
            continue;
        }
        let set = sets.len();
        let mut reached = vec![start];
        label[start] = Some(set);
        let mut members = Vec::new();
        while let Some(state) = reached.pop() {
            members.push(state);
            for other in 0..n {
                let joined = matrix[(state, other)] != 0.0 || matrix[(other, state)] != 0.0;
                if joined && label[other].is_none() {
                    label[other] = Some(set);
                    reached.push(other);
                }
            }
        }
        members.sort_unstable();
        sets.push(members);
    }
    sets
}

fn decouple_connected(matrix: &DMatrix<f64>) -> (DMatrix<f64>, DMatrix<f64>, Vec<Group>) {
    let n = matrix.nrows();
    let identity = || DMatrix::identity(n, n);
    let together = || {
        let group = Group {
            first: 0,
            matrix: matrix.clone(),
        };
        (identity(), identity(), vec![group])
    };
    if n == 1 {
        return together();
    }
    let Some(schur) = nalgebra::Schur::try_new(matrix.clone(), f64::EPSILON, 100 * n) else {
        return together();
    };
    let (mut q, mut t) = schur.unpack();
    let mut sizes = diagonal_blocks(&mut t);
    loop {
        match decoupling_transformation(&t, &sizes) {
            Ok(unit) => {
                let starts = starts(&sizes);
                let groups = starts
                    .iter()
                    .zip(&sizes)
                    .map(|(&first, &size)| Group {
                        first,
                        matrix: t.view((first, first), (size, size)).into_owned(),
                    })
                    .collect();
                let inverse = unit_inverse(&unit) * q.transpose();
                return (&q * unit, inverse, groups);
            }
            Err((low, high)) => join(&mut t, &mut q, &mut sizes, low, high),
        }
    }
}

/// Sizes of the diagonal blocks of a quasi-triangular matrix; entries below them become exactly zero.
fn diagonal_blocks(t: &mut DMatrix<f64>) -> Vec<usize> {
    let n = t.nrows();
    let mut sizes = Vec::new();
    let mut i = 0;
    while i < n {
        let coupled = i + 1 < n
            && t[(i + 1, i)].abs() > f64::EPSILON * (t[(i, i)].abs() + t[(i + 1, i + 1)].abs());
        let size = if coupled { 2 } else { 1 };
        sizes.push(size);
        i += size;
        for row in i..n {
            for column in i - size..i {
                t[(row, column)] = 0.0;
            }
        }
    }
    sizes
}

fn starts(sizes: &[usize]) -> Vec<usize> {
    let mut next = 0;
    sizes
        .iter()
        .map(|size| {
            let start = next;
            next += size;
            start
        })
        .collect()
}

/// The unit upper block triangular S with T S = S B; otherwise the two blocks that should stay together.
fn decoupling_transformation(
    t: &DMatrix<f64>,
    sizes: &[usize],
) -> Result<DMatrix<f64>, (usize, usize)> {
    let n = t.nrows();
    let starts = starts(sizes);
    let mut s = DMatrix::identity(n, n);
    for j in 0..sizes.len() {
        let (column, width) = (starts[j], sizes[j]);
        let own = t.view((column, column), (width, width));
        for i in (0..j).rev() {
            let (row, height) = (starts[i], sizes[i]);
            // T_ii X - X T_jj = -(sum over k = i+1 .. j of T_ik S_kj)
            let below = row + height..column + width;
            let right = t.view((row, below.start), (height, below.len()))
                * s.view((below.start, column), (below.len(), width));
            let x = sylvester(t.view((row, row), (height, height)), own, &-right)
                .filter(|x| x.amax() <= LARGEST_COUPLING)
                .ok_or((i, j))?;
            s.view_mut((row, column), (height, width)).copy_from(&x);
        }
    }
    Ok(s)
}

/// X of L X - X R = C; `None` when it is not determined.
fn sylvester(
    left: DMatrixView<'_, f64>,
    right: DMatrixView<'_, f64>,
    constant: &DMatrix<f64>,
) -> Option<DMatrix<f64>> {
    let (p, q) = (left.nrows(), right.nrows());
    // Column by column: (I x L - R' x I) vec X = vec C.
    let system = DMatrix::from_fn(p * q, p * q, |row, column| {
        let (i, j) = (row % p, row / p);
        let (k, l) = (column % p, column / p);
        let from_left = if j == l { left[(i, k)] } else { 0.0 };
        let from_right = if i == k { right[(l, j)] } else { 0.0 };
        from_left - from_right
    });
    if constant.amax() == 0.0 {
        return Some(constant.clone());
    }
    let solution =
        system
            .full_piv_lu()
            .solve(&DMatrix::from_column_slice(p * q, 1, constant.as_slice()))?;
    Some(DMatrix::from_column_slice(p, q, solution.as_slice()))
}

/// Moves block `high` down the order until it follows block `low`, and makes them one.
fn join(
    t: &mut DMatrix<f64>,
    q: &mut DMatrix<f64>,
    sizes: &mut Vec<usize>,
    low: usize,
    high: usize,
) {
    for position in (low + 1..high).rev() {
        let first = starts(sizes)[position];
        swap_neighbours(t, q, first, sizes[position], sizes[position + 1]);
        sizes.swap(position, position + 1);
    }
    sizes[low] += sizes.remove(low + 1);
}

/// Exchanges two neighbouring diagonal blocks of sizes p and r by an orthogonal transformation.
fn swap_neighbours(t: &mut DMatrix<f64>, q: &mut DMatrix<f64>, first: usize, p: usize, r: usize) {
    let n = t.nrows();
    let coupling = t.view((first, first + p), (p, r)).into_owned();
    // A11 X - X A22 = -A12: the columns of [X; I] span the invariant subspace of A22.
    let Some(x) = sylvester(
        t.view((first, first), (p, p)),
        t.view((first + p, first + p), (r, r)),
        &-coupling,
    ) else {
        return; // equal blocks: their order does not matter
    };
    let mut basis = DMatrix::zeros(p + r, p + r);
    basis.view_mut((0, 0), (p, r)).copy_from(&x);
    basis.view_mut((p, 0), (r, r)).fill_with_identity();
    basis.view_mut((0, r), (p, p)).fill_with_identity();
    let rotation = basis.qr().q();
    let rows = rotation.transpose() * t.view((first, 0), (p + r, n));
    t.view_mut((first, 0), (p + r, n)).copy_from(&rows);
    let columns = t.view((0, first), (n, p + r)) * &rotation;
    t.view_mut((0, first), (n, p + r)).copy_from(&columns);
    let columns = q.view((0, first), (n, p + r)) * &rotation;
    q.view_mut((0, first), (n, p + r)).copy_from(&columns);
    t.view_mut((first + r, first), (p, r)).fill(0.0);
}

/// The inverse of a unit upper triangular matrix.
fn unit_inverse(s: &DMatrix<f64>) -> DMatrix<f64> {
    let n = s.nrows();
    let mut inverse = DMatrix::identity(n, n);
    for column in 0..n {
        for row in (0..column).rev() {
            let known: f64 = (row + 1..=column)
                .map(|k| s[(row, k)] * inverse[(k, column)])
                .sum();
            inverse[(row, column)] = -known;
        }
    }
    inverse
}

#[cfg(test)]
mod tests {
    use super::*;

    fn check(matrix: &DMatrix<f64>) -> Decoupling {
        let n = matrix.nrows();
        let parts = decouple(matrix);
        let mut diagonal = DMatrix::zeros(n, n);
        for group in &parts.groups {
            let m = group.matrix.nrows();
            diagonal
                .view_mut((group.first, group.first), (m, m))
                .copy_from(&group.matrix);
        }
        // 1e-10: rounding times the largest coupling that is allowed.
        let scale = matrix.amax() * parts.shapes.amax();
        let residual = matrix * &parts.shapes - &parts.shapes * diagonal;
        assert!(residual.amax() < 1e-10 * scale, "{}", residual.amax());
        let identity = &parts.shapes * &parts.inverse - DMatrix::identity(n, n);
        assert!(identity.amax() < 1e-10, "{}", identity.amax());
        parts
    }

    fn sizes(parts: &Decoupling) -> Vec<usize> {
        let mut sizes: Vec<usize> = parts
            .groups
            .iter()
            .map(|group| group.matrix.nrows())
            .collect();
        sizes.sort_unstable();
        sizes
    }

    #[test]
    fn states_without_a_common_entry_are_separate() {
        let mut matrix = DMatrix::zeros(4, 4);
        (matrix[(0, 2)], matrix[(2, 0)]) = (3.0, -3.0);
        (matrix[(1, 3)], matrix[(3, 1)]) = (3.0, -3.0);
        assert_eq!(sizes(&check(&matrix)), [2, 2]);
    }

    #[test]
    fn oscillators_with_and_without_damping_become_pairs_and_single_states() {
        // Two masses, springs and dampers: a pair and two real eigenvalues.
        let matrix = DMatrix::from_row_slice(
            4,
            4,
            &[
                0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, -5.0, 2.0, -0.1, 0.05, 2.0, -9.0, 0.05,
                -30.0,
            ],
        );
        assert_eq!(sizes(&check(&matrix)), [1, 1, 2]);
    }

    #[test]
    fn a_slow_rotation_with_weak_drag_stays_together() {
        let group_sizes = |drag: f64| {
            sizes(&check(&DMatrix::from_row_slice(
                2,
                2,
                &[0.0, 1e3, 0.0, -drag],
            )))
        };
        assert_eq!(group_sizes(9.0), [2]);
        assert_eq!(group_sizes(11.0), [1, 1]);
    }

    #[test]
    fn nearly_defective_states_stay_together_wherever_they_stand() {
        // Two rigid rotations with weak drag, joined by small entries with three oscillators.
        let n = 10;
        let mut matrix = DMatrix::zeros(n, n);
        for (i, w) in [(0, 3.0), (4, 11.0), (8, 40.0)] {
            (matrix[(i, i + 1)], matrix[(i + 1, i)]) = (w, -w);
            matrix[(i + 1, i + 1)] = -0.02 * w;
        }
        (matrix[(2, 3)], matrix[(3, 3)]) = (1.0, -1e-9);
        (matrix[(6, 7)], matrix[(7, 7)]) = (1.0, -2.0);
        for i in 0..n {
            for j in [1, 3, 5, 7, 9] {
                if i != j && i % 2 == 1 {
                    matrix[(j, i)] += 1e-3 * (i * j) as f64;
                }
            }
        }
        let parts = check(&matrix);
        assert!(
            parts.groups.iter().all(|group| group.matrix.nrows() <= 4),
            "{:?}",
            sizes(&parts)
        );
    }
}
