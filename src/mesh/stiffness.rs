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
//! ```
//!
//! Knows no gears and no time.

use super::gauss::integral;

/// k over the phase.
#[derive(Debug, Clone, PartialEq)]
pub struct StiffnessLaw {
    shape: Shape,
    /// Where the smooth pieces start, ascending in [0, 1), the first at 0.
    starts: Vec<f64>,
    mean: f64,
}

#[derive(Debug, Clone, Copy, PartialEq)]
enum Shape {
    Constant {
        value: f64,
    },
    Rectangular {
        fewer_pairs: f64,
        more_pairs: f64,
        split: f64,
    },
    ToothPair(ToothPair),
}

/// Parameters of the law `tooth_pair`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ToothPair {
    /// Stiffness of one pair at mid contact [N/m].
    pub pair: f64,
    /// Relative loss at the ends of contact, quadratic term.
    pub quadratic: f64,
    /// Relative loss at the ends of contact, quartic term.
    pub quartic: f64,
    /// Length over which a pair takes and leaves its load [pitches].
    pub ramp: f64,
    /// Mean number of tooth pairs in contact eps.
    pub contact_ratio: f64,
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
        StiffnessLaw {
            shape: Shape::ToothPair(law),
            starts: ascending([fraction(eps), fraction(ramp), fraction(eps - ramp)]),
            // The mean over a pitch of the sum over the pairs is the integral over one pair's contact.
            mean: [[0.0, ramp], [ramp, eps - ramp], [eps - ramp, eps]]
                .iter()
                // Five points are exact: one pair's stiffness is a polynomial of degree 9.
                .map(|&[from, to]| integral(|x| law.one_pair(x), from, to))
                .sum(),
        }
    }

    /// Mean over the period [N/m].
    pub fn mean(&self) -> f64 {
        self.mean
    }

    /// Where the smooth pieces start, ascending in [0, 1), the first at 0.
    pub fn starts(&self) -> &[f64] {
        &self.starts
    }

    /// Whether the law is the same at every phase.
    pub fn is_constant(&self) -> bool {
        matches!(self.shape, Shape::Constant { .. })
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
            Shape::ToothPair(law) => {
                // The number of pairs is that of the piece: rounding at its ends cannot change it.
                let pairs = (law.contact_ratio - self.middle(piece)).floor().max(-1.0) + 1.0;
                (0..pairs as usize)
                    .map(|j| law.one_pair(cycle + j as f64))
                    .sum()
            }
        }
    }

    fn middle(&self, piece: usize) -> f64 {
        let end = self.starts.get(piece + 1).copied().unwrap_or(1.0);
        0.5 * (self.starts[piece] + end)
    }
}

impl ToothPair {
    /// Stiffness of one pair [N/m] at distance x [pitches] after its first contact.
    fn one_pair(&self, x: f64) -> f64 {
        let eps = self.contact_ratio;
        let xi = 2.0 * x / eps - 1.0;
        let load_share = if self.ramp == 0.0 {
            1.0
        } else {
            let u = (x.min(eps - x) / self.ramp).clamp(0.0, 1.0);
            u * u * u * (10.0 - u * (15.0 - 6.0 * u))
        };
        self.pair * self.profile(xi * xi) * load_share
    }

    /// 1 - quadratic xi^2 - quartic xi^4 over xi^2.
    fn profile(&self, xi_squared: f64) -> f64 {
        1.0 - xi_squared * (self.quadratic + xi_squared * self.quartic)
    }

    /// The smallest value of the profile over the contact: must not be negative.
    pub fn weakest(&self) -> f64 {
        let vertex = (-0.5 * self.quadratic / self.quartic).clamp(0.0, 1.0);
        let inside = if vertex.is_finite() {
            self.profile(vertex)
        } else {
            1.0
        };
        self.profile(1.0).min(inside).min(1.0)
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

    fn laws() -> Vec<StiffnessLaw> {
        let mut laws = vec![
            StiffnessLaw::constant(3e8),
            StiffnessLaw::rectangular(2e8, 5e8, 1.3),
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
    fn weakest_point_of_a_pair_is_found_inside_and_at_the_ends() {
        assert!((example().weakest() - 0.5).abs() < 1e-15);
        let hollow = ToothPair {
            quadratic: 2.4,
            quartic: -1.2,
            ..example()
        };
        assert!((hollow.weakest() + 0.2).abs() < 1e-15);
    }
}
