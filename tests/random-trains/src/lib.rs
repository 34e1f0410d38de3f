//! Random valid trains: trees of shafts with compound gears, idlers, rings and parallel pairs that close loops.
//!
//! ```text
//!   trains     what every train has: shafts, meshes, unbalance, torques           varied     and what users vary beside that
//!   of_seed    a varied one, the same from the same seed                          Train      what was drawn; `text` is its model file
//! ```
//!
//! Gears roll on each other: base radii and speeds follow from the teeth. Knows nothing of the library.

#![allow(clippy::disallowed_methods)] // only the library needs the same bits everywhere

mod draw;
mod text;

use std::f64::consts::{PI, TAU};

pub use draw::{of_seed, trains, varied};

const MODULE: f64 = 0.003;
const PRESSURE_ANGLE: f64 = 0.35;

/// A train.
#[derive(Debug, Clone)]
pub struct Train {
    /// All shafts.
    pub shafts: Vec<Shaft>,
    /// All meshes.
    pub links: Vec<Link>,
    /// Cross stiffness of every bearing, +xy and -yx [N/m].
    pub skew: f64,
    /// Whether anything takes energy away.
    pub damped: bool,
    /// Lines of the table `[simulation]`.
    pub simulation: &'static str,
    /// Lateral and torsional modes of every rotor.
    pub modes: [u32; 2],
    /// Vibration of all supports: amplitude [m], frequency [Hz]; none where the amplitude is 0.
    pub vibration: (f64, f64),
}

/// A shaft on two bearings, with an unbalance and a torque.
#[derive(Debug, Clone)]
pub struct Shaft {
    /// Speed [rad/s].
    pub speed: f64,
    /// Teeth of the gears, from left to right.
    pub teeth: Vec<u32>,
    /// Torque [N m].
    pub torque: f64,
    /// Load slope of the torque [N m s/rad].
    pub slope: f64,
    /// Unbalance [kg m] and its phase.
    pub unbalance: (f64, f64),
    /// Stiffness of both bearings [N/m].
    pub bearing: f64,
    /// What kind both bearings are of.
    pub support: Support,
}

/// Kinds of bearings.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Support {
    /// A spring and a damper.
    Linear,
    /// Coefficients that fall or grow with the speed, by this part from half to twice the first speed.
    OverSpeed(f64),
    /// A soft spring and a radial force with this exponent that begins behind this clearance [m].
    Radial(f64, f64),
}

/// A mesh.
#[derive(Debug, Clone)]
pub struct Link {
    /// Shaft and gear of a and b.
    pub gears: [(usize, usize); 2],
    /// Direction from a to b.
    pub center_angle: f64,
    /// Whether b is a ring.
    pub internal: bool,
    /// Sign of the torque that drives a.
    pub flank: f64,
    /// Pitches at time 0.
    pub phase: f64,
    /// Stiffness over the phase.
    pub law: Law,
    /// Amplitude [m] and phase of the transmission error.
    pub error: (f64, f64),
    /// Damping ratio of the mesh.
    pub damping: f64,
    /// Backlash of teeth that can part [m].
    pub backlash: Option<f64>,
}

/// Stiffness laws: contact ratios, or first harmonics relative to the mean.
#[derive(Debug, Clone, Copy)]
pub enum Law {
    /// The mean alone.
    Constant,
    /// Jumps with the number of tooth pairs.
    Rectangular(f64),
    /// Rises and falls along the contact of every pair.
    ToothPair(f64),
    /// One harmonic.
    Fourier(f64, f64),
}

/// Base radius of a gear [m].
pub fn base_radius(teeth: u32) -> f64 {
    0.5 * MODULE * f64::from(teeth) * PRESSURE_ANGLE.cos()
}

impl Train {
    /// Linear: teeth that hold on to each other.
    pub fn bilateral(mut self) -> Train {
        self.links.iter_mut().for_each(|link| link.backlash = None);
        self
    }

    /// Nothing that excites and nothing that varies.
    pub fn quiet(mut self) -> Train {
        for shaft in &mut self.shafts {
            shaft.unbalance.0 = 0.0;
        }
        for link in &mut self.links {
            (link.law, link.error.0) = (Law::Constant, 0.0);
        }
        self
    }

    /// The whole machine turned by an angle about z.
    pub fn turned(mut self, angle: f64) -> Train {
        self.links
            .iter_mut()
            .for_each(|link| link.center_angle += angle);
        self.shafts
            .iter_mut()
            .for_each(|shaft| shaft.unbalance.1 += angle);
        self
    }

    /// The machine in a mirror: y, and with it every sense of rotation, the other way.
    pub fn mirrored(mut self) -> Train {
        for shaft in &mut self.shafts {
            shaft.speed = -shaft.speed;
            shaft.torque = -shaft.torque;
            shaft.unbalance.1 = -shaft.unbalance.1;
        }
        for link in &mut self.links {
            link.center_angle = -link.center_angle;
            link.flank = -link.flank;
        }
        self.skew = -self.skew;
        self
    }

    /// Gears a and b of every external mesh in the other order. The phase counts the same contact from its other end:
    /// p' = eps - p, with eps where the law begins at an end of contact, otherwise 0.
    pub fn swapped(mut self) -> Train {
        for link in self.links.iter_mut().filter(|link| !link.internal) {
            link.gears.swap(0, 1);
            link.center_angle += PI;
            let ratio = match &mut link.law {
                Law::Constant => 0.0,
                Law::Rectangular(ratio) | Law::ToothPair(ratio) => *ratio,
                Law::Fourier(_, sine) => {
                    *sine = -*sine;
                    0.0
                }
            };
            link.phase = ratio - link.phase;
            link.error.1 = -link.error.1 - TAU * ratio;
        }
        self
    }
}
