//! Wall times on a machine that others use too: the best of several, taken in turn.

use std::time::{Duration, Instant};

/// All are measured once, then all again, and so on: who disturbs the machine for some minutes disturbs none of them alone, and
/// leaves some rounds alone.
const ROUNDS: usize = 5;
/// Repetitions in a round for which there is time.
const MOST_REPEATS: u32 = 1000;
const ENOUGH: Duration = Duration::from_millis(300);

/// Something whose wall time is measured [s].
pub type Measure<'a> = Box<dyn FnMut() -> f64 + 'a>;

/// What came out of all rounds.
#[derive(Debug, Clone)]
pub struct Times {
    /// The smallest time of each [s].
    pub best: Vec<f64>,
    /// How quiet the machine was, in words.
    pub quiet: String,
}

/// Measures all in rounds.
pub fn in_rounds(measures: &mut [Measure<'_>]) -> Times {
    let mut times = vec![Vec::new(); measures.len()];
    for _ in 0..ROUNDS {
        for (measure, times) in measures.iter_mut().zip(&mut times) {
            times.push(best_of_round(measure));
        }
    }
    let smallest = |times: &Vec<f64>| times.iter().copied().fold(f64::INFINITY, f64::min);
    let largest = |times: &Vec<f64>| times.iter().copied().fold(0.0, f64::max);
    let spreads: Vec<f64> = times.iter().map(|of| largest(of) / smallest(of)).collect();
    Times {
        best: times.iter().map(smallest).collect(),
        quiet: format!(
            "The best of {ROUNDS} rounds. The slowest round of a measurement took {:.2} times its best one (median; at most {:.2}).",
            median(spreads.clone()),
            spreads.iter().copied().fold(1.0, f64::max)
        ),
    }
}

/// The smallest time [s] of some repetitions.
fn best_of_round(measure: &mut Measure<'_>) -> f64 {
    let (clock, first) = (Instant::now(), measure());
    let mut best = first;
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
