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
//!   F + k_mean ((w K^-1 b) F - (w R) r) = k_mean w K^-1 f    one row per coupling
//!   (R' b) F + Z mu                     = R' f               one row per rigid rotation
//!   Z' r                                = 0
//! ```
//!
//! Unilateral flanks that the solution does not press together are left out, and the secant stiffness of radial
//! bearings follows it, until both agree with the position they lead to. K holds the first guess of that stiffness, so
//! that it is regular where nothing else holds a shaft; the spring of the bearing is what the secant differs by.

use core::fmt;

use nalgebra::{DMatrix, DVector};

use super::radial::secant;
use super::{Inputs, Mesh, ModalModel};
use crate::linalg::{multiply_add, solve_in_place};
use crate::solver::{Coupling, Row};

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
/// Depth of contact of a radial bearing in the first guess [m].
const FIRST_DEPTH: f64 = 1e-6;
/// Iterations after which contact counts as not to be found, and what counts as found.
const MOST_ITERATIONS: usize = 500;
const SETTLED: f64 = 1e-13;

/// Solves for the static displacement under the inputs' torques and gearbox displacements.
pub fn equilibrium(model: &ModalModel, inputs: &Inputs) -> Result<Equilibrium, NoEquilibrium> {
    let load = inputs.static_load(model);
    let mut springs = Springs::first_guess(model, inputs);
    let compliance = Compliance::of(model, &springs.springs)?;
    for _ in 0..MOST_ITERATIONS {
        let equilibrium = solve(&compliance, &load, &springs.active())?;
        if springs.follow(model, &equilibrium.0) {
            return Ok(Equilibrium {
                mesh_forces: springs.mesh_forces(model, &equilibrium.0),
                position: equilibrium.0,
            });
        }
    }
    Err(NoEquilibrium { rotor: None })
}

/// Position of the rotors held by linear springs.
struct Position(Vec<f64>);

/// A spring along a coupling: force k (w q - gap), of which K already holds k_0 w q.
#[derive(Debug, Clone, Copy)]
struct StaticSpring {
    coupling: usize,
    stiffness: f64,
    gap: f64,
    in_block: f64,
}

fn solve(
    compliance: &Compliance<'_>,
    load: &[f64],
    springs: &[StaticSpring],
) -> Result<Position, NoEquilibrium> {
    let model = compliance.model;
    let coupling = |spring: &StaticSpring| &model.system.couplings[spring.coupling];
    let mut load = load.to_vec();
    let rigid = &compliance.rigid;
    let (m, r) = (springs.len(), rigid.len());
    let row_on_rigid = DMatrix::from_fn(m, r, |i, j| coupling(&springs[i]).row.dot_row(&rigid[j]));
    let free = null_space(&row_on_rigid);
    let size = m + r + free.ncols();

    let mut matrix = DMatrix::zeros(size, size);
    let mut rhs = vec![0.0; size];
    let elastic = compliance.apply(&load);
    for (i, spring) in springs.iter().enumerate() {
        let Coupling { row, column } = coupling(spring);
        let k = spring.stiffness - spring.in_block;
        rhs[i] = k * row.dot(&elastic) - spring.stiffness * spring.gap;
        matrix[(i, i)] += 1.0;
        let response = compliance.apply(&column.to_dense(model.system.size));
        for (l, other) in springs.iter().enumerate() {
            let k = other.stiffness - other.in_block;
            matrix[(l, i)] += k * coupling(other).row.dot(&response);
        }
        for (j, rotation) in rigid.iter().enumerate() {
            matrix[(i, m + j)] = -k * row_on_rigid[(i, j)];
            matrix[(m + j, i)] = column.dot_row(rotation);
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
        coupling(spring).column.add_to(-force, &mut load);
    }
    let mut position = compliance.apply(&load);
    for (j, rotation) in rigid.iter().enumerate() {
        rotation.add_to(rhs[m + j], &mut position);
    }
    Ok(Position(position))
}

/// The springs that stand for meshes and radial bearings, and which of them act.
struct Springs {
    springs: Vec<StaticSpring>,
    active: Vec<bool>,
    /// For every radial bearing of the model: the number of its first spring, and the gearbox's displacement.
    bearings: Vec<(usize, [f64; 2])>,
}

impl Springs {
    /// Reference flanks closed, back flanks open, bearings in light contact.
    fn first_guess(model: &ModalModel, inputs: &Inputs) -> Springs {
        let (mut springs, mut active) = (Vec::new(), Vec::new());
        for mesh in &model.meshes {
            for coupling in mesh.couplings() {
                let back = mesh.backlash.is_some() && coupling > mesh.first_coupling;
                active.push(!back);
                springs.push(StaticSpring {
                    coupling,
                    stiffness: mesh.mean_stiffness(),
                    gap: mesh.backlash.filter(|_| back).unwrap_or(0.0),
                    in_block: 0.0,
                });
            }
        }
        let mut bearings = Vec::new();
        for bearing in &model.radial {
            let base = inputs.bases[bearing.input].displacement;
            bearings.push((springs.len(), base));
            let stiffness = secant(&bearing.force, bearing.force.clearance + FIRST_DEPTH);
            for (axis, gap) in base.into_iter().enumerate() {
                active.push(stiffness > 0.0);
                springs.push(StaticSpring {
                    coupling: bearing.first_coupling + axis,
                    stiffness,
                    gap,
                    in_block: stiffness,
                });
            }
        }
        Springs {
            springs,
            active,
            bearings,
        }
    }

    fn active(&self) -> Vec<StaticSpring> {
        let both = self.springs.iter().zip(&self.active);
        both.filter(|(_, active)| **active)
            .map(|(spring, _)| *spring)
            .collect()
    }

    fn deflection(&self, model: &ModalModel, spring: usize, position: &[f64]) -> f64 {
        let StaticSpring { coupling, gap, .. } = self.springs[spring];
        model.system.couplings[coupling].row.dot(position) - gap
    }

    /// Follows the position just found. Gives whether nothing changed.
    fn follow(&mut self, model: &ModalModel, position: &[f64]) -> bool {
        let mut same = true;
        for mesh in model.meshes.iter().filter(|mesh| mesh.backlash.is_some()) {
            for coupling in mesh.couplings() {
                // Springs of meshes stand in the order of their couplings.
                let spring = self
                    .springs
                    .iter()
                    .position(|spring| spring.coupling == coupling);
                let spring = spring.unwrap_or(0);
                let closed = self.deflection(model, spring, position) > 0.0;
                same &= closed == self.active[spring];
                self.active[spring] = closed;
            }
        }
        for (bearing, &(first, _)) in model.radial.iter().zip(&self.bearings) {
            let [x, y] = [first, first + 1].map(|spring| self.deflection(model, spring, position));
            let (force, radius) = (&bearing.force, libm::hypot(x, y));
            let old = self.springs[first].stiffness;
            if old == 0.0 {
                continue; // no coefficient, no force
            }
            // A power law is a straight line in logarithms: this step finds it at once, and in a clearance nearly.
            let wanted = secant(force, radius);
            let depth = (radius - force.clearance).max(1e-3 * FIRST_DEPTH);
            let wanted = if wanted > 0.0 {
                wanted
            } else {
                secant(force, force.clearance + depth)
            };
            let step = depth / (force.exponent * radius.max(depth));
            let new = old * libm::pow(wanted / old, step.max(1e-3));
            same &= (new - old).abs() <= SETTLED * old;
            for spring in &mut self.springs[first..first + 2] {
                spring.stiffness = new;
            }
        }
        same
    }

    /// Normal force of every mesh: of its reference flank less that of its back flank.
    fn mesh_forces(&self, model: &ModalModel, position: &[f64]) -> Vec<f64> {
        let force = |coupling: usize| {
            let mine = |&spring: &usize| self.springs[spring].coupling == coupling;
            let spring = (0..self.springs.len())
                .find(mine)
                .filter(|&spring| self.active[spring]);
            spring.map_or(0.0, |spring| {
                self.springs[spring].stiffness * self.deflection(model, spring, position)
            })
        };
        let of_mesh = |mesh: &Mesh| {
            let back = if mesh.backlash.is_some() {
                force(mesh.first_coupling + 1)
            } else {
                0.0
            };
            force(mesh.first_coupling) - back
        };
        model.meshes.iter().map(of_mesh).collect()
    }
}

/// K^-1 block by block, without the rigid rotations.
struct Compliance<'a> {
    model: &'a ModalModel,
    inverses: Vec<DMatrix<f64>>,
    /// R: the rigid rotations, as rows.
    rigid: Vec<Row>,
}

impl<'a> Compliance<'a> {
    fn of(model: &'a ModalModel, springs: &[StaticSpring]) -> Result<Self, NoEquilibrium> {
        let mut inverses = Vec::new();
        let mut rigid = Vec::new();
        for (index, blocks) in model.system.blocks.chunks(2).enumerate() {
            let loose = NoEquilibrium { rotor: Some(index) };
            let mut lateral = blocks[0].stiffness.clone();
            for spring in springs.iter().filter(|spring| spring.in_block > 0.0) {
                let Coupling { row, column } = &model.system.couplings[spring.coupling];
                if let (Some(row), Some(column)) =
                    (row.in_block(2 * index), column.in_block(2 * index))
                {
                    let (row, column) = (DVector::from_vec(row), DVector::from_vec(column));
                    lateral.ger(spring.in_block, &column, &row, 1.0);
                }
            }
            inverses.push(invert(&lateral).ok_or(loose)?);
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
            multiply_add(
                1.0,
                inverse.as_slice(),
                &load[range.clone()],
                &mut displacement[range],
            );
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
