//! A matrix of the shape of B: small blocks on the diagonal, over the states of all parts.
//!
//! Almost all blocks are pairs (a vibration) or single (an overdamped motion). Pairs stand at even places, so that row i of
//! them needs x_i and the neighbour x_(i^1) only, and the product runs through in one loop.

use super::part::Part;
use crate::linalg::{Group, multiply_add};

/// The numbers of the matrix.
#[derive(Debug, Clone, Default)]
pub(super) struct BlockDiagonal {
    /// Per pair of states the diagonal and then what either takes from the other; 0 within larger blocks.
    pairs: Vec<[f64; 4]>,
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
        let states = parts.iter().map(Part::len).sum::<usize>();
        let mut matrix = BlockDiagonal {
            pairs: vec![[0.0; 4]; states / 2],
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
        (4 * self.pairs.len() + others) * size_of::<f64>()
    }

    /// Overwrites the block of a group with `scale` times a matrix, column by column.
    pub(super) fn set(&mut self, part: &Part, group: &Group, scale: f64, block: &[f64]) {
        let (first, m) = (part.first + group.first, group.matrix.nrows());
        if is_in_pairs(group, part.paired) {
            let pair = &mut self.pairs[first / 2];
            if m == 2 {
                *pair = [block[0], block[3], block[2], block[1]].map(|entry| scale * entry);
            } else {
                pair[first % 2] = scale * block[0];
            }
        } else if let Some((.., own)) = self.others.iter_mut().find(|other| other.0 == first) {
            for (entry, value) in own.iter_mut().zip(block) {
                *entry = scale * value;
            }
        }
    }

    /// y += A x.
    pub(super) fn multiply_add(&self, x: &[f64], y: &mut [f64]) {
        let vectors = x.chunks_exact(2).zip(y.chunks_exact_mut(2));
        for ([d0, d1, c0, c1], (x, y)) in self.pairs.iter().zip(vectors) {
            y[0] += d0 * x[0] + c0 * x[1];
            y[1] += d1 * x[1] + c1 * x[0];
        }
        for (first, m, block) in &self.others {
            let range = *first..first + m;
            multiply_add(1.0, block, &x[range.clone()], &mut y[range]);
        }
    }
}
