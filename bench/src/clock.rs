//! Wall times on a machine that others use too: the best of several.

use std::time::{Duration, Instant};

/// Enough repetitions, and enough time for them.
const MOST_REPEATS: u32 = 1000;
const ENOUGH: Duration = Duration::from_millis(1500);

/// The smallest of the times [s] that `measure` gives, again and again for a while; the first one is known.
pub fn best(first: f64, mut measure: impl FnMut() -> f64) -> f64 {
    let (clock, mut best) = (Instant::now(), first);
    for _ in 0..MOST_REPEATS {
        if clock.elapsed() + Duration::from_secs_f64(first) > ENOUGH {
            break;
        }
        best = best.min(measure());
    }
    best
}

/// The middle one of measured values.
pub fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}
