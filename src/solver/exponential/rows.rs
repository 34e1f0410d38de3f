//! Numbers that are read from the states along rows.

use super::super::Row;
use super::lanes::{Quad, add_product, sum};
use super::part::Part;
use crate::linalg::dot;

/// Rows over the states of all parts.
#[derive(Debug, Clone)]
pub(super) struct Rows {
    /// For every part the numbers that it contributes to.
    targets: Vec<Vec<usize>>,
    /// What a state contributes, part by part and target by target.
    entries: Vec<Quad>,
}

impl Rows {
    /// For numbers `position q + velocity q'`; the parts are those of all blocks in order.
    pub(super) fn over(parts: &[Part], numbers: &[[&Row; 2]]) -> Rows {
        let (mut targets, mut entries) = (Vec::new(), Vec::new());
        for (block, part) in parts.iter().enumerate() {
            let n = part.coordinates.len();
            let mut own = Vec::new();
            for (number, rows) in numbers.iter().enumerate() {
                let [position, velocity] = rows.map(|row| row.in_block(block));
                if position.is_none() && velocity.is_none() {
                    continue;
                }
                let both = [position, velocity].map(|row| row.unwrap_or_else(|| vec![0.0; n]));
                let both = both.concat();
                let entry = |column: usize| dot(part.shapes.column(column).as_slice(), &both);
                let row: Vec<f64> = (0..part.len()).map(entry).collect();
                entries.extend(row.as_chunks().0);
                own.push(number);
            }
            targets.push(own);
        }
        Rows { targets, entries }
    }

    /// Overwrites the numbers.
    #[inline(always)]
    pub(super) fn read(&self, parts: &[Part], states: &[Quad], numbers: &mut [f64]) {
        numbers.fill(0.0);
        let mut entries = self.entries.as_slice();
        for (part, targets) in parts.iter().zip(&self.targets) {
            let own = &states[part.quads()];
            for &target in targets {
                let (row, others) = entries.split_at(own.len());
                entries = others;
                let mut products = [0.0; 4];
                for (entry, state) in row.iter().zip(own) {
                    add_product(&mut products, entry, state);
                }
                numbers[target] += sum(&products);
            }
        }
    }
}
