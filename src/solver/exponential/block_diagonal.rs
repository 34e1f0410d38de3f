//! A matrix of the shape of B: small blocks on the diagonal, over the states of all parts.
//!
//! Almost all blocks are pairs (a vibration) or single (an overdamped motion). Pairs stand at even places, so that row i of
//! them needs x_i and the neighbour x_(i^1) only, and the product runs through in one loop.

use pulp::Simd;

use super::lanes::{Quad, add_products, neighbours};
use super::part::Part;
use crate::linalg::{Group, multiply_add};

/// The pairs of one quad: the diagonal, and what each state takes from its neighbour.
pub(super) type Pairs = [Quad; 2];

/// The numbers of the matrix.
#[derive(Debug, Clone, Default)]
pub(super) struct BlockDiagonal {
    /// One entry per quad of states; 0 within larger blocks.
    pub(super) pairs: Vec<Pairs>,
    /// Blocks of other sizes: first state, and the entries column by column.
    others: Vec<(usize, usize, Vec<f64>)>,
}

/// Whether a group belongs to a pair of neighbours: two states, or single ones as long as they fill pairs.
fn is_in_pairs(group: &Group, last: usize) -> bool {
    group.matrix.nrows() <= 2 && group.first + group.matrix.nrows() <= last
}

/// The order in which the groups of a part stand: pairs, single states, then larger blocks.
pub(super) fn rank(group: &Group) -> usize {
    match group.matrix.nrows() {
        2 => 0,
        1 => 1,
        _ => 2,
    }
}

impl BlockDiagonal {
    /// Room for one block per group of all parts.
    pub(super) fn zero(parts: &[Part]) -> BlockDiagonal {
        let quads = parts.iter().map(|part| part.quads().len()).sum();
        let mut matrix = BlockDiagonal {
            pairs: vec![[[0.0; 4]; 2]; quads],
            others: Vec::new(),
        };
        for part in parts {
            for group in &part.groups {
                if !is_in_pairs(group, part.paired) {
                    let m = group.matrix.nrows();
                    let first = part.first + group.first;
                    matrix.others.push((first, m, vec![0.0; m * m]));
                }
            }
        }
        matrix
    }

    /// Memory in use [bytes].
    pub(super) fn bytes(&self) -> usize {
        let others: usize = self.others.iter().map(|(.., block)| block.len()).sum();
        (8 * self.pairs.len() + others) * size_of::<f64>()
    }

    /// Overwrites the block of a group with `scale` times a matrix, column by column.
    pub(super) fn set(&mut self, part: &Part, group: &Group, scale: f64, block: &[f64]) {
        let (first, m) = (part.first + group.first, group.matrix.nrows());
        if is_in_pairs(group, part.paired) {
            let [own, across] = &mut self.pairs[first / 4];
            let place = first % 4;
            own[place] = scale * block[0];
            if m == 2 {
                own[place + 1] = scale * block[3];
                (across[place], across[place + 1]) = (scale * block[2], scale * block[1]);
            }
        } else if let Some((.., own)) = self.others.iter_mut().find(|other| other.0 == first) {
            for (entry, value) in own.iter_mut().zip(block) {
                *entry = scale * value;
            }
        }
    }

    /// Overwrites the block of a group of one or two states with level + slope S.
    pub(super) fn set_line(&mut self, part: &Part, group: &Group, level: f64, slope: f64) {
        let matrix = group.matrix.as_slice();
        if let [a, b, c, d] = *matrix {
            let half = 0.5 * slope * (a - d);
            let block = [level + half, slope * b, slope * c, level - half];
            self.set(part, group, 1.0, &block);
        } else {
            self.set(part, group, 1.0, &[level]);
        }
    }

    /// y += A x of the larger blocks.
    #[inline(always)]
    pub(super) fn add_others(&self, x: &[f64], y: &mut [f64]) {
        for (first, m, block) in &self.others {
            let range = *first..first + m;
            multiply_add(1.0, block, &x[range.clone()], &mut y[range]);
        }
    }
}

/// y += A x in one quad, without larger blocks.
#[inline(always)]
pub(super) fn add_pairs<S: Simd>(simd: S, [own, across]: &Pairs, x: &Quad, y: &mut Quad) {
    add_products(simd, [own, across], [x, &neighbours(x)], y);
}
