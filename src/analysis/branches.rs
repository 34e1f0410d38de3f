//! Which vibration at one speed is which at the next: the one whose shape is most like it.
//!
//! ```text
//!   likeness of x and y    |x* y|^2,   |x| = |y| = 1
//! ```
//!
//! Where a vibration is two at once (x and y alike, nothing turning) the assignment is arbitrary.

use super::campbell::Point;
use super::vibration::Vibration;

/// A branch may change its frequency by this factor between neighbouring points.
const LARGEST_CHANGE: f64 = 1.6;

/// Finds the branches, from the point nearest to the file's speed outward.
pub(super) fn follow(points: &mut [Point], nominal: &[Vibration], speed: f64) {
    let distance = |point: &Point| (point.speed - speed).abs();
    let nearest = (0..points.len())
        .min_by(|&one, &two| distance(&points[one]).total_cmp(&distance(&points[two])))
        .unwrap_or(0);
    let own: Vec<Option<usize>> = (0..nominal.len()).map(Some).collect();
    points[nearest].branches = continued(nominal, &own, &points[nearest].vibrations);
    for index in nearest + 1..points.len() {
        let before = &points[index - 1];
        points[index].branches = continued(
            &before.vibrations,
            &before.branches,
            &points[index].vibrations,
        );
    }
    for index in (0..nearest).rev() {
        let before = &points[index + 1];
        points[index].branches = continued(
            &before.vibrations,
            &before.branches,
            &points[index].vibrations,
        );
    }
}

/// Branches of `next`: each vibration takes that of the one in `before` whose shape is most like its own, the
/// most alike first.
fn continued(
    before: &[Vibration],
    branches: &[Option<usize>],
    next: &[Vibration],
) -> Vec<Option<usize>> {
    let mut pairs = Vec::new();
    for (i, old) in before.iter().enumerate() {
        for (j, new) in next.iter().enumerate() {
            let change = new.natural.frequency / old.natural.frequency;
            if (1.0 / LARGEST_CHANGE..LARGEST_CHANGE).contains(&change) {
                pairs.push((old.likeness(new), i, j));
            }
        }
    }
    pairs.sort_by(|one, two| two.0.total_cmp(&one.0));
    let mut found = vec![None; next.len()];
    let mut used = vec![false; before.len()];
    let mut taken = vec![false; next.len()];
    for (_, i, j) in pairs {
        if !used[i] && !taken[j] {
            (used[i], taken[j]) = (true, true);
            found[j] = branches[i];
        }
    }
    found
}
