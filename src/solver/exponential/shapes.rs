//! Displacements and velocities from decoupled states.
//!
//! ```text
//!   [q; q'] = V eta
//! ```

use core::ops::Range;

use nalgebra::DMatrix;
use pulp::{Arch, Simd, WithSimd};

use super::super::state::Track;
use super::lanes::Quad;
use super::part::Part;
use crate::linalg::multiply_add;

/// V of all parts.
#[derive(Debug)]
pub(in super::super) struct Shapes {
    of_parts: Vec<OfPart>,
    /// Number of coordinates.
    size: usize,
    arch: Arch,
}

/// V of one part.
#[derive(Debug)]
struct OfPart {
    coordinates: Range<usize>,
    quads: Range<usize>,
    position: DMatrix<f64>,
    velocity: DMatrix<f64>,
}

impl Shapes {
    pub(super) fn of(parts: &[Part]) -> Shapes {
        let of_part = |part: &Part| {
            let n = part.coordinates.len();
            OfPart {
                coordinates: part.coordinates.clone(),
                quads: part.quads(),
                position: part.shapes.rows(0, n).into_owned(),
                velocity: part.shapes.rows(n, n).into_owned(),
            }
        };
        Shapes {
            of_parts: parts.iter().map(of_part).collect(),
            size: parts.last().map_or(0, |part| part.coordinates.end),
            arch: Arch::new(),
        }
    }

    /// Overwrites q and q'.
    pub(in super::super) fn put_together(&self, states: &[Quad], whole: &mut Track) {
        for list in [&mut whole.position, &mut whole.velocity] {
            list.clear();
            list.resize(self.size, 0.0);
        }
        self.arch.dispatch(PutTogether {
            shapes: self,
            states,
            whole,
        });
    }
}

/// The loop over all parts, for any vectors.
struct PutTogether<'a> {
    shapes: &'a Shapes,
    states: &'a [Quad],
    whole: &'a mut Track,
}

impl WithSimd for PutTogether<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let Track { position, velocity } = self.whole;
        for part in &self.shapes.of_parts {
            let own = self.states[part.quads.clone()].as_flattened();
            let range = part.coordinates.clone();
            multiply_add(
                1.0,
                part.position.as_slice(),
                own,
                &mut position[range.clone()],
            );
            multiply_add(1.0, part.velocity.as_slice(), own, &mut velocity[range]);
        }
    }
}
