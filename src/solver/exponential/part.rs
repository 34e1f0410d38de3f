//! One diagonal block as a first-order system in decoupled states.
//!
//! ```text
//!   x = [q; q'],  x' = A x + [0; p],  A = [0, I; -K, -D]
//!   x = V eta,    eta' = B eta + V^-1 [0; p],   B block diagonal
//! ```
//!
//! Before A is taken apart the displacements are scaled with sqrt(K_ii), so that both halves of x measure
//! energy: without damping A is then skew-symmetric and V orthogonal.

use nalgebra::{Complex, DMatrix, DVector};

use super::super::{Block, Harmonic, System};
use super::block_diagonal::rank;
use super::lanes::{Quad, padded};
use crate::linalg::{Decoupling, Group, decouple};

/// Softer coordinates than this [rad^2/s^2] are scaled like it, a slow vibration. It decides which rotations stay one group of angle
/// and speed: taken apart, the angle would be counted from where a weak drag lets the rotation come to rest, and lose digits.
const SOFTEST: f64 = 1e6;

/// A block with everything that acts on it and looks at it. Behind its 2n states others may follow that stay zero: `len` of
/// them in all.
#[derive(Debug, Clone)]
pub(super) struct Part {
    /// The block's coordinates.
    pub(super) coordinates: core::ops::Range<usize>,
    /// Its first state among those of all parts.
    pub(super) first: usize,
    /// V: displacements on top, velocities below, 2n x len.
    pub(super) shapes: DMatrix<f64>,
    /// V^-1, len x 2n.
    pub(super) inverse: DMatrix<f64>,
    /// B.
    pub(super) groups: Vec<Group>,
    /// So many of the states stand in pairs.
    pub(super) paired: usize,
    /// The couplings whose rows look at the block.
    pub(super) sensors: Vec<usize>,
    /// What the four numbers that a step computes of them (`polynomials::SEEN_AT`) take from eta: for every sensor len of them.
    pub(super) sensor_rows: Vec<Quad>,
    /// The same times S.
    pub(super) sensor_slopes: Vec<Quad>,
    /// The couplings whose forces act on the block.
    pub(super) actuators: Vec<usize>,
    /// V^-1 [0; b] of these, len x actuators.
    pub(super) actuator_columns: DMatrix<f64>,
    /// S times the same.
    pub(super) actuator_slopes: DMatrix<f64>,
    /// The loads from outside that act on the block: number, and V^-1 [0; column].
    pub(super) loads: Vec<(usize, Vec<f64>)>,
    /// The harmonics that act on the block: number, and V^-1 [0; cosine - i sine].
    pub(super) harmonics: Vec<(usize, Vec<Complex<f64>>)>,
}

impl Part {
    /// Takes block number `index` apart; `first` is its first state. `harmonics`: cosine and sine loads of the block with
    /// their numbers.
    fn new(
        system: &System,
        (index, first): (usize, usize),
        block: &Block,
        harmonics: &[(usize, [Vec<f64>; 2])],
    ) -> Part {
        let n = block.len();
        let Decoupling {
            shapes,
            inverse,
            groups,
        } = in_order(take_apart_block(block));
        let input = inverse.columns(n, n).into_owned();
        let in_states = |load: &[f64]| &input * DVector::from_row_slice(load);
        let touching = |rows: &dyn Fn(usize) -> Option<Vec<f64>>| -> (Vec<usize>, DMatrix<f64>) {
            let (numbers, rows): (Vec<usize>, Vec<Vec<f64>>) = (0..system.couplings.len())
                .filter_map(|coupling| Some((coupling, rows(coupling)?)))
                .unzip();
            let columns = DMatrix::from_fn(n, rows.len(), |i, j| rows[j][i]);
            (numbers, columns)
        };
        let (sensors, rows) = touching(&|coupling| system.couplings[coupling].row.in_block(index));
        let deflections = shapes.rows(0, n).transpose() * &rows;
        let rates = shapes.rows(n, n).transpose() * &rows;
        let both = |deflections: &DMatrix<f64>, rates: &DMatrix<f64>| {
            let both = deflections.iter().zip(rates.iter());
            both.map(|(d, v)| [*v, *d, *d, *d]).collect()
        };
        let slopes = slopes(&groups, shapes.ncols());
        let (actuators, columns) =
            touching(&|coupling| system.couplings[coupling].column.in_block(index));
        let actuators_in_states = &input * columns;
        let loads = system.loads.iter().map(|column| column.in_block(index));
        let loads = loads.enumerate().filter_map(|(number, column)| {
            let column = in_states(&column?);
            Some((number, column.as_slice().to_vec()))
        });
        let harmonics = harmonics.iter().map(|(number, [cosine, sine])| {
            let (cosine, sine) = (in_states(cosine), in_states(sine));
            let load = cosine.iter().zip(sine.iter());
            (*number, load.map(|(c, s)| Complex::new(*c, -*s)).collect())
        });
        Part {
            coordinates: block.range(),
            first,
            sensor_rows: both(&deflections, &rates),
            sensor_slopes: both(&slopes.tr_mul(&deflections), &slopes.tr_mul(&rates)),
            actuator_slopes: &slopes * &actuators_in_states,
            actuator_columns: actuators_in_states,
            loads: loads.collect(),
            harmonics: harmonics.collect(),
            paired: paired(&groups),
            groups,
            shapes,
            inverse,
            sensors,
            actuators,
        }
    }

    /// Number of states.
    pub(super) fn len(&self) -> usize {
        self.shapes.ncols()
    }

    /// So many of its states, the first ones, are in groups of one or two.
    pub(super) fn in_small_groups(&self) -> usize {
        small(&self.groups)
    }

    /// Its states among those of all parts, in fours.
    pub(super) fn quads(&self) -> core::ops::Range<usize> {
        self.first / 4..(self.first + self.len()) / 4
    }
}

/// All blocks taken apart.
pub(super) fn take_apart(system: &System, blocks: &[Block], harmonics: &[Harmonic]) -> Vec<Part> {
    let mut first = 0;
    let part = |(index, block): (usize, &Block)| {
        let numbered = harmonics.iter().enumerate();
        let own: Vec<_> = numbered
            .filter_map(|(number, harmonic)| Some((number, harmonic.on_block(block)?)))
            .collect();
        let part = Part::new(system, (index, first), block, &own);
        first += part.len();
        part
    };
    blocks.iter().enumerate().map(part).collect()
}

fn take_apart_block(block: &Block) -> Decoupling {
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
    decoupled
}

/// The same with pairs first, then single states, then larger groups, and states that stay zero up to a whole number of
/// quads.
fn in_order(decoupled: Decoupling) -> Decoupling {
    let mut groups = decoupled.groups;
    groups.sort_by_key(rank);
    let mut states = Vec::new();
    for group in &mut groups {
        let old = group.first;
        group.first = states.len();
        states.extend(old..old + group.matrix.nrows());
    }
    let length = padded(states.len());
    let shapes = decoupled.shapes.select_columns(&states);
    let inverse = decoupled.inverse.select_rows(&states);
    Decoupling {
        shapes: shapes.resize_horizontally(length, 0.0),
        inverse: inverse.resize_vertically(length, 0.0),
        groups,
    }
}

/// S: for every group of one or two states its matrix less the mean of its diagonal, along which functions of it change.
fn slopes(groups: &[Group], states: usize) -> DMatrix<f64> {
    let mut slopes = DMatrix::zeros(states, states);
    for group in groups.iter().filter(|group| group.matrix.nrows() == 2) {
        let mean = 0.5 * group.matrix.trace();
        let shifted = &group.matrix - DMatrix::identity(2, 2) * mean;
        let place = (group.first, group.first);
        slopes.view_mut(place, (2, 2)).copy_from(&shifted);
    }
    slopes
}

/// The states of groups of one or two, without a single one left over.
fn paired(groups: &[Group]) -> usize {
    small(groups) / 2 * 2
}

/// The states of groups of one or two.
fn small(groups: &[Group]) -> usize {
    let sizes = groups.iter().map(|group| group.matrix.nrows());
    sizes.filter(|&size| size <= 2).sum()
}
