//! One shaft reduced to its vibration modes and static shapes, with nothing of its equations lost on them.
//!
//! ```text
//!   one plane   (K_s + K_xx + K_sup) phi = w^2 M phi         torsion   (K_T + K_sup,t) phi_t = w_t^2 J phi_t
//!   x = Phi A,  y = Phi B,  th = Phi_t A_t                   mass normalised; paper (7)-(12)
//!
//!   A''   + [L^2 - Phi'K_sup Phi] A + Phi'C_xx Phi A' + Phi'C_xy Phi B' + Om Phi'G Phi B' + Om' Phi'G Phi B
//!         + Phi'K_xy Phi B = Phi'K_s r cos(phi + psi) + ...
//!   B''   + [L^2 - Phi'K_sup Phi + Phi'(K_yy-K_xx)Phi] B + Phi'C_yy Phi B' + Phi'C_yx Phi A'
//!         - Om Phi'G Phi A' - Om' Phi'G Phi A + Phi'K_yx Phi A = Phi'K_s r sin(phi + psi) + ...
//!   A_t'' + Phi_t'C_T Phi_t A_t' + [L_t^2 - Phi_t'K_sup,t Phi_t] A_t = ...
//! ```
//!
//! paper (13)-(15) with the corrections of `docs/errata.md`. K_sup, the paper's nominal gear support, is
//! a device for the basis and subtracted again. Both planes share the modes computed with K_xx; the rest
//! K_yy - K_xx stays as a term. Static shapes stand in Phi like modes, with their own w^2. Modal damping is
//! C = M V diag(2 zeta w) V' M over all modes V of the finite-element model. Knows one rotor; knows no mesh and
//! no time.

mod basis;
mod bow;
mod elastic;
mod finite_elements;
mod projection;
mod static_shapes;
mod stations;

use core::fmt;

use nalgebra::DMatrix;

use crate::train::{Basis, Rotor};

use basis::Shapes;
use elastic::Elastic;
use projection::LateralMatrices;

pub use basis::ModeCounts;
pub use finite_elements::FiniteElements;
pub use stations::Stations;

/// A rotor in modal coordinates.
#[derive(Debug, Clone)]
pub struct ModalRotor {
    /// Where the stations are.
    pub stations: Stations,
    /// Phi, 2N x n: modes, then static shapes.
    pub lateral_shapes: DMatrix<f64>,
    /// Phi_t, N x n_t: modes, then static shapes.
    pub torsional_shapes: DMatrix<f64>,
    /// Natural frequencies of the lateral basis modes [Hz].
    pub lateral_frequencies: Vec<f64>,
    /// Natural frequencies of the torsional basis modes [Hz]; exactly 0 for the rigid rotation.
    pub torsional_frequencies: Vec<f64>,
    /// Stiffness of [A, B] at the rotor's mean speed, 2n x 2n.
    pub lateral_stiffness: DMatrix<f64>,
    /// Damping and gyroscopic coupling of [A, B] at the rotor's mean speed, 2n x 2n.
    pub lateral_damping: DMatrix<f64>,
    /// Stiffness of A_t, n_t x n_t.
    pub torsional_stiffness: DMatrix<f64>,
    /// Damping of A_t, load slopes included, n_t x n_t.
    pub torsional_damping: DMatrix<f64>,
    /// The mean rotation (1'J th) / (1'J 1) per coordinate of A_t.
    pub mean_rotation: Vec<f64>,
    /// Moment of inertia of the whole rotor about its axis, 1'J 1 [kg m^2].
    pub inertia: f64,
    /// Residual bows.
    pub bows: Vec<BowLoad>,
    lateral: LateralMatrices,
}

/// What a residual bow does to A and B: the load times cos(phi + phase) on A, times sin(phi + phase) on B.
#[derive(Debug, Clone, PartialEq)]
pub struct BowLoad {
    /// Phi'K_s r.
    pub load: Vec<f64>,
    /// Direction relative to the rotation angle phi [rad].
    pub phase: f64,
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
    /// Computes the shapes of the rotor and projects its equations. `counts` fixes the number of modes and static
    /// shapes; otherwise `basis` decides.
    pub fn reduce(
        rotor: &Rotor,
        basis: &Basis,
        counts: Option<ModeCounts>,
    ) -> Result<Self, ReductionError> {
        let failed = |kind| move |cause| ReductionError::of(rotor, kind, cause);
        let elements = FiniteElements::assemble(rotor);
        let lateral = Elastic::lateral(rotor, &elements)
            .ok_or(Cause::NoModes)
            .map_err(failed("lateral"))?;
        let torsional = Elastic::torsional(rotor, &elements)
            .ok_or(Cause::NoModes)
            .map_err(failed("torsional"))?;
        let [extent, extent_t] = basis::extents(basis, counts, &lateral.modes, &torsional.modes);
        let loads = basis::lateral_loads(rotor, &elements);
        let phi = Shapes::of(&lateral, extent, &loads).map_err(failed("lateral"))?;
        let loads = basis::torsional_loads(rotor, &elements);
        let phi_t = Shapes::of(&torsional, extent_t, &loads).map_err(failed("torsional"))?;
        let matrices = LateralMatrices::of(rotor, &elements, &lateral, &phi);
        let size = 2 * phi.columns.ncols();
        let mut stiffness = DMatrix::zeros(size, size);
        let mut damping = DMatrix::zeros(size, size);
        matrices.at(rotor.speed, &mut stiffness, &mut damping);
        let bows: Option<Vec<BowLoad>> = rotor
            .bows
            .iter()
            .map(|bow| {
                let load = phi.columns.tr_mul(&bow::force(&elements, bow)?);
                Some(BowLoad {
                    load: load.as_slice().to_vec(),
                    phase: bow.phase,
                })
            })
            .collect();
        let inertia = elements.inertia.sum();
        let carried = phi_t.columns.tr_mul(&elements.inertia.column_sum()) / inertia;
        Ok(ModalRotor {
            lateral_frequencies: phi.frequencies(),
            torsional_frequencies: phi_t.frequencies(),
            lateral_stiffness: stiffness,
            lateral_damping: damping,
            torsional_stiffness: projection::torsional_stiffness(rotor, &elements, &phi_t),
            torsional_damping: projection::torsional_damping(rotor, &elements, &torsional, &phi_t),
            mean_rotation: carried.as_slice().to_vec(),
            inertia,
            bows: bows.ok_or(Cause::NoModes).map_err(failed("lateral"))?,
            lateral: matrices,
            lateral_shapes: phi.columns,
            torsional_shapes: phi_t.columns,
            stations: elements.stations,
        })
    }

    /// Phi'G Phi: per speed, the damping in x per velocity in y, and its opposite in y per velocity in x; per
    /// angular acceleration, the same for stiffness.
    pub fn gyroscopic(&self) -> &DMatrix<f64> {
        &self.lateral.gyroscopic
    }

    /// Overwrites stiffness and damping (gyroscopic coupling included) of [A, B], 2n x 2n, with those at another
    /// speed [rad/s]; the basis stays. Allocates nothing.
    pub fn lateral_at(&self, speed: f64, stiffness: &mut DMatrix<f64>, damping: &mut DMatrix<f64>) {
        self.lateral.at(speed, stiffness, damping);
    }

    /// Number of modes and static shapes in each direction.
    pub fn counts(&self) -> ModeCounts {
        ModeCounts {
            lateral: self.lateral_shapes.ncols(),
            torsional: self.torsional_shapes.ncols(),
            lateral_modes: self.lateral_frequencies.len(),
            torsional_modes: self.torsional_frequencies.len(),
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
