//! Sizes of series of forces.

/// Root mean square.
pub fn rms(series: &[f64]) -> f64 {
    let squares = series.iter().map(|value| value * value);
    (squares.sum::<f64>() / series.len() as f64).sqrt()
}

/// RMS of what is left without the mean.
pub fn alternating(series: &[f64]) -> f64 {
    let mean = series.iter().sum::<f64>() / series.len() as f64;
    rms(&series
        .iter()
        .map(|value| value - mean)
        .collect::<Vec<f64>>())
}

/// RMS of the difference of two series of the same length.
pub fn difference(one: &[f64], other: &[f64]) -> f64 {
    let differences = one.iter().zip(other).map(|(a, b)| a - b);
    rms(&differences.collect::<Vec<f64>>())
}

/// The largest of some errors; NaN, which is no small error, where there is one.
pub fn worst(errors: impl Iterator<Item = f64>) -> f64 {
    errors.fold(0.0, |worst, error| {
        if error > worst || error.is_nan() {
            error
        } else {
            worst
        }
    })
}
