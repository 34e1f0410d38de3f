//! A periodic quantity given at points, linear between them.
//!
//! ```text
//!   value   v_1'              a jump: two points at one phase; the first ends what comes before,
//!            \      v_3         the second holds from there on
//!             v_2 --+
//!                   v_3' ...  from the last point the line goes on to the first one of the next period
//!   phase   p_1  p_2  p_3     1 + p_1
//! ```

/// The table as straight lines.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Table {
    lines: Vec<Line>,
    mean: f64,
}

/// value = at_start + slope (phase - start)
#[derive(Debug, Clone, Copy, PartialEq)]
struct Line {
    start: f64,
    at_start: f64,
    slope: f64,
}

impl Table {
    /// At least one point (phase, value); phases ascending in [0, 1), each at most twice.
    pub(super) fn new(points: &[(f64, f64)]) -> Table {
        let (first, last) = (points[0], points[points.len() - 1]);
        let mut lines = Vec::new();
        let mut mean = 0.0;
        let next_period = std::iter::once((first.0 + 1.0, first.1));
        for (&(start, from), (end, to)) in points
            .iter()
            .zip(points[1..].iter().copied().chain(next_period))
        {
            if end > start {
                mean += 0.5 * (end - start) * (from + to);
                lines.push(Line {
                    start,
                    at_start: from,
                    slope: (to - from) / (end - start),
                });
            }
        }
        if first.0 > 0.0 {
            // The line that crosses the end of the period is also the first one of the next.
            let slope = (first.1 - last.1) / (first.0 + 1.0 - last.0);
            let at_start = first.1 - slope * first.0;
            lines.insert(
                0,
                Line {
                    start: 0.0,
                    at_start,
                    slope,
                },
            );
        }
        Table { lines, mean }
    }

    /// Where the lines start, ascending in [0, 1), the first at 0.
    pub(super) fn starts(&self) -> Vec<f64> {
        self.lines.iter().map(|line| line.start).collect()
    }

    pub(super) fn mean(&self) -> f64 {
        self.mean
    }

    /// The value at a phase in its period, continued along the given line.
    pub(super) fn value(&self, cycle: f64, line: usize) -> f64 {
        let line = self.lines[line];
        line.at_start + line.slope * (cycle - line.start)
    }

    /// Its change per period along the given line.
    pub(super) fn slope(&self, line: usize) -> f64 {
        self.lines[line].slope
    }
}
