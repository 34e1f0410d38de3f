//! The full equations on the shapes of the basis.
//!
//! ```text
//!   stiffness of [A, B]   [w^2 - Phi'K_sup Phi,  Phi'K_xy Phi;   Phi'K_yx Phi,  w^2 - Phi'K_sup Phi + Phi'(K_yy - K_xx)Phi]
//!   damping of [A, B]     Phi'C Phi + [Phi'C_xx Phi,  Phi'C_xy Phi;  Phi'C_yx Phi,  Phi'C_yy Phi] + Om [0, Phi'G Phi; -Phi'G Phi, 0]
//!   modal damping         C = M V diag(2 zeta w) V'M        V: all modes of the finite-element model
//! ```
//!
//! w^2 and K_xx are those of the basis. Where a bearing depends on the speed, K_xx is its value at the mean speed.

use nalgebra::{DMatrix, DVector};

use super::FiniteElements;
use super::basis::Shapes;
use super::elastic::Elastic;
use crate::linalg::Modes;
use crate::train::{Bearing, Rotor};

/// The matrices of [A, B] as they depend on the speed.
#[derive(Debug, Clone)]
pub(super) struct LateralMatrices {
    /// Phi'G Phi.
    pub(super) gyroscopic: DMatrix<f64>,
    /// Without bearings that depend on the speed.
    stiffness: DMatrix<f64>,
    /// Without them and without gyroscopic terms.
    damping: DMatrix<f64>,
    /// Bearings that depend on the speed.
    varying: Vec<MountedBearing>,
}

/// A bearing on the shapes of a basis.
#[derive(Debug, Clone)]
struct MountedBearing {
    bearing: Bearing,
    /// K_xx in the basis.
    basis_stiffness: f64,
    /// Displacement at the bearing per coordinate.
    row: DVector<f64>,
}

impl LateralMatrices {
    pub(super) fn of(
        rotor: &Rotor,
        elements: &FiniteElements,
        elastic: &Elastic,
        phi: &Shapes,
    ) -> LateralMatrices {
        let n = phi.columns.ncols();
        let row = |position: f64| {
            phi.columns
                .row(2 * elements.stations.at(position))
                .transpose()
        };
        let mut stiffness = DMatrix::zeros(2 * n, 2 * n);
        let mut damping = DMatrix::zeros(2 * n, 2 * n);
        let modal = modal_damping(rotor.lateral_damping_ratio, elastic, phi);
        for plane in [0, n] {
            for (i, w2) in phi.squared_frequencies.iter().enumerate() {
                stiffness[(plane + i, plane + i)] += w2;
            }
            for support in &rotor.basis_supports {
                add_outer(
                    &mut stiffness,
                    (plane, plane),
                    -support.lateral,
                    &row(support.position),
                );
            }
            damping.view_mut((plane, plane), (n, n)).copy_from(&modal);
        }
        let mut varying = Vec::new();
        for bearing in &rotor.bearings {
            let mounted = MountedBearing {
                bearing: bearing.clone(),
                basis_stiffness: bearing.coefficients(rotor.speed).stiffness.xx,
                row: row(bearing.position),
            };
            if bearing.depends_on_speed() {
                varying.push(mounted);
            } else {
                mounted.add(rotor.speed, &mut stiffness, &mut damping);
            }
        }
        LateralMatrices {
            gyroscopic: phi.columns.transpose() * &elements.gyroscopic * &phi.columns,
            stiffness,
            damping,
            varying,
        }
    }

    /// Overwrites stiffness and damping of [A, B], 2n x 2n, with those at a speed [rad/s]. Allocates nothing.
    pub(super) fn at(&self, speed: f64, stiffness: &mut DMatrix<f64>, damping: &mut DMatrix<f64>) {
        stiffness.copy_from(&self.stiffness);
        damping.copy_from(&self.damping);
        for mounted in &self.varying {
            mounted.add(speed, stiffness, damping);
        }
        let n = self.gyroscopic.nrows();
        for j in 0..n {
            for i in 0..n {
                let coupling = speed * self.gyroscopic[(i, j)];
                damping[(i, n + j)] += coupling;
                damping[(n + i, j)] -= coupling;
            }
        }
    }
}

impl MountedBearing {
    /// What the bearing adds to the stiffness beyond the basis, and to the damping.
    fn add(&self, speed: f64, stiffness: &mut DMatrix<f64>, damping: &mut DMatrix<f64>) {
        let n = self.row.len();
        let coefficients = self.bearing.coefficients(speed);
        let mut beyond = coefficients.stiffness.rows();
        beyond[0][0] -= self.basis_stiffness;
        beyond[1][1] -= self.basis_stiffness;
        for (matrix, rows) in [(stiffness, beyond), (damping, coefficients.damping.rows())] {
            for (i, row) in rows.iter().enumerate() {
                for (j, &coefficient) in row.iter().enumerate() {
                    add_outer(matrix, (i * n, j * n), coefficient, &self.row);
                }
            }
        }
    }
}

/// Phi'C Phi. The modes of the basis are among the modes V and take their damping along: 2 zeta w, one by one. Static
/// shapes share in the modes beyond.
fn modal_damping(ratio: f64, elastic: &Elastic, phi: &Shapes) -> DMatrix<f64> {
    let (n, kept) = (phi.columns.ncols(), phi.modes);
    let mut damping = DMatrix::zeros(n, n);
    for (i, w2) in phi.squared_frequencies[..kept].iter().enumerate() {
        damping[(i, i)] = 2.0 * ratio * w2.sqrt();
    }
    if n > kept && ratio > 0.0 {
        let shapes = phi.columns.columns(kept, n - kept).into_owned();
        let added = projected_damping(ratio, &elastic.modes, &elastic.mass, &shapes);
        damping
            .view_mut((kept, kept), (n - kept, n - kept))
            .copy_from(&added);
    }
    damping
}

/// X'M V diag(2 zeta w) V'M X for shapes X.
fn projected_damping(
    ratio: f64,
    modes: &Modes,
    mass: &DMatrix<f64>,
    shapes: &DMatrix<f64>,
) -> DMatrix<f64> {
    let n = shapes.ncols();
    let mut damping = DMatrix::zeros(n, n);
    let projection = shapes.transpose() * mass * &modes.shapes;
    for (mode, w2) in projection.column_iter().zip(&modes.squared_frequencies) {
        damping += 2.0 * ratio * w2.sqrt() * mode * mode.transpose();
    }
    damping
}

/// Stiffness of A_t: the diagonal w_t^2 less the supports.
pub(super) fn torsional_stiffness(
    rotor: &Rotor,
    elements: &FiniteElements,
    phi_t: &Shapes,
) -> DMatrix<f64> {
    let diagonal = DVector::from_row_slice(&phi_t.squared_frequencies);
    let mut stiffness = DMatrix::from_diagonal(&diagonal);
    for support in &rotor.basis_supports {
        let row = rotation_row(elements, phi_t, support.position);
        add_outer(&mut stiffness, (0, 0), -support.torsional, &row);
    }
    stiffness
}

/// Damping of A_t: load slopes, and modal damping over the modes without supports.
pub(super) fn torsional_damping(
    rotor: &Rotor,
    elements: &FiniteElements,
    elastic: &Elastic,
    phi_t: &Shapes,
) -> DMatrix<f64> {
    let (n, ratio) = (phi_t.columns.ncols(), rotor.torsional_damping_ratio);
    let mut damping = if ratio > 0.0 {
        projected_damping(ratio, elastic.unsupported(), &elastic.mass, &phi_t.columns)
    } else {
        DMatrix::zeros(n, n)
    };
    for torque in &rotor.torques {
        let row = rotation_row(elements, phi_t, torque.position);
        add_outer(&mut damping, (0, 0), torque.slope, &row);
    }
    damping
}

fn rotation_row(elements: &FiniteElements, phi_t: &Shapes, position: f64) -> DVector<f64> {
    phi_t
        .columns
        .row(elements.stations.at(position))
        .transpose()
}

/// The block of `matrix` at `corner` grows by `factor` row row'.
fn add_outer(matrix: &mut DMatrix<f64>, corner: (usize, usize), factor: f64, row: &DVector<f64>) {
    let n = row.len();
    let mut block = matrix.view_mut(corner, (n, n));
    block.ger(factor, row, row, 1.0);
}
