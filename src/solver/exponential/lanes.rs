//! Four states side by side.
//!
//! Lists of states are padded with zeros to whole quads, and loops run over quads: the same sums in the same order on every
//! CPU, one after the other or with vectors of two or four numbers. `pulp` chooses the widest ones that the CPU has.

use pulp::Simd;

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

/// sum -= x y.
#[inline(always)]
pub(super) fn subtract_product(sum: &mut Quad, x: &Quad, y: &Quad) {
    for ((sum, x), y) in sum.iter_mut().zip(x).zip(y) {
        *sum -= x * y;
    }
}

/// sum += x_1 y_1 + x_2 y_2 ..., in words of the CPU. For loops over many quads: left to itself, the compiler runs over four of them
/// at a time and turns them around.
#[inline(always)]
pub(super) fn add_products<S: Simd, const N: usize>(
    simd: S,
    x: [&Quad; N],
    y: [&Quad; N],
    sum: &mut Quad,
) {
    let [x, y] = [x, y].map(|quads| quads.map(|quad| S::as_simd_f64s(quad)));
    let (vectors, rest) = S::as_mut_simd_f64s(sum);
    for (i, vector) in vectors.iter_mut().enumerate() {
        let products = x.iter().zip(&y);
        let product = products.map(|(x, y)| simd.mul_f64s(x.0[i], y.0[i]));
        *vector = product.fold(*vector, |sum, product| simd.add_f64s(sum, product));
    }
    for (i, number) in rest.iter_mut().enumerate() {
        for (x, y) in x.iter().zip(&y) {
            *number += x.1[i] * y.1[i];
        }
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
    subtract_product(sum, &[factor; 4], x);
}

/// Whether all of them are numbers: zero times anything else is none.
#[inline(always)]
pub(super) fn are_finite(quads: &[Quad]) -> bool {
    let mut zeros = [0.0; 4];
    for quad in quads {
        add_multiple(&mut zeros, 0.0, quad);
    }
    zeros == [0.0; 4]
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
