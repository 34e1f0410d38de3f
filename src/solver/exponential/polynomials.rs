//! The polynomials by which forces are represented over one step, x = s/h from 0 to 1.
//!
//! A force is a cubic through four Lobatto nodes. At two further places, near both ends, it is compared with the force that the
//! law gives there; the quintic through all six places says what the cubic leaves out. Two places, because forces that pass
//! from one level to another are odd about the middle of the step. What the couplings see there is interpolated from deflections
//! and rates at the nodes: eight numbers, so that the motion is known far better than the cubic knows the force.

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
/// Polynomials of degree seven from values and slopes at the nodes, at the places for comparison.
pub(super) const HERMITE_AT_CHECKS: Hermite = Hermite {
    of_values: [
        [
            0.323_061_621_135_924_7,
            0.035_442_627_457_812_1,
            -5.070_515_495_046_595,
            0.158_586_471_203_089_5,
        ],
        [
            0.607_633_497_187_473_7,
            0.033_862_254_218_789_43,
            5.307_686_604_609_184,
            0.078_584_638_359_499_87,
        ],
        [
            0.033_862_254_218_789_43,
            0.607_633_497_187_473_7,
            -0.078_584_638_359_499_87,
            -5.307_686_604_609_184,
        ],
        [
            0.035_442_627_457_812_1,
            0.323_061_621_135_924_7,
            -0.158_586_471_203_089_5,
            5.070_515_495_046_595,
        ],
    ],
    of_slopes: [
        [
            0.016_794_576_808_202_5,
            0.002_693_135_621_484_342,
            -0.217_879_248_593_736_86,
            0.012_325_849_718_747_37,
        ],
        [
            -0.083_972_884_041_012_5,
            0.019_823_308_900_386_19,
            -0.125_870_751_406_263_14,
            0.079_866_502_812_526_29,
        ],
        [
            -0.019_823_308_900_386_19,
            0.083_972_884_041_012_5,
            0.079_866_502_812_526_29,
            -0.125_870_751_406_263_14,
        ],
        [
            -0.002_693_135_621_484_342,
            -0.016_794_576_808_202_5,
            0.012_325_849_718_747_37,
            -0.217_879_248_593_736_86,
        ],
    ],
};

/// What a polynomial's values and slopes at the places for comparison take from its values and from its slopes at the nodes: for
/// every node the value at either place, then the slope at either.
pub(super) struct Hermite {
    pub(super) of_values: [Quad; NODES],
    pub(super) of_slopes: [Quad; NODES],
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
pub(super) const FACTORIAL: [f64; POWERS] = [1.0, 1.0, 2.0, 6.0, 24.0, 120.0];

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
    fn interpolation_at_the_checks_is_exact_for_polynomials_of_degree_seven() {
        let nodes = PLACES;
        let polynomial = [0.7, -1.0, 0.5, 2.0, -3.0, 1.5, 0.3, -0.8];
        let slope: Vec<f64> = (1..8).map(|k| k as f64 * polynomial[k]).collect();
        let Hermite {
            of_values,
            of_slopes,
        } = HERMITE_AT_CHECKS;
        let from = |lane: usize| -> f64 {
            let weights = of_values.iter().zip(&of_slopes);
            let terms = nodes.iter().zip(weights);
            terms
                .map(|(&x, (v, s))| v[lane] * value(&polynomial, x) + s[lane] * value(&slope, x))
                .sum()
        };
        for (check, place) in CHECK_PLACES.into_iter().enumerate() {
            // 1e-13: rounding of weights up to 5.
            assert!((from(check) - value(&polynomial, place)).abs() < 1e-13);
            assert!((from(CHECKS + check) - value(&slope, place)).abs() < 1e-13);
        }
    }
}
