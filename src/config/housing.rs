//! `kind = "housing"` and `[housing]`: a gearbox structure by its vibration modes, as finite-element programs export them.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use super::{Place, Planar};

/// What a model file describes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Kind {
    /// Rotors and their meshes, perhaps with the housing around them.
    GearTrain,
    /// A housing alone.
    Housing,
}

/// A structure by its modes.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Housing {
    /// The file that describes it, by its path from the model file; `None` where it is the model file.
    pub file: Option<String>,
    /// The file with its modes, by its path from the model file; `None` where they stand beside the points.
    pub modes_file: Option<String>,
    /// Places at which forces act or that are looked at.
    pub points: Vec<HousingPoint>,
    /// Modes of vibration.
    pub modes: Vec<HousingMode>,
    /// The bearings that it holds.
    pub connections: Vec<Connection>,
}

/// `[[point]]`: a place on the structure.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct HousingPoint {
    /// Unique name.
    pub name: String,
    /// Whether it is only looked at: no force acts there.
    pub observe: bool,
    /// What is known of the bearing that stands on it in another model.
    pub bearing: Option<KnownBearing>,
}

/// `stiffness` and `damping` of a point: the linear spring and damper between it and what exerts the force on it.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct KnownBearing {
    /// Stiffness [N/m]; direct terms >= 0.
    pub stiffness: Planar,
    /// Damping [N s/m]; direct terms >= 0.
    pub damping: Planar,
}

impl KnownBearing {
    /// No spring and no damper.
    pub const NONE: KnownBearing = KnownBearing {
        stiffness: Planar::ZERO,
        damping: Planar::ZERO,
    };

    /// A part of the bearing.
    pub fn times(&self, share: f64) -> KnownBearing {
        KnownBearing {
            stiffness: self.stiffness.times(share),
            damping: self.damping.times(share),
        }
    }
}

/// `[[mode]]`: a natural vibration of the structure, mass normalised.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct HousingMode {
    /// Natural frequency [Hz]. >= 0
    pub frequency: f64,
    /// Damping ratio. >= 0
    pub damping_ratio: f64,
    /// Displacement in x and y at points by name [1/sqrt(kg)]; points that are not named stand still.
    pub shape: BTreeMap<String, [f64; 2]>,
}

/// A bearing that stands on a point of the structure.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Connection {
    /// The bearing, written `rotor.bearing`.
    pub bearing: String,
    /// The point.
    pub point: String,
}

impl Housing {
    /// Whether forces from outside act on a point: on those that are not only looked at and that hold no bearing.
    pub fn takes_forces(&self, point: &HousingPoint) -> bool {
        let mut connections = self.connections.iter();
        !point.observe && !connections.any(|connection| connection.point == point.name)
    }

    /// The top of the file that describes it.
    pub fn place(&self) -> Place {
        self.file
            .as_deref()
            .map_or_else(Place::root, Place::of_file)
    }

    /// The top of the file with its modes.
    pub fn place_of_modes(&self) -> Place {
        let own = self.modes_file.as_deref();
        own.map_or_else(|| self.place(), Place::of_file)
    }
}
