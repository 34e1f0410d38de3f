//! Four states side by side.
//!
//! Lists of states are padded with zeros to whole quads, and loops run over quads: the same sums in the same order on every
//! CPU, one after the other or with vectors of two or four numbers. `pulp` chooses the widest ones that the CPU has.

/// Four neighbouring states.
pub(super) type Quad = [f64; 4];

/// So many numbers fill whole quads.
pub(super) fn padded(length: usize) -> usize {
    length.next_multiple_of(4)
}

/// sum += x y.
#[inline(always)]
pub(super) fn add_product(sum: &mut Quad, x: &Quad, y: &Quad) {
    for ((sum, x), y) in sum.iter_mut().zip(x).zip(y) {
        *sum += x * y;
    }
}

/// sum += factor x.
#[inline(always)]
pub(super) fn add_multiple(sum: &mut Quad, factor: f64, x: &Quad) {
    add_product(sum, &[factor; 4], x);
}

/// sum -= factor x.
#[inline(always)]
pub(super) fn subtract_multiple(sum: &mut Quad, factor: f64, x: &Quad) {
    for (sum, x) in sum.iter_mut().zip(x) {
        *sum -= factor * x;
    }
}

/// The sum of all four.
#[inline(always)]
pub(super) fn sum([a, b, c, d]: &Quad) -> f64 {
    (a + c) + (b + d)
}

/// The neighbour of each within its pair.
#[inline(always)]
pub(super) fn neighbours([a, b, c, d]: &Quad) -> Quad {
    [*b, *a, *d, *c]
}
