//! The outcome of a comparison with the full model: channels, bands, and what follows from them.

use super::compliance::Spot;
use super::response::{Force, Source};

/// Largest error of a basis that is large enough.
pub const LIMIT: f64 = 0.05;
/// Bands are thirds of an octave.
pub(super) const BANDS_PER_OCTAVE: usize = 3;

/// Kinds of excitation.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Excites {
    /// The same gearbox motion at all bearings, x and y.
    Supports,
    /// Gearbox motion at each bearing, x and y.
    Bearing,
    /// Transmission error of each mesh.
    TransmissionError,
    /// Each external torque.
    Torque,
}

/// Kinds of force.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Answers {
    /// Normal forces of the meshes.
    Meshes,
    /// Forces on the gearbox at the bearings.
    Bearings,
}

/// All channels.
pub const CHANNELS: [(Excites, Answers); 8] = [
    (Excites::Supports, Answers::Meshes),
    (Excites::Supports, Answers::Bearings),
    (Excites::Bearing, Answers::Meshes),
    (Excites::Bearing, Answers::Bearings),
    (Excites::TransmissionError, Answers::Meshes),
    (Excites::TransmissionError, Answers::Bearings),
    (Excites::Torque, Answers::Meshes),
    (Excites::Torque, Answers::Bearings),
];

/// How far a modal model is from the full one.
#[derive(Debug, Clone, PartialEq)]
pub struct BasisErrors {
    /// Bands, ascending.
    pub bands: Vec<BandErrors>,
    /// Relative error of each static compliance.
    pub compliances: Vec<(Spot, f64)>,
}

/// Errors of the force responses between two frequencies.
#[derive(Debug, Clone, PartialEq)]
pub struct BandErrors {
    /// Lower end [Hz].
    pub from: f64,
    /// Upper end [Hz].
    pub to: f64,
    /// Error of each of [`CHANNELS`]; `None` where the train has no such excitation or force.
    pub channels: [Option<f64>; CHANNELS.len()],
}

impl BandErrors {
    /// The worst channel.
    pub fn worst(&self) -> f64 {
        self.channels.iter().flatten().copied().fold(0.0, f64::max)
    }
}

impl BasisErrors {
    /// Root mean square over the bands of one channel; `None` when the train has none.
    pub fn channel_rms(&self, channel: usize) -> Option<f64> {
        let errors = self.bands.iter().map(|band| band.channels[channel]);
        let squares = errors.map(|error| error.map(|error| error * error));
        let sum: f64 = squares.sum::<Option<f64>>()?;
        Some((sum / self.bands.len() as f64).sqrt())
    }

    /// The worst channel.
    pub fn worst_response(&self) -> f64 {
        let channels = (0..CHANNELS.len()).filter_map(|channel| self.channel_rms(channel));
        channels.fold(0.0, f64::max)
    }

    /// The worst static compliance.
    pub fn worst_compliance(&self) -> f64 {
        self.compliances
            .iter()
            .map(|(_, error)| *error)
            .fold(0.0, f64::max)
    }

    /// Whether everything is within the limit.
    pub fn sufficient(&self) -> bool {
        self.worst_response() <= LIMIT && self.worst_compliance() <= LIMIT
    }

    /// The frequency up to which all responses are within the limit [Hz]; 0 when they are nowhere.
    pub fn good_to(&self) -> f64 {
        let good = self.bands.iter().take_while(|band| band.worst() <= LIMIT);
        good.last().map_or(0.0, |band| band.to)
    }

    /// The same for one channel; `None` when the train has none.
    pub fn channel_good_to(&self, channel: usize) -> Option<f64> {
        self.bands.first()?.channels[channel]?;
        let within =
            |band: &&BandErrors| band.channels[channel].is_some_and(|error| error <= LIMIT);
        let good = self.bands.iter().take_while(within);
        Some(good.last().map_or(0.0, |band| band.to))
    }

    /// The bands joined to octaves, each with its worst errors.
    pub fn octaves(&self) -> Vec<BandErrors> {
        let join = |bands: &[BandErrors]| BandErrors {
            from: bands[0].from,
            to: bands[bands.len() - 1].to,
            channels: core::array::from_fn(|channel| {
                let errors = bands.iter().filter_map(|band| band.channels[channel]);
                errors.reduce(f64::max)
            }),
        };
        self.bands.chunks(BANDS_PER_OCTAVE).map(join).collect()
    }
}

impl Excites {
    /// Its excitations, each a sum of sources.
    pub(super) fn among(self, sources: &[Source]) -> Vec<Vec<usize>> {
        let those = |belongs: &dyn Fn(&Source) -> bool| -> Vec<usize> {
            let all = 0..sources.len();
            all.filter(|&index| belongs(&sources[index])).collect()
        };
        let alone = |belongs: &dyn Fn(&Source) -> bool| -> Vec<Vec<usize>> {
            let found = those(belongs).into_iter();
            found.map(|index| vec![index]).collect()
        };
        match self {
            Excites::Supports => [0, 1]
                .map(|axis| those(&|source| matches!(source, Source::Housing(_, a) if *a == axis)))
                .into_iter()
                .filter(|together| !together.is_empty())
                .collect(),
            Excites::Bearing => alone(&|source| matches!(source, Source::Housing(..))),
            Excites::TransmissionError => {
                alone(&|source| matches!(source, Source::TransmissionError(_)))
            }
            Excites::Torque => alone(&|source| matches!(source, Source::Torque(_))),
        }
    }
}

impl Force {
    /// Its kind.
    pub fn kind(&self) -> Answers {
        match self {
            Force::Mesh(_) => Answers::Meshes,
            Force::Bearing(..) => Answers::Bearings,
        }
    }
}
