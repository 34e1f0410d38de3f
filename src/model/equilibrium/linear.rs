//! The static solution of rotors held by linear springs.
//!
//! ```text
//!   (K + mu) q + sum over springs of b k (w q - gap) = f - Z mu',   Z' q = 0
//! ```
//!
//! A rigid rotation R of a rotor is a torsional motion below 0.05 Hz: with a torsional basis support, subtracted again,
//! it is one only as nearly as the basis can represent it. Springs on a single block (radial bearings) stand in K. Per block K
//! is inverted without R; what remains are the forces F of the springs between blocks and the rotations r:
//!
//! ```text
//!   F + k ((w K^-1 b) F - (w R) r) = k (w K^-1 f - gap)      one row per spring
//!   (R' b) F + Z mu'               = R' f                    one row per rigid rotation
//!   Z' r                           = 0
//! ```
//!
//! mu > 0 holds everything a little, as Newton's method needs it on its way; there are no rigid rotations then.

use nalgebra::{DMatrix, DVector, DVectorView, Dyn, SymmetricEigen};

use super::super::{Coordinates, ModalModel};
use super::NoEquilibrium;
use crate::linalg::{multiply_add, solve_in_place};
use crate::solver::Row;

/// Smallest pivot of a block's stiffness relative to its largest below which the block is loose:
/// rounding leaves 1e-16, a mode of 1 Hz beside one of 1 MHz has 1e-12.
const LOOSE: f64 = 1e-14;
/// Squared circular frequency [rad^2/s^2] below which a torsional motion is rigid: 0.05 Hz.
const RIGID: f64 = 0.1;

/// A linear spring: force k (w q - gap) on the coordinates along -b.
#[derive(Debug, Clone)]
pub(super) struct StaticSpring {
    pub(super) row: Row,
    pub(super) column: Row,
    pub(super) stiffness: f64,
    pub(super) gap: f64,
    /// The only block that it touches.
    pub(super) block: Option<usize>,
}

/// The blocks with the springs on them, inverted without the rigid rotations.
pub(super) struct Held<'a> {
    model: &'a ModalModel,
    inverses: Vec<DMatrix<f64>>,
    /// R: the rigid rotations, as rows.
    rigid: Vec<Row>,
}

impl<'a> Held<'a> {
    pub(super) fn of(
        model: &'a ModalModel,
        springs: &[StaticSpring],
        mu: f64,
    ) -> Result<Self, NoEquilibrium> {
        let mut inverses = Vec::new();
        let mut rigid = Vec::new();
        for (index, block) in model.system.blocks.iter().enumerate() {
            if let Some(torsion) = Torsion::of(model, index) {
                if mu == 0.0 {
                    rigid.extend(torsion.rigid_rotations());
                }
                inverses.push(torsion.inverse(mu));
                continue;
            }
            let mut lateral = block.stiffness.clone();
            for spring in springs.iter().filter(|spring| spring.block == Some(index)) {
                let parts = (spring.row.in_block(index), spring.column.in_block(index));
                if let (Some(row), Some(column)) = parts {
                    let (row, column) = (DVector::from_vec(row), DVector::from_vec(column));
                    lateral.ger(spring.stiffness, &column, &row, 1.0);
                }
            }
            for i in 0..lateral.nrows() {
                lateral[(i, i)] += mu;
            }
            let mut rotors = model.rotors.iter();
            let rotor = rotors.position(|rotor| rotor.lateral.block() == index);
            inverses.push(invert(&lateral).ok_or(NoEquilibrium { rotor })?);
        }
        Ok(Held {
            model,
            inverses,
            rigid,
        })
    }

    /// q under a load, one entry per coordinate.
    pub(super) fn solve(
        &self,
        load: &[f64],
        springs: &[StaticSpring],
    ) -> Result<Vec<f64>, NoEquilibrium> {
        let mut load = load.to_vec();
        for spring in springs.iter().filter(|spring| spring.block.is_some()) {
            spring
                .column
                .add_to(spring.stiffness * spring.gap, &mut load);
        }
        let springs: Vec<&StaticSpring> = springs
            .iter()
            .filter(|spring| spring.block.is_none())
            .collect();
        let rigid = &self.rigid;
        let (m, r) = (springs.len(), rigid.len());
        let row_on_rigid = DMatrix::from_fn(m, r, |i, j| springs[i].row.dot_row(&rigid[j]));
        let free = null_space(&row_on_rigid);
        let size = m + r + free.ncols();

        let mut matrix = DMatrix::zeros(size, size);
        let mut rhs = vec![0.0; size];
        let elastic = self.apply(&load);
        for (i, spring) in springs.iter().enumerate() {
            let k = spring.stiffness;
            rhs[i] = k * (spring.row.dot(&elastic) - spring.gap);
            matrix[(i, i)] += 1.0;
            let response = self.apply(&spring.column.to_dense(self.model.system.size));
            for (l, other) in springs.iter().enumerate() {
                matrix[(l, i)] += other.stiffness * other.row.dot(&response);
            }
            for (j, rotation) in rigid.iter().enumerate() {
                matrix[(i, m + j)] = -k * row_on_rigid[(i, j)];
                matrix[(m + j, i)] = spring.column.dot_row(rotation);
            }
        }
        for (j, rotation) in rigid.iter().enumerate() {
            rhs[m + j] = rotation.dot(&load);
            for k in 0..free.ncols() {
                matrix[(m + j, m + r + k)] = free[(j, k)];
                matrix[(m + r + k, m + j)] = free[(j, k)];
            }
        }
        if !solve_in_place(&mut matrix, &mut rhs) {
            return Err(NoEquilibrium { rotor: None });
        }
        for (spring, &force) in springs.iter().zip(&rhs) {
            spring.column.add_to(-force, &mut load);
        }
        let mut position = self.apply(&load);
        for (j, rotation) in rigid.iter().enumerate() {
            rotation.add_to(rhs[m + j], &mut position);
        }
        Ok(position)
    }

    fn apply(&self, load: &[f64]) -> Vec<f64> {
        let mut displacement = vec![0.0; load.len()];
        for (block, inverse) in self.model.system.blocks.iter().zip(&self.inverses) {
            let range = block.range();
            let (load, target) = (&load[range.clone()], &mut displacement[range]);
            multiply_add(1.0, inverse.as_slice(), load, target);
        }
        displacement
    }
}

/// The torsional motions of one rotor, which are symmetric.
struct Torsion<'a> {
    place: &'a Coordinates,
    modes: SymmetricEigen<f64, Dyn>,
}

impl<'a> Torsion<'a> {
    /// Those in a block; `None` where it holds others.
    fn of(model: &'a ModalModel, block: usize) -> Option<Torsion<'a>> {
        let mut places = model.rotors.iter().map(|rotor| &rotor.torsional);
        let place = places.find(|place| place.block() == block)?;
        Some(Torsion {
            place,
            modes: place.stiffness(&model.system.blocks).symmetric_eigen(),
        })
    }

    fn each(&self) -> impl Iterator<Item = (f64, DVectorView<'_, f64>)> {
        let values = self.modes.eigenvalues.iter().copied();
        values.zip(self.modes.eigenvectors.column_iter())
    }

    /// What nothing holds; what only basis supports held, subtracted again, is one of them.
    fn rigid_rotations(&self) -> impl Iterator<Item = Row> {
        let rigid = self.each().filter(|(value, _)| value.abs() < RIGID);
        rigid.map(|(_, shape)| self.place.row(&shape.iter().copied().collect::<Vec<f64>>()))
    }

    /// (K + mu)^-1, without the rigid rotations where mu is zero.
    fn inverse(&self, mu: f64) -> DMatrix<f64> {
        let n = self.modes.eigenvalues.len();
        let held = self
            .each()
            .filter(|(value, _)| mu > 0.0 || value.abs() >= RIGID);
        held.fold(DMatrix::zeros(n, n), |sum, (value, shape)| {
            sum + shape * shape.transpose() / (value + mu)
        })
    }
}

/// The rigid rotations of all rotors that none of these rows resists, orthonormal.
pub(super) fn free_rotations(model: &ModalModel, rows: &[&Row]) -> Vec<Row> {
    let mut rigid: Vec<Row> = Vec::new();
    for block in 0..model.system.blocks.len() {
        if let Some(torsion) = Torsion::of(model, block) {
            rigid.extend(torsion.rigid_rotations());
        }
    }
    let on_rigid = DMatrix::from_fn(rows.len(), rigid.len(), |i, j| rows[i].dot_row(&rigid[j]));
    let combine = |weights: DVectorView<'_, f64>| {
        let mut sum = Row::default();
        for (weight, rotation) in weights.iter().zip(&rigid) {
            sum.add(*weight, rotation);
        }
        sum
    };
    null_space(&on_rigid).column_iter().map(combine).collect()
}

/// The inverse of a matrix that is clearly regular.
fn invert(matrix: &DMatrix<f64>) -> Option<DMatrix<f64>> {
    if matrix.is_empty() {
        return Some(matrix.clone());
    }
    let lu = matrix.clone().full_piv_lu();
    let pivots = lu.u().diagonal().abs();
    if pivots.min() > LOOSE * pivots.max() {
        lu.try_inverse()
    } else {
        None
    }
}

/// An orthonormal basis of the vectors that `matrix` maps to zero.
fn null_space(matrix: &DMatrix<f64>) -> DMatrix<f64> {
    let n = matrix.ncols();
    if n == 0 {
        return DMatrix::zeros(0, 0);
    }
    let eigen = (matrix.transpose() * matrix).symmetric_eigen();
    // Squares of singular values: rounding leaves 1e-16 of the largest, a tooth contact far above 1e-6 of
    // the largest radius has more than 1e-12.
    let limit = 1e-12 * eigen.eigenvalues.amax();
    let zero = |&i: &usize| eigen.eigenvalues[i] <= limit.max(f64::MIN_POSITIVE);
    let columns: Vec<DVector<f64>> = (0..n)
        .filter(zero)
        .map(|i| eigen.eigenvectors.column(i).into_owned())
        .collect();
    if columns.is_empty() {
        DMatrix::zeros(n, 0)
    } else {
        DMatrix::from_columns(&columns)
    }
}
