//! Natural vibrations of the coupled train at its mean speed, with the mean mesh stiffness.
//!
//! ```text
//!   q'' + (D + b c w) q' + (K + b k_mean w) q = 0
//!   x = [q; q' / s],   x' = s A x,   A = [0, I; -K/s^2, -D/s]        s scales time for the eigenvalue solver
//! ```

use core::f64::consts::TAU;

use nalgebra::DMatrix;

use super::ModalModel;

/// One natural vibration: a pair of complex eigenvalues, or one that does not oscillate.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NaturalVibration {
    /// |lambda| / 2 pi [Hz].
    pub frequency: f64,
    /// Im lambda / 2 pi [Hz]; 0 for a motion that does not oscillate.
    pub damped_frequency: f64,
    /// -Re lambda / |lambda|; negative when the vibration grows.
    pub damping_ratio: f64,
}

impl ModalModel {
    /// K and D with the meshes at their mean stiffness, n x n.
    pub fn mean_matrices(&self) -> (DMatrix<f64>, DMatrix<f64>) {
        let n = self.system.size;
        let (mut stiffness, mut damping) = (DMatrix::zeros(n, n), DMatrix::zeros(n, n));
        for block in &self.system.blocks {
            let (corner, shape) = ((block.offset, block.offset), (block.len(), block.len()));
            stiffness
                .view_mut(corner, shape)
                .copy_from(&block.stiffness);
            damping.view_mut(corner, shape).copy_from(&block.damping);
        }
        for (coupling, &mesh) in self.system.couplings.iter().zip(&self.coupling_mesh) {
            let (row, column) = (coupling.row.to_dense(n), coupling.column.to_dense(n));
            let outer = DMatrix::from_fn(n, n, |i, j| column[i] * row[j]);
            stiffness += self.meshes[mesh].mean_stiffness() * &outer;
            damping += self.meshes[mesh].damping * &outer;
        }
        (stiffness, damping)
    }

    /// All natural vibrations, ascending in frequency; `None` when the eigenvalue iteration fails.
    pub fn natural_vibrations(&self) -> Option<Vec<NaturalVibration>> {
        let n = self.system.size;
        let (stiffness, damping) = self.mean_matrices();
        let scale = stiffness.amax().sqrt().max(1.0);
        let mut matrix = DMatrix::zeros(2 * n, 2 * n);
        matrix.view_mut((0, n), (n, n)).fill_with_identity();
        matrix
            .view_mut((n, 0), (n, n))
            .copy_from(&(-stiffness / (scale * scale)));
        matrix
            .view_mut((n, n), (n, n))
            .copy_from(&(-damping / scale));
        let schur = nalgebra::Schur::try_new(matrix, f64::EPSILON, 10_000)?;
        let mut vibrations: Vec<NaturalVibration> = schur
            .complex_eigenvalues()
            .iter()
            .filter(|value| value.im >= 0.0)
            .map(|value| {
                let size = libm::hypot(value.re, value.im);
                NaturalVibration {
                    frequency: scale * size / TAU,
                    damped_frequency: scale * value.im / TAU,
                    damping_ratio: if size == 0.0 { 0.0 } else { -value.re / size },
                }
            })
            .collect();
        vibrations.sort_by(|one, two| one.frequency.total_cmp(&two.frequency));
        Some(vibrations)
    }
}
