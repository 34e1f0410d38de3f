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
//! The k-th largest Im lambda is a continuous function of speed, also where branches cross; its
//! crossings with an excitation line are bracketed by the points of the table and located to rounding. What is
//! not found: two crossings of one of these functions between neighbouring points.

use core::f64::consts::TAU;
use core::fmt;

use super::branches::follow;
use super::vibration::{Vibration, vibrations};
use crate::config::{Config, Problem};
use crate::linalg::eigenvalues;
use crate::model::ModalModel;
use crate::rotor::{ModeCounts, ReductionError};
use crate::train::{GearTrain, speed_ratios, validate};

/// Harmonics of the mesh frequency that are followed.
const MESH_HARMONICS: u32 = 2;
/// Crossings below this frequency are those of rigid motions [Hz].
const LOWEST: f64 = 0.05;
/// Two excitations whose frequencies agree to this part are one.
const SAME: f64 = 1e-9;

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
    let mut family = Family::of(config, counts)?;
    let mut points = Vec::new();
    let mut refused = Vec::new();
    for index in 0..range.count {
        let part = index as f64 / (range.count - 1) as f64;
        let speed = range.from + part * (range.to - range.from);
        match family.model_at(speed) {
            Ok(model) => {
                let found = vibrations(&model).ok_or(NoCampbell::NoEigenvalues)?;
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
    let Some(last) = points.last() else {
        let message = refused.first().map(|(_, message)| message.clone());
        return Err(NoCampbell::Refused(message.unwrap_or_default()));
    };
    let excitations = family.excitations(last.speed);
    follow(&mut points, nominal, family.reference_speed());
    let critical_speeds = family.critical_speeds(&points, &excitations)?;
    Ok(Campbell {
        points,
        excitations,
        critical_speeds,
        refused,
    })
}

/// One train at all speeds.
struct Family<'a> {
    config: &'a Config,
    counts: &'a [ModeCounts],
    /// Signed speed of each rotor per reference speed.
    ratios: Vec<f64>,
    /// Im lambda [rad/s] at the speeds visited, descending; sorted by speed.
    visited: Vec<(f64, Vec<f64>)>,
}

impl<'a> Family<'a> {
    fn of(config: &'a Config, counts: &'a [ModeCounts]) -> Result<Self, NoCampbell> {
        let (train, _) =
            validate(config).map_err(|problems| NoCampbell::Refused(first(&problems)))?;
        Ok(Family {
            config,
            counts,
            ratios: ratios(&train),
            visited: Vec::new(),
        })
    }

    fn reference_speed(&self) -> f64 {
        self.config.rotors[0].speed.abs()
    }

    fn model_at(&self, speed: f64) -> Result<ModalModel, String> {
        let mut config = self.config.clone();
        for (rotor, ratio) in config.rotors.iter_mut().zip(&self.ratios) {
            rotor.speed = ratio * speed;
        }
        let (train, _) = validate(&config).map_err(|problems| first(&problems))?;
        ModalModel::assemble(&train, Some(self.counts))
            .map_err(|error: ReductionError| error.to_string())
    }

    /// Rotors first, then meshes; `speed` is any at which the model has a meaning.
    fn excitations(&self, speed: f64) -> Vec<Excitation> {
        let mut found: Vec<Excitation> = Vec::new();
        let mut add = |order: f64, rotor: Option<usize>, mesh: Option<(usize, u32)>| {
            let same = |other: &&mut Excitation| (other.order - order).abs() <= SAME * order;
            match found.iter_mut().find(same) {
                Some(known) => {
                    known.rotors.extend(rotor);
                    known.meshes.extend(mesh);
                }
                None => found.push(Excitation {
                    order,
                    rotors: rotor.into_iter().collect(),
                    meshes: mesh.into_iter().collect(),
                }),
            }
        };
        for (index, ratio) in self.ratios.iter().enumerate() {
            add(ratio.abs(), Some(index), None);
        }
        // Mesh frequencies are proportional to speed: any will do.
        if let Ok(model) = self.model_at(if speed > 0.0 { speed } else { 1.0 }) {
            let reference = (model.rotors[0].speed / self.ratios[0]).abs();
            for harmonic in 1..=MESH_HARMONICS {
                for (index, mesh) in model.meshes.iter().enumerate() {
                    let order = f64::from(harmonic) * TAU * mesh.frequency() / reference;
                    add(order, None, Some((index, harmonic)));
                }
            }
        }
        found.retain(|excitation| excitation.order > 0.0);
        found
    }

    fn critical_speeds(
        &mut self,
        points: &[Point],
        excitations: &[Excitation],
    ) -> Result<Vec<CriticalSpeed>, NoCampbell> {
        let mut found = Vec::new();
        for ends in points.windows(2) {
            let (from, to) = (ends[0].speed, ends[1].speed);
            let (low, high) = (self.frequencies(from)?, self.frequencies(to)?);
            for (index, excitation) in excitations.iter().enumerate() {
                for (rank, (low, high)) in low.iter().zip(&high).enumerate() {
                    let ends = [low - excitation.order * from, high - excitation.order * to];
                    if !crosses(ends) {
                        continue;
                    }
                    let speed = self.locate(rank, excitation.order, [from, to])?;
                    if excitation.order * speed < TAU * LOWEST {
                        continue;
                    }
                    if let Some(vibration) = self.vibration_at(speed, rank)? {
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

    /// Im lambda [rad/s], descending.
    fn frequencies(&mut self, speed: f64) -> Result<Vec<f64>, NoCampbell> {
        match self
            .visited
            .binary_search_by(|(other, _)| other.total_cmp(&speed))
        {
            Ok(index) => Ok(self.visited[index].1.clone()),
            Err(index) => {
                let model = self.model_at(speed).map_err(NoCampbell::Refused)?;
                let values =
                    eigenvalues(model.state_matrix().matrix).ok_or(NoCampbell::NoEigenvalues)?;
                let mut imaginary: Vec<f64> = values.iter().map(|value| value.im).collect();
                imaginary.sort_by(|one, two| two.total_cmp(one));
                // Real eigenvalues come one by one, and there are never fewer values than coordinates.
                imaginary.truncate(model.system.size);
                self.visited.insert(index, (speed, imaginary.clone()));
                Ok(imaginary)
            }
        }
    }

    /// The speed in `ends` at which the frequency of this rank meets the excitation: regula falsi, Illinois variant
    /// (Dowell, Jarratt, BIT 11, 1971), starting from the closest speeds visited.
    fn locate(&mut self, rank: usize, order: f64, ends: [f64; 2]) -> Result<f64, NoCampbell> {
        let [mut a, mut b] = ends;
        let distance = |speed: f64, frequencies: &[f64]| frequencies[rank] - order * speed;
        let mut values = [0.0; 2];
        for pair in self.visited.windows(2) {
            let [(low, at_low), (high, at_high)] = pair else {
                continue;
            };
            let inside = *low >= ends[0] && *high <= ends[1];
            let candidate = [distance(*low, at_low), distance(*high, at_high)];
            if inside && crosses(candidate) {
                (a, b, values) = (*low, *high, candidate);
                break;
            }
        }
        let [mut fa, mut fb] = values;
        for _ in 0..60 {
            if fb == 0.0 || (b - a).abs() <= 4.0 * f64::EPSILON * b.abs() {
                break;
            }
            let next = b - fb * (b - a) / (fb - fa);
            let frequencies = self.frequencies(next)?;
            let value = distance(next, &frequencies);
            if value * fb < 0.0 {
                (a, fa) = (b, fb);
            } else {
                fa *= 0.5;
            }
            let change = (next - b).abs();
            (b, fb) = (next, value);
            if change <= 1e-13 * b.abs() {
                break;
            }
        }
        Ok(b)
    }

    fn vibration_at(&self, speed: f64, rank: usize) -> Result<Option<Vibration>, NoCampbell> {
        let model = self.model_at(speed).map_err(NoCampbell::Refused)?;
        let mut found = vibrations(&model)
            .ok_or(NoCampbell::NoEigenvalues)?
            .oscillating;
        found.sort_by(|one, two| {
            let frequencies = (two.natural.damped_frequency, one.natural.damped_frequency);
            frequencies.0.total_cmp(&frequencies.1)
        });
        Ok((rank < found.len()).then(|| found.swap_remove(rank)))
    }
}

/// Signed speeds per reference speed: those of the file, or those of the teeth when the first rotor stands still.
fn ratios(train: &GearTrain) -> Vec<f64> {
    let reference = train.rotors[0].speed.abs();
    if reference > 0.0 {
        let speeds = train.rotors.iter().map(|rotor| rotor.speed / reference);
        return speeds.collect();
    }
    let led = speed_ratios(train);
    let ratio = |led: &crate::train::SpeedRatio| if led.leader == 0 { led.ratio } else { 0.0 };
    led.iter().map(ratio).collect()
}

/// Whether a function with these values at the ends of an interval has a zero in it, its start excluded.
fn crosses([start, end]: [f64; 2]) -> bool {
    (start > 0.0 && end <= 0.0) || (start < 0.0 && end >= 0.0)
}

fn first(problems: &[Problem]) -> String {
    problems
        .first()
        .map(ToString::to_string)
        .unwrap_or_default()
}

impl fmt::Display for NoCampbell {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            NoCampbell::Refused(message) => f.write_str(message),
            NoCampbell::NoEigenvalues => f.write_str("the eigenvalue iteration does not converge"),
        }
    }
}
