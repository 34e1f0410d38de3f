//! The speeds at which an excitation meets a natural frequency.
//!
//! ```text
//!   g(Om) = Im lambda_k(Om) - c Om = 0            lambda_k: the k-th largest Im lambda
//! ```
//!
//! lambda_k is continuous in speed, also where branches cross, so that a change of the sign of g between neighbouring
//! points of the table brackets a critical speed. It is located by following the vibration from a point
//! with Newton's method in lambda and the secant method in Om. Where that leaves the bracket or finds a speed that was
//! found already (branches cross nearby), all eigenvalues are computed at each trial speed instead. What is not
//! found: two zeros of one g between neighbouring points.

use core::f64::consts::TAU;

use nalgebra::{Complex, DVector};

use super::campbell::{CriticalSpeed, Excitation, NoCampbell, Point};
use super::family::Family;
use super::vibration::{Vibration, vibration_of, vibrations};
use crate::linalg::{eigenvalues, quadratic_eigenpair};

/// Crossings below this frequency are those of rigid motions [Hz].
const LOWEST: f64 = 0.05;
/// Relative accuracy of a critical speed.
const ACCURACY: f64 = 1e-12;
/// Critical speeds of one excitation closer than this are looked at twice.
const CLOSE: f64 = 1e-7;

/// All critical speeds in the table, ascending.
pub(super) fn critical_speeds(
    family: &Family<'_>,
    points: &[Point],
    excitations: &[Excitation],
) -> Result<Vec<CriticalSpeed>, NoCampbell> {
    let mut found: Vec<CriticalSpeed> = Vec::new();
    for ends in points.windows(2) {
        let ranks = ends[0].vibrations.len().max(ends[1].vibrations.len());
        for (index, excitation) in excitations.iter().enumerate() {
            for rank in 0..ranks {
                let bracket = Bracket {
                    family,
                    order: excitation.order,
                    rank,
                    ends: [&ends[0], &ends[1]],
                };
                if !bracket.holds_a_zero() {
                    continue;
                }
                let known = |one: &CriticalSpeed| one.excitation == index;
                let followed = bracket.follow().filter(|(speed, vibration)| {
                    !found.iter().filter(|one| known(one)).any(|one| {
                        (one.speed - speed).abs() <= CLOSE * speed
                            && one.vibration.is_like(vibration)
                    })
                });
                let critical = match followed {
                    Some(critical) => Some(critical),
                    None => bracket.search()?,
                };
                if let Some((speed, vibration)) = critical
                    && excitation.order * speed > TAU * LOWEST
                {
                    found.push(CriticalSpeed {
                        speed,
                        excitation: index,
                        vibration,
                    });
                }
            }
        }
    }
    found.sort_by(|one, two| one.speed.total_cmp(&two.speed));
    Ok(found)
}

/// Two neighbouring points between which g has a zero.
struct Bracket<'a> {
    family: &'a Family<'a>,
    order: f64,
    rank: usize,
    ends: [&'a Point; 2],
}

impl Bracket<'_> {
    fn holds_a_zero(&self) -> bool {
        let [start, end] = self.values();
        (start > 0.0 && end <= 0.0) || (start < 0.0 && end >= 0.0)
    }

    /// g at the ends.
    fn values(&self) -> [f64; 2] {
        self.ends.map(|point| {
            let im = ranked(&point.vibrations, self.rank).map_or(0.0, angular_frequency);
            im - self.order * point.speed
        })
    }

    /// Follows the vibration of this rank from the end of the bracket.
    fn follow(&self) -> Option<(f64, Vibration)> {
        let [(mut a, mut g_a), (mut b, mut g_b)] = [0, 1].map(|end| {
            let speed = self.ends[end].speed;
            (speed, self.values()[end])
        });
        let start = ranked(&self.ends[1].vibrations, self.rank)?;
        let (mut value, mut shape) = (start.eigenvalue(), DVector::from_vec(start.shape.clone()));
        for _ in 0..12 {
            let next = b - g_b * (b - a) / (g_b - g_a);
            if !(self.ends[0].speed..=self.ends[1].speed).contains(&next) {
                return None;
            }
            let model = self.family.model_at(next).ok()?;
            let (stiffness, damping) = model.mean_matrices();
            let guess = Complex::new(value.re, self.order * next);
            (value, shape) = quadratic_eigenpair(&stiffness, &damping, (guess, &shape))?;
            (a, g_a) = (b, g_b);
            (b, g_b) = (next, value.im - self.order * next);
            if (b - a).abs() <= ACCURACY * b || g_b.abs() <= ACCURACY * value.im.abs() {
                let vibration = vibration_of(&model, value, shape.iter().copied().collect())?;
                return Some((b, vibration));
            }
        }
        None
    }

    /// Regula falsi, Illinois variant (Dowell, Jarratt, BIT 11, 1971), with all eigenvalues at each speed.
    fn search(&self) -> Result<Option<(f64, Vibration)>, NoCampbell> {
        let [mut a, mut b] = self.ends.map(|point| point.speed);
        let [mut g_a, mut g_b] = self.values();
        for _ in 0..60 {
            let next = b - g_b * (b - a) / (g_b - g_a);
            let g = self.value_at(next)?;
            if g * g_b < 0.0 {
                (a, g_a) = (b, g_b);
            } else {
                g_a *= 0.5;
            }
            let change = (next - b).abs();
            (b, g_b) = (next, g);
            if g == 0.0 || change <= ACCURACY * b {
                break;
            }
        }
        let model = self.family.model_at(b).map_err(NoCampbell::Refused)?;
        let found = vibrations(&model).ok_or(NoCampbell::NoEigenvalues)?;
        let vibration = ranked(&found.oscillating, self.rank).cloned();
        Ok(vibration.map(|vibration| (b, vibration)))
    }

    fn value_at(&self, speed: f64) -> Result<f64, NoCampbell> {
        let model = self.family.model_at(speed).map_err(NoCampbell::Refused)?;
        let values = eigenvalues(model.state_matrix().matrix).ok_or(NoCampbell::NoEigenvalues)?;
        let mut imaginary: Vec<f64> = values.iter().map(|value| value.im).collect();
        imaginary.sort_by(|one, two| two.total_cmp(one));
        Ok(imaginary[self.rank] - self.order * speed)
    }
}

/// The vibration with the rank-th largest damped frequency.
fn ranked(vibrations: &[Vibration], rank: usize) -> Option<&Vibration> {
    let mut sorted: Vec<&Vibration> = vibrations.iter().collect();
    sorted.sort_by(|one, two| angular_frequency(two).total_cmp(&angular_frequency(one)));
    sorted.get(rank).copied()
}

/// Im lambda [rad/s].
fn angular_frequency(vibration: &Vibration) -> f64 {
    TAU * vibration.natural.damped_frequency
}
