//! Numbers that are read from the states along rows, four side by side.

use core::ops::Range;

use super::super::Row;
use super::lanes::{Quad, add_multiple};
use super::part::Part;
use crate::linalg::dot;

/// Rows over the states of all parts.
#[derive(Debug, Clone)]
pub(super) struct Rows {
    shares: Vec<Share>,
    /// What every state of these contributes to the four, one share after the other.
    entries: Vec<Quad>,
    /// How many numbers there are.
    count: usize,
}

/// What the states of one part contribute to four numbers.
#[derive(Debug, Clone)]
struct Share {
    /// These numbers; the one behind the last takes what belongs to none.
    targets: [usize; 4],
    /// The states among those of all parts, in fours, and the same among the entries.
    quads: Range<usize>,
    entries: Range<usize>,
}

impl Rows {
    /// For numbers `position q + velocity q'`; the parts are those of all blocks in order.
    pub(super) fn over(parts: &[Part], numbers: &[[&Row; 2]]) -> Rows {
        let (mut shares, mut entries) = (Vec::new(), Vec::new());
        for (block, part) in parts.iter().enumerate() {
            let per_coordinate = |[position, velocity]: &[&Row; 2]| -> Option<Vec<f64>> {
                let both = [position.in_block(block), velocity.in_block(block)];
                let zeros = || vec![0.0; part.coordinates.len()];
                let any = both.iter().any(Option::is_some);
                any.then(|| both.map(|row| row.unwrap_or_else(zeros)).concat())
            };
            let own = numbers.iter().enumerate();
            let own: Vec<(usize, Vec<f64>)> = own
                .filter_map(|(number, rows)| Some((number, per_coordinate(rows)?)))
                .collect();
            for four in own.chunks(4) {
                let first = entries.len();
                entries.extend(part.shapes.column_iter().map(|shape| {
                    let entry = |(_, row): &(usize, Vec<f64>)| dot(row, shape.as_slice());
                    core::array::from_fn(|lane| four.get(lane).map_or(0.0, entry))
                }));
                let target = |(number, _): &(usize, Vec<f64>)| *number;
                shares.push(Share {
                    targets: core::array::from_fn(|lane| {
                        four.get(lane).map_or(numbers.len(), target)
                    }),
                    quads: part.quads(),
                    entries: first..entries.len(),
                });
            }
        }
        Rows {
            shares,
            entries,
            count: numbers.len(),
        }
    }

    /// Room for the numbers, and for one more that means nothing.
    pub(super) fn room(&self) -> Vec<f64> {
        vec![0.0; self.count + 1]
    }

    /// Overwrites the numbers.
    #[inline(always)]
    pub(super) fn read(&self, states: &[Quad], numbers: &mut [f64]) {
        numbers.fill(0.0);
        for share in &self.shares {
            let own = states[share.quads.clone()].iter();
            let rows = self.entries[share.entries.clone()].as_chunks::<4>().0;
            // Two sums side by side, so that one addition need not wait for the last.
            let (mut even, mut odd) = ([0.0; 4], [0.0; 4]);
            for ([a, b, c, d], rows) in own.zip(rows) {
                add_multiple(&mut even, *a, &rows[0]);
                add_multiple(&mut odd, *b, &rows[1]);
                add_multiple(&mut even, *c, &rows[2]);
                add_multiple(&mut odd, *d, &rows[3]);
            }
            for (lane, &number) in share.targets.iter().enumerate() {
                numbers[number] += even[lane] + odd[lane];
            }
        }
    }
}
