//! What the paper claims, each as a number and where that number confirms it.

mod lateral;
mod orbits;
mod summary;
mod torsion;

use crate::family::Family;
use crate::spectrum::Spectrum;

/// Claims of one part of the paper.
#[derive(Debug)]
pub struct Part {
    /// Heading.
    pub title: &'static str,
    /// In the order of the paper.
    pub rows: Vec<Row>,
    /// What to know beside the numbers.
    pub remarks: &'static [&'static str],
}

/// One claim, or one side of it.
#[derive(Debug)]
pub struct Row {
    /// The paper's words and where they stand; empty where the row above goes on.
    pub claim: &'static str,
    /// What is measured, with its unit unless it is a ratio.
    pub quantity: &'static str,
    /// Where it confirms the claim.
    pub holds: Rule,
    /// The measurement.
    pub measure: fn(&Family) -> f64,
}

/// Values that confirm a claim.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Rule {
    /// Greater than this.
    Above(f64),
    /// Less than this.
    Below(f64),
    /// Between these.
    Between(f64, f64),
}

impl Rule {
    /// Whether a value confirms the claim.
    pub fn confirms(self, value: f64) -> bool {
        match self {
            Rule::Above(limit) => value > limit,
            Rule::Below(limit) => value < limit,
            Rule::Between(low, high) => (low..=high).contains(&value),
        }
    }
}

/// Everything, in the order of the paper.
pub fn parts() -> Vec<Part> {
    vec![
        orbits::shapes(),
        orbits::orbits(),
        lateral::first_mode(),
        lateral::second_mode(),
        lateral::torsion_and_mesh(),
        torsion::mesh_forces(),
        torsion::torsional_modes(),
        summary::summary(),
    ]
}

/// Rotation, gearbox vibration and meshing [Hz].
const ROTATION: f64 = 50.0;
const VIBRATION: f64 = 1200.0;
const MESHING: f64 = 1800.0;

/// Table I [Hz]: first and second torsional frequency per stage.
const TORSIONAL: [[f64; 2]; 3] = [[355.0, 1090.0], [550.0, 1610.0], [280.0, 820.0]];

/// Half the width of a line of a settled vibration under Hann's window, and of one that decays [Hz].
const LINE: f64 = 4.0;

/// Highest frequency at which a line is looked for [Hz]: three times the mesh frequency. What sampling folds back from
/// above it is less than 0.5 % of any mesh force.
const HIGHEST: f64 = 5500.0;

/// The line at a frequency over the highest other one.
fn prominence(spectrum: &Spectrum, frequency: f64) -> f64 {
    spectrum.near(frequency, LINE) / spectrum.highest_beside(&[frequency], LINE, HIGHEST)
}

/// The highest line.
fn highest(spectrum: &Spectrum) -> f64 {
    spectrum.highest_beside(&[], LINE, HIGHEST)
}
