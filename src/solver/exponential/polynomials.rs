//! The polynomials by which forces are represented over one step, x = s/h from 0 to 1.
//!
//! A force is a cubic through four Lobatto nodes. At two further places, near both ends, the true force is compared with it;
//! the quintic through all six places says what the cubic leaves out. Two places, because forces that pass from one level
//! to another are odd about the middle of the step.

/// Nodes of the force polynomial.
pub(super) const NODES: usize = 4;
/// Places where forces are evaluated: the nodes behind the first one, and two for comparison.
pub(super) const POINTS: usize = 5;
/// Where they are in the step: a, b, 1, and a/2, 1 - a/2 with a = (1 - 1/sqrt 5)/2, b = 1 - a.
pub(super) const PLACES: [f64; POINTS] = [INNER, 1.0 - INNER, 1.0, 0.5 * INNER, 1.0 - 0.5 * INNER];
const INNER: f64 = 0.276_393_202_250_021;
const SQRT_5: f64 = 2.236_067_977_499_79;
/// The point at the end of the step, and those for comparison.
pub(super) const END: usize = 2;
pub(super) const CHECKS: [usize; 2] = [3, 4];
/// All points in the order of time.
pub(super) const IN_TIME: [usize; POINTS] = [3, 0, 1, 4, 2];
/// l_jk: coefficients of the Lagrange polynomials on the nodes 0, a, b, 1 (a + b = 1, a b = 1/5).
pub(super) const LAGRANGE: [[f64; NODES]; NODES] = [
    [1.0, -6.0, 10.0, -5.0],
    [
        0.0,
        5.0 * SQRT_5 * (1.0 - INNER),
        -5.0 * SQRT_5 * (2.0 - INNER),
        5.0 * SQRT_5,
    ],
    [
        0.0,
        -5.0 * SQRT_5 * INNER,
        5.0 * SQRT_5 * (1.0 + INNER),
        -5.0 * SQRT_5,
    ],
    [0.0, 1.0, -5.0, 5.0],
];
/// l_j at the points for comparison.
pub(super) const LAGRANGE_AT_CHECKS: [[f64; NODES]; 2] = [
    [
        0.348_606_797_749_979,
        0.779_508_497_187_473_7,
        -0.184_016_994_374_947_42,
        0.055_901_699_437_494_74,
    ],
    [
        0.055_901_699_437_494_74,
        -0.184_016_994_374_947_42,
        0.779_508_497_187_473_7,
        0.348_606_797_749_979,
    ],
];
/// Powers of s/h in use.
pub(super) const POWERS: usize = 6;
/// The quintics that are one at one point for comparison and zero at the other and at the nodes.
pub(super) const BUBBLES: [[f64; POWERS]; 2] = [
    [
        0.0,
        24.721_359_549_995_794,
        -177.013_771_190_877_74,
        419.327_278_845_375_8,
        -410.462_936_659_008_7,
        143.428_069_454_514_87,
    ],
    [
        0.0,
        -3.964_254_340_907_179,
        52.471_139_936_346_05,
        -211.756_226_754_489_63,
        306.677_410_613_565_6,
        -143.428_069_454_514_87,
    ],
];
/// k!.
pub(super) const FACTORIAL: [f64; POWERS] = [1.0, 1.0, 2.0, 6.0, 24.0, 120.0];

#[cfg(test)]
mod tests {
    use super::*;

    fn value(polynomial: &[f64], x: f64) -> f64 {
        polynomial.iter().rev().fold(0.0, |sum, c| sum * x + c)
    }

    #[test]
    fn polynomials_are_one_at_their_own_place_and_zero_at_the_others() {
        let nodes = [0.0, PLACES[0], PLACES[1], PLACES[2]];
        let checks = CHECKS.map(|point| PLACES[point]);
        // 1e-12: rounding of coefficients of some hundreds.
        let is = |found: f64, expected: f64| (found - expected).abs() < 1e-12;
        for (j, polynomial) in LAGRANGE.iter().enumerate() {
            for (i, &node) in nodes.iter().enumerate() {
                assert!(is(value(polynomial, node), f64::from(u8::from(i == j))));
            }
            for (check, values) in checks.iter().zip(LAGRANGE_AT_CHECKS) {
                assert!(is(value(polynomial, *check), values[j]));
            }
        }
        for (j, polynomial) in BUBBLES.iter().enumerate() {
            for (i, &check) in checks.iter().enumerate() {
                assert!(is(value(polynomial, check), f64::from(u8::from(i == j))));
            }
            for node in nodes {
                assert!(is(value(polynomial, node), 0.0));
            }
        }
    }
}
