//! Complex numbers and their kin, several at once: the compiler keeps them side by side in vectors. Their phi functions.
//!
//! ```text
//!   z = re + im S,  S^2 = q         complex: q = -1;  matrices of two rows: B = a + S, where q = (difference of the eigenvalues / 2)^2
//!   z* = re - im S,  z z* = re^2 - q im^2
//! ```

use nalgebra::Complex;

/// N numbers re + im S.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Numbers<const N: usize> {
    /// Real parts.
    pub re: [f64; N],
    /// Parts along S.
    pub im: [f64; N],
}

/// S^2 of complex numbers.
pub(super) const COMPLEX: f64 = -1.0;

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

/// All functions of numbers that are not larger than [`SERIES_RADIUS`]; `largest` is the largest of them.
#[inline(always)]
pub(super) fn phi_by_series<const N: usize>(
    z: &Numbers<N>,
    q: f64,
    largest: f64,
) -> [Numbers<N>; PHI_ORDERS] {
    let mut phi = [Numbers::ZERO; PHI_ORDERS];
    let top = PHI_ORDERS - 1;
    phi[top] = series(z, q, terms(largest));
    for k in (0..top).rev() {
        phi[k] = z.times(&phi[k + 1], q).plus(INVERSE_FACTORIAL[k]);
    }
    phi
}

/// All functions of numbers that are not small, from their exponentials.
#[inline(always)]
pub(super) fn phi_by_exponential<const N: usize>(
    z: &Numbers<N>,
    q: f64,
    exponential: &Numbers<N>,
) -> [Numbers<N>; PHI_ORDERS] {
    let mut phi = [*exponential; PHI_ORDERS];
    let per_square = z.squares(q).map(|square| 1.0 / square);
    let inverse = z.conjugates().scaled(&per_square);
    for k in 1..PHI_ORDERS {
        let above = phi[k - 1].plus(-INVERSE_FACTORIAL[k - 1]);
        phi[k] = above.times(&inverse, q);
    }
    phi
}

/// The sum of z^n / (n + 6)!, n = 0, 1, ..., `last`. Divided by (x - z)(x - z*) the polynomial leaves a real line, whose value at z
/// is that of the polynomial: real products only.
#[inline(always)]
fn series<const N: usize>(z: &Numbers<N>, q: f64, last: usize) -> Numbers<N> {
    let twice = z.re.map(|re| 2.0 * re);
    let square = z.squares(q);
    let (mut one, mut two) = ([0.0; N], [0.0; N]);
    for coefficient in SERIES[..=last].iter().rev() {
        for i in 0..N {
            let next = coefficient + twice[i] * one[i] - square[i] * two[i];
            (one[i], two[i]) = (next, one[i]);
        }
    }
    Numbers {
        re: core::array::from_fn(|i| one[i] - z.re[i] * two[i]),
        im: core::array::from_fn(|i| z.im[i] * two[i]),
    }
}

impl<const N: usize> Numbers<N> {
    /// Nothing.
    pub const ZERO: Numbers<N> = Numbers {
        re: [0.0; N],
        im: [0.0; N],
    };

    /// The same complex number everywhere.
    #[inline(always)]
    pub fn all(z: Complex<f64>) -> Numbers<N> {
        Numbers {
            re: [z.re; N],
            im: [z.im; N],
        }
    }

    /// Complex number i.
    pub fn get(&self, i: usize) -> Complex<f64> {
        Complex::new(self.re[i], self.im[i])
    }

    /// Each times its own real number.
    #[inline(always)]
    pub fn scaled(&self, factors: &[f64; N]) -> Numbers<N> {
        Numbers {
            re: core::array::from_fn(|i| self.re[i] * factors[i]),
            im: core::array::from_fn(|i| self.im[i] * factors[i]),
        }
    }

    /// Number by number.
    #[inline(always)]
    pub(super) fn times(&self, other: &Numbers<N>, q: f64) -> Numbers<N> {
        let (a, b) = (self, other);
        Numbers {
            re: core::array::from_fn(|i| a.re[i] * b.re[i] + q * (a.im[i] * b.im[i])),
            im: core::array::from_fn(|i| a.re[i] * b.im[i] + a.im[i] * b.re[i]),
        }
    }

    /// The sum, number by number.
    #[inline(always)]
    pub(super) fn with(&self, other: &Numbers<N>) -> Numbers<N> {
        Numbers {
            re: core::array::from_fn(|i| self.re[i] + other.re[i]),
            im: core::array::from_fn(|i| self.im[i] + other.im[i]),
        }
    }

    /// The difference, number by number.
    #[inline(always)]
    pub(super) fn without(&self, other: &Numbers<N>) -> Numbers<N> {
        self.with(&other.scaled(&[-1.0; N]))
    }

    /// z*.
    #[inline(always)]
    pub(super) fn conjugates(&self) -> Numbers<N> {
        Numbers {
            im: self.im.map(|im| -im),
            ..*self
        }
    }

    #[inline(always)]
    fn plus(&self, real: f64) -> Numbers<N> {
        Numbers {
            re: self.re.map(|re| re + real),
            ..*self
        }
    }

    /// z z*.
    #[inline(always)]
    fn squares(&self, q: f64) -> [f64; N] {
        core::array::from_fn(|i| self.re[i] * self.re[i] - q * (self.im[i] * self.im[i]))
    }

    /// Its own numbers here, those of another there.
    #[inline(always)]
    pub(super) fn where_or(&self, own: [bool; N], other: &Numbers<N>) -> Numbers<N> {
        let select = |one: &[f64; N], two: &[f64; N]| {
            core::array::from_fn(|i| if own[i] { one[i] } else { two[i] })
        };
        Numbers {
            re: select(&self.re, &other.re),
            im: select(&self.im, &other.im),
        }
    }
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
