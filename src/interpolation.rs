//! A smooth curve through given points that rises and falls only where the points do.
//!
//! ```text
//!   between x_k and x_k+1, h = x_k+1 - x_k, D_k = (y_k+1 - y_k) / h, t = (x - x_k) / h:
//!   y = y_k + h t (d_k + t ((3 D_k - 2 d_k - d_k+1) + t (d_k + d_k+1 - 2 D_k)))          cubic Hermite
//!   inside    d_k = 0 where D_k-1 D_k <= 0, else (w1 + w2) / (w1 / D_k-1 + w2 / D_k),
//!             w1 = 2 h_k + h_k-1,  w2 = h_k + 2 h_k-1
//!   at an end d_0 = ((2 h_0 + h_1) D_0 - h_0 D_1) / (h_0 + h_1), no further than the curve stays monotone
//! ```
//!
//! Fritsch, Carlson, SIAM J. Numer. Anal. 17 (1980): a cubic is monotone when 0 <= d <= 3 D at both ends. The
//! slopes are those of Fritsch, Butland, SIAM J. Sci. Stat. Comput. 5 (1984), widely known as PCHIP. The curve
//! has a continuous first derivative, is exact at the points, and keeps its end values outside them.

/// The curve.
#[derive(Debug, Clone, PartialEq)]
pub struct MonotoneCubic {
    knots: Vec<Knot>,
}

#[derive(Debug, Clone, Copy, PartialEq)]
struct Knot {
    x: f64,
    y: f64,
    /// d.
    slope: f64,
}

impl MonotoneCubic {
    /// Through the points `(x, y)`: at least one, strictly ascending in x.
    pub fn through(points: &[(f64, f64)]) -> MonotoneCubic {
        let knot = |(index, &(x, y))| Knot {
            x,
            y,
            slope: slope(points, index),
        };
        MonotoneCubic {
            knots: points.iter().enumerate().map(knot).collect(),
        }
    }

    /// y at `x`.
    pub fn value(&self, x: f64) -> f64 {
        let next = self.knots.partition_point(|knot| knot.x <= x);
        match (next.checked_sub(1), self.knots.get(next)) {
            (Some(left), Some(right)) => between(&self.knots[left], right, x),
            (None, Some(first)) => first.y,
            (Some(last), None) => self.knots[last].y,
            (None, None) => f64::NAN,
        }
    }

    /// dy/dx at `x`; at a point that of the curve to its right.
    pub fn slope(&self, x: f64) -> f64 {
        let next = self.knots.partition_point(|knot| knot.x <= x);
        match (next.checked_sub(1), self.knots.get(next)) {
            (Some(left), Some(right)) => slope_between(&self.knots[left], right, x),
            _ => 0.0,
        }
    }
}

fn slope_between(left: &Knot, right: &Knot, x: f64) -> f64 {
    let (h, d0, d1) = (right.x - left.x, left.slope, right.slope);
    let (secant, t) = ((right.y - left.y) / h, (x - left.x) / h);
    let (c2, c3) = (3.0 * secant - 2.0 * d0 - d1, d0 + d1 - 2.0 * secant);
    d0 + t * (2.0 * c2 + 3.0 * t * c3)
}

fn between(left: &Knot, right: &Knot, x: f64) -> f64 {
    let (h, d0, d1) = (right.x - left.x, left.slope, right.slope);
    let (secant, t) = ((right.y - left.y) / h, (x - left.x) / h);
    let (c2, c3) = (3.0 * secant - 2.0 * d0 - d1, d0 + d1 - 2.0 * secant);
    left.y + h * t * (d0 + t * (c2 + t * c3))
}

/// d at one of the points.
fn slope(points: &[(f64, f64)], index: usize) -> f64 {
    let secant = |k: usize| {
        let ((x0, y0), (x1, y1)) = (points[k], points[k + 1]);
        (x1 - x0, (y1 - y0) / (x1 - x0))
    };
    let last = points.len() - 1;
    match index {
        _ if last == 0 => 0.0,
        _ if last == 1 => secant(0).1,
        0 => end_slope(secant(0), secant(1)),
        _ if index == last => end_slope(secant(last - 1), secant(last - 2)),
        _ => inner_slope(secant(index - 1), secant(index)),
    }
}

/// The weighted harmonic mean of both secants, each as (h, D).
fn inner_slope((h0, before): (f64, f64), (h1, after): (f64, f64)) -> f64 {
    if !same_direction(before, after) {
        return 0.0;
    }
    let (w1, w2) = (2.0 * h1 + h0, h1 + 2.0 * h0);
    (w1 + w2) / (w1 / before + w2 / after)
}

/// The slope of the parabola through the last three points, limited to what keeps the curve monotone.
fn end_slope((h0, own): (f64, f64), (h1, next): (f64, f64)) -> f64 {
    let parabola = ((2.0 * h0 + h1) * own - h0 * next) / (h0 + h1);
    if !same_direction(parabola, own) {
        0.0
    } else if !same_direction(own, next) && parabola.abs() > 3.0 * own.abs() {
        3.0 * own
    } else {
        parabola
    }
}

fn same_direction(one: f64, other: f64) -> bool {
    (one > 0.0 && other > 0.0) || (one < 0.0 && other < 0.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_slope_is_the_derivative_of_the_value() {
        let (curve, h) = (MonotoneCubic::through(&POINTS), 1e-5);
        for i in 0..60 {
            let x = 0.05 + 0.1 * f64::from(i);
            let difference = (curve.value(x + h) - curve.value(x - h)) / (2.0 * h);
            // Third derivatives times h^2, and rounding: 1e-8.
            assert!((curve.slope(x) - difference).abs() < 1e-7, "at {x}");
        }
    }

    /// Rises, stays, rises steeply, falls: unequal distances.
    const POINTS: [(f64, f64); 7] = [
        (0.0, 1.0),
        (1.0, 1.5),
        (3.0, 4.0),
        (4.0, 4.0),
        (4.5, 30.0),
        (9.0, 31.0),
        (10.0, -2.0),
    ];

    #[test]
    fn the_curve_passes_exactly_through_its_points_and_holds_its_ends() {
        let curve = MonotoneCubic::through(&POINTS);
        for (x, y) in POINTS {
            assert_eq!(curve.value(x), y);
        }
        assert_eq!([curve.value(-5.0), curve.value(50.0)], [1.0, -2.0]);
    }

    #[test]
    fn between_two_points_the_curve_stays_between_their_values_and_turns_nowhere() {
        let curve = MonotoneCubic::through(&POINTS);
        for pair in POINTS.windows(2) {
            let ((x0, y0), (x1, y1)) = (pair[0], pair[1]);
            let values: Vec<f64> = (0..=1000)
                .map(|i| curve.value(x0 + (x1 - x0) * f64::from(i) / 1000.0))
                .collect();
            for step in values.windows(2) {
                // 1e-13: rounding of values up to 31.
                assert!(
                    (step[1] - step[0]) * (y1 - y0).signum() >= -1e-13,
                    "{pair:?}"
                );
            }
        }
    }

    #[test]
    fn the_slope_is_continuous() {
        let curve = MonotoneCubic::through(&POINTS);
        let h = 1e-6;
        for (x, _) in &POINTS[1..6] {
            let (left, right) = (
                (curve.value(*x) - curve.value(x - h)) / h,
                (curve.value(x + h) - curve.value(*x)) / h,
            );
            // Second derivatives reach 300: differences over 1e-6 are off by 3e-4.
            assert!((left - right).abs() < 1e-3, "x = {x}: {left} and {right}");
        }
    }

    #[test]
    fn straight_lines_are_reproduced_and_two_points_make_one() {
        let line = |x: f64| 2.0 - 3.0 * x;
        for xs in [&[0.0, 5.0][..], &[0.0, 1.0, 1.5, 5.0][..]] {
            let points: Vec<(f64, f64)> = xs.iter().map(|&x| (x, line(x))).collect();
            let curve = MonotoneCubic::through(&points);
            for x in [0.3, 1.2, 4.9] {
                assert!((curve.value(x) - line(x)).abs() < 1e-14, "rounding");
            }
        }
        assert_eq!(MonotoneCubic::through(&[(1.0, 7.0)]).value(3.0), 7.0);
    }

    #[test]
    fn slopes_are_the_published_weighted_harmonic_mean() {
        // Points (0,0), (1,1), (3,9): D = 1, 4, w1 = 2 x 2 + 1 = 5, w2 = 2 + 2 x 1 = 4: d = 9 / (5/1 + 4/4) = 1.5;
        // ends: ((2+2) 1 - 4) / 3 = 0 and ((4+1) 4 - 2) / 3 = 6.
        let curve = MonotoneCubic::through(&[(0.0, 0.0), (1.0, 1.0), (3.0, 9.0)]);
        let slopes: Vec<f64> = curve.knots.iter().map(|knot| knot.slope).collect();
        assert_eq!(slopes, [0.0, 1.5, 6.0]);
    }
}
