//! Pieces, means and slopes of the laws.

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

#[test]
fn a_piece_continued_within_the_slack_changes_the_mean_by_a_hundredth_of_the_tolerance() {
    for (contact_ratio, ramp) in [(1.6, 0.1), (2.35, 0.3)] {
        let law = StiffnessLaw::tooth_pair(ToothPair {
            contact_ratio,
            ramp,
            ..example()
        });
        for tolerance in [1e-2, 1e-4, 1e-8] {
            let (slack, pieces) = (law.slack(tolerance), law.starts().len());
            for piece in 0..pieces {
                let end = law.starts().get(piece + 1).copied().unwrap_or(1.0);
                let (next, wrap) = (
                    (piece + 1) % pieces,
                    if piece + 1 == pieces { 1.0 } else { 0.0 },
                );
                let off = |i: i32| {
                    let cycle = end + slack * f64::from(i) / 1000.0;
                    (law.value(cycle, piece) - law.value(cycle - wrap, next)).abs()
                };
                let mean = slack * (1..=1000).map(off).sum::<f64>() / 1000.0;
                // 1.1: the higher powers of the ramp; 1e-16 of a stiffness and a length of 1: rounding.
                let bound = 1.1 * 1e-2 * tolerance * 5e8 + 1e-16 * 5e8;
                assert!(mean <= bound, "{tolerance}, piece {piece}: {mean}, {bound}");
            }
        }
        assert_eq!(StiffnessLaw::rectangular(2e8, 5e8, 1.3).slack(1e-2), 0.0);
        assert_eq!(StiffnessLaw::constant(3e8).slack(1e-8), f64::INFINITY);
    }
}
