//! How long a step of the two Newmark solutions may be.
//!
//! Newmark's rule slows a motion of frequency w down: its phase is off by w h^2 w^2 / 12 per time,
//! p = C h^2 w^2 / 12 in all, where C = w t grows until damping has made the motion forget, at 1 / (2 zeta).
//! The extrapolation leaves p^2/8 of its amplitude. Each monitored displacement d therefore keeps, with a
//! safety factor of 4,
//!
//! ```text
//!   4 C^2 h^4 / 1152 |d''''|_recent <= tolerance x RMS of d over the run so far
//!   d'''' = (d''_start - 2 d''_middle + d''_end) / (h/2)^2                    of the fine solution
//!   w^2   = |d''''|_recent / |d''|_recent,   10 <= C <= 1 / (2 zeta)
//! ```
//!
//! and that (1 + w c/k) times where a damper c beside the spring k belongs to the force. One frequency w stands
//! for all that d contains: the bound is an estimate, and a train without any damping that rings for long can
//! exceed it. `tests/integration_in_time.rs` holds the result against converged solutions. Source of the
//! period elongation: Hughes, The Finite Element Method (1987), 9.1.

use super::super::{Control, Monitor, State, System};
use super::kernel::Work;

/// How much of a peak of d'''' is remembered per step, so that its zero crossings do not lengthen steps.
const PEAK_MEMORY: f64 = 0.95;
/// Ratio of the bound to the estimate of the error.
const SAFETY: f64 = 4.0;
/// Monitored displacements [m or rad] below this count as zero.
const DISPLACEMENT_FLOOR: f64 = 1e-12;

/// Adds `weight` times the second derivative of every monitored displacement.
pub(super) fn differentiate(
    system: &System,
    differences: &mut [f64],
    acceleration: &[f64],
    weight: f64,
) {
    for (Monitor { row, .. }, difference) in system.monitors.iter().zip(differences) {
        *difference += weight * row.dot(acceleration);
    }
}

/// Keeps the squares and peaks of the monitored displacements with the step just computed, and gives the
/// largest error relative to the RMS.
pub(super) fn control_error(
    system: &System,
    state: &State,
    work: &Work,
    differences: &[f64],
    h: f64,
    next: &mut Control,
) -> f64 {
    let control = &state.control;
    next.elapsed = control.elapsed + h;
    let mut worst: f64 = 0.0;
    for (
        index,
        Monitor {
            row,
            damping_ratio,
            rate_weight,
            ..
        },
    ) in system.monitors.iter().enumerate()
    {
        let value = row.dot(&state.tracks[1].position);
        next.squares[index] = control.squares[index] + h * value * value;
        let now = [
            row.dot(work.acceleration()).abs(),
            differences[index].abs() / (0.25 * h * h),
        ];
        let [second, fourth] = [0, 1].map(|order| {
            let held = PEAK_MEMORY * control.peaks[index][order];
            // f64::max would drop a NaN.
            if now[order] <= held { held } else { now[order] }
        });
        next.peaks[index] = [second, fourth];
        let frequency = (fourth / second.max(f64::MIN_POSITIVE)).sqrt();
        let turns = frequency * next.elapsed;
        let amplification = turns.clamp(10.0, (0.5 / damping_ratio).max(10.0));
        let scale = (next.squares[index] / next.elapsed)
            .sqrt()
            .max(DISPLACEMENT_FLOOR);
        let phase = amplification * h * h;
        let with_rate = 1.0 + rate_weight * frequency;
        let relative = SAFETY * phase * phase / 1152.0 * fourth * with_rate / scale;
        if !relative.is_finite() {
            return f64::NAN;
        }
        worst = worst.max(relative);
    }
    worst
}
