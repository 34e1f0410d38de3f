//! Which frequencies a signal is made of.
//!
//! ```text
//!   A(f) = 2 |sum over n of w_n (s_n - mean) exp(-2 pi i f n h)| / sum of w_n      w_n = (1 - cos(2 pi n / N)) / 2   (Hann)
//! ```
//!
//! A sinusoid shows its amplitude. The mean is taken off first, so that a large one does not leak into low frequencies.

use std::f64::consts::TAU;

/// Single-sided amplitudes of a signal at multiples of a frequency step.
#[derive(Debug, Clone)]
pub struct Spectrum {
    /// The signal's mean.
    pub mean: f64,
    /// Distance of the amplitudes in frequency [Hz].
    pub step: f64,
    /// Amplitudes at 0, step, 2 step, ... up to half the sampling rate; 0 at 0 Hz.
    pub amplitudes: Vec<f64>,
}

/// A peak of a spectrum.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Line {
    /// [Hz]
    pub frequency: f64,
    /// In the unit of the signal.
    pub amplitude: f64,
}

impl Spectrum {
    /// Of as many samples as a power of two, over `duration` seconds.
    pub fn of(signal: &[f64], duration: f64) -> Spectrum {
        let count = signal.len();
        assert!(count.is_power_of_two(), "{count} samples");
        let mean = signal.iter().sum::<f64>() / count as f64;
        let turn = TAU / count as f64;
        let windowed = |(n, value): (usize, &f64)| {
            let weight = 0.5 - 0.5 * libm::cos(turn * n as f64);
            [weight * (value - mean), 0.0]
        };
        let transformed = transform(&signal.iter().enumerate().map(windowed).collect::<Vec<_>>());
        // The weights add up to half the number of samples.
        let amplitude = |[re, im]: &[f64; 2]| 4.0 * libm::hypot(*re, *im) / count as f64;
        let mut amplitudes: Vec<f64> = transformed[..=count / 2].iter().map(amplitude).collect();
        amplitudes[0] = 0.0;
        Spectrum {
            mean,
            step: 1.0 / duration,
            amplitudes,
        }
    }

    /// Of two signals at right angles: the lengths of their amplitudes, line by line.
    pub fn beside(mut self, other: &Spectrum) -> Spectrum {
        self.mean = libm::hypot(self.mean, other.mean);
        for (amplitude, other) in self.amplitudes.iter_mut().zip(&other.amplitudes) {
            *amplitude = libm::hypot(*amplitude, *other);
        }
        self
    }

    /// Amplitude at a frequency [Hz] that is a multiple of the step.
    pub fn at(&self, frequency: f64) -> f64 {
        self.amplitudes[(frequency / self.step).round() as usize]
    }

    /// Largest amplitude within `reach` of a frequency [Hz].
    pub fn near(&self, frequency: f64, reach: f64) -> f64 {
        let index = |frequency: f64| (frequency / self.step).round() as usize;
        let range = index(frequency - reach)..=index(frequency + reach);
        self.amplitudes[range].iter().copied().fold(0.0, f64::max)
    }

    /// The highest peak up to a frequency [Hz] that is farther than `reach` from every one of `others`.
    pub fn highest_beside(&self, others: &[f64], reach: f64, highest: f64) -> f64 {
        let apart = |line: &Line| {
            others
                .iter()
                .all(|other| (line.frequency - other).abs() > reach)
        };
        let found = self.lines(highest).into_iter().find(apart);
        found.map_or(0.0, |line| line.amplitude)
    }

    /// The peaks up to a frequency [Hz], highest first.
    pub fn lines(&self, highest: f64) -> Vec<Line> {
        let end = ((highest / self.step) as usize).min(self.amplitudes.len() - 2);
        let peak = |&i: &usize| {
            let (left, here, right) = (
                self.amplitudes[i - 1],
                self.amplitudes[i],
                self.amplitudes[i + 1],
            );
            here > left && here >= right
        };
        let line = |i: usize| Line {
            frequency: i as f64 * self.step,
            amplitude: self.amplitudes[i],
        };
        let mut lines: Vec<Line> = (1..=end).filter(peak).map(line).collect();
        lines.sort_by(|one, two| two.amplitude.total_cmp(&one.amplitude));
        lines
    }
}

/// Discrete Fourier transform by halves: X(k) = E(k) + exp(-2 pi i k / N) O(k), E and O those of the even and odd samples.
fn transform(samples: &[[f64; 2]]) -> Vec<[f64; 2]> {
    let turn = |k: usize| libm::sincos(TAU * k as f64 / samples.len() as f64);
    by_halves(
        samples,
        &(0..samples.len() / 2).map(turn).collect::<Vec<_>>(),
    )
}

/// `turns`: sine and cosine of 2 pi k / M for the M >= N samples at the top.
fn by_halves(samples: &[[f64; 2]], turns: &[(f64, f64)]) -> Vec<[f64; 2]> {
    let count = samples.len();
    if count == 1 {
        return samples.to_vec();
    }
    let half = |first: usize| {
        let samples = samples.iter().skip(first).step_by(2);
        by_halves(&samples.copied().collect::<Vec<_>>(), turns)
    };
    let (even, odd) = (half(0), half(1));
    let mut whole = vec![[0.0; 2]; count];
    for k in 0..count / 2 {
        let (sine, cosine) = turns[k * (2 * turns.len() / count)];
        let [re, im] = odd[k];
        let turned = [re * cosine + im * sine, im * cosine - re * sine];
        for axis in 0..2 {
            whole[k][axis] = even[k][axis] + turned[axis];
            whole[k + count / 2][axis] = even[k][axis] - turned[axis];
        }
    }
    whole
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sinusoids_show_their_amplitudes_and_the_mean_is_apart() {
        let (count, duration) = (1024, 0.5);
        let sample = |n: usize| {
            let time = duration * n as f64 / count as f64;
            7.0 + 3.0 * libm::sin(TAU * 50.0 * time) + 0.5 * libm::cos(TAU * 300.0 * time + 1.0)
        };
        let spectrum = Spectrum::of(&(0..count).map(sample).collect::<Vec<_>>(), duration);
        // 1e-12: rounding; the lines are multiples of 2 Hz, where Hann's window separates exactly.
        assert!((spectrum.mean - 7.0).abs() < 1e-12);
        assert!((spectrum.at(50.0) - 3.0).abs() < 1e-12);
        assert!((spectrum.near(299.0, 3.0) - 0.5).abs() < 1e-12);
        assert!(spectrum.at(200.0) < 1e-12);
        let lines = spectrum.lines(1000.0);
        assert_eq!([lines[0].frequency, lines[1].frequency], [50.0, 300.0]);
    }
}
