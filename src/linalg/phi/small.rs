//! The functions of matrices of one or two rows, at several times at once.
//!
//! ```text
//!   B = a + S,  S^2 = q          a: half the sum of the diagonal; eigenvalues a +- sqrt q
//!   f(B T) = re + im S           as if it were the number a T + T S
//! ```

use nalgebra::{Complex, DMatrix};

use super::PhiFunctions;
use super::numbers::{
    COMPLEX, Numbers, PHI_ORDERS, SERIES_RADIUS, phi_by_exponential, phi_by_series,
};

/// Below this |(lambda - i w) T| at the last time the response to an oscillator is taken from the series: the difference of two
/// exponentials would lose digits.
const RESONANT: f64 = 1e-2;

/// phi_0 to phi_6 of a matrix of one or two rows, as numbers along S, at four [`times`](SmallPhi::of).
#[derive(Debug, Clone, Copy)]
pub struct SmallPhi {
    /// The functions.
    pub phi: [Numbers<4>; PHI_ORDERS],
    times: [f64; 4],
    /// The eigenvalue with positive imaginary part, where there is a pair of complex ones.
    pair: Option<Complex<f64>>,
}

impl SmallPhi {
    /// The functions of `matrix * time` at these times, not negative: two, and before and behind them their sum. `None` for a larger
    /// matrix. `general` serves where the eigenvalues do not.
    #[inline(always)]
    pub fn of(
        matrix: &DMatrix<f64>,
        times: [f64; 4],
        general: &mut PhiFunctions,
    ) -> Option<SmallPhi> {
        let (a, q) = match *matrix.as_slice() {
            [value] => (value, 0.0),
            [a, b, c, d] => (0.5 * (a + d), 0.25 * (a - d) * (a - d) + b * c),
            _ => return None,
        };
        let radius = a.abs() + q.abs().sqrt();
        let is_small = times.map(|time| radius * time <= SERIES_RADIUS);
        let z = Numbers {
            re: times.map(|time| a * time),
            im: times,
        };
        let longest = times[0];
        let pair = (q < 0.0).then(|| Complex::new(a, (-q).sqrt()));
        let phi = if is_small[0] {
            phi_by_series(&z, q, radius * longest)
        } else {
            let others = match pair {
                // With a small w the formula would divide rounding by w.
                Some(value) if value.im * longest > 1e-3 * (a.abs() * longest + 1.0) => {
                    let mut grown = exponentials(value, times);
                    grown.im = grown.im.map(|im| im / value.im);
                    phi_by_exponential(&z, q, &grown)
                }
                _ => in_general(matrix, times, is_small, general),
            };
            if is_small == [false; 4] {
                others
            } else {
                let series = phi_by_series(&z, q, SERIES_RADIUS);
                core::array::from_fn(|k| series[k].where_or(is_small, &others[k]))
            }
        };
        Some(SmallPhi { phi, times, pair })
    }

    /// The responses of x' = B x + Re(load e^(i w t)) from rest at all times T: x(T) = Re(result); `turned` is e^(i w T). `None`
    /// where [`PhiFunctions::oscillator_response`] has to serve.
    ///
    /// ```text
    ///   result = integral from 0 to T of e^(B (T-s)) e^(i w s) ds load = f(B) load
    ///   f(z) = (e^(z T) - e^(i w T)) / (z - i w) = T e^(i w T) phi_1((z - i w) T)            exact at resonance too
    /// ```
    #[inline(always)]
    pub fn oscillator_response(
        &self,
        matrix: &DMatrix<f64>,
        driven: (f64, &Numbers<4>),
        load: &[Complex<f64>],
    ) -> Option<[Numbers<4>; 2]> {
        let (Some(value), &[one, two]) = (self.pair, load) else {
            return None;
        };
        // Lagrange's form of f(B) on the two eigenvalues a +- i w.
        let grown = Numbers {
            im: self.phi[0].im.map(|im| im * value.im),
            ..self.phi[0]
        };
        let upper = self.driven(value, &grown, driven);
        let lower = self.driven(value.conj(), &grown.conjugates(), driven);
        let per_difference = Numbers::all(Complex::new(0.0, -0.5 / value.im));
        let slope = upper.without(&lower).times(&per_difference, COMPLEX);
        let level = upper.without(&slope.times(&Numbers::all(value), COMPLEX));
        let product = |i: usize| one * matrix[(i, 0)] + two * matrix[(i, 1)];
        Some([
            combination(&level, one, &slope, product(0)),
            combination(&level, two, &slope, product(1)),
        ])
    }

    /// f(z) of an eigenvalue; `grown` is e^(z T).
    #[inline(always)]
    fn driven(
        &self,
        value: Complex<f64>,
        grown: &Numbers<4>,
        (frequency, turned): (f64, &Numbers<4>),
    ) -> Numbers<4> {
        let apart = value - Complex::new(0.0, frequency);
        let size = apart.l1_norm() * self.times[0];
        if size < RESONANT {
            let z = Numbers::all(apart).scaled(&self.times);
            let phi = phi_by_series(&z, COMPLEX, size);
            turned.scaled(&self.times).times(&phi[1], COMPLEX)
        } else {
            let per_apart = Numbers::all(apart.inv());
            grown.without(turned).times(&per_apart, COMPLEX)
        }
    }
}

/// e^(z T) at times T as those of [`SmallPhi::of`]: at the sum of two times it is the product.
pub fn exponentials(z: Complex<f64>, times: [f64; 4]) -> Numbers<4> {
    let exponential = |time: f64| {
        let (sine, cosine) = libm::sincos(z.im * time);
        Complex::new(cosine, sine) * libm::exp(z.re * time)
    };
    let [one, other] = [times[1], times[2]].map(exponential);
    let grown = [one * other, one, other, one * other];
    Numbers {
        re: grown.map(|grown| grown.re),
        im: grown.map(|grown| grown.im),
    }
}

/// a x + b y.
#[inline(always)]
fn combination(a: &Numbers<4>, x: Complex<f64>, b: &Numbers<4>, y: Complex<f64>) -> Numbers<4> {
    let along = b.times(&Numbers::all(y), COMPLEX);
    a.times(&Numbers::all(x), COMPLEX).with(&along)
}

/// The functions of a matrix of any eigenvalues; not where they are not asked for.
fn in_general(
    matrix: &DMatrix<f64>,
    times: [f64; 4],
    skipped: [bool; 4],
    general: &mut PhiFunctions,
) -> [Numbers<4>; PHI_ORDERS] {
    let mut functions = [Numbers::ZERO; PHI_ORDERS];
    let entries = matrix.as_slice();
    let largest = largest_along(entries);
    for (i, time) in times.into_iter().enumerate().filter(|(i, _)| !skipped[*i]) {
        general.evaluate(matrix, time);
        for (k, function) in functions.iter_mut().enumerate() {
            match *general.get(k) {
                [a, b, c, d] => {
                    let along = [0.5 * (a - d), b, c];
                    function.re[i] = 0.5 * (a + d);
                    if let Some((place, entry)) = largest {
                        function.im[i] = along[place] / entry;
                    }
                }
                ref one => function.re[i] = one[0],
            }
        }
    }
    functions
}

/// Which entry of S is the largest, and its value; `None` where all are zero.
fn largest_along(entries: &[f64]) -> Option<(usize, f64)> {
    let &[a, b, c, d] = entries else {
        return None;
    };
    let along = [0.5 * (a - d), b, c].into_iter().enumerate();
    let largest = along.max_by(|one, other| one.1.abs().total_cmp(&other.1.abs()));
    largest.filter(|(_, entry)| *entry != 0.0)
}
