//! Row vectors over a few blocks of the coordinates.

use crate::linalg::{add_scaled, dot};

/// A row vector that is zero outside a few blocks.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Row {
    pub(super) parts: Vec<Part>,
}

#[derive(Debug, Clone, PartialEq)]
pub(super) struct Part {
    pub(super) block: usize,
    pub(super) offset: usize,
    pub(super) values: Vec<f64>,
}

impl Row {
    /// A row over the coordinates of one block: number `block`, first coordinate `offset`.
    pub fn new(block: usize, offset: usize, values: Vec<f64>) -> Row {
        Row {
            parts: vec![Part {
                block,
                offset,
                values,
            }],
        }
    }

    /// This row grows by `scale` times another one.
    pub fn add(&mut self, scale: f64, other: &Row) {
        for part in &other.parts {
            match self.parts.iter_mut().find(|own| own.block == part.block) {
                Some(own) => add_scaled(scale, &part.values, &mut own.values),
                None => {
                    let values = part.values.iter().map(|value| scale * value).collect();
                    self.parts.push(Part { values, ..*part });
                }
            }
        }
    }

    /// The entry of one coordinate.
    pub fn entry(&self, coordinate: usize) -> f64 {
        let part = self
            .parts
            .iter()
            .find(|part| part.range().contains(&coordinate));
        part.map_or(0.0, |part| part.values[coordinate - part.offset])
    }

    /// The entries of one block; `None` where they are all zero.
    pub fn in_block(&self, block: usize) -> Option<Vec<f64>> {
        let part = self.parts.iter().find(|part| part.block == block)?;
        let any = part.values.iter().any(|&value| value != 0.0);
        any.then(|| part.values.clone())
    }

    /// The number of the block that it touches; `None` where there are several or none.
    pub fn only_block(&self) -> Option<usize> {
        match self.parts.as_slice() {
            [part] => Some(part.block),
            _ => None,
        }
    }

    /// All entries of a system of this size.
    pub fn to_dense(&self, size: usize) -> Vec<f64> {
        let mut dense = vec![0.0; size];
        self.add_to(1.0, &mut dense);
        dense
    }

    /// row * q.
    pub fn dot(&self, q: &[f64]) -> f64 {
        self.parts
            .iter()
            .map(|part| dot(&part.values, &q[part.range()]))
            .sum()
    }

    /// Product with another row: only blocks that both touch contribute.
    pub fn dot_row(&self, other: &Row) -> f64 {
        let mut sum = 0.0;
        for mine in &self.parts {
            for theirs in other.parts.iter().filter(|part| part.block == mine.block) {
                sum += dot(&mine.values, &theirs.values);
            }
        }
        sum
    }

    /// q += scale * row'.
    pub fn add_to(&self, scale: f64, q: &mut [f64]) {
        for part in &self.parts {
            add_scaled(scale, &part.values, &mut q[part.range()]);
        }
    }
}

impl Part {
    fn range(&self) -> core::ops::Range<usize> {
        self.offset..self.offset + self.values.len()
    }
}
