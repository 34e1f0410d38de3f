//! A periodic quantity as the sum of its harmonics.
//!
//! ```text
//!   f(p) = sum over i of  c_i cos(2 pi i p) + s_i sin(2 pi i p),   i = 1, 2, ...   period 1, mean 0
//! ```

use core::f64::consts::TAU;

/// The series, without a mean.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct FourierSeries {
    /// (c_i, s_i) of the orders i = 1, 2, ...
    coefficients: Vec<(f64, f64)>,
}

/// Samples per period of the highest harmonic for the bound on the minimum.
const SAMPLES: usize = 256;

impl FourierSeries {
    /// The coefficients of the orders 1, 2, ...; the shorter list goes on with zeros.
    pub(super) fn new(cosine: &[f64], sine: &[f64]) -> FourierSeries {
        let entry = |list: &[f64], i: usize| list.get(i).copied().unwrap_or(0.0);
        FourierSeries {
            coefficients: (0..cosine.len().max(sine.len()))
                .map(|i| (entry(cosine, i), entry(sine, i)))
                .collect(),
        }
    }

    /// f(p).
    pub(super) fn value(&self, phase: f64) -> f64 {
        let [value] = self.values([phase]);
        value
    }

    /// f(p) at some phases.
    #[inline(always)] // into the loops over states, with their vectors
    pub(super) fn values<const N: usize>(&self, phases: [f64; N]) -> [f64; N] {
        let [values] = self.sums(phases, |_, pair, turned| [along(pair, turned)]);
        values
    }

    /// df/dp [per period].
    pub(super) fn slope(&self, phase: f64) -> f64 {
        let [_, [slope]] = self.values_and_slopes([phase]);
        slope
    }

    /// f(p) at some phases, and df/dp.
    #[inline(always)] // into the loops over states, with their vectors
    pub(super) fn values_and_slopes<const N: usize>(&self, phases: [f64; N]) -> [[f64; N]; 2] {
        self.sums(phases, |order, pair, turned| {
            [along(pair, turned), TAU * order * across(pair, turned)]
        })
    }

    /// d2f/dp2 [per period squared].
    pub(super) fn curvature(&self, phase: f64) -> f64 {
        let [[curvature]] = self.sums([phase], |order, pair, turned| {
            [-TAU * order * TAU * order * along(pair, turned)]
        });
        curvature
    }

    /// Whether f is zero everywhere.
    pub(super) fn is_zero(&self) -> bool {
        self.coefficients.iter().all(|&pair| pair == (0.0, 0.0))
    }

    /// A lower bound of f, below its minimum by at most 1e-4 of the sum of the amplitudes.
    ///
    /// The nearest of n samples lies within 1/(2n) of the minimum, where f' = 0, so that f there is larger by at
    /// most max|f''| / 8 n^2; with n = 256 per period of the highest order N, max|f''| <= (2 pi N)^2 sum of amplitudes
    /// makes this 7.6e-5 of that sum.
    pub(super) fn lower_bound(&self) -> f64 {
        let amplitudes: f64 = self
            .coefficients
            .iter()
            .map(|&(c, s)| libm::hypot(c, s))
            .sum();
        let samples = SAMPLES * self.coefficients.len().max(1);
        let least = (0..samples)
            .map(|i| self.value(i as f64 / samples as f64))
            .fold(f64::INFINITY, f64::min);
        let per_order = TAU / SAMPLES as f64;
        least - 0.125 * per_order * per_order * amplitudes
    }

    /// The sums over the orders of `terms(i, (c_i, s_i), (cos 2 pi i p, sin 2 pi i p))` at some phases.
    #[inline(always)]
    fn sums<const N: usize, const TERMS: usize>(
        &self,
        phases: [f64; N],
        terms: impl Fn(f64, (f64, f64), (f64, f64)) -> [f64; TERMS],
    ) -> [[f64; N]; TERMS] {
        let mut sums = [[0.0; N]; TERMS];
        if self.coefficients.is_empty() {
            return sums;
        }
        let (mut cosine, mut sine) = ([0.0; N], [0.0; N]);
        for (i, phase) in phases.into_iter().enumerate() {
            (sine[i], cosine[i]) = libm::sincos(TAU * (phase - libm::floor(phase)));
        }
        let (mut cosines, mut sines) = ([1.0; N], [0.0; N]);
        let mut order = 0.0;
        for &pair in &self.coefficients {
            order += 1.0;
            for i in 0..N {
                // The angle of the next order by the addition theorem.
                let (c, s) = (cosines[i], sines[i]);
                cosines[i] = c * cosine[i] - s * sine[i];
                sines[i] = s * cosine[i] + c * sine[i];
                let terms = terms(order, pair, (cosines[i], sines[i]));
                for (sums, term) in sums.iter_mut().zip(terms) {
                    sums[i] += term;
                }
            }
        }
        sums
    }
}

/// c cos + s sin.
#[inline(always)]
fn along((c, s): (f64, f64), (cosine, sine): (f64, f64)) -> f64 {
    c * cosine + s * sine
}

/// The same a quarter turn ahead: s cos - c sin.
#[inline(always)]
fn across((c, s): (f64, f64), (cosine, sine): (f64, f64)) -> f64 {
    s * cosine - c * sine
}

#[cfg(test)]
mod tests {
    use super::*;

    fn series() -> FourierSeries {
        FourierSeries::new(&[0.2, 0.0, -0.1], &[0.05, 0.3])
    }

    #[test]
    fn the_sum_is_that_of_its_harmonics() {
        for phase in [0.0, 0.125, 0.7, -0.3, 12.9] {
            let x = TAU * phase;
            let expected = 0.2 * libm::cos(x) + 0.05 * libm::sin(x) + 0.3 * libm::sin(2.0 * x)
                - 0.1 * libm::cos(3.0 * x);
            // 1e-13: rounding of an angle of 80 rad.
            assert!((series().value(phase) - expected).abs() < 1e-13);
        }
    }

    #[test]
    fn the_slope_is_the_derivative_of_the_value() {
        let (series, h) = (series(), 1e-5);
        for phase in [0.0, 0.2, 0.55, 0.99] {
            let difference = (series.value(phase + h) - series.value(phase - h)) / (2.0 * h);
            // h^2 f''' / 6 with f''' < (2 pi 3)^3: 1e-7.
            assert!((series.slope(phase) - difference).abs() < 1e-6);
        }
    }

    #[test]
    fn the_curvature_is_the_derivative_of_the_slope() {
        let (series, h) = (series(), 1e-5);
        for phase in [0.0, 0.2, 0.55, 0.99] {
            let difference = (series.slope(phase + h) - series.slope(phase - h)) / (2.0 * h);
            // h^2 f'''' / 6 with f'''' < (2 pi 3)^4: 2e-6.
            assert!((series.curvature(phase) - difference).abs() < 1e-5);
        }
    }

    #[test]
    fn the_lower_bound_lies_closely_below_the_minimum() {
        let shifted = FourierSeries::new(&[0.6], &[0.8]); // amplitude 1, minimum between the samples
        let bound = shifted.lower_bound();
        assert!((-1.0 - 1e-4..=-1.0).contains(&bound), "{bound}");
    }
}
