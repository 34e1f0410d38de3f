//! The polynomials by which forces are represented over one step, x = s/h from 0 to 1.
//!
//! A force is a cubic through four Lobatto nodes. At two further places, near both ends, it is compared with the force that the
//! law gives there; the quintic through all six places says what the cubic leaves out. Two places, because forces that pass
//! from one level to another are odd about the middle of the step.
//!
//! Of the motion of a coupling a step computes its deflections at the nodes and its rate at the end; with those of the start
//! they are a quintic, which says what the rates at the inner nodes are, and where the coupling is at the places for comparison.
//! That is two orders better than the cubic knows the force, and the errors of the two rates are opposite: the method
//! keeps its order of six.

use super::lanes::Quad;

/// Nodes of the force polynomial. The force at the first one, the start, is known; those at the others are to be found.
pub(super) const NODES: usize = 4;
/// Where they are in the step: 0, a, b, 1 with a = (1 - 1/sqrt 5)/2, b = 1 - a.
pub(super) const PLACES: [f64; NODES] = [0.0, INNER, 1.0 - INNER, 1.0];
const INNER: f64 = 0.276_393_202_250_021;
const SQRT_5: f64 = 2.236_067_977_499_79;
/// The node at the end of the step.
pub(super) const END: usize = NODES - 1;
/// Places for comparison: a/2 and 1 - a/2.
pub(super) const CHECKS: usize = 2;
pub(super) const CHECK_PLACES: [f64; CHECKS] = [0.5 * INNER, 1.0 - 0.5 * INNER];
/// When a coupling has the four numbers that a step computes: its rate at the end, its deflections at the nodes but the first.
pub(super) const SEEN_AT: Quad = [1.0, INNER, 1.0 - INNER, 1.0];
/// The rate at the end among these.
pub(super) const RATE: usize = 0;
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
/// l_j at the places for comparison, for every node.
pub(super) const LAGRANGE_AT_CHECKS: [[f64; CHECKS]; NODES] = [
    [0.348_606_797_749_979, 0.055_901_699_437_494_74],
    [0.779_508_497_187_473_7, -0.184_016_994_374_947_42],
    [-0.184_016_994_374_947_42, 0.779_508_497_187_473_7],
    [0.055_901_699_437_494_74, 0.348_606_797_749_979],
];
/// Polynomials of degree five from values at the nodes and slopes at both ends, at the places for comparison.
pub(super) const HERMITE_AT_CHECKS: Hermite = Hermite {
    of_values: [
        [
            0.464_190_686_445_302_64,
            -0.109_580_556_523_381_64,
            4.847_644_118_671_816,
            0.538_627_124_296_868_4,
        ],
        [
            -0.109_580_556_523_381_64,
            0.464_190_686_445_302_64,
            -0.538_627_124_296_868_4,
            -4.847_644_118_671_816,
        ],
        [
            0.054_330_006_670_304_74,
            0.591_059_863_407_774_3,
            0.246_250_916_421_794_83,
            4.555_267_910_796_742,
        ],
    ],
    of_slopes: [
        [
            0.041_518_477_176_559_48,
            0.006_657_797_401_561_58,
            -0.167_274_575_140_626_3,
            -0.029_077_974_015_615_8,
        ],
        [
            -0.006_657_797_401_561_58,
            -0.041_518_477_176_559_48,
            -0.029_077_974_015_615_8,
            -0.167_274_575_140_626_3,
        ],
    ],
};
/// The slopes of the same polynomials at all nodes.
pub(super) const HERMITE_SLOPES: HermiteSlopes = HermiteSlopes {
    of_inner_values: [0.0, SQRT_5, -SQRT_5, 0.0],
    of_last_value: [0.0, 1.2 - SQRT_5, 1.2 + SQRT_5, 0.0],
    of_first_slope: [1.0, -0.2, -0.2, 1.0],
    of_more_slope: [0.0, 0.1 * (SQRT_5 - 1.0), -0.1 * (SQRT_5 + 1.0), 1.0],
};

/// What the growth of a polynomial's value from the first node to the places for comparison, and its slopes there, take from the
/// growth of its value to the other nodes and from its slopes at both ends: the value at either place, then the slope at either.
pub(super) struct Hermite {
    pub(super) of_values: [Quad; NODES - 1],
    pub(super) of_slopes: [Quad; 2],
}

/// What a polynomial's slopes at the nodes take from the growth of its value to either inner node and to the last, from its first
/// slope, and from the growth of its slope to the last node.
pub(super) struct HermiteSlopes {
    pub(super) of_inner_values: Quad,
    pub(super) of_last_value: Quad,
    pub(super) of_first_slope: Quad,
    pub(super) of_more_slope: Quad,
}

/// Powers of s/h in use.
pub(super) const POWERS: usize = 6;
/// The quintics that are one at one place for comparison and zero at the other and at the nodes.
pub(super) const BUBBLES: [[f64; POWERS]; CHECKS] = [
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
const FACTORIAL: [f64; POWERS] = [1.0, 1.0, 2.0, 6.0, 24.0, 120.0];
/// k! x^(k+1) where couplings are looked at.
pub(super) const MOMENTS: [Quad; POWERS] = {
    let mut moments = [[0.0; 4]; POWERS];
    let (mut k, mut power) = (0, SEEN_AT);
    while k < POWERS {
        let mut i = 0;
        while i < 4 {
            moments[k][i] = FACTORIAL[k] * power[i];
            power[i] *= SEEN_AT[i];
            i += 1;
        }
        k += 1;
    }
    moments
};

#[cfg(test)]
mod tests {
    use super::*;

    fn value(polynomial: &[f64], x: f64) -> f64 {
        polynomial.iter().rev().fold(0.0, |sum, c| sum * x + c)
    }

    #[test]
    fn polynomials_are_one_at_their_own_place_and_zero_at_the_others() {
        let nodes = PLACES;
        let checks = CHECK_PLACES;
        // 1e-12: rounding of coefficients of some hundreds.
        let is = |found: f64, expected: f64| (found - expected).abs() < 1e-12;
        for (j, polynomial) in LAGRANGE.iter().enumerate() {
            for (i, &node) in nodes.iter().enumerate() {
                assert!(is(value(polynomial, node), f64::from(u8::from(i == j))));
            }
            for (check, at_check) in checks.iter().zip(LAGRANGE_AT_CHECKS[j]) {
                assert!(is(value(polynomial, *check), at_check));
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

    #[test]
    fn interpolation_is_exact_for_polynomials_of_degree_five() {
        let polynomial = [0.7, -1.0, 0.5, 2.0, -3.0, 1.5];
        let slope: Vec<f64> = (1..6).map(|k| k as f64 * polynomial[k]).collect();
        let values = PLACES.map(|x| value(&polynomial, x));
        let slopes = PLACES.map(|x| value(&slope, x));
        let growth = |list: Quad, node: usize| list[node] - list[0];
        let grown = [1, 2, END].map(|node| growth(values, node));
        let Hermite {
            of_values,
            of_slopes,
        } = HERMITE_AT_CHECKS;
        let from = |lane: usize| -> f64 {
            let of_values = of_values.iter().zip(grown);
            let of_slopes = of_slopes.iter().zip([slopes[0], slopes[END]]);
            of_values.chain(of_slopes).map(|(w, x)| w[lane] * x).sum()
        };
        for (check, place) in CHECK_PLACES.into_iter().enumerate() {
            // 1e-13: rounding of weights up to 5.
            let grown = value(&polynomial, place) - values[0];
            assert!((from(check) - grown).abs() < 1e-13);
            assert!((from(CHECKS + check) - value(&slope, place)).abs() < 1e-13);
        }
        for node in 0..NODES {
            let found = HERMITE_SLOPES.of_inner_values[node] * (grown[0] + grown[1])
                + HERMITE_SLOPES.of_last_value[node] * grown[2]
                + HERMITE_SLOPES.of_first_slope[node] * slopes[0]
                + HERMITE_SLOPES.of_more_slope[node] * growth(slopes, END);
            assert!((found - slopes[node]).abs() < 1e-13, "{node}");
        }
    }
}
