//! Are the modes kept enough? The modal model against the full finite-element model.
//!
//! ```text
//!   channel        one kind of excitation (all supports moving together, each by itself, transmission
//!                  errors, torques) on one kind of force (mesh forces, bearing forces)
//!   error of a force in a band    sqrt( sum |H - H_full|^2 / sum |H_full|^2 )      sums over frequencies and sources
//!   error of a channel            that of its worst force
//! ```
//!
//! Bands are thirds of an octave, eight of them octaves up to the range of interest (three times the highest
//! mesh frequency), with eight frequencies in each. H is averaged over two percent of the frequency to either side
//! (see [`ForceResponse`]), so that a resonance that is shifted by less counts in proportion. Forces that
//! hardly answer are judged by what the others do: the sum below is at least (1/4)^2 of the same force's largest in
//! any band, and (1/100)^2 of the largest among forces of the kind. (What a basis does to slow motion of the supports
//! shows in the static compliances.) The full model has every mode of the finite elements and is as good as
//! these; whether elements are short enough is not asked here.
//!
//! The basis is **large enough** when the RMS over all bands of every channel, and every static compliance, is within
//! 5 %.

use core::f64::consts::TAU;

use nalgebra::{Complex, DMatrix, DVector};

use super::basis_errors::{BANDS_PER_OCTAVE, BandErrors, BasisErrors, CHANNELS};
use super::compliance::{Compliance, Spot, static_compliances};
use super::response::{ForceResponse, Source};
use crate::config::{BasisModes, GearboxVibration};
use crate::model::{Mesh, ModalModel};
use crate::rotor::ReductionError;
use crate::train::{Basis, GearTrain};

/// Octaves that are looked at.
const OCTAVES: usize = 8;
/// Frequencies per octave.
const PER_OCTAVE: usize = BANDS_PER_OCTAVE * PER_BAND;
/// Frequencies per band.
const PER_BAND: usize = 8;
/// Half width of the frequency average.
const AVERAGE: f64 = 0.02;
/// A force in a band counts with at least this part of its largest band.
const LEAST_OF_BANDS: f64 = 0.25;
/// A force counts with at least this part of the largest of its kind.
const LEAST_OF_KIND: f64 = 0.01;
/// A torsional compliance counts with at least this part of the largest of its rotor.
const LEAST_TWIST: f64 = 0.05;
/// Without meshing teeth the range of interest ends here [Hz].
const RANGE_WITHOUT_MESHES: f64 = 1000.0;
/// Smallest sum that something is divided by.
const NOTHING: f64 = f64::MIN_POSITIVE;

type Matrix = DMatrix<Complex<f64>>;

/// The full finite-element model and its answers.
#[derive(Debug)]
pub struct Reference {
    /// All modes of the finite elements.
    pub model: ModalModel,
    /// End of the range of interest [Hz].
    pub highest_frequency: f64,
    /// Frequencies [Hz], ascending.
    frequencies: Vec<f64>,
    /// H at each.
    responses: Vec<Matrix>,
    compliances: Vec<Compliance>,
}

/// Errors of the steady forces under the gearbox vibration of the file.
#[derive(Debug, Clone, PartialEq)]
pub struct VibrationErrors {
    /// Its frequency [Hz].
    pub frequency: f64,
    /// Relative error of each mesh force.
    pub meshes: Vec<f64>,
    /// Relative error of each bearing force, both directions together.
    pub bearings: Vec<f64>,
}

/// Three times the highest mesh frequency, and half as much again as a gearbox vibration of the file [Hz].
pub fn range_of_interest(train: &GearTrain, model: &ModalModel) -> f64 {
    let meshes = model.meshes.iter().map(Mesh::frequency).fold(0.0, f64::max);
    let vibration = &train.gearbox_vibration;
    let shaken = vibration.amplitude_x != 0.0 || vibration.amplitude_y != 0.0;
    let vibration = if shaken { vibration.frequency } else { 0.0 };
    let range = if meshes > 0.0 {
        3.0 * meshes
    } else {
        RANGE_WITHOUT_MESHES
    };
    range.max(1.5 * vibration)
}

impl Reference {
    /// Keeps all modes and computes what they answer up to a frequency [Hz].
    pub fn of(train: &GearTrain, highest_frequency: f64) -> Result<Reference, ReductionError> {
        let model = full_model(train)?;
        let count = OCTAVES * PER_OCTAVE;
        let frequency = |index: usize| {
            // The middles of equal parts of the octaves.
            let octaves = (index as f64 + 0.5) / PER_OCTAVE as f64 - OCTAVES as f64;
            highest_frequency * libm::exp2(octaves)
        };
        let frequencies: Vec<f64> = (0..count).map(frequency).collect();
        Ok(Reference {
            responses: responses(&model, &frequencies),
            compliances: static_compliances(&model),
            highest_frequency,
            frequencies,
            model,
        })
    }

    /// Compares a model of the same train with fewer modes.
    pub fn errors(&self, model: &ModalModel) -> BasisErrors {
        let response = ForceResponse::of(model);
        let found = responses(model, &self.frequencies);
        let edge = |band: usize| {
            let octaves = (band * PER_BAND) as f64 / PER_OCTAVE as f64 - OCTAVES as f64;
            self.highest_frequency * libm::exp2(octaves)
        };
        let mut bands: Vec<BandErrors> = (0..OCTAVES * BANDS_PER_OCTAVE)
            .map(|band| BandErrors {
                from: edge(band),
                to: edge(band + 1),
                channels: [None; CHANNELS.len()],
            })
            .collect();
        for (channel, &(excites, answers)) in CHANNELS.iter().enumerate() {
            let sources = excites.among(&response.sources);
            let forces: Vec<usize> = (0..response.forces.len())
                .filter(|&row| response.forces[row].kind() == answers)
                .collect();
            if sources.is_empty() || forces.is_empty() {
                continue;
            }
            let of_force = |&row: &usize| self.sums(&found, row, &sources);
            let table: Vec<Vec<Sums>> = forces.iter().map(of_force).collect();
            for (band, errors) in bands.iter_mut().enumerate() {
                errors.channels[channel] = Some(worst_force(&table, band));
            }
        }
        BasisErrors {
            bands,
            compliances: self.compliance_errors(model),
        }
    }

    /// The squares of one force in each band.
    fn sums(&self, found: &[Matrix], row: usize, sources: &[Vec<usize>]) -> Vec<Sums> {
        let together = |matrix: &Matrix, source: &[usize]| -> Complex<f64> {
            source.iter().map(|&column| matrix[(row, column)]).sum()
        };
        let band = |(full, found): (&[Matrix], &[Matrix])| {
            let mut sums = Sums::default();
            for (full, found) in full.iter().zip(found) {
                for source in sources {
                    let (full, own) = (together(full, source), together(found, source));
                    sums.full += full.norm_sqr();
                    sums.difference += (own - full).norm_sqr();
                }
            }
            sums
        };
        let full = self.responses.chunks(PER_BAND);
        full.zip(found.chunks(PER_BAND)).map(band).collect()
    }

    /// Compares the steady forces while all supports move as one, as the file's gearbox vibration moves them;
    /// without amplitudes there, equally far in x and y. `None` without a frequency, or at an undamped resonance.
    pub fn vibration_errors(
        &self,
        model: &ModalModel,
        vibration: &GearboxVibration,
    ) -> Option<VibrationErrors> {
        if vibration.frequency <= 0.0 {
            return None;
        }
        let (sine, cosine) = libm::sincos(vibration.phase_y);
        let (x, y) = match (vibration.amplitude_x, vibration.amplitude_y) {
            (0.0, 0.0) => (1.0, 1.0),
            amplitudes => amplitudes,
        };
        let motion = [Complex::new(x, 0.0), Complex::new(cosine, sine) * y];
        let s = Complex::new(0.0, TAU * vibration.frequency);
        let forces = |model: &ModalModel| {
            let response = ForceResponse::of(model);
            let amplitude = |source: &Source| match *source {
                Source::Housing(_, axis) => motion[axis],
                _ => Complex::new(0.0, 0.0),
            };
            let sources = response.sources.len();
            let amplitudes =
                DVector::from_iterator(sources, response.sources.iter().map(amplitude));
            Some(response.at(s)? * amplitudes)
        };
        let (own, full) = (forces(model)?, forces(&self.model)?);
        let error = |rows: core::ops::Range<usize>| {
            let difference: f64 = rows.clone().map(|i| (own[i] - full[i]).norm_sqr()).sum();
            let whole: f64 = rows.map(|i| full[i].norm_sqr()).sum();
            (difference / whole.max(NOTHING)).sqrt()
        };
        let meshes = model.meshes.len();
        Some(VibrationErrors {
            frequency: vibration.frequency,
            meshes: (0..meshes).map(|i| error(i..i + 1)).collect(),
            bearings: (meshes..own.len())
                .step_by(2)
                .map(|i| error(i..i + 2))
                .collect(),
        })
    }

    fn compliance_errors(&self, model: &ModalModel) -> Vec<(Spot, f64)> {
        let found = static_compliances(model);
        let largest_twist = |rotor: usize| {
            let twists = self
                .compliances
                .iter()
                .filter(|one| one.spot.rotor == rotor && one.spot.torsional);
            twists.map(|one| one.values[0]).fold(0.0, f64::max)
        };
        let error = |full: &Compliance| {
            let own = found.iter().find(|one| one.spot == full.spot)?;
            let least = if full.spot.torsional {
                LEAST_TWIST * largest_twist(full.spot.rotor)
            } else {
                0.0
            };
            let deviation = |axis: usize| {
                let (own, full) = (own.values[axis], full.values[axis]);
                (own - full).abs() / full.abs().max(least).max(NOTHING)
            };
            Some((full.spot, deviation(0).max(deviation(1))))
        };
        self.compliances.iter().filter_map(error).collect()
    }
}

/// All modes of the finite elements.
fn full_model(train: &GearTrain) -> Result<ModalModel, ReductionError> {
    let mut full = train.clone();
    full.basis = Basis {
        modes: BasisModes::MaxFrequency(f64::INFINITY),
        static_shapes: false,
    };
    ModalModel::assemble(&full, None)
}

/// H at each frequency [Hz], averaged over a relative band.
fn responses(model: &ModalModel, frequencies: &[f64]) -> Vec<Matrix> {
    let response = ForceResponse::of(model);
    let (rows, columns) = (response.forces.len(), response.sources.len());
    let at = |frequency: &f64| {
        let answer = response.at(Complex::new(AVERAGE, 1.0) * (TAU * frequency));
        answer.unwrap_or_else(|| DMatrix::zeros(rows, columns))
    };
    frequencies.iter().map(at).collect()
}

/// Squares of one force in one band.
#[derive(Debug, Clone, Copy, Default)]
struct Sums {
    full: f64,
    difference: f64,
}

/// `table[force][band]`: the largest relative error of a force in a band.
fn worst_force(table: &[Vec<Sums>], band: usize) -> f64 {
    let largest = |sums: &[Sums]| sums.iter().map(|sums| sums.full).fold(0.0, f64::max);
    let kind = table.iter().map(|sums| sums[band].full).fold(0.0, f64::max);
    let error = |sums: &Vec<Sums>| {
        let least = (LEAST_OF_BANDS * LEAST_OF_BANDS * largest(sums))
            .max(LEAST_OF_KIND * LEAST_OF_KIND * kind)
            .max(NOTHING);
        (sums[band].difference / sums[band].full.max(least)).sqrt()
    };
    table.iter().map(error).fold(0.0, f64::max)
}
