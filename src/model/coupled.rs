//! The coupled train at its mean speed, with the mean mesh stiffness: matrices and natural vibrations.
//!
//! ```text
//!   q'' + (D + b c w) q' + (K + b k_mean w) q = 0
//!   x = [S q; q'],   x' = A x,   A = [0, S; -K S^-1, -D]         S_ii = sqrt(K_ii)
//! ```
//!
//! With this S the matrix A of a lightly damped train is nearly skew, so that its eigenvalues are as
//! accurate as rounding of the highest frequency allows. What the vibrations look like is the business of
//! [`crate::analysis`].

use core::f64::consts::TAU;

use nalgebra::{Complex, DMatrix};

use super::ModalModel;
use crate::linalg::eigenvalues;
use crate::solver::Coupling;

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

/// A coupling with the mean stiffness and the damping of its mesh.
#[derive(Debug, Clone, Copy)]
pub struct MeanSpring<'a> {
    /// Its rows.
    pub coupling: &'a Coupling,
    /// The mesh it belongs to. The first of a mesh carries the mesh force.
    pub mesh: usize,
    /// k_mean [N/m].
    pub stiffness: f64,
    /// c [N s/m].
    pub damping: f64,
}

/// x' = A x.
#[derive(Debug, Clone)]
pub struct StateMatrix {
    /// A, 2n x 2n [1/s].
    pub matrix: DMatrix<f64>,
    /// Diagonal of S [1/s].
    pub scale: Vec<f64>,
}

/// Least entry of S [rad/s].
const LEAST_SCALE: f64 = 1.0;

impl ModalModel {
    /// The meshes as linear springs, pressed on their reference flanks: one each, or two where torques follow the
    /// printed equation. Radial forces of bearings are not among them.
    pub fn mean_springs(&self) -> impl Iterator<Item = MeanSpring<'_>> {
        self.meshes.iter().enumerate().flat_map(|(index, mesh)| {
            let mut couplings = mesh.couplings.clone();
            if mesh.backlash.is_some() {
                couplings.end = mesh.couplings.start + 1;
            }
            let spring = move |coupling| MeanSpring {
                coupling,
                mesh: index,
                stiffness: mesh.mean_stiffness(),
                damping: mesh.damping,
            };
            self.system.couplings[couplings].iter().map(spring)
        })
    }

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
        for spring in self.mean_springs() {
            let row = spring.coupling.row.to_dense(n);
            let column = spring.coupling.column.to_dense(n);
            let outer = DMatrix::from_fn(n, n, |i, j| column[i] * row[j]);
            stiffness += spring.stiffness * &outer;
            damping += spring.damping * &outer;
        }
        (stiffness, damping)
    }

    /// The first-order form of the equations of free motion.
    pub fn state_matrix(&self) -> StateMatrix {
        let n = self.system.size;
        let (stiffness, damping) = self.mean_matrices();
        let scale: Vec<f64> = (0..n)
            .map(|i| stiffness[(i, i)].abs().sqrt().max(LEAST_SCALE))
            .collect();
        let mut matrix = DMatrix::zeros(2 * n, 2 * n);
        for j in 0..n {
            matrix[(j, n + j)] = scale[j];
            for i in 0..n {
                matrix[(n + i, j)] = -stiffness[(i, j)] / scale[j];
                matrix[(n + i, n + j)] = -damping[(i, j)];
            }
        }
        StateMatrix { matrix, scale }
    }

    /// All natural vibrations, ascending in frequency; `None` when the eigenvalue iteration fails.
    pub fn natural_vibrations(&self) -> Option<Vec<NaturalVibration>> {
        let values = eigenvalues(self.state_matrix().matrix)?;
        let mut vibrations: Vec<_> = values.into_iter().map(NaturalVibration::of).collect();
        vibrations.sort_by(|one, two| one.frequency.total_cmp(&two.frequency));
        Some(vibrations)
    }
}

impl NaturalVibration {
    /// The vibration of an eigenvalue [1/s].
    pub fn of(value: Complex<f64>) -> NaturalVibration {
        let size = libm::hypot(value.re, value.im);
        NaturalVibration {
            frequency: size / TAU,
            damped_frequency: value.im / TAU,
            damping_ratio: if size == 0.0 { 0.0 } else { -value.re / size },
        }
    }
}
