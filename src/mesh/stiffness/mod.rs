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
use super::polynomial::Polynomial;
use super::table::Table;
use super::tooth_geometry::{PairStiffness, SpurPair};
use super::tooth_pair::ToothPair;

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
    /// The law, and each piece.
    ToothPair(ToothPair, Vec<PairSum>),
    ToothGeometry(PairStiffness),
    Fourier {
        mean: f64,
        series: FourierSeries,
    },
    Table(Table),
}

/// The sum over the pairs that a piece engages, over the distance from the middle of the piece.
#[derive(Debug, Clone, PartialEq)]
struct PairSum {
    middle: f64,
    sum: Polynomial,
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
        let starts = ascending([fraction(eps), fraction(ramp), fraction(eps - ramp)]);
        let (mut pieces, mut mean) = (Vec::new(), 0.0);
        for piece in 0..starts.len() {
            let (middle, end) = (middle(&starts, piece), end(&starts, piece));
            let pairs = (0..engaged(eps, middle)).map(|j| law.around(middle + j as f64));
            let sum = pairs.fold(Polynomial::constant(0.0), |sum, one| sum.plus(1.0, &one));
            mean += sum.integral(starts[piece] - middle, end - middle);
            pieces.push(PairSum { middle, sum });
        }
        StiffnessLaw {
            shape: Shape::ToothPair(law, pieces),
            starts,
            mean,
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

    /// How far beyond its ends [pitches] a piece may be continued: with the fourth root of the tolerance, infinity for a smooth
    /// law, 0 where pieces meet in a kink or a jump.
    ///
    /// Ramps of tooth pairs join with two continuous derivatives. Continued by d, k is off by 10 (d/ramp)^3 of a pair, and its
    /// mean over a pitch by 10/4 (d/ramp)^3 d, which is to be 1 % of the tolerance.
    pub fn slack(&self, tolerance: f64) -> f64 {
        match self.shape {
            _ if self.is_smooth() => f64::INFINITY,
            Shape::ToothPair(law, _) if law.ramp > 0.0 && 2.0 * law.ramp <= law.contact_ratio => {
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
        let [value] = self.values([cycle], piece);
        value
    }

    /// k [N/m] at some phases in their cycle, continued smoothly from the given piece.
    #[inline(always)]
    pub fn values<const N: usize>(&self, cycles: [f64; N], piece: usize) -> [f64; N] {
        match self.shape {
            Shape::Constant { value } => [value; N],
            Shape::Fourier { mean, ref series } => {
                series.values(cycles).map(|value| mean * (1.0 + value))
            }
            Shape::Table(ref table) => cycles.map(|cycle| table.value(cycle, piece)),
            Shape::Rectangular {
                fewer_pairs,
                more_pairs,
                split,
            } => {
                let more = middle(&self.starts, piece) < split;
                [if more { more_pairs } else { fewer_pairs }; N]
            }
            Shape::ToothPair(_, ref pieces) => {
                let PairSum { middle, sum } = &pieces[piece];
                sum.values(cycles.map(|cycle| cycle - middle))
            }
            Shape::ToothGeometry(ref law) => {
                let mut sums = [0.0; N];
                for pair in 0..engaged(law.contact_ratio(), middle(&self.starts, piece)) {
                    let one = law.values(cycles.map(|cycle| cycle + pair as f64));
                    for (sum, one) in sums.iter_mut().zip(one) {
                        *sum += one;
                    }
                }
                sums
            }
        }
    }

    /// dk/dphase [N/m per pitch] at a phase in its cycle, continued smoothly from the given piece.
    pub fn slope(&self, cycle: f64, piece: usize) -> f64 {
        match self.shape {
            Shape::Constant { .. } | Shape::Rectangular { .. } => 0.0,
            Shape::Fourier { mean, ref series } => mean * series.slope(cycle),
            Shape::Table(ref table) => table.slope(piece),
            Shape::ToothPair(_, ref pieces) => {
                let PairSum { middle, sum } = &pieces[piece];
                sum.slope(cycle - middle)
            }
            Shape::ToothGeometry(ref law) => {
                let pairs = 0..engaged(law.contact_ratio(), middle(&self.starts, piece));
                pairs.map(|pair| law.slope(cycle + pair as f64)).sum()
            }
        }
    }
}

/// The number of pairs that a piece engages: that in its middle, so that rounding at its ends cannot change it.
fn engaged(contact_ratio: f64, middle: f64) -> usize {
    (contact_ratio - middle + 1.0).max(0.0) as usize
}

/// Where a piece ends.
fn end(starts: &[f64], piece: usize) -> f64 {
    starts.get(piece + 1).copied().unwrap_or(1.0)
}

/// Where it has its middle.
fn middle(starts: &[f64], piece: usize) -> f64 {
    0.5 * (starts[piece] + end(starts, piece))
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
mod tests;
