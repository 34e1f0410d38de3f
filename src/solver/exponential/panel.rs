//! What touches which states, and where that is in the lists of coefficients.
//!
//! A rotor's bending and its torsion are parts of their own, and every mesh of the rotor sees and pushes both: neighbouring parts
//! that the same couplings touch are a **panel**, looked at and pushed in one go. Lists run over panels, then over what touches
//! them, then over their states.

use core::ops::Range;

use super::lanes::Quad;
use super::part::Part;
use super::polynomials::{END, RATE};

/// Everything that touches the states of all parts.
#[derive(Debug, Clone, Default)]
pub(super) struct Panels {
    pub(super) looks: Vec<Look>,
    /// Deflection and rate per eta, in fours: for every look its quads.
    pub(super) rows: Vec<[Quad; 2]>,
    /// The numbers of the harmonics that act on what is looked at: look by look.
    pub(super) turns: Vec<usize>,
    /// What the forces of couplings push.
    pub(super) pushes: Vec<Push>,
    /// What harmonics do: part by part.
    pub(super) responses: Vec<Push>,
    pub(super) of_parts: Vec<Place>,
}

/// A coupling looks at a panel.
#[derive(Debug, Clone)]
pub(super) struct Look {
    pub(super) coupling: usize,
    /// The panel's states among those of all parts, in fours.
    pub(super) quads: Range<usize>,
    /// Its states in lists over looks and states, and its quads in those over looks and quads.
    pub(super) states: Range<usize>,
    pub(super) rows: Range<usize>,
    /// Its harmonics in lists over looks and harmonics.
    pub(super) turns: Range<usize>,
}

/// A coupling or a harmonic pushes states.
#[derive(Debug, Clone)]
pub(super) struct Push {
    /// The number of the coupling or harmonic.
    pub(super) by: usize,
    /// The states among those of all parts, in fours.
    pub(super) quads: Range<usize>,
    /// The same in lists over pushes and quads.
    pub(super) entries: Range<usize>,
}

/// Where the entries of one part are in these lists: the first one, and how far it is to that of the next sensor or actuator.
#[derive(Debug, Clone, Copy)]
pub(super) struct Place {
    states: [usize; 2],
    turns: [usize; 2],
    pushes: [usize; 2],
    responses: [usize; 2],
}

impl Place {
    /// The first state that a sensor looks at.
    pub(super) fn states(&self, sensor: usize) -> usize {
        entry(self.states, sensor)
    }

    /// The first harmonic of what a sensor looks at.
    pub(super) fn turns(&self, sensor: usize) -> usize {
        entry(self.turns, sensor)
    }

    /// The first quad that an actuator pushes.
    pub(super) fn pushes(&self, actuator: usize) -> usize {
        entry(self.pushes, actuator)
    }

    /// The first quad that a harmonic of the part pushes.
    pub(super) fn responses(&self, harmonic: usize) -> usize {
        entry(self.responses, harmonic)
    }
}

fn entry([first, apart]: [usize; 2], number: usize) -> usize {
    first + number * apart
}

impl Panels {
    pub(super) fn of(parts: &[Part]) -> Panels {
        let mut panels = Panels::default();
        let alike = |one: &Part, next: &Part| {
            one.sensors == next.sensors && one.actuators == next.actuators
        };
        for parts in parts.chunk_by(alike) {
            panels.add(parts);
        }
        panels
    }

    /// Number of entries in lists over looks and states.
    pub(super) fn states(&self) -> usize {
        4 * self.rows.len()
    }

    /// A panel of these parts.
    fn add(&mut self, parts: &[Part]) {
        let [first, ..] = parts else {
            return;
        };
        let end = parts.iter().map(|part| part.quads().end).max();
        let quads = first.quads().start..end.unwrap_or_default();
        let harmonics = parts.iter().flat_map(|part| &part.harmonics);
        let harmonics: Vec<usize> = harmonics.map(|(number, _)| *number).collect();
        let mut place = Place {
            states: [self.states(), 4 * quads.len()],
            turns: [self.turns.len(), harmonics.len()],
            pushes: [entries(&self.pushes), quads.len()],
            responses: [0, 0],
        };
        for (sensor, &coupling) in first.sensors.iter().enumerate() {
            let (row, turn) = (self.rows.len(), self.turns.len());
            for part in parts {
                let rows = &part.sensor_rows[sensor * part.len()..][..part.len()];
                let quads = rows.as_chunks::<4>().0.iter();
                let turned = quads.map(|rows| [END, RATE].map(|seen| rows.map(|row| row[seen])));
                self.rows.extend(turned);
            }
            self.turns.extend_from_slice(&harmonics);
            self.looks.push(Look {
                coupling,
                quads: quads.clone(),
                states: 4 * row..self.states(),
                rows: row..self.rows.len(),
                turns: turn..self.turns.len(),
            });
        }
        for &coupling in &first.actuators {
            push(&mut self.pushes, coupling, &quads);
        }
        for part in parts {
            place.responses = [entries(&self.responses), part.quads().len()];
            for (harmonic, _) in &part.harmonics {
                push(&mut self.responses, *harmonic, &part.quads());
            }
            self.of_parts.push(place);
            place.states[0] += part.len();
            place.turns[0] += part.harmonics.len();
            place.pushes[0] += part.quads().len();
        }
    }
}

/// Number of entries in a list over these pushes and their quads.
pub(super) fn entries(pushes: &[Push]) -> usize {
    pushes.last().map_or(0, |last| last.entries.end)
}

fn push(pushes: &mut Vec<Push>, by: usize, quads: &Range<usize>) {
    let first = entries(pushes);
    pushes.push(Push {
        by,
        quads: quads.clone(),
        entries: first..first + quads.len(),
    });
}
