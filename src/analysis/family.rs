//! One train at all speeds.

use core::f64::consts::TAU;

use super::campbell::{Excitation, NoCampbell};
use crate::config::{Config, Problem};
use crate::model::ModalModel;
use crate::rotor::ModeCounts;
use crate::train::{GearTrain, SpeedRatio, speed_ratios, validate};

/// Harmonics of the mesh frequency that are followed.
const MESH_HARMONICS: u32 = 2;
/// Two excitations whose frequencies agree to this part are one.
const SAME: f64 = 1e-9;

/// The train of a file, with the modes of its basis, at any reference speed.
pub(super) struct Family<'a> {
    config: &'a Config,
    counts: &'a [ModeCounts],
    /// Signed speed of each rotor per reference speed.
    ratios: Vec<f64>,
}

impl<'a> Family<'a> {
    pub(super) fn of(config: &'a Config, counts: &'a [ModeCounts]) -> Result<Self, NoCampbell> {
        let (train, _) =
            validate(config).map_err(|problems| NoCampbell::Refused(first(&problems)))?;
        Ok(Family {
            config,
            counts,
            ratios: ratios(&train),
        })
    }

    /// The reference speed of the file [rad/s].
    pub(super) fn reference_speed(&self) -> f64 {
        self.config.rotors[0].speed.abs()
    }

    /// The model at a reference speed [rad/s], or why there is none.
    pub(super) fn model_at(&self, speed: f64) -> Result<ModalModel, String> {
        let mut config = self.config.clone();
        for (rotor, ratio) in config.rotors.iter_mut().zip(&self.ratios) {
            rotor.speed = ratio * speed;
        }
        let (train, _) = validate(&config).map_err(|problems| first(&problems))?;
        ModalModel::assemble(&train, Some(self.counts)).map_err(|error| error.to_string())
    }

    /// Rotors first, then meshes. Their frequencies are proportional to speed; `model` is at any but 0.
    pub(super) fn excitations(&self, model: &ModalModel) -> Vec<Excitation> {
        let reference = (model.rotors[0].speed / self.ratios[0]).abs();
        let mut found: Vec<Excitation> = Vec::new();
        for (index, ratio) in self.ratios.iter().enumerate() {
            entry(&mut found, ratio.abs()).rotors.push(index);
        }
        for harmonic in 1..=MESH_HARMONICS {
            for (index, mesh) in model.meshes.iter().enumerate() {
                let order = f64::from(harmonic) * TAU * mesh.frequency() / reference;
                entry(&mut found, order).meshes.push((index, harmonic));
            }
        }
        found.retain(|excitation| excitation.order > 0.0);
        found
    }
}

/// The excitation of this order, made when there is none.
fn entry(found: &mut Vec<Excitation>, order: f64) -> &mut Excitation {
    let same = |other: &Excitation| (other.order - order).abs() <= SAME * order;
    let index = found.iter().position(same).unwrap_or(found.len());
    if index == found.len() {
        found.push(Excitation {
            order,
            rotors: Vec::new(),
            meshes: Vec::new(),
        });
    }
    &mut found[index]
}

/// Signed speeds per reference speed: those of the file, or those of the teeth when the first rotor stands still.
fn ratios(train: &GearTrain) -> Vec<f64> {
    let reference = train.rotors[0].speed.abs();
    if reference > 0.0 {
        let speeds = train.rotors.iter().map(|rotor| rotor.speed / reference);
        return speeds.collect();
    }
    let led = speed_ratios(train);
    let ratio = |led: &SpeedRatio| if led.leader == 0 { led.ratio } else { 0.0 };
    led.iter().map(ratio).collect()
}

fn first(problems: &[Problem]) -> String {
    problems
        .first()
        .map(ToString::to_string)
        .unwrap_or_default()
}
