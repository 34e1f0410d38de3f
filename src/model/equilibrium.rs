//! The static solution a simulation starts from.
//!
//! ```text
//!   K q + sum over couplings of b F = f - Z mu,   F = k_mean w q,   Z' q = 0
//! ```
//!
//! f holds the torques and the gearbox displacements, k_mean the mean mesh stiffness. Z spans the rigid
//! rotations that no mesh resists; torque that nothing balances is carried by their acceleration mu, and
//! the mean rotation (weighted with inertia) is zero. A rigid rotation R of a rotor is a torsional motion
//! below 0.05 Hz: with a torsional basis support, subtracted again, it is one only as nearly as the basis can
//! represent it. Per block K is inverted without R; what remains are the mesh forces F and the rotations r:
//!
//! ```text
//!   F / k_mean + (w K^-1 b) F - (w R) r = w K^-1 f           one row per coupling
//!   (R' b) F + Z mu                     = R' f               one row per rigid rotation
//!   Z' r                                = 0
//! ```

use core::fmt;

use nalgebra::{DMatrix, DVector};

use super::{Inputs, ModalModel};
use crate::linalg::{multiply_add, solve_in_place};
use crate::solver::Row;

/// The static solution.
#[derive(Debug, Clone, PartialEq)]
pub struct Equilibrium {
    /// q.
    pub position: Vec<f64>,
    /// Normal force of each mesh [N].
    pub mesh_forces: Vec<f64>,
}

/// A rotor that nothing holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct NoEquilibrium {
    /// Its index; `None` when the rotors together are not held.
    pub rotor: Option<usize>,
}

/// Smallest pivot of a block's stiffness relative to its largest below which the block is loose:
/// rounding leaves 1e-16, a mode of 1 Hz beside one of 1 MHz has 1e-12.
const LOOSE: f64 = 1e-14;
/// Squared circular frequency [rad^2/s^2] below which a torsional motion is rigid: 0.05 Hz.
const RIGID: f64 = 0.1;

/// Solves for the static displacement under the inputs' torques and gearbox displacements.
pub fn equilibrium(model: &ModalModel, inputs: &Inputs) -> Result<Equilibrium, NoEquilibrium> {
    let mut load = vec![0.0; model.system.size];
    let mut still = inputs.clone();
    for base in &mut still.bases {
        base.velocity = [0.0; 2];
    }
    still.load_into(model, &mut load);

    let compliance = Compliance::of(model)?;
    let rigid = &compliance.rigid;
    let couplings = &model.system.couplings;
    let (m, r) = (couplings.len(), rigid.len());
    let row_on_rigid = DMatrix::from_fn(m, r, |i, j| couplings[i].row.dot_row(&rigid[j]));
    let free = null_space(&row_on_rigid);
    let size = m + r + free.ncols();

    let mut matrix = DMatrix::zeros(size, size);
    let mut rhs = vec![0.0; size];
    let elastic = compliance.apply(&load);
    let mean = |i: usize| model.meshes[model.coupling_mesh[i]].mean_stiffness();
    for (i, coupling) in couplings.iter().enumerate() {
        rhs[i] = coupling.row.dot(&elastic);
        matrix[(i, i)] += 1.0 / mean(i);
        let response = compliance.apply(&coupling.column.to_dense(model.system.size));
        for (l, other) in couplings.iter().enumerate() {
            matrix[(l, i)] += other.row.dot(&response);
        }
        for (j, rotation) in rigid.iter().enumerate() {
            matrix[(i, m + j)] = -row_on_rigid[(i, j)];
            matrix[(m + j, i)] = coupling.column.dot_row(rotation);
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

    for (coupling, &force) in couplings.iter().zip(&rhs) {
        coupling.column.add_to(-force, &mut load);
    }
    let mut position = compliance.apply(&load);
    for (j, rotation) in rigid.iter().enumerate() {
        rotation.add_to(rhs[m + j], &mut position);
    }
    // The first coupling of a mesh carries its (lateral) force.
    let first = |mesh: usize| model.coupling_mesh.iter().position(|&other| other == mesh);
    let mesh_forces = (0..model.meshes.len())
        .filter_map(|mesh| first(mesh).map(|index| rhs[index]))
        .collect();
    Ok(Equilibrium {
        position,
        mesh_forces,
    })
}

/// K^-1 block by block, without the rigid rotations.
struct Compliance<'a> {
    model: &'a ModalModel,
    inverses: Vec<DMatrix<f64>>,
    /// R: the rigid rotations, as rows.
    rigid: Vec<Row>,
}

impl<'a> Compliance<'a> {
    fn of(model: &'a ModalModel) -> Result<Self, NoEquilibrium> {
        let mut inverses = Vec::new();
        let mut rigid = Vec::new();
        for (index, blocks) in model.system.blocks.chunks(2).enumerate() {
            let loose = NoEquilibrium { rotor: Some(index) };
            inverses.push(invert(&blocks[0].stiffness).ok_or(loose)?);
            // Torsion is symmetric: what its supports held and nothing else does is a rigid rotation.
            let torsion = blocks[1].stiffness.clone().symmetric_eigen();
            let mut inverse = DMatrix::zeros(blocks[1].len(), blocks[1].len());
            for (value, shape) in torsion
                .eigenvalues
                .iter()
                .zip(torsion.eigenvectors.column_iter())
            {
                if value.abs() < RIGID {
                    let entries = shape.iter().copied().collect();
                    rigid.push(Row::new(2 * index + 1, blocks[1].offset, entries));
                } else {
                    inverse += shape * shape.transpose() / *value;
                }
            }
            inverses.push(inverse);
        }
        Ok(Compliance {
            model,
            inverses,
            rigid,
        })
    }

    fn apply(&self, load: &[f64]) -> Vec<f64> {
        let mut displacement = vec![0.0; load.len()];
        for (block, inverse) in self.model.system.blocks.iter().zip(&self.inverses) {
            let range = block.range();
            multiply_add(1.0, inverse, &load[range.clone()], &mut displacement[range]);
        }
        displacement
    }
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

impl fmt::Display for NoEquilibrium {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let advice = "check its bearings, or use start = \"rest\"";
        match self.rotor {
            Some(rotor) => write!(
                f,
                "rotor {} has no static equilibrium: it can move freely; {advice}",
                rotor + 1
            ),
            None => write!(
                f,
                "the rotors together have no static equilibrium; {advice}"
            ),
        }
    }
}
