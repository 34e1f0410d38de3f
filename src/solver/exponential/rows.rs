//! Numbers that are read from the states along rows, four side by side.

use super::super::Row;
use super::lanes::{Quad, add_multiple};
use super::part::Part;
use crate::linalg::dot;

/// Rows over the states of all parts.
#[derive(Debug, Clone)]
pub(super) struct Rows {
    /// For every part the numbers that it contributes to.
    targets: Vec<Vec<usize>>,
    /// What every state contributes to four of these; part by part, four by four, then state by state.
    entries: Vec<Quad>,
}

impl Rows {
    /// For numbers `position q + velocity q'`; the parts are those of all blocks in order.
    pub(super) fn over(parts: &[Part], numbers: &[[&Row; 2]]) -> Rows {
        let (mut targets, mut entries) = (Vec::new(), Vec::new());
        for (block, part) in parts.iter().enumerate() {
            let per_coordinate = |[position, velocity]: &[&Row; 2]| -> Option<Vec<f64>> {
                let both = [position.in_block(block), velocity.in_block(block)];
                let zeros = || vec![0.0; part.coordinates.len()];
                let any = both.iter().any(Option::is_some);
                any.then(|| both.map(|row| row.unwrap_or_else(zeros)).concat())
            };
            let own = numbers.iter().enumerate();
            let (own, rows): (Vec<usize>, Vec<Vec<f64>>) = own
                .filter_map(|(number, rows)| Some((number, per_coordinate(rows)?)))
                .unzip();
            for four in rows.chunks(4) {
                entries.extend(part.shapes.column_iter().map(|shape| {
                    let entry = |row: &Vec<f64>| dot(row, shape.as_slice());
                    core::array::from_fn(|lane| four.get(lane).map_or(0.0, entry))
                }));
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
            for four in targets.chunks(4) {
                let (rows, others) = entries.split_at(part.len());
                entries = others;
                // Two sums side by side, so that one addition need not wait for the last.
                let (mut even, mut odd) = ([0.0; 4], [0.0; 4]);
                for ([a, b, c, d], rows) in own.iter().zip(rows.as_chunks::<4>().0) {
                    add_multiple(&mut even, *a, &rows[0]);
                    add_multiple(&mut odd, *b, &rows[1]);
                    add_multiple(&mut even, *c, &rows[2]);
                    add_multiple(&mut odd, *d, &rows[3]);
                }
                for (lane, &number) in four.iter().enumerate() {
                    numbers[number] += even[lane] + odd[lane];
                }
            }
        }
    }
}
