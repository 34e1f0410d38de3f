//! The phi functions of a complex number.

use nalgebra::Complex;

/// phi_0 to phi_6.
pub const PHI_ORDERS: usize = 7;

/// 1/k!.
pub(super) const INVERSE_FACTORIAL: [f64; PHI_ORDERS] = [
    1.0,
    1.0,
    0.5,
    1.0 / 6.0,
    1.0 / 24.0,
    1.0 / 120.0,
    1.0 / 720.0,
];

/// Size of an argument up to which the series is used.
pub(super) const SERIES_RADIUS: f64 = 1.0;
/// Terms n of the series of phi_6 behind the first, for arguments up to a size: what is left out is below 2e-17 of it,
/// size^(n + 1) 6! / (n + 7)!.
const SERIES_TERMS: [(f64, usize); 4] = [(1e-3, 4), (3e-2, 6), (0.3, 10), (1.0, 14)];

/// All functions of a number.
pub(super) fn complex_phi_functions(z: Complex<f64>) -> [Complex<f64>; PHI_ORDERS] {
    let mut phi = [Complex::new(0.0, 0.0); PHI_ORDERS];
    let size = z.re.abs() + z.im.abs();
    if size <= SERIES_RADIUS {
        let top = PHI_ORDERS - 1;
        phi[top] = series(z, terms(size));
        for k in (0..top).rev() {
            phi[k] = z * phi[k + 1] + INVERSE_FACTORIAL[k];
        }
    } else {
        phi[0] = rotation(z.im) * libm::exp(z.re);
        let inverse = z.conj() / z.norm_sqr();
        for k in 1..PHI_ORDERS {
            phi[k] = (phi[k - 1] - INVERSE_FACTORIAL[k - 1]) * inverse;
        }
    }
    phi
}

/// The sum of z^n / (n + 6)!, n = 0, 1, ..., `last`. Divided by (x - z)(x - z*) the polynomial leaves a real line, whose value at z
/// is that of the polynomial: real products only.
fn series(z: Complex<f64>, last: usize) -> Complex<f64> {
    let (twice, square) = (2.0 * z.re, z.norm_sqr());
    let (mut one, mut two) = (0.0, 0.0);
    for coefficient in SERIES[..=last].iter().rev() {
        (one, two) = (coefficient + twice * one - square * two, one);
    }
    Complex::new(one - z.re * two, z.im * two)
}

/// 1/(n + 6)!.
const SERIES: [f64; 15] = {
    let mut values = [INVERSE_FACTORIAL[PHI_ORDERS - 1]; 15];
    let mut n = 1;
    while n < values.len() {
        values[n] = values[n - 1] / (n + PHI_ORDERS - 1) as f64;
        n += 1;
    }
    values
};

/// 1/n.
pub(super) const RECIPROCAL: [f64; 21] = {
    let mut values = [0.0; 21];
    let mut n = 1;
    while n < values.len() {
        values[n] = 1.0 / n as f64;
        n += 1;
    }
    values
};

/// Terms of the series behind the first for an argument of a size up to [`SERIES_RADIUS`].
pub(super) fn terms(size: f64) -> usize {
    let enough = SERIES_TERMS.iter().find(|(radius, _)| size <= *radius);
    enough.map_or(SERIES_TERMS[SERIES_TERMS.len() - 1].1, |(_, terms)| *terms)
}

/// e^(i angle).
pub(super) fn rotation(angle: f64) -> Complex<f64> {
    let (sine, cosine) = libm::sincos(angle);
    Complex::new(cosine, sine)
}
