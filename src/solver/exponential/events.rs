//! Where the motion ends the piece of a law inside a step.
//!
//! Where forces are small the step may be long, longer than vibrations of the blocks, which it integrates exactly; a contact
//! that such a vibration closes must not be missed. Between neighbouring points the couplings are interpolated by cubics.
//! What a cubic over two of these intervals says of the point between them tells how far that can be trusted: laws that are
//! clear of their ends by more than that go on, others ask for a step that shows them clearly.

use super::super::march::{Ending, Span, Task};
use super::super::{Forcing, Piece};
use super::kernel::Kernel;
use super::polynomials::{END, NODES, PLACES};
use super::sight::{Sight, instant};

/// Accuracy of the time of an event, in parts of the way between two places.
const ROOT_ACCURACY: f64 = 1e-12;
/// A margin within this part of its range over the step is zero where the step was to end with it: this part of the
/// tolerance, between these bounds.
const LANDED: f64 = 1e-3;
const LANDED_WITHIN: (f64, f64) = (1e-10, 1e-7);
/// Margins [m, pitches] cannot be told from zero below this: rounding of large rotation angles.
const SMALLEST_MARGIN: f64 = 1e-12;
/// Bounds of the part of the range of a margin that interpolation may miss: the root of the tolerance, because energies go
/// with squares of depths.
const CLEAR: (f64, f64) = (1e-5, 1e-2);
/// Margins that are larger than this part of their range at all nodes do not end between them: the dip of a parabola is a quarter.
const DEEPEST_DIP: f64 = 0.5;
/// Places between two nodes at which the interpolated motion is looked at.
const BETWEEN: usize = 6;

/// What a step shows of the pieces.
#[derive(Debug, Clone, Copy)]
pub(super) enum Sighting {
    /// All laws stay in their pieces, but for those that land.
    Clear,
    /// The motion ends the piece of a law.
    Ends { law: usize, time: f64 },
    /// The step is too long to say; the length it should have relative to this one.
    Unclear { ratio: f64 },
}

/// The margins of one law at the nodes of a step.
struct Margins([f64; NODES]);

impl Margins {
    fn least(&self) -> f64 {
        let points = self.0[1..].iter();
        // f64::min would drop a NaN.
        points.fold(
            f64::INFINITY,
            |least, &one| if one >= least { least } else { one },
        )
    }

    fn range(&self) -> f64 {
        let most = self.0.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        most - self.0.iter().copied().fold(f64::INFINITY, f64::min)
    }

    fn last(&self) -> f64 {
        self.0[END]
    }
}

impl Kernel {
    /// The law whose piece the motion ends first, and when. A law that was to land and has not is put under watch again.
    pub(super) fn sight_events<F: Forcing>(
        &mut self,
        task: Task<'_, F>,
        slow: &[f64],
        span: Span,
        pieces: &[Piece],
        endings: &mut [Ending],
    ) -> Sighting {
        let clear = task.tolerance.sqrt().clamp(CLEAR.0, CLEAR.1);
        let landed = (LANDED * task.tolerance).clamp(LANDED_WITHIN.0, LANDED_WITHIN.1);
        let mut earliest: Option<(usize, f64)> = None;
        for (law, (&piece, ending)) in pieces.iter().zip(endings).enumerate() {
            if *ending == Ending::Excused {
                continue;
            }
            let view = View {
                task,
                slow,
                span,
                law,
                piece,
            };
            let Some(margins) = view.margins(&self.sight) else {
                continue;
            };
            let missed = view.missed(&mut self.sight, &margins);
            let range = margins.range();
            let holds = margins.least() > missed
                && (margins.least() > DEEPEST_DIP * range
                    || view.end(&mut self.sight, -missed).is_none());
            if holds {
                *ending = Ending::Watched;
                continue;
            }
            let allowed = (clear * range).max(SMALLEST_MARGIN);
            if missed > allowed {
                // The error of cubics is of fourth order.
                let ratio = 0.8 * (allowed / missed).sqrt().sqrt();
                return Sighting::Unclear {
                    ratio: ratio.clamp(0.2, 0.8),
                };
            }
            let mut slack = 0.0;
            if *ending == Ending::Landing {
                slack = (landed * range).max(0.1 * SMALLEST_MARGIN);
                if margins.0[0] <= slack {
                    continue; // the piece was at its end from the start
                }
            }
            match view.end(&mut self.sight, slack) {
                Some(time) if earliest.is_none_or(|(_, other)| time < other) => {
                    earliest = Some((law, time));
                }
                Some(_) => {}
                None if margins.last() > slack => *ending = Ending::Watched,
                None => {}
            }
        }
        match earliest {
            Some((law, time)) => Sighting::Ends { law, time },
            None => Sighting::Clear,
        }
    }
}

/// One law in one step.
struct View<'a, F> {
    task: Task<'a, F>,
    slow: &'a [f64],
    span: Span,
    law: usize,
    piece: Piece,
}

impl<F: Forcing> View<'_, F> {
    fn margin(&self, seen: &[Vec<f64>; 2], part: f64) -> f64 {
        let at = instant(seen, self.span.at(part), self.slow);
        self.task.forcing.margin(self.law, self.piece, at)
    }

    /// `None` where only time ends the piece.
    fn margins(&self, sight: &Sight) -> Option<Margins> {
        let margin = |node: usize| self.margin(&sight.nodes[node], PLACES[node]);
        let first = margin(0);
        (first != f64::INFINITY).then(|| {
            Margins(core::array::from_fn(|node| {
                if node == 0 { first } else { margin(node) }
            }))
        })
    }

    /// The margin at a part of the step, interpolated between two places.
    fn interpolated(&self, sight: &mut Sight, between: [usize; 2], part: f64) -> f64 {
        let [from, to] = between.map(|node| PLACES[node]);
        let width = (to - from) * self.span.step;
        let s = (part - from) / (to - from);
        let mut trial = core::mem::take(&mut sight.trial);
        let [left, right] = between.map(|node| &sight.nodes[node]);
        for coupling in 0..left[0].len() {
            // Movements, because the slope is a difference over a width that may be tiny.
            let moved = between.map(|node| sight.moved(coupling, node));
            let end = |moved: f64, seen: &[Vec<f64>; 2]| [moved, seen[1][coupling] * width];
            let (value, slope) = hermite(end(moved[0], left), end(moved[1], right), s);
            trial[0][coupling] = sight.nodes[0][0][coupling] + value;
            trial[1][coupling] = slope / width;
        }
        let margin = self.margin(&trial, part);
        sight.trial = trial;
        margin
    }

    /// The largest error of interpolation over two neighbouring intervals.
    fn missed(&self, sight: &mut Sight, margins: &Margins) -> f64 {
        let mut missed = 0.0_f64;
        for (node, &place) in PLACES.iter().enumerate().take(END).skip(1) {
            let found = self.interpolated(sight, [node - 1, node + 1], place);
            missed = missed.max((found - margins.0[node]).abs());
        }
        missed
    }

    /// When the margin falls below -`slack`.
    fn end(&self, sight: &mut Sight, slack: f64) -> Option<f64> {
        for node in 0..END {
            let between = [node, node + 1];
            let [from, to] = between.map(|node| PLACES[node]);
            let place = |step: usize| from + (to - from) * step as f64 / BETWEEN as f64;
            for step in 1..=BETWEEN {
                let margin = self.interpolated(sight, between, place(step));
                // Written so that a NaN ends the piece.
                if margin < -slack || margin.is_nan() {
                    let root = self.root(sight, between, [place(step - 1), place(step)]);
                    return Some(self.span.at(root));
                }
            }
        }
        None
    }

    /// Where the margin becomes negative between two parts of the step, by bisection.
    fn root(&self, sight: &mut Sight, between: [usize; 2], [low, high]: [f64; 2]) -> f64 {
        let (mut low, mut high) = (low, high);
        let accuracy = ROOT_ACCURACY * (high - low);
        while high - low > accuracy {
            let middle = 0.5 * (low + high);
            if middle <= low || middle >= high {
                break;
            }
            if self.interpolated(sight, between, middle) >= 0.0 {
                low = middle;
            } else {
                high = middle;
            }
        }
        high
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
