//! How stiff a mesh is while the teeth pass: k over the mesh phase.
//!
//! The phase counts tooth pitches; every law has period 1. A law is smooth between its **breakpoints**
//! and is evaluated piece by piece, so that a time step may end exactly on a breakpoint and see either
//! side of it. With contact ratio eps, x = frac(phase) + j runs over the pairs j engaged, 0 <= x <= eps:
//!
//! ```text
//!   constant      k = mean
//!   rectangular   floor(eps) + 1 pairs for frac(phase) < frac(eps), else floor(eps)
//!   tooth_pair    k = sum over the pairs of pair (1 - quadratic xi^2 - quartic xi^4) r(u)
//!                 xi = 2 x / eps - 1,  u = clamp(min(x, eps - x) / ramp, 0, 1),  r = u^3 (10 - 15 u + 6 u^2)
//!   fourier       k = mean (1 + sum over i of c_i cos(2 pi i phase) + s_i sin(2 pi i phase))
//!   tooth_geometry  k = sum over the pairs of k(x), from the shape of the teeth (`tooth_geometry/`)
//!   table         linear between points, periodic; at a jump the value after it holds
//! ```
//!
//! Knows no gears and no time.

use super::fourier::FourierSeries;
use super::table::Table;
use super::tooth_geometry::{PairStiffness, SpurPair};
use super::tooth_pair::{PairCurve, ToothPair};

/// k over the phase.
#[derive(Debug, Clone, PartialEq)]
pub struct StiffnessLaw {
    shape: Shape,
    /// Where the smooth pieces start, ascending in [0, 1), the first at 0.
    starts: Vec<f64>,
    mean: f64,
}

#[derive(Debug, Clone, PartialEq)]
enum Shape {
    Constant {
        value: f64,
    },
    Rectangular {
        fewer_pairs: f64,
        more_pairs: f64,
        split: f64,
    },
    ToothPair(PairCurve),
    ToothGeometry(PairStiffness),
    Fourier {
        mean: f64,
        series: FourierSeries,
    },
    Table(Table),
}

impl StiffnessLaw {
    /// The same stiffness [N/m] at every phase.
    pub fn constant(value: f64) -> StiffnessLaw {
        StiffnessLaw {
            shape: Shape::Constant { value },
            starts: vec![0.0],
            mean: value,
        }
    }

    /// Steps between floor(eps) and floor(eps) + 1 pairs, with the stiffness [N/m] of either.
    pub fn rectangular(fewer_pairs: f64, more_pairs: f64, contact_ratio: f64) -> StiffnessLaw {
        let split = fraction(contact_ratio);
        StiffnessLaw {
            shape: Shape::Rectangular {
                fewer_pairs,
                more_pairs,
                split,
            },
            starts: ascending([split]),
            mean: fewer_pairs + (more_pairs - fewer_pairs) * split,
        }
    }

    /// The sum over the engaged tooth pairs.
    pub fn tooth_pair(law: ToothPair) -> StiffnessLaw {
        let (eps, ramp) = (law.contact_ratio, law.ramp.min(0.5 * law.contact_ratio));
        let curve = PairCurve::of(law);
        StiffnessLaw {
            shape: Shape::ToothPair(curve),
            starts: ascending([fraction(eps), fraction(ramp), fraction(eps - ramp)]),
            mean: curve.mean(),
        }
    }

    /// The sum over the engaged pairs of what follows from the shape of the teeth. The pair must be able to mesh, with
    /// a contact ratio of at least 1.
    pub fn tooth_geometry(pair: &SpurPair) -> StiffnessLaw {
        let stiffness = PairStiffness::of(pair);
        StiffnessLaw {
            starts: ascending([fraction(stiffness.contact_ratio())]),
            mean: stiffness.integral(),
            shape: Shape::ToothGeometry(stiffness),
        }
    }

    /// The gears that the law was made from, where it was made from tooth geometry.
    pub fn spur_pair(&self) -> Option<&SpurPair> {
        match &self.shape {
            Shape::ToothGeometry(stiffness) => Some(stiffness.pair()),
            _ => None,
        }
    }

    /// Harmonics of the tooth pitch, relative to the mean [N/m]: cosines and sines of the orders 1, 2, ...
    pub fn fourier(mean: f64, cosine: &[f64], sine: &[f64]) -> StiffnessLaw {
        StiffnessLaw {
            shape: Shape::Fourier {
                mean,
                series: FourierSeries::new(cosine, sine),
            },
            starts: vec![0.0],
            mean,
        }
    }

    /// Linear between points (phase, k [N/m]), at least one. Phases ascend in [0, 1); one that appears twice is a
    /// jump from the first value to the second.
    pub fn table(points: &[(f64, f64)]) -> StiffnessLaw {
        let table = Table::new(points);
        StiffnessLaw {
            starts: table.starts(),
            mean: table.mean(),
            shape: Shape::Table(table),
        }
    }

    /// A value [N/m] that k never falls below; closely below the minimum (1e-4 of all amplitudes).
    pub fn lower_bound_of_fourier(mean: f64, cosine: &[f64], sine: &[f64]) -> f64 {
        mean * (1.0 + FourierSeries::new(cosine, sine).lower_bound())
    }

    /// Mean over the period [N/m].
    pub fn mean(&self) -> f64 {
        self.mean
    }

    /// Where the smooth pieces start, ascending in [0, 1), the first at 0.
    pub fn starts(&self) -> &[f64] {
        &self.starts
    }

    /// Whether the law is smooth at every phase: no step needs to end at its start.
    pub fn is_smooth(&self) -> bool {
        matches!(self.shape, Shape::Constant { .. } | Shape::Fourier { .. })
    }

    /// How far beyond its ends [pitches] a piece may be continued: infinity for a smooth law, 0 where pieces meet in a
    /// kink or a jump.
    ///
    /// Ramps of tooth pairs join with two continuous derivatives. Continued by d, k is off by 10 (d/ramp)^3 of a pair, and its
    /// mean over a pitch by 10/4 (d/ramp)^3 d, which is to be 1 % of the tolerance.
    pub fn slack(&self, tolerance: f64) -> f64 {
        match self.shape {
            _ if self.is_smooth() => f64::INFINITY,
            Shape::ToothPair(PairCurve { law, .. })
                if law.ramp > 0.0 && 2.0 * law.ramp <= law.contact_ratio =>
            {
                law.ramp * (4e-3 * tolerance / law.ramp).sqrt().sqrt()
            }
            _ => 0.0,
        }
    }

    /// The piece that a phase in [0, 1) lies in; at a breakpoint the one that begins there.
    pub fn piece(&self, cycle: f64) -> usize {
        self.starts
            .iter()
            .rposition(|&start| start <= cycle)
            .unwrap_or(0)
    }

    /// k [N/m] at a phase in its cycle, continued smoothly from the given piece.
    pub fn value(&self, cycle: f64, piece: usize) -> f64 {
        match self.shape {
            Shape::Constant { value } => value,
            Shape::Fourier { mean, ref series } => mean * (1.0 + series.value(cycle)),
            Shape::Table(ref table) => table.value(cycle, piece),
            Shape::Rectangular {
                fewer_pairs,
                more_pairs,
                split,
            } => {
                if self.middle(piece) < split {
                    more_pairs
                } else {
                    fewer_pairs
                }
            }
            Shape::ToothPair(ref curve) => self
                .engaged(curve.law.contact_ratio, cycle, piece)
                .map(|x| curve.one_pair(x))
                .sum(),
            Shape::ToothGeometry(ref law) => self
                .engaged(law.contact_ratio(), cycle, piece)
                .map(|x| law.value(x))
                .sum(),
        }
    }

    /// dk/dphase [N/m per pitch] at a phase in its cycle, continued smoothly from the given piece.
    pub fn slope(&self, cycle: f64, piece: usize) -> f64 {
        match self.shape {
            Shape::Constant { .. } | Shape::Rectangular { .. } => 0.0,
            Shape::Fourier { mean, ref series } => mean * series.slope(cycle),
            Shape::Table(ref table) => table.slope(piece),
            Shape::ToothPair(ref curve) => self
                .engaged(curve.law.contact_ratio, cycle, piece)
                .map(|x| curve.one_pair_slope(x))
                .sum(),
            Shape::ToothGeometry(ref law) => self
                .engaged(law.contact_ratio(), cycle, piece)
                .map(|x| law.slope(x))
                .sum(),
        }
    }

    /// Where in their contact [pitches] the pairs are that a piece engages.
    fn engaged(&self, contact_ratio: f64, cycle: f64, piece: usize) -> impl Iterator<Item = f64> {
        // The number of pairs is that of the piece: rounding at its ends cannot change it.
        let pairs = (contact_ratio - self.middle(piece) + 1.0).max(0.0);
        (0..pairs as usize).map(move |j| cycle + j as f64)
    }

    fn middle(&self, piece: usize) -> f64 {
        let end = self.starts.get(piece + 1).copied().unwrap_or(1.0);
        0.5 * (self.starts[piece] + end)
    }
}

fn fraction(value: f64) -> f64 {
    value - value.floor()
}

/// Breakpoints ascending without repetition, 0 first.
fn ascending<const N: usize>(points: [f64; N]) -> Vec<f64> {
    let mut starts = vec![0.0];
    starts.extend(points);
    starts.sort_by(f64::total_cmp);
    // Neighbours closer than a millionth of a pitch come from rounding (1.6 - 0.1 and 0.5 + 1).
    starts.dedup_by(|next, kept| *next - *kept < 1e-6);
    if starts.len() > 1 && starts.last().is_some_and(|last| *last > 1.0 - 1e-6) {
        starts.pop();
    }
    starts
}

#[cfg(test)]
mod tests {
    use super::*;

    fn example() -> ToothPair {
        ToothPair {
            pair: 5e8,
            quadratic: 0.4,
            quartic: 0.1,
            ramp: 0.1,
            contact_ratio: 1.6,
        }
    }

    /// 3e8 falls to 2e8 at 0.25, jumps to 4e8 there, stays until 0.75 and is back at 3e8 at 1.25.
    const JUMPS: [(f64, f64); 3] = [(0.25, 2e8), (0.25, 4e8), (0.75, 4e8)];

    fn laws() -> Vec<StiffnessLaw> {
        let mut laws = vec![
            StiffnessLaw::constant(3e8),
            StiffnessLaw::rectangular(2e8, 5e8, 1.3),
            StiffnessLaw::fourier(3e8, &[0.2, 0.0, -0.1], &[0.05, 0.3]),
            StiffnessLaw::table(&[(0.3, 2e8)]),
            StiffnessLaw::table(&JUMPS),
            StiffnessLaw::table(&[(0.0, 2e8), (0.0, 3e8), (0.5, 4e8)]),
        ];
        for (contact_ratio, ramp) in [
            (1.6, 0.1),
            (1.6, 0.0),
            (2.0, 0.2),
            (2.35, 0.3),
            (1.0, 0.7),
            (1.2, 0.6),
        ] {
            laws.push(StiffnessLaw::tooth_pair(ToothPair {
                contact_ratio,
                ramp,
                ..example()
            }));
        }
        laws
    }

    fn at(law: &StiffnessLaw, cycle: f64) -> f64 {
        law.value(cycle, law.piece(cycle))
    }

    #[test]
    fn the_example_breaks_at_the_ends_of_its_ramps() {
        let law = StiffnessLaw::tooth_pair(example());
        let expected = [0.0, 0.1, 0.5, 0.6];
        assert_eq!(law.starts().len(), expected.len());
        for (start, expected) in law.starts().iter().zip(expected) {
            assert!((start - expected).abs() < 1e-12);
        }
    }

    #[test]
    fn the_mean_is_the_mean_of_the_values() {
        for law in laws() {
            let samples = 200_000;
            let sum: f64 = (0..samples)
                .map(|i| at(&law, (f64::from(i) + 0.5) / f64::from(samples)))
                .sum();
            // 1e-5: midpoint rule with jumps at 5e-6 of a period.
            assert!(
                (sum / f64::from(samples) / law.mean() - 1.0).abs() < 1e-5,
                "{law:?}"
            );
        }
    }

    #[test]
    fn the_slope_is_the_derivative_of_the_value_inside_every_piece() {
        for law in laws() {
            for (piece, &start) in law.starts().iter().enumerate() {
                let end = law.starts().get(piece + 1).copied().unwrap_or(1.0);
                let h = 1e-5 * (end - start);
                for i in 1..20 {
                    let here = start + (end - start) * f64::from(i) / 20.0;
                    let difference =
                        (law.value(here + h, piece) - law.value(here - h, piece)) / (2.0 * h);
                    let error = (law.slope(here, piece) - difference).abs();
                    // Third derivatives times h^2, and rounding of k in 2 h: 1e-5.
                    let bound = 1e-5 * law.mean() / (end - start);
                    assert!(error < bound, "{law:?} at {here}: {error}");
                }
            }
        }
    }

    #[test]
    fn pieces_are_smooth_and_cover_every_jump() {
        for law in laws() {
            for (piece, &start) in law.starts().iter().enumerate() {
                let end = law.starts().get(piece + 1).copied().unwrap_or(1.0);
                let step = (end - start) / 1000.0;
                for i in 0..1000 {
                    let here = start + step * f64::from(i);
                    let change = law.value(here + step, piece) - law.value(here, piece);
                    // No jump inside a piece: the steepest slope is 15/8 of a pair per ramp.
                    assert!(change.abs() <= 5e8 * 4.0 * step / 0.1, "{law:?} at {here}");
                }
            }
        }
    }

    #[test]
    fn tooth_pair_is_the_sum_over_engaged_pairs() {
        let law = StiffnessLaw::tooth_pair(example());
        // Phase 0.3: pairs at x = 0.3 and 1.3, xi = -0.625 and 0.625, no ramp.
        let one = 5e8 * (1.0 - 0.4 * 0.625_f64 * 0.625 - 0.1 * 0.625 * 0.625 * 0.625 * 0.625);
        assert!((at(&law, 0.3) / (2.0 * one) - 1.0).abs() < 1e-12);
        // Phase 0.8: a single pair at mid contact.
        assert!((at(&law, 0.8) / 5e8 - 1.0).abs() < 1e-12);
    }

    #[test]
    fn fourier_is_its_mean_and_harmonics_without_breakpoints() {
        let law = StiffnessLaw::fourier(3e8, &[0.2], &[0.1, 0.05]);
        assert!(law.is_smooth() && law.mean() == 3e8);
        // Cosine 1, 0, -1, 0 and sine 0, 1, 0, -1 at the quarters; the second sine vanishes at all of them.
        for (cycle, relative) in [(0.0, 1.2), (0.25, 1.1), (0.5, 0.8), (0.75, 0.9), (1.0, 1.2)] {
            assert!((law.value(cycle, 0) / (3e8 * relative) - 1.0).abs() < 1e-15);
        }
    }

    #[test]
    fn a_table_is_linear_between_its_points_and_jumps_where_two_coincide() {
        let law = StiffnessLaw::table(&JUMPS);
        assert_eq!(law.starts(), [0.0, 0.25, 0.75]);
        // From 4e8 at 0.75 to 2e8 at 1.25: 3e8 at the end of the period.
        for (cycle, value) in [
            (0.0, 3e8),
            (0.125, 2.5e8),
            (0.25, 4e8),
            (0.5, 4e8),
            (0.875, 3.5e8),
        ] {
            assert!((at(&law, cycle) / value - 1.0).abs() < 1e-15, "at {cycle}");
        }
        // Both sides of the jump, and both sides of the end of the period.
        assert!((law.value(0.25, 0) / 2e8 - 1.0).abs() < 1e-15);
        assert!((law.value(1.0, 2) / 3e8 - 1.0).abs() < 1e-15);
        assert!((law.mean() / (0.5 * 4e8 + 0.5 * 3e8) - 1.0).abs() < 1e-15);
    }

    #[test]
    fn a_table_may_jump_where_the_period_ends() {
        // A saw tooth: up from 3e8 at 0 to 5e8 at 1, where it falls.
        let law = StiffnessLaw::table(&[(0.0, 5e8), (0.0, 3e8)]);
        assert_eq!(law.starts(), [0.0]);
        assert!(!law.is_smooth());
        for (cycle, value) in [(0.0, 3e8), (0.5, 4e8), (1.0, 5e8)] {
            assert!((law.value(cycle, 0) / value - 1.0).abs() < 1e-15);
        }
    }
}
