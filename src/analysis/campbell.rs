//! How natural frequencies move with speed, and the speeds at which something excites them.
//!
//! ```text
//!   all rotors' speeds scale together;   the reference speed Om is that of the first rotor, its sign aside
//!   excitation j has the circular frequency c_j Om:   c = |Om_r / Om| for the unbalance of rotor r,
//!                                                     c = h z |Om_r / Om| for harmonic h of a mesh
//!   critical speed:   Im lambda_k(Om) = c_j Om
//! ```
//!
//! At each speed the whole train is validated and assembled anew, so that everything that depends on speed does.

use core::fmt;

use super::branches::follow;
use super::critical::critical_speeds;
use super::family::Family;
use super::vibration::{Vibration, vibrations};
use crate::config::Config;
use crate::rotor::ModeCounts;

/// Reference speeds of a table.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SpeedRange {
    /// Lowest [rad/s]. >= 0
    pub from: f64,
    /// Highest [rad/s]. > from
    pub to: f64,
    /// Number of speeds. >= 2
    pub count: usize,
}

/// Natural vibrations over speed, and critical speeds.
#[derive(Debug, Clone)]
pub struct Campbell {
    /// One per speed, ascending.
    pub points: Vec<Point>,
    /// What excites.
    pub excitations: Vec<Excitation>,
    /// Where it meets a natural frequency, ascending in speed.
    pub critical_speeds: Vec<CriticalSpeed>,
    /// Speeds of the range at which the model has no meaning, and why.
    pub refused: Vec<(f64, String)>,
}

/// The train at one speed.
#[derive(Debug, Clone)]
pub struct Point {
    /// Reference speed [rad/s].
    pub speed: f64,
    /// Signed speed of each rotor [rad/s].
    pub rotor_speeds: Vec<f64>,
    /// Oscillating vibrations, ascending in frequency.
    pub vibrations: Vec<Vibration>,
    /// For each of them the vibration at the file's speed that it grows out of, when that can be told.
    pub branches: Vec<Option<usize>>,
}

/// A source of periodic forces; those of equal frequency are one.
#[derive(Debug, Clone, PartialEq)]
pub struct Excitation {
    /// Circular frequency per reference speed.
    pub order: f64,
    /// Rotors that turn at it.
    pub rotors: Vec<usize>,
    /// Meshes with the harmonic that has it.
    pub meshes: Vec<(usize, u32)>,
}

/// A speed at which an excitation meets a natural frequency.
#[derive(Debug, Clone)]
pub struct CriticalSpeed {
    /// Reference speed [rad/s].
    pub speed: f64,
    /// Index into [`Campbell::excitations`].
    pub excitation: usize,
    /// The vibration it meets, as it is at this speed.
    pub vibration: Vibration,
}

/// Why there is no table.
#[derive(Debug)]
pub enum NoCampbell {
    /// The model has no meaning at any of the speeds; the reason at the first.
    Refused(String),
    /// The eigenvalue iteration fails.
    NoEigenvalues,
}

/// The table over `range`; `nominal` holds the vibrations at the file's speed, `counts` the modes kept.
pub fn campbell(
    config: &Config,
    counts: &[ModeCounts],
    nominal: &[Vibration],
    range: &SpeedRange,
) -> Result<Campbell, NoCampbell> {
    let family = Family::of(config, counts)?;
    let mut points = Vec::new();
    let mut refused = Vec::new();
    let mut excitations = Vec::new();
    for index in 0..range.count {
        let part = index as f64 / (range.count - 1) as f64;
        let speed = range.from + part * (range.to - range.from);
        match family.model_at(speed) {
            Ok(model) => {
                let found = vibrations(&model).ok_or(NoCampbell::NoEigenvalues)?;
                if speed > 0.0 {
                    excitations = family.excitations(&model);
                }
                points.push(Point {
                    speed,
                    rotor_speeds: model.rotors.iter().map(|rotor| rotor.speed).collect(),
                    branches: Vec::new(),
                    vibrations: found.oscillating,
                });
            }
            Err(message) => refused.push((speed, message)),
        }
    }
    if points.is_empty() {
        let message = refused.into_iter().next().map(|(_, message)| message);
        return Err(NoCampbell::Refused(message.unwrap_or_default()));
    }
    follow(&mut points, nominal, family.reference_speed());
    Ok(Campbell {
        critical_speeds: critical_speeds(&family, &points, &excitations)?,
        points,
        excitations,
        refused,
    })
}

impl fmt::Display for NoCampbell {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            NoCampbell::Refused(message) => f.write_str(message),
            NoCampbell::NoEigenvalues => f.write_str("the eigenvalue iteration does not converge"),
        }
    }
}
