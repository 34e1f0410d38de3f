//! What the loads from outside exert on the states.

use core::ops::Range;

use pulp::Simd;

use super::lanes::{Quad, add_products};
use super::part::Part;

/// The columns of all loads over the states of all parts, some side by side.
#[derive(Debug, Clone)]
pub(super) struct Loads {
    shares: Vec<Share>,
    /// The entries of these, one after the other.
    entries: Vec<[Quad; ABREAST]>,
}

/// So many columns are added at a time.
const ABREAST: usize = 4;

/// Some loads on one part: columns of zeros stand in for those that are missing.
#[derive(Debug, Clone)]
struct Share {
    numbers: [usize; ABREAST],
    /// Whether no share before has the same states.
    is_first: bool,
    /// The states among those of all parts, in fours, and the same among the entries.
    quads: Range<usize>,
    entries: Range<usize>,
}

impl Loads {
    pub(super) fn on(parts: &[Part]) -> Loads {
        let (mut shares, mut entries) = (Vec::new(), Vec::new());
        for part in parts {
            let quads = part.quads();
            for (chunk, loads) in part.loads.chunks(ABREAST).enumerate() {
                let first = entries.len();
                entries.extend((0..quads.len()).map(|quad| {
                    let own = |(_, column): &(usize, Vec<f64>)| column.as_chunks::<4>().0[quad];
                    core::array::from_fn(|i| loads.get(i).map_or([0.0; 4], own))
                }));
                shares.push(Share {
                    is_first: chunk == 0,
                    numbers: core::array::from_fn(|i| loads.get(i).unwrap_or(&loads[0]).0),
                    quads: quads.clone(),
                    entries: first..entries.len(),
                });
            }
        }
        Loads { shares, entries }
    }

    /// Overwrites what a value of every load exerts; where none acts, nothing is touched.
    #[inline(always)]
    pub(super) fn exert<S: Simd>(
        &self,
        simd: S,
        value: impl Fn(usize) -> f64,
        target: &mut [Quad],
    ) {
        for share in &self.shares {
            let factors = share.numbers.map(|number| [value(number); 4]);
            let columns = &self.entries[share.entries.clone()];
            for (target, columns) in target[share.quads.clone()].iter_mut().zip(columns) {
                let mut sum = if share.is_first { [0.0; 4] } else { *target };
                add_products(simd, factors.each_ref(), columns.each_ref(), &mut sum);
                *target = sum;
            }
        }
    }
}
