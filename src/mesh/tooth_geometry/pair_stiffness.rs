//! The stiffness of one pair of teeth in a form that is cheap to evaluate: a Chebyshev series over the contact.
//!
//! ```text
//!   k(x) = sum over n of c_n T_n(2 x / eps - 1)        c_n from the values at the zeros of T_N
//! ```
//!
//! k(x) is analytic over the contact, so that the coefficients fall off geometrically; those beyond the accuracy of the
//! integration are dropped.

use core::f64::consts::PI;

use super::SpurPair;

/// Values from which the series is made.
const SAMPLES: usize = 64;

/// Sum of dropped coefficients relative to the mean: a tenth of the promised 1e-9.
const DROPPED: f64 = 1e-10;

/// Stiffness of one pair over the contact.
#[derive(Debug, Clone, PartialEq)]
pub struct PairStiffness {
    pair: SpurPair,
    contact_ratio: f64,
    /// c_n, with half of c_0.
    coefficients: Vec<f64>,
}

impl PairStiffness {
    /// Represents the pair's stiffness to 1e-9 of itself. The pair must be one whose teeth can mesh.
    pub fn of(pair: &SpurPair) -> PairStiffness {
        let contact_ratio = pair.path_of_contact().contact_ratio();
        let angle = |sample: usize| PI * (sample as f64 + 0.5) / SAMPLES as f64;
        let values: Vec<f64> = (0..SAMPLES)
            .map(|sample| 0.5 * contact_ratio * (1.0 + libm::cos(angle(sample))))
            .map(|x| pair.pair_stiffness(x))
            .collect();
        let coefficient = |n: usize| {
            let terms =
                (0..SAMPLES).map(|sample| values[sample] * libm::cos(n as f64 * angle(sample)));
            let weight = if n == 0 { 1.0 } else { 2.0 };
            weight * terms.sum::<f64>() / SAMPLES as f64
        };
        let mut coefficients: Vec<f64> = (0..SAMPLES).map(coefficient).collect();
        let mut dropped = 0.0;
        while coefficients.len() > 1 {
            dropped += coefficients[coefficients.len() - 1].abs();
            if dropped > DROPPED * coefficients[0] {
                break;
            }
            coefficients.pop();
        }
        PairStiffness {
            pair: *pair,
            contact_ratio,
            coefficients,
        }
    }

    /// What it is the stiffness of.
    pub fn pair(&self) -> &SpurPair {
        &self.pair
    }

    /// Mean number of tooth pairs in contact eps.
    pub fn contact_ratio(&self) -> f64 {
        self.contact_ratio
    }

    /// Stiffness [N/m] at some places along the path of contact [pitches], 0 <= x <= eps. Each waits for itself at every coefficient:
    /// several together take no longer than one.
    #[inline(always)] // into the loops over states, with their vectors
    pub fn values<const N: usize>(&self, places: [f64; N]) -> [f64; N] {
        // Clenshaw's recurrence.
        let t = places.map(|x| 2.0 * x / self.contact_ratio - 1.0);
        let (mut one, mut two) = ([0.0; N], [0.0; N]);
        for &coefficient in self.coefficients.iter().skip(1).rev() {
            for i in 0..N {
                (one[i], two[i]) = (coefficient + 2.0 * t[i] * one[i] - two[i], one[i]);
            }
        }
        core::array::from_fn(|i| self.coefficients[0] + t[i] * one[i] - two[i])
    }

    /// dk/dx [N/m per pitch].
    pub fn slope(&self, x: f64) -> f64 {
        // T_n' = n U_(n-1); Clenshaw's recurrence for the U.
        let t = 2.0 * x / self.contact_ratio - 1.0;
        let (mut one, mut two) = (0.0, 0.0);
        for (n, &coefficient) in self.coefficients.iter().enumerate().skip(1).rev() {
            (one, two) = (n as f64 * coefficient + 2.0 * t * one - two, one);
        }
        one * 2.0 / self.contact_ratio
    }

    /// Integral over the contact [N/m x pitches]: the mean, over a pitch, of the sum over all pairs.
    pub fn integral(&self) -> f64 {
        // Integral of T_n over [-1, 1]: 2 / (1 - n^2) for even n, 0 for odd n.
        let even = self.coefficients.iter().enumerate().step_by(2);
        let sum: f64 = even
            .map(|(n, coefficient)| coefficient * 2.0 / (1.0 - (n * n) as f64))
            .sum();
        0.5 * self.contact_ratio * sum
    }
}
