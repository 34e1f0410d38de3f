//! What the loads from outside exert on the states.

use core::ops::Range;

use pulp::Simd;

use super::lanes::{Quad, add_products};
use super::part::Part;

/// The columns of all loads over the states of all parts, two side by side.
#[derive(Debug, Clone)]
pub(super) struct Loads {
    /// Two loads on a part that both act on, or one and a column of zeros: their numbers, and the states in fours.
    places: Vec<([usize; 2], Range<usize>)>,
    /// The entries of these, one after the other.
    entries: Vec<[Quad; 2]>,
}

impl Loads {
    pub(super) fn on(parts: &[Part]) -> Loads {
        let (mut places, mut entries) = (Vec::new(), Vec::new());
        for part in parts {
            for loads in part.loads.chunks(2) {
                let (number, first) = &loads[0];
                let (other, second) = loads.get(1).unwrap_or(&loads[0]);
                places.push(([*number, *other], part.quads()));
                let both = first.as_chunks().0.iter().zip(second.as_chunks().0);
                entries.extend(both.map(|(&first, &second)| {
                    let alone = loads.len() == 1;
                    [first, if alone { [0.0; 4] } else { second }]
                }));
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
        for (numbers, quads) in &self.places {
            let factors = numbers.map(|number| [value(number); 4]);
            let own = &mut target[quads.clone()];
            let (columns, others) = entries.split_at(own.len());
            entries = others;
            for (target, columns) in own.iter_mut().zip(columns) {
                add_products(simd, factors.each_ref(), columns.each_ref(), target);
            }
        }
    }
}
