//! What forces answer an excitation exp(s t): mesh and bearing forces in the frequency range.
//!
//! ```text
//!   Z q = l - sum over couplings of b F,    Z = s^2 + s D + K     block by block
//!   F / (k + s c) = w q - e
//!   housing motion u_b = 1        l = w' (K + s C) u_b,    bearing force (K + s C)(u - u_b)
//!   transmission error e = 1      l = 0
//!   torque T = 1                  l = w_th
//! ```
//!
//! s = i w is the steady vibration; s = (i + zeta) w with a small zeta > 0 gives the response averaged
//! over a band of relative width 2 zeta (Poisson's kernel), which a finite number of frequencies represents
//! also where a resonance has no damping. The couplings are condensed: only forces between the blocks are
//! solved for together.

use nalgebra::{Complex, DMatrix};

use crate::model::{Bearing, ModalModel};
use crate::solver::Block;

type Matrix = DMatrix<Complex<f64>>;

/// A unit excitation.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Source {
    /// Gearbox motion at a bearing, numbered over all rotors, along x (0) or y (1) [m].
    Housing(usize, usize),
    /// Transmission error of a mesh [m].
    TransmissionError(usize),
    /// External torque, numbered over all rotors [N m].
    Torque(usize),
}

/// A force that is looked at.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Force {
    /// Normal force of a mesh [N].
    Mesh(usize),
    /// Force on the gearbox at a bearing along x (0) or y (1) [N].
    Bearing(usize, usize),
}

/// A model prepared for many frequencies.
#[derive(Debug)]
pub struct ForceResponse<'a> {
    model: &'a ModalModel,
    bearings: Vec<&'a Bearing>,
    /// What excites: the columns of [`ForceResponse::at`].
    pub sources: Vec<Source>,
    /// What answers: its rows.
    pub forces: Vec<Force>,
    /// x and y of every bearing, 2 n_b x n.
    stations: DMatrix<f64>,
    /// w of every coupling, m x n.
    rows: DMatrix<f64>,
    /// b of every coupling, n x m.
    columns: DMatrix<f64>,
    /// Loads of the torques, n x n_t.
    torques: DMatrix<f64>,
    /// The coupling of each mesh that carries the mesh force.
    first_couplings: Vec<usize>,
}

impl<'a> ForceResponse<'a> {
    /// Collects the rows of the model.
    pub fn of(model: &'a ModalModel) -> ForceResponse<'a> {
        let n = model.system.size;
        let bearings: Vec<&Bearing> = model.bearings().collect();
        let stations = bearings.iter().flat_map(|bearing| &bearing.relative);
        let couplings = &model.system.couplings;
        let dense = |rows: Vec<Vec<f64>>| {
            DMatrix::from_row_iterator(rows.len(), n, rows.into_iter().flatten())
        };
        let axes = || (0..bearings.len()).flat_map(|index| [(index, 0), (index, 1)]);
        let meshes = 0..model.meshes.len();
        let torques: Vec<Vec<f64>> = model.torques().map(|row| row.to_dense(n)).collect();
        let mut sources: Vec<Source> = axes()
            .map(|(bearing, axis)| Source::Housing(bearing, axis))
            .collect();
        sources.extend(meshes.clone().map(Source::TransmissionError));
        sources.extend((0..torques.len()).map(Source::Torque));
        let mut forces: Vec<Force> = meshes.map(Force::Mesh).collect();
        forces.extend(axes().map(|(bearing, axis)| Force::Bearing(bearing, axis)));
        let first = |mesh| model.mean_springs().position(|spring| spring.mesh == mesh);
        ForceResponse {
            first_couplings: (0..model.meshes.len()).filter_map(first).collect(),
            stations: dense(stations.map(|row| row.to_dense(n)).collect()),
            rows: dense(couplings.iter().map(|one| one.row.to_dense(n)).collect()),
            columns: dense(couplings.iter().map(|one| one.column.to_dense(n)).collect())
                .transpose(),
            torques: dense(torques).transpose(),
            model,
            bearings,
            sources,
            forces,
        }
    }

    /// Complex amplitude of every force per unit source, forces x sources; `None` where the train
    /// resonates without damping.
    pub fn at(&self, s: Complex<f64>) -> Option<Matrix> {
        let load = self.loads(s);
        let mut answer = Matrix::zeros(load.nrows(), load.ncols());
        for block in &self.model.system.blocks {
            solve_block(block, s, &load, &mut answer)?;
        }
        let uncoupled = load.ncols() - self.columns.ncols();
        let direct = self.by_source(&answer.columns(0, uncoupled).into_owned());
        let coupled = answer.columns(uncoupled, self.columns.ncols()).into_owned();
        let coupling_forces = self.coupling_forces(s, &direct, &coupled)?;

        let mut motion = self.stations.map(real) * (direct - coupled * &coupling_forces);
        for i in 0..motion.nrows() {
            motion[(i, i)] -= real(1.0); // u - u_b: housing motions are the first sources
        }
        let meshes = self.model.meshes.len();
        let mut forces = Matrix::zeros(self.forces.len(), self.sources.len());
        for (mesh, &first) in self.first_couplings.iter().enumerate() {
            forces.set_row(mesh, &coupling_forces.row(first));
        }
        for (index, bearing) in self.bearings.iter().enumerate() {
            for (axis, coefficients) in impedance(bearing, s).into_iter().enumerate() {
                for (other, coefficient) in coefficients.into_iter().enumerate() {
                    let part = motion.row(2 * index + other) * coefficient;
                    let mut row = forces.row_mut(meshes + 2 * index + axis);
                    row += part;
                }
            }
        }
        Some(forces)
    }

    /// Answers of the uncoupled rotors to housing motions and torques, with columns (zero) for the transmission errors
    /// between them.
    fn by_source(&self, answer: &Matrix) -> Matrix {
        let housing = self.stations.nrows();
        let meshes = self.model.meshes.len();
        answer.clone().insert_columns(housing, meshes, real(0.0))
    }

    /// F for every source: (1 / (k + s c) + w Z^-1 b) F = w Z^-1 l - e.
    fn coupling_forces(
        &self,
        s: Complex<f64>,
        direct: &Matrix,
        coupled: &Matrix,
    ) -> Option<Matrix> {
        let rows = self.rows.map(real);
        let mut matrix = &rows * coupled;
        let mut rhs = rows * direct;
        if matrix.is_empty() {
            return Some(rhs);
        }
        for (index, spring) in self.model.mean_springs().enumerate() {
            matrix[(index, index)] += real(1.0) / (s * spring.damping + spring.stiffness);
        }
        for (mesh, &first) in self.first_couplings.iter().enumerate() {
            rhs[(first, self.stations.nrows() + mesh)] -= real(1.0);
        }
        matrix.lu().solve(&rhs)
    }

    /// Columns: housing motion of every bearing, torques, couplings.
    fn loads(&self, s: Complex<f64>) -> Matrix {
        let n = self.model.system.size;
        let (nb, nt) = (2 * self.bearings.len(), self.torques.ncols());
        let mut load = Matrix::zeros(n, nb + nt + self.columns.ncols());
        for (index, bearing) in self.bearings.iter().enumerate() {
            for (axis, coefficients) in impedance(bearing, s).into_iter().enumerate() {
                let row = self.stations.row(2 * index + axis);
                for (other, coefficient) in coefficients.into_iter().enumerate() {
                    for (i, &shape) in row.iter().enumerate() {
                        load[(i, 2 * index + other)] += coefficient * shape;
                    }
                }
            }
        }
        load.columns_mut(nb, nt).copy_from(&self.torques.map(real));
        load.columns_mut(nb + nt, self.columns.ncols())
            .copy_from(&self.columns.map(real));
        load
    }
}

fn real(value: f64) -> Complex<f64> {
    Complex::new(value, 0.0)
}

/// K + s C.
fn impedance(bearing: &Bearing, s: Complex<f64>) -> [[Complex<f64>; 2]; 2] {
    let (stiffness, damping) = (bearing.stiffness.rows(), bearing.damping.rows());
    core::array::from_fn(|i| core::array::from_fn(|j| s * damping[i][j] + stiffness[i][j]))
}

/// answer = Z^-1 load on the coordinates of one block; columns that do not touch it stay zero.
fn solve_block(block: &Block, s: Complex<f64>, load: &Matrix, answer: &mut Matrix) -> Option<()> {
    let (n, range) = (block.len(), block.range());
    if n == 0 {
        return Some(());
    }
    let touched: Vec<usize> = (0..load.ncols())
        .filter(|&j| range.clone().any(|i| load[(i, j)] != real(0.0)))
        .collect();
    let mut rhs = Matrix::from_fn(n, touched.len(), |i, j| {
        load[(block.offset + i, touched[j])]
    });
    let mut z = Matrix::from_fn(n, n, |i, j| {
        s * block.damping[(i, j)] + block.stiffness[(i, j)]
    });
    for i in 0..n {
        z[(i, i)] += s * s;
    }
    if !z.lu().solve_mut(&mut rhs) {
        return None;
    }
    for (column, &target) in touched.iter().enumerate() {
        for i in 0..n {
            answer[(block.offset + i, target)] = rhs[(i, column)];
        }
    }
    Some(())
}
