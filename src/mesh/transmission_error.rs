//! The unloaded static transmission error: how far the true tooth surfaces are from conjugate ones.
//!
//! ```text
//!   e(p) = sum of amplitude cos(2 pi order p + phase)      [m]     p: mesh phase [pitches], offset included
//!   delta = n.(u_a - u_b) + s (R_a th_a + R_b th_b) - e    [m]     e > 0 is relief on the reference flank
//! ```
//!
//! The back flank sees -e.

use super::fourier::FourierSeries;

/// e over the mesh phase.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct TransmissionError {
    series: FourierSeries,
}

/// One harmonic of the transmission error.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ErrorHarmonic {
    /// Periods per tooth pitch. >= 1
    pub order: usize,
    /// Amplitude [m].
    pub amplitude: f64,
    /// Phase at mesh phase 0 [rad].
    pub phase: f64,
}

impl TransmissionError {
    /// The sum of harmonics; several of one order add up.
    pub fn new(harmonics: &[ErrorHarmonic]) -> TransmissionError {
        let highest = harmonics.iter().map(|one| one.order).max().unwrap_or(0);
        let (mut cosine, mut sine) = (vec![0.0; highest], vec![0.0; highest]);
        for harmonic in harmonics {
            // A cos(x + f) = A cos f cos x - A sin f sin x
            let (s, c) = libm::sincos(harmonic.phase);
            cosine[harmonic.order - 1] += harmonic.amplitude * c;
            sine[harmonic.order - 1] -= harmonic.amplitude * s;
        }
        TransmissionError {
            series: FourierSeries::new(&cosine, &sine),
        }
    }

    /// Whether the teeth are perfect: e = 0 at every phase.
    pub fn is_zero(&self) -> bool {
        self.series.is_zero()
    }

    /// e [m] at some mesh phases [pitches], and de/dp [m per pitch].
    #[inline(always)] // into the loops over states, with their vectors
    pub fn values_and_slopes<const N: usize>(&self, phases: [f64; N]) -> [[f64; N]; 2] {
        self.series.values_and_slopes(phases)
    }

    /// d2e/dp2 [m per pitch squared] at a mesh phase [pitches].
    pub fn curvature(&self, phase: f64) -> f64 {
        self.series.curvature(phase)
    }
}

#[cfg(test)]
mod tests {
    use core::f64::consts::TAU;

    use super::*;

    #[test]
    fn the_error_is_the_sum_of_its_harmonics() {
        let harmonics = [(1, 5e-6, 0.3), (3, 2e-6, -1.0), (1, 1e-6, 2.0)];
        let error =
            TransmissionError::new(&harmonics.map(|(order, amplitude, phase)| ErrorHarmonic {
                order,
                amplitude,
                phase,
            }));
        for p in [0.0, 0.37, 5.9, -2.2] {
            let angle = |order: usize, phase: f64| TAU * order as f64 * p + phase;
            let (mut value, mut slope) = (0.0, 0.0);
            for (order, amplitude, phase) in harmonics {
                value += amplitude * libm::cos(angle(order, phase));
                slope -= TAU * order as f64 * amplitude * libm::sin(angle(order, phase));
            }
            // Rounding of angles up to 100 rad.
            let [[found], [found_slope]] = error.values_and_slopes([p]);
            assert!((found - value).abs() < 1e-13 * 5e-6 * 10.0);
            assert!((found_slope - slope).abs() < 1e-13 * 5e-6 * 100.0);
        }
        assert!(!error.is_zero() && TransmissionError::default().is_zero());
    }
}
