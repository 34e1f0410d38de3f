//! One shaft reduced to its vibration modes, with nothing of its equations lost on them.
//!
//! ```text
//!   one plane   (K_s + K_xx + K_sup) phi = w^2 M phi         torsion   (K_T + K_sup,t) phi_t = w_t^2 J phi_t
//!   x = Phi A,  y = Phi B,  th = Phi_t A_t                   mass normalised; paper (7)-(12)
//!
//!   A''   + [L^2 - Phi'K_sup Phi] A + Phi'C_xx Phi A' + Phi'C_xy Phi B' + Om Phi'G Phi B' + Phi'K_xy Phi B = ...
//!   B''   + [L^2 - Phi'K_sup Phi + Phi'(K_yy-K_xx)Phi] B + Phi'C_yy Phi B' + Phi'C_yx Phi A'
//!                                                        - Om Phi'G Phi A' + Phi'K_yx Phi A = ...
//!   A_t'' + Phi_t'C_T Phi_t A_t' + [L_t^2 - Phi_t'K_sup,t Phi_t] A_t = ...
//! ```
//!
//! paper (13)-(15) with the corrections of `docs/errata.md`. K_sup, the paper's nominal gear support, is
//! a device for the basis and subtracted again. Both planes share the modes computed with K_xx; the rest
//! K_yy - K_xx stays as a term. Modal damping is C = M V diag(2 zeta w) V' M over all modes V of the
//! finite-element model. Knows one rotor; knows no mesh and no time.

mod finite_elements;
mod stations;

use core::f64::consts::TAU;
use core::fmt;

use nalgebra::{DMatrix, DVector};

use crate::config::Basis;
use crate::linalg::{Modes, natural_modes};
use crate::train::Rotor;

pub use finite_elements::FiniteElements;
pub use stations::Stations;

/// Number of modes kept.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ModeCounts {
    /// Modes per lateral plane.
    pub lateral: usize,
    /// Torsional modes, a rigid rotation included.
    pub torsional: usize,
}

/// A rotor in modal coordinates.
#[derive(Debug, Clone)]
pub struct ModalRotor {
    /// Where the stations are.
    pub stations: Stations,
    /// Phi, 2N x n.
    pub lateral_shapes: DMatrix<f64>,
    /// Phi_t, N x n_t.
    pub torsional_shapes: DMatrix<f64>,
    /// Natural frequencies of the lateral basis modes [Hz].
    pub lateral_frequencies: Vec<f64>,
    /// Natural frequencies of the torsional basis modes [Hz]; exactly 0 for the rigid rotation.
    pub torsional_frequencies: Vec<f64>,
    /// Stiffness of [A, B], 2n x 2n.
    pub lateral_stiffness: DMatrix<f64>,
    /// Damping and gyroscopic coupling of [A, B] at the rotor's mean speed, 2n x 2n.
    pub lateral_damping: DMatrix<f64>,
    /// Stiffness of A_t, n_t x n_t.
    pub torsional_stiffness: DMatrix<f64>,
    /// Damping of A_t, load slopes included, n_t x n_t.
    pub torsional_damping: DMatrix<f64>,
}

/// Why a rotor cannot be reduced to modes.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ReductionError {
    rotor: String,
    kind: &'static str,
    cause: Cause,
}

#[derive(Debug, Clone, PartialEq, Eq)]
enum Cause {
    /// A parameter is beyond what floating-point numbers can carry.
    NoModes,
    /// More modes were asked for than the finite elements have.
    TooFewModes { wanted: usize, available: usize },
}

impl ModalRotor {
    /// Computes the modes of the rotor and projects its equations. `counts` fixes the number of modes;
    /// otherwise `basis` decides.
    pub fn reduce(
        rotor: &Rotor,
        basis: &Basis,
        counts: Option<ModeCounts>,
    ) -> Result<Self, ReductionError> {
        let elements = FiniteElements::assemble(rotor);
        let lateral = lateral_modes(rotor, &elements)?;
        let torsional = torsional_modes(rotor, &elements)?;
        let counts = counts.unwrap_or_else(|| choose(basis, &lateral, &torsional));
        let phi = lowest(rotor, "lateral", &lateral, counts.lateral)?;
        let phi_t = lowest(rotor, "torsional", &torsional, counts.torsional)?;
        let hertz = |modes: &Modes, shapes: &DMatrix<f64>| {
            modes.squared_frequencies[..shapes.ncols()]
                .iter()
                .map(|w2| w2.sqrt() / TAU)
                .collect()
        };
        Ok(ModalRotor {
            lateral_frequencies: hertz(&lateral, &phi),
            torsional_frequencies: hertz(&torsional, &phi_t),
            lateral_stiffness: lateral_stiffness(rotor, &elements, &lateral, &phi),
            lateral_damping: lateral_damping(rotor, &elements, &lateral, &phi),
            torsional_stiffness: torsional_stiffness(rotor, &elements, &torsional, &phi_t),
            torsional_damping: torsional_damping(rotor, &elements, &phi_t)?,
            lateral_shapes: phi,
            torsional_shapes: phi_t,
            stations: elements.stations,
        })
    }

    /// Number of modes in each direction.
    pub fn counts(&self) -> ModeCounts {
        ModeCounts {
            lateral: self.lateral_shapes.ncols(),
            torsional: self.torsional_shapes.ncols(),
        }
    }

    /// Whether the first torsional mode is the rigid rotation.
    pub fn has_rigid_rotation(&self) -> bool {
        self.torsional_frequencies.first() == Some(&0.0)
    }

    /// How the displacement in either plane at a position [m] follows from A or B.
    pub fn lateral_row(&self, position: f64) -> Vec<f64> {
        self.lateral_shapes
            .row(2 * self.stations.at(position))
            .iter()
            .copied()
            .collect()
    }

    /// How the rotation at a position [m] follows from A_t.
    pub fn torsional_row(&self, position: f64) -> Vec<f64> {
        self.torsional_shapes
            .row(self.stations.at(position))
            .iter()
            .copied()
            .collect()
    }
}

/// Modes of one plane with K_xx and the supports.
fn lateral_modes(rotor: &Rotor, elements: &FiniteElements) -> Result<Modes, ReductionError> {
    let mut stiffness = elements.shaft_stiffness.clone();
    let springs = rotor
        .bearings
        .iter()
        .map(|bearing| (bearing.position, bearing.stiffness.xx));
    let supports = rotor
        .basis_supports
        .iter()
        .map(|support| (support.position, support.lateral));
    for (position, spring) in springs.chain(supports) {
        let displacement = 2 * elements.stations.at(position);
        stiffness[(displacement, displacement)] += spring;
    }
    natural_modes(&stiffness, &elements.mass)
        .ok_or_else(|| ReductionError::of(rotor, "lateral", Cause::NoModes))
}

/// Torsional modes with the supports.
fn torsional_modes(rotor: &Rotor, elements: &FiniteElements) -> Result<Modes, ReductionError> {
    let mut stiffness = elements.torsional_stiffness.clone();
    for support in &rotor.basis_supports {
        let station = elements.stations.at(support.position);
        stiffness[(station, station)] += support.torsional;
    }
    modes_with_exact_rotation(rotor, &stiffness, &elements.inertia)
}

/// A rigid rotation is exactly the same at all stations.
fn modes_with_exact_rotation(
    rotor: &Rotor,
    stiffness: &DMatrix<f64>,
    inertia: &DMatrix<f64>,
) -> Result<Modes, ReductionError> {
    let mut modes = natural_modes(stiffness, inertia)
        .ok_or_else(|| ReductionError::of(rotor, "torsional", Cause::NoModes))?;
    if modes.squared_frequencies[0] == 0.0 {
        modes.shapes.column_mut(0).fill(1.0 / inertia.sum().sqrt());
    }
    Ok(modes)
}

/// The number of modes a basis asks for on this rotor.
fn choose(basis: &Basis, lateral: &Modes, torsional: &Modes) -> ModeCounts {
    match *basis {
        Basis::Counts {
            lateral_modes,
            torsional_modes,
        } => ModeCounts {
            lateral: lateral_modes,
            torsional: torsional_modes,
        },
        Basis::MaxFrequency(frequency) => {
            let below = |modes: &Modes| {
                modes
                    .squared_frequencies
                    .iter()
                    .filter(|w2| w2.sqrt() <= TAU * frequency)
                    .count()
            };
            ModeCounts {
                lateral: below(lateral).max(2),
                torsional: below(torsional).max(1),
            }
        }
    }
}

/// The shapes of the lowest `count` modes.
fn lowest(
    rotor: &Rotor,
    kind: &'static str,
    modes: &Modes,
    count: usize,
) -> Result<DMatrix<f64>, ReductionError> {
    let available = modes.shapes.ncols();
    if count > available {
        let cause = Cause::TooFewModes {
            wanted: count,
            available,
        };
        return Err(ReductionError::of(rotor, kind, cause));
    }
    Ok(modes.shapes.columns(0, count).into_owned())
}

/// Stiffness of [A, B]: the diagonal L^2 less the supports, and what the bearings add beyond K_xx.
fn lateral_stiffness(
    rotor: &Rotor,
    elements: &FiniteElements,
    modes: &Modes,
    phi: &DMatrix<f64>,
) -> DMatrix<f64> {
    let n = phi.ncols();
    let mut stiffness = DMatrix::zeros(2 * n, 2 * n);
    for plane in [0, n] {
        for (i, w2) in modes.squared_frequencies[..n].iter().enumerate() {
            stiffness[(plane + i, plane + i)] += w2;
        }
        for support in &rotor.basis_supports {
            let row = displacement_row(elements, phi, support.position);
            add_outer(&mut stiffness, (plane, plane), -support.lateral, &row);
        }
    }
    for bearing in &rotor.bearings {
        let (row, k) = (
            displacement_row(elements, phi, bearing.position),
            bearing.stiffness,
        );
        add_outer(&mut stiffness, (0, n), k.xy, &row);
        add_outer(&mut stiffness, (n, 0), k.yx, &row);
        add_outer(&mut stiffness, (n, n), k.yy - k.xx, &row);
    }
    stiffness
}

/// Damping of [A, B]: bearings, modal damping, and the gyroscopic coupling at the mean speed.
fn lateral_damping(
    rotor: &Rotor,
    elements: &FiniteElements,
    modes: &Modes,
    phi: &DMatrix<f64>,
) -> DMatrix<f64> {
    let n = phi.ncols();
    let mut damping = DMatrix::zeros(2 * n, 2 * n);
    for plane in [0, n] {
        // The basis modes are among the modes V that carry the damping: Phi'C Phi is diagonal.
        for (i, w2) in modes.squared_frequencies[..n].iter().enumerate() {
            damping[(plane + i, plane + i)] += 2.0 * rotor.lateral_damping_ratio * w2.sqrt();
        }
    }
    for bearing in &rotor.bearings {
        let row = displacement_row(elements, phi, bearing.position);
        for (i, coefficients) in bearing.damping.rows().iter().enumerate() {
            for (j, &coefficient) in coefficients.iter().enumerate() {
                add_outer(&mut damping, (i * n, j * n), coefficient, &row);
            }
        }
    }
    let gyroscopic = rotor.speed * phi.transpose() * &elements.gyroscopic * phi;
    let mut coupling = damping.view_mut((0, n), (n, n));
    coupling += &gyroscopic;
    let mut coupling = damping.view_mut((n, 0), (n, n));
    coupling -= &gyroscopic;
    damping
}

/// Stiffness of A_t: the diagonal L_t^2 less the supports.
fn torsional_stiffness(
    rotor: &Rotor,
    elements: &FiniteElements,
    modes: &Modes,
    phi_t: &DMatrix<f64>,
) -> DMatrix<f64> {
    let n = phi_t.ncols();
    let mut stiffness =
        DMatrix::from_diagonal(&DVector::from_row_slice(&modes.squared_frequencies[..n]));
    for support in &rotor.basis_supports {
        let row = rotation_row(elements, phi_t, support.position);
        add_outer(&mut stiffness, (0, 0), -support.torsional, &row);
    }
    stiffness
}

/// Damping of A_t: load slopes, and modal damping over the modes without supports.
fn torsional_damping(
    rotor: &Rotor,
    elements: &FiniteElements,
    phi_t: &DMatrix<f64>,
) -> Result<DMatrix<f64>, ReductionError> {
    let n = phi_t.ncols();
    let mut damping = DMatrix::zeros(n, n);
    if rotor.torsional_damping_ratio > 0.0 {
        let modes =
            modes_with_exact_rotation(rotor, &elements.torsional_stiffness, &elements.inertia)?;
        let projection = phi_t.transpose() * &elements.inertia * &modes.shapes; // Phi_t'J V
        for (mode, w2) in projection.column_iter().zip(&modes.squared_frequencies) {
            damping += 2.0 * rotor.torsional_damping_ratio * w2.sqrt() * mode * mode.transpose();
        }
    }
    for torque in &rotor.torques {
        let row = rotation_row(elements, phi_t, torque.position);
        add_outer(&mut damping, (0, 0), torque.slope, &row);
    }
    Ok(damping)
}

fn displacement_row(elements: &FiniteElements, phi: &DMatrix<f64>, position: f64) -> DVector<f64> {
    phi.row(2 * elements.stations.at(position)).transpose()
}

fn rotation_row(elements: &FiniteElements, phi_t: &DMatrix<f64>, position: f64) -> DVector<f64> {
    phi_t.row(elements.stations.at(position)).transpose()
}

/// The block of `matrix` at `corner` grows by `factor` row row'.
fn add_outer(matrix: &mut DMatrix<f64>, corner: (usize, usize), factor: f64, row: &DVector<f64>) {
    let n = row.len();
    let mut block = matrix.view_mut(corner, (n, n));
    block.ger(factor, row, row, 1.0);
}

impl ReductionError {
    fn of(rotor: &Rotor, kind: &'static str, cause: Cause) -> ReductionError {
        ReductionError {
            rotor: rotor.name.clone(),
            kind,
            cause,
        }
    }
}

impl fmt::Display for ReductionError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (rotor, kind) = (&self.rotor, self.kind);
        match self.cause {
            Cause::NoModes => write!(
                f,
                "rotor \"{rotor}\": its {kind} modes cannot be computed; look for parameters of extreme size"
            ),
            Cause::TooFewModes { wanted, available } => write!(
                f,
                "rotor \"{rotor}\": {kind}_modes = {wanted}, but its finite elements have only {available} \
                 {kind} modes; ask for fewer, or make max_element_length smaller"
            ),
        }
    }
}
