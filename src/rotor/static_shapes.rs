//! Static shapes: the deflections under unit loads that the kept modes leave out.
//!
//! ```text
//!   K x_j = f_j                                        unit load at a gear, a bearing, a torque
//!   (K + s M R R'M) x_j = (I - M R R') f_j             R: modes with hardly any strain; inertia relief
//!   x_j <- x_j - Phi Phi'M x_j                         what the modes have is taken out
//!   X U, (X'K_b X) U = (X'M X) U diag(w^2)             so that M = I and K_b diagonal again, K_b = K + K_sup
//! ```
//!
//! With them every static stiffness between the loaded stations is exact, however few modes are kept; they cannot
//! replace a missing mode at its frequency. K has no basis supports: the statics are those of the real shaft. R holds the
//! motions of a free or softly held shaft, beside which its bending would drown in rounding; they belong to the statics
//! too, and are added where supports have bent them out of the modes.
//!
//! Shapes depend on each other where stations are neighbours, or where the modes are nearly complete. They are
//! chosen one by one, always the one with the largest part that is not there yet, measured by energy
//! <x, x> = x'(K_b + s M) x, s = w^2 of the first mode beyond R (residual flexibility: MacNeal, Computers & Structures 1 (1971);
//! Rubin, AIAA J. 13 (1975)).

use nalgebra::{DMatrix, DVector};

use super::elastic::Elastic;
use crate::linalg::largest;

/// A shape whose energy is there but for this part is left out: the compliance at its own station is then
/// exact to this part, a thousandth of the 1e-9 asked for.
const THERE: f64 = 1e-12;
/// Rounding of the shapes, 1e-16 of their size, has an energy of about 1e-19 with the stiffest of elements;
/// a part above this is still a shape.
const NOISE: f64 = 1e-16;

/// Shapes with their squared frequencies.
pub(super) struct StaticShapes {
    /// One per column, mass normalised and mass-orthogonal to the modes.
    pub(super) shapes: DMatrix<f64>,
    /// w^2 with the basis supports, ascending.
    pub(super) squared_frequencies: Vec<f64>,
}

/// A shape that could be added.
struct Candidate {
    /// The part that is not there yet.
    rest: DVector<f64>,
    /// Energy of the whole shape.
    energy: f64,
}

/// The shapes for unit loads on the degrees of freedom `loads`, beyond the lowest `kept` modes. `count` fixes their
/// number: shapes that are there already are then replaced by the modes that follow. `None` when the statics cannot
/// be solved or when there is nothing left to add.
pub(super) fn static_shapes(
    elastic: &Elastic,
    kept: usize,
    loads: &[usize],
    count: Option<usize>,
) -> Option<StaticShapes> {
    let squared = &elastic.modes.squared_frequencies;
    let shift = squared.iter().copied().find(|&w2| w2 > 0.0).unwrap_or(1.0);
    let modes = elastic.modes.shapes.columns(0, kept);
    let weighted_modes = modes.transpose() * &elastic.mass; // Phi'M
    let metric = &elastic.supported + &elastic.mass * shift;
    let energy = |shape: &DVector<f64>| shape.dot(&(&metric * shape));
    let candidate = |shape: DVector<f64>| {
        let energy = energy(&shape);
        let mut rest = shape;
        for _ in 0..2 {
            // Twice: the first time leaves rounding of the whole shape.
            rest -= modes * (&weighted_modes * &rest);
        }
        Candidate { rest, energy }
    };

    let mut candidates: Vec<Candidate> = deflections(elastic, shift, loads)?
        .into_iter()
        .map(candidate)
        .collect();
    let mut spare = kept..elastic.modes.shapes.ncols();
    let mut chosen: Vec<DVector<f64>> = Vec::new();
    while count.is_none_or(|count| chosen.len() < count) {
        let share = |candidate: &Candidate| energy(&candidate.rest) / candidate.energy;
        let best = (0..candidates.len())
            .map(|index| (index, share(&candidates[index])))
            .reduce(|best, next| if next.1 > best.1 { next } else { best });
        let enough = if count.is_some() { NOISE } else { THERE };
        let mut shape = match best {
            Some((index, share)) if share > enough => candidates.swap_remove(index).rest,
            _ if count.is_none() => break,
            _ => elastic.modes.shapes.column(spare.next()?).into_owned(),
        };
        let whole = energy(&shape);
        for _ in 0..2 {
            shape -= modes * (&weighted_modes * &shape);
            for other in &chosen {
                shape.axpy(-other.dot(&(&metric * &shape)), other, 1.0);
            }
        }
        let size = energy(&shape);
        if size <= NOISE * whole {
            continue; // a spare mode that the chosen shapes have
        }
        shape /= size.sqrt();
        let weighted = &metric * &shape;
        for candidate in &mut candidates {
            candidate
                .rest
                .axpy(-weighted.dot(&candidate.rest), &shape, 1.0);
        }
        chosen.push(shape);
    }
    Some(diagonalised(&elastic.mass, shift, &chosen))
}

/// R and the deflections under the unit loads.
fn deflections(elastic: &Elastic, shift: f64, loads: &[usize]) -> Option<Vec<DVector<f64>>> {
    let real = elastic.unsupported();
    let soft = real.shapes.columns(0, elastic.soft_count(real));
    let carried = &elastic.mass * soft; // M R
    let held = &elastic.stiffness + shift * &carried * carried.transpose();
    let factor = held.cholesky()?;
    let mut shapes: Vec<DVector<f64>> = soft
        .column_iter()
        .map(nalgebra::Matrix::into_owned)
        .collect();
    for &load in loads {
        let mut force = DVector::zeros(elastic.mass.nrows());
        force[load] = 1.0;
        force -= &carried * soft.row(load).transpose();
        factor.solve_mut(&mut force);
        shapes.push(force);
    }
    Some(shapes)
}

/// Combines shapes X with X'(K_b + s M) X = I so that X'M X = I and X'K_b X = diag(w^2), ascending:
/// X'M X u = u / (w^2 + s).
fn diagonalised(mass: &DMatrix<f64>, shift: f64, chosen: &[DVector<f64>]) -> StaticShapes {
    let (n, count) = (mass.nrows(), chosen.len());
    let x = DMatrix::from_fn(n, count, |i, j| chosen[j][i]);
    if count == 0 {
        return StaticShapes {
            shapes: x,
            squared_frequencies: Vec::new(),
        };
    }
    let eigen = (x.transpose() * mass * &x).symmetric_eigen();
    let mut order: Vec<usize> = (0..count).collect();
    order.sort_by(|&i, &j| eigen.eigenvalues[j].total_cmp(&eigen.eigenvalues[i]));
    let mut shapes = DMatrix::zeros(n, count);
    let mut squared_frequencies = Vec::with_capacity(count);
    for (column, &source) in order.iter().enumerate() {
        let mut shape = &x * eigen.eigenvectors.column(source);
        shape /= shape.dot(&(mass * &shape)).sqrt();
        if largest(&shape) < 0.0 {
            shape.neg_mut();
        }
        shapes.set_column(column, &shape);
        let squared = 1.0 / eigen.eigenvalues[source] - shift;
        // Rounding of a strainless motion; others are near s or above.
        squared_frequencies.push(if squared < 1e-9 * shift { 0.0 } else { squared });
    }
    StaticShapes {
        shapes,
        squared_frequencies,
    }
}
