//! What the loads from outside exert on the states.

use core::ops::Range;

use pulp::Simd;

use super::lanes::{Quad, add_products};
use super::part::Part;

/// The columns of all loads over the states of all parts.
#[derive(Debug, Clone)]
pub(super) struct Loads {
    /// Every load on every part that it acts on: its number, and the states in fours.
    places: Vec<(usize, Range<usize>)>,
    /// The entries of these, one after the other.
    entries: Vec<Quad>,
}

impl Loads {
    pub(super) fn on(parts: &[Part]) -> Loads {
        let (mut places, mut entries) = (Vec::new(), Vec::new());
        for part in parts {
            for (number, column) in &part.loads {
                places.push((*number, part.quads()));
                entries.extend(column.as_chunks().0);
            }
        }
        Loads { places, entries }
    }

    /// Overwrites what a value of every load exerts.
    #[inline(always)]
    pub(super) fn exert<S: Simd>(
        &self,
        simd: S,
        value: impl Fn(usize) -> f64,
        target: &mut [Quad],
    ) {
        target.fill([0.0; 4]);
        let mut entries = self.entries.as_slice();
        for (number, quads) in &self.places {
            let factor = [value(*number); 4];
            let own = &mut target[quads.clone()];
            let (column, others) = entries.split_at(own.len());
            entries = others;
            for (target, entry) in own.iter_mut().zip(column) {
                add_products(simd, [&factor], [entry], target);
            }
        }
    }
}
