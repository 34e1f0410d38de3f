//! One diagonal block as a first-order system in decoupled states.
//!
//! ```text
//!   x = [q; q'],  x' = A x + [0; p],  A = [0, I; -K, -D]
//!   x = V eta,    eta' = B eta + V^-1 [0; p],   B block diagonal
//! ```
//!
//! Before A is taken apart the displacements are scaled with sqrt(K_ii), so that both halves of x measure
//! energy: without damping A is then skew-symmetric and V orthogonal.

use nalgebra::{Complex, DMatrix};

use super::super::{Block, Harmonic, Ramp, State, System};
use super::coefficients::PartCoefficients;
use super::polynomials::POINTS;
use crate::linalg::{Group, add_scaled, decouple, multiply_add};

/// Softer coordinates than this [rad^2/s^2] are scaled like it.
const SOFTEST: f64 = 1.0;

/// A block with everything that acts on it and looks at it.
#[derive(Debug, Clone)]
pub(super) struct Part {
    /// The block's coordinates.
    pub(super) coordinates: core::ops::Range<usize>,
    /// V: displacements on top, velocities below, 2n x 2n.
    pub(super) shapes: DMatrix<f64>,
    /// V^-1, 2n x 2n.
    pub(super) inverse: DMatrix<f64>,
    /// B.
    pub(super) groups: Vec<Group>,
    /// The couplings whose rows look at the block.
    pub(super) sensors: Vec<usize>,
    /// Their deflections and rates per eta: one column each, 2n x sensors.
    pub(super) sensor_rows: [DMatrix<f64>; 2],
    /// The couplings whose forces act on the block.
    pub(super) actuators: Vec<usize>,
    /// V^-1 [0; b] of these, 2n x actuators.
    pub(super) actuator_columns: DMatrix<f64>,
    /// The loads from outside that act on the block: number, and V^-1 [0; column].
    pub(super) loads: Vec<(usize, Vec<f64>)>,
    /// The harmonics that act on the block: number, and V^-1 [0; cosine - i sine].
    pub(super) harmonics: Vec<(usize, Vec<Complex<f64>>)>,
}

impl Part {
    /// Takes block number `index` apart. `harmonics`: cosine and sine loads of the block with their numbers.
    pub(super) fn new(
        system: &System,
        index: usize,
        block: &Block,
        harmonics: &[(usize, Vec<f64>, Vec<f64>)],
    ) -> Part {
        let n = block.len();
        let scale: Vec<f64> = (0..n)
            .map(|i| block.stiffness[(i, i)].max(SOFTEST).sqrt())
            .collect();
        let mut matrix = DMatrix::zeros(2 * n, 2 * n);
        for i in 0..n {
            matrix[(i, n + i)] = scale[i];
            for j in 0..n {
                matrix[(n + i, j)] = -block.stiffness[(i, j)] / scale[j];
                matrix[(n + i, n + j)] = -block.damping[(i, j)];
            }
        }
        let mut decoupled = decouple(&matrix);
        for (i, scale) in scale.iter().enumerate() {
            decoupled.shapes.row_mut(i).scale_mut(1.0 / scale);
            decoupled.inverse.column_mut(i).scale_mut(*scale);
        }
        let (shapes, inverse) = (decoupled.shapes, decoupled.inverse);
        let input = inverse.columns(n, n);
        let touching = |rows: &dyn Fn(usize) -> Option<Vec<f64>>| -> (Vec<usize>, Vec<Vec<f64>>) {
            (0..system.couplings.len())
                .filter_map(|coupling| Some((coupling, rows(coupling)?)))
                .unzip()
        };
        let (sensors, rows) = touching(&|coupling| system.couplings[coupling].row.in_block(index));
        let (actuators, columns) =
            touching(&|coupling| system.couplings[coupling].column.in_block(index));
        let as_columns =
            |vectors: &[Vec<f64>]| DMatrix::from_fn(n, vectors.len(), |i, j| vectors[j][i]);
        let rows = as_columns(&rows);
        let in_states = |load: &[f64]| input * nalgebra::DVector::from_row_slice(load);
        let loads = system.loads.iter().map(|column| column.in_block(index));
        let loads = loads.enumerate().filter_map(|(number, column)| {
            let column = in_states(&column?);
            Some((number, column.as_slice().to_vec()))
        });
        let loads = loads.collect();
        let harmonics = harmonics
            .iter()
            .map(|(number, cosine, sine)| {
                let (cosine, sine) = (in_states(cosine), in_states(sine));
                let load = cosine.iter().zip(sine.iter());
                (*number, load.map(|(c, s)| Complex::new(*c, -*s)).collect())
            })
            .collect();
        Part {
            coordinates: block.range(),
            sensor_rows: [
                shapes.rows(0, n).transpose() * &rows,
                shapes.rows(n, n).transpose() * &rows,
            ],
            actuator_columns: input * as_columns(&columns),
            groups: decoupled.groups,
            shapes,
            inverse,
            sensors,
            actuators,
            loads,
            harmonics,
        }
    }

    /// Number of states 2n.
    pub(super) fn len(&self) -> usize {
        self.shapes.ncols()
    }

    /// Number of deflections and rates of all sensors at all points.
    pub(super) fn readings(&self) -> usize {
        2 * POINTS * self.sensors.len()
    }

    /// The number of one of them: deflection (`what` = 0) or rate (1) of a sensor at a point.
    pub(super) fn reading(&self, point: usize, what: usize, sensor: usize) -> usize {
        (2 * point + what) * self.sensors.len() + sensor
    }
}

/// All blocks taken apart.
pub(super) fn take_apart(system: &System, blocks: &[Block], harmonics: &[Harmonic]) -> Vec<Part> {
    let part = |(index, block): (usize, &Block)| {
        let own: Vec<_> = harmonics
            .iter()
            .enumerate()
            .filter_map(|(number, harmonic)| {
                let [cosine, sine] = harmonic.on_block(block)?;
                Some((number, cosine, sine))
            })
            .collect();
        Part::new(system, index, block, &own)
    };
    blocks.iter().enumerate().map(part).collect()
}

/// The motion of one part.
#[derive(Debug, Clone)]
pub(super) struct PartMotion {
    /// eta.
    pub(super) states: Vec<f64>,
    /// B eta + load.
    pub(super) derivative: Vec<f64>,
    /// The load from outside at the start of the call, and its change per second.
    load: Vec<f64>,
    pub(super) load_rate: Vec<f64>,
    /// Deflections and rates at the points that the part adds: see [`Part::reading`].
    pub(super) readings: Vec<f64>,
}

impl PartMotion {
    pub(super) fn at_rest(part: &Part) -> PartMotion {
        let zeros = || vec![0.0; part.len()];
        PartMotion {
            states: zeros(),
            derivative: zeros(),
            load: zeros(),
            load_rate: zeros(),
            readings: vec![0.0; part.readings()],
        }
    }

    /// Decoupled states from displacements and velocities, and the load from outside in them.
    pub(super) fn take_over(&mut self, part: &Part, state: &State, ramps: &[Ramp]) {
        let (range, n) = (part.coordinates.clone(), part.len() / 2);
        let (per_position, per_velocity) = part.inverse.as_slice().split_at(n * part.len());
        self.states.fill(0.0);
        multiply_add(
            1.0,
            per_position,
            &state.position[range.clone()],
            &mut self.states,
        );
        multiply_add(1.0, per_velocity, &state.velocity[range], &mut self.states);
        self.load.fill(0.0);
        self.load_rate.fill(0.0);
        for (number, column) in &part.loads {
            let Ramp { first, rate } = ramps[*number];
            add_scaled(first, column, &mut self.load);
            if rate != 0.0 {
                add_scaled(rate, column, &mut self.load_rate);
            }
        }
    }

    /// Displacements and velocities from decoupled states.
    pub(super) fn hand_back(&self, part: &Part, state: &mut State) {
        let (range, n) = (part.coordinates.clone(), part.len() / 2);
        let position = &mut state.position[range.clone()];
        let velocity = &mut state.velocity[range];
        position.fill(0.0);
        velocity.fill(0.0);
        for (shape, value) in part.shapes.column_iter().zip(&self.states) {
            add_scaled(*value, &shape.as_slice()[..n], position);
            add_scaled(*value, &shape.as_slice()[n..], velocity);
        }
    }

    /// B eta + load, some seconds after the start of the call.
    pub(super) fn differentiate(&mut self, part: &Part, elapsed: f64) {
        self.derivative.copy_from_slice(&self.load);
        add_scaled(elapsed, &self.load_rate, &mut self.derivative);
        for group in &part.groups {
            let range = group.first..group.first + group.matrix.nrows();
            let target = &mut self.derivative[range.clone()];
            multiply_add(1.0, group.matrix.as_slice(), &self.states[range], target);
        }
    }

    /// eta + h phi_1 (B eta + load) + h^2 phi_2 load': the step without forces.
    pub(super) fn advance(&mut self, part: &Part, coefficients: &PartCoefficients, ramps: bool) {
        let PartMotion {
            states,
            derivative,
            load_rate,
            ..
        } = self;
        let mut apply = |mut gain: &[f64], source: &[f64]| {
            for group in &part.groups {
                let range = group.first..group.first + group.matrix.nrows();
                let (own, rest) = gain.split_at(group.matrix.len());
                multiply_add(1.0, own, &source[range.clone()], &mut states[range]);
                gain = rest;
            }
        };
        apply(&coefficients.gain, derivative);
        if ramps {
            apply(&coefficients.ramp_gain, load_rate);
        }
    }
}
