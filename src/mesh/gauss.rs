//! Numerical integration of smooth functions.

/// Five-point Gauss rule: exact for polynomials of degree 9.
pub(super) fn integral(function: impl Fn(f64) -> f64, from: f64, to: f64) -> f64 {
    let root = 2.0 * (10.0_f64 / 7.0).sqrt();
    let inner = (
        (5.0 - root).sqrt() / 3.0,
        (322.0 + 13.0 * 70.0_f64.sqrt()) / 900.0,
    );
    let outer = (
        (5.0 + root).sqrt() / 3.0,
        (322.0 - 13.0 * 70.0_f64.sqrt()) / 900.0,
    );
    let (middle, half) = (0.5 * (from + to), 0.5 * (to - from));
    let pair = |(node, weight): (f64, f64)| {
        weight * (function(middle - half * node) + function(middle + half * node))
    };
    half * (128.0 / 225.0 * function(middle) + pair(inner) + pair(outer))
}
