//! Where the motion ends the piece of a law inside a step.

use super::super::march::{Span, Task};
use super::super::{Forcing, Piece};
use super::kernel::Kernel;
use super::polynomials::{IN_TIME, PLACES};
use super::sight::{Sight, instant};

/// Accuracy of the time of an event, in parts of the way between two points.
const ROOT_ACCURACY: f64 = 1e-12;

impl Kernel {
    /// The law whose piece the motion ends first, and when. `landing` is one whose piece ends with the step anyway.
    pub(super) fn interruption<F: Forcing>(
        &mut self,
        task: Task<'_, F>,
        slow: &[f64],
        span: Span,
        pieces: &[Piece],
        landing: Option<usize>,
    ) -> Option<(usize, f64)> {
        let mut earliest: Option<(usize, f64)> = None;
        for (law, &piece) in pieces.iter().enumerate() {
            if Some(law) == landing {
                continue;
            }
            let mut previous = None;
            for point in IN_TIME {
                let at = instant(&self.sight.points[point], span.at(PLACES[point]), slow);
                let margin = task.forcing.margin(law, piece, at);
                if margin < 0.0 || margin.is_nan() {
                    let time = self.root(task, slow, span, (law, piece), (previous, point));
                    if earliest.is_none_or(|(_, other)| time < other) {
                        earliest = Some((law, time));
                    }
                    break;
                }
                previous = Some(point);
            }
        }
        earliest
    }

    /// When the margin of a law becomes negative between two points (the start of the step where there is no previous
    /// one), by bisection on cubic interpolants.
    fn root<F: Forcing>(
        &mut self,
        task: Task<'_, F>,
        slow: &[f64],
        span: Span,
        (law, piece): (usize, Piece),
        (previous, point): (Option<usize>, usize),
    ) -> f64 {
        let Sight {
            start,
            points,
            trial,
            ..
        } = &mut self.sight;
        let right = &points[point];
        let (left, from) = match previous {
            Some(previous) => (&points[previous], PLACES[previous]),
            None => (&*start, 0.0),
        };
        let width = (PLACES[point] - from) * span.step;
        let (mut low, mut high) = (0.0, 1.0);
        while high - low > ROOT_ACCURACY {
            let middle = 0.5 * (low + high);
            for coupling in 0..left[0].len() {
                let end = |seen: &[Vec<f64>; 2]| [seen[0][coupling], seen[1][coupling] * width];
                let (value, slope) = hermite(end(left), end(right), middle);
                (trial[0][coupling], trial[1][coupling]) = (value, slope / width);
            }
            let time = span.start + from * span.step + middle * width;
            if task.forcing.margin(law, piece, instant(trial, time, slow)) >= 0.0 {
                low = middle;
            } else {
                high = middle;
            }
        }
        span.start + from * span.step + high * width
    }
}

/// The cubic with these values and derivatives at 0 and 1: its value and derivative at s.
fn hermite([left, left_slope]: [f64; 2], [right, right_slope]: [f64; 2], s: f64) -> (f64, f64) {
    let difference = right - left;
    let quadratic = 3.0 * difference - 2.0 * left_slope - right_slope;
    let cubic = left_slope + right_slope - 2.0 * difference;
    (
        left + s * (left_slope + s * (quadratic + s * cubic)),
        left_slope + s * (2.0 * quadratic + 3.0 * s * cubic),
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_interpolant_reproduces_a_cubic() {
        let value = |s: f64| 2.0 - s + 0.5 * s * s + 3.0 * s * s * s;
        let slope = |s: f64| -1.0 + s + 9.0 * s * s;
        let ends = [0.0, 1.0].map(|s| [value(s), slope(s)]);
        let (found, found_slope) = hermite(ends[0], ends[1], 0.3);
        // 1e-14: rounding.
        assert!((found - value(0.3)).abs() < 1e-14 && (found_slope - slope(0.3)).abs() < 1e-14);
    }
}
