//! Cosine and sine of angles that are counted in turns, as phases are.
//!
//! ```text
//!   p = n + q / 4 + r      n the nearest integer, then q that of 4 (p - n), both taken off exactly; |r| <= 1/8
//!   x = 2 pi r,  |x| <= pi / 4,  where two polynomials are good to 2^-58
//!   a quarter turn times q = -2, -1, 0, 1, 2 has the cosine 1 - |q| and the sine q (2 - |q|)
//! ```
//!
//! The polynomials are those of fdlibm's k_cos.c and k_sin.c (Sun Microsystems 1993). There is nothing that waits for a call or
//! takes a branch, so that several angles are found at once.

use core::f64::consts::TAU;

/// Coefficients of x^3, x^5, ... x^13 in the sine.
const SINE: [f64; 6] = [
    -0.16666666666666632,
    0.00833333333332249,
    -0.0001984126982985795,
    2.7557313707070068e-06,
    -2.5050760253406863e-08,
    1.58969099521155e-10,
];
/// Coefficients of x^4, x^6, ... x^14 in the cosine.
const COSINE: [f64; 6] = [
    0.0416666666666666,
    -0.001388888888887411,
    2.480158728947673e-05,
    -2.7557314351390663e-07,
    2.087572321298175e-09,
    -1.1359647557788195e-11,
];

/// Cosines and sines of 2 pi p, for |p| below 2^50.
#[inline(always)]
pub(super) fn turned<const N: usize>(phases: [f64; N]) -> ([f64; N], [f64; N]) {
    let (mut cosines, mut sines) = ([0.0; N], [0.0; N]);
    for i in 0..N {
        let part = phases[i] - nearest(phases[i]);
        let quarter = nearest(4.0 * part);
        let x = TAU * (part - 0.25 * quarter);
        let square = x * x;
        let half = 0.5 * square;
        let most = 1.0 - half;
        let rest = square * square * polynomial(&COSINE, square);
        let cosine = most + (((1.0 - most) - half) + rest);
        let sine = x + x * square * polynomial(&SINE, square);
        let (along, across) = (1.0 - quarter.abs(), quarter * (2.0 - quarter.abs()));
        cosines[i] = along * cosine - across * sine;
        sines[i] = along * sine + across * cosine;
    }
    (cosines, sines)
}

#[inline(always)]
fn polynomial(c: &[f64; 6], t: f64) -> f64 {
    let square = t * t;
    let [first, second, third] = [c[0] + t * c[1], c[2] + t * c[3], c[4] + t * c[5]];
    first + square * (second + square * third)
}

/// The integer next to a number below 2^51: there numbers have no digits for more.
#[inline(always)]
fn nearest(number: f64) -> f64 {
    const NO_DIGITS: f64 = 1.5 * (1_u64 << 52) as f64;
    (number + NO_DIGITS) - NO_DIGITS
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn they_are_those_of_the_library() {
        for step in -4000..=4000 {
            let phase = f64::from(step) / 1600.0;
            // Exact multiples of an eighth included. Both are good to a unit in the last place, of the angle, too.
            let (sine, cosine) = libm::sincos(TAU * (phase - libm::floor(phase)));
            let ([c], [s]) = turned([phase]);
            assert!(
                (c - cosine).abs() < 1e-15 && (s - sine).abs() < 1e-15,
                "{phase}"
            );
        }
    }

    #[test]
    fn whole_turns_change_nothing_and_quarters_are_exact() {
        let part = 0.2890625; // exact in binary
        for turns in [-1e9, -3.0, 1.0, 7.0, 1e12] {
            assert_eq!(turned([turns + part]), turned([part]));
        }
        let quarters = turned([0.0, 0.25, 0.5, 0.75]);
        assert_eq!(quarters, ([1.0, 0.0, -1.0, 0.0], [0.0, 1.0, 0.0, -1.0]));
    }
}
