//! Where the coordinates of rotors and housing stand among all.
//!
//! ```text
//!   q = [A_1 B_1 At_1 | A_2 B_2 At_2 | ...]                  each rotor's lateral and torsional coordinates: blocks of their own
//!   q = [A_1 B_1 A_2 B_2 ... eta | At_1 | At_2 | ...]        rotors whose bearings a housing holds move with it: one block
//!   q = [eta_1 | eta_2 | ...]                                a housing that holds no rotor: each mode by itself
//! ```

use core::ops::Range;

use nalgebra::DMatrix;

use crate::rotor::ModeCounts;
use crate::solver::{Block, Row};

/// Some neighbouring coordinates, all in one block.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Coordinates {
    /// Number of the block.
    block: usize,
    /// All coordinates of that block.
    neighbours: Range<usize>,
    own: Range<usize>,
}

/// The places of everything.
#[derive(Debug, Clone, Default)]
pub(super) struct Layout {
    /// [A, B] of every rotor.
    pub(super) lateral: Vec<Coordinates>,
    /// Torsion of every rotor.
    pub(super) torsional: Vec<Coordinates>,
    /// Every mode of the housing.
    pub(super) housing: Vec<Coordinates>,
    /// The coordinates of every block.
    blocks: Vec<Range<usize>>,
}

impl Layout {
    /// For rotors with these numbers of modes, of which some are held by a housing with so many modes.
    pub(super) fn of(counts: &[ModeCounts], held: &[bool], housing_modes: usize) -> Layout {
        let mut layout = Layout::default();
        let laterals = || counts.iter().map(|counts| 2 * counts.lateral);
        let together = held.contains(&true);
        let mut joint = Vec::new();
        if together {
            let of_rotors = laterals().zip(held).filter(|&(_, &held)| held);
            let groups = of_rotors.map(|(size, _)| size);
            joint = layout.add_block(groups.chain(vec![1; housing_modes]));
            layout.housing = joint.split_off(joint.len() - housing_modes);
        }
        let mut joint = joint.into_iter();
        for ((lateral, counts), held) in laterals().zip(counts).zip(held) {
            let of_rotor = if *held { joint.next() } else { None };
            let of_rotor = of_rotor.unwrap_or_else(|| layout.add_group(lateral));
            layout.lateral.push(of_rotor);
            let torsional = layout.add_group(counts.torsional);
            layout.torsional.push(torsional);
        }
        if !together {
            layout.housing = (0..housing_modes).map(|_| layout.add_group(1)).collect();
        }
        layout
    }

    /// A block of neighbouring groups.
    fn add_block(&mut self, sizes: impl Iterator<Item = usize>) -> Vec<Coordinates> {
        let first = self.size();
        let mut groups = Vec::new();
        let mut end = first;
        for size in sizes {
            groups.push(end..end + size);
            end += size;
        }
        let block = self.blocks.len();
        self.blocks.push(first..end);
        let group = |own| Coordinates {
            block,
            neighbours: first..end,
            own,
        };
        groups.into_iter().map(group).collect()
    }

    /// A group in a block of its own.
    fn add_group(&mut self, size: usize) -> Coordinates {
        let own = self.size()..self.size() + size;
        self.blocks.push(own.clone());
        Coordinates {
            block: self.blocks.len() - 1,
            neighbours: own.clone(),
            own,
        }
    }

    /// Number of coordinates.
    pub(super) fn size(&self) -> usize {
        self.blocks.last().map_or(0, |last| last.end)
    }

    /// The blocks, without stiffness and damping.
    pub(super) fn empty_blocks(&self) -> Vec<Block> {
        let empty = |range: &Range<usize>| Block {
            offset: range.start,
            stiffness: DMatrix::zeros(range.len(), range.len()),
            damping: DMatrix::zeros(range.len(), range.len()),
        };
        self.blocks.iter().map(empty).collect()
    }
}

impl Coordinates {
    /// Their indices among all coordinates.
    pub fn range(&self) -> Range<usize> {
        self.own.clone()
    }

    /// Number of the block that they stand in.
    pub fn block(&self) -> usize {
        self.block
    }

    /// A row with these values on them.
    pub fn row(&self, values: &[f64]) -> Row {
        let mut all = vec![0.0; self.neighbours.len()];
        all[self.in_block()].copy_from_slice(values);
        Row::new(self.block, self.neighbours.start, all)
    }

    /// Their indices in the block.
    fn in_block(&self) -> Range<usize> {
        let first = self.neighbours.start;
        self.own.start - first..self.own.end - first
    }

    /// Overwrites stiffness and damping between them.
    pub(super) fn put(
        &self,
        blocks: &mut [Block],
        stiffness: &DMatrix<f64>,
        damping: &DMatrix<f64>,
    ) {
        let (block, own) = (&mut blocks[self.block], self.in_block());
        let (corner, shape) = ((own.start, own.start), (own.len(), own.len()));
        block.stiffness.view_mut(corner, shape).copy_from(stiffness);
        block.damping.view_mut(corner, shape).copy_from(damping);
    }

    /// Takes away their stiffness and damping, and that between them and others.
    pub(super) fn clear(&self, blocks: &mut [Block]) {
        let (block, own) = (&mut blocks[self.block], self.in_block());
        for matrix in [&mut block.stiffness, &mut block.damping] {
            matrix.rows_mut(own.start, own.len()).fill(0.0);
            matrix.columns_mut(own.start, own.len()).fill(0.0);
        }
    }

    /// The stiffness between them.
    pub fn stiffness(&self, blocks: &[Block]) -> DMatrix<f64> {
        let own = self.in_block();
        let (corner, shape) = ((own.start, own.start), (own.len(), own.len()));
        blocks[self.block]
            .stiffness
            .view(corner, shape)
            .into_owned()
    }
}
