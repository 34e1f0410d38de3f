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
    /// The harmonics that act on what is looked at: look by look.
    pub(super) turns: Vec<Turn>,
    /// What the forces of couplings push.
    pub(super) pushes: Vec<Push>,
    /// What harmonics do: part by part.
    pub(super) responses: Vec<Response>,
    pub(super) of_parts: Vec<Place>,
}

/// A coupling looks at a panel.
#[derive(Debug, Clone)]
pub(super) struct Look {
    pub(super) coupling: usize,
    /// The panel's states among those of all parts, in fours.
    pub(super) quads: Range<usize>,
}

/// Two harmonics act on what a coupling looks at. Where one has no other beside it, it stands twice, and the coefficients of the
/// second are zero.
#[derive(Debug, Clone)]
pub(super) struct Turn {
    pub(super) coupling: usize,
    pub(super) harmonics: [usize; 2],
}

/// A coupling pushes states.
#[derive(Debug, Clone)]
pub(super) struct Push {
    pub(super) coupling: usize,
    /// The states among those of all parts, in fours.
    pub(super) quads: Range<usize>,
}

/// Two harmonics push states, in the same way as they [`Turn`].
#[derive(Debug, Clone)]
pub(super) struct Response {
    pub(super) harmonics: [usize; 2],
    /// The states among those of all parts, in fours.
    pub(super) quads: Range<usize>,
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

    /// The first two harmonics of what a sensor looks at.
    pub(super) fn turns(&self, sensor: usize) -> usize {
        entry(self.turns, sensor)
    }

    /// The first quad that an actuator pushes.
    pub(super) fn pushes(&self, actuator: usize) -> usize {
        entry(self.pushes, actuator)
    }

    /// The first quad that two harmonics of the part push, the first two, the next two and so on.
    pub(super) fn responses(&self, twos: usize) -> usize {
        entry(self.responses, twos)
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

    /// Number of entries in lists over pushes and quads.
    pub(super) fn pushed(&self) -> usize {
        self.pushes.iter().map(|push| push.quads.len()).sum()
    }

    /// Number of entries in lists over responses and quads.
    pub(super) fn answering(&self) -> usize {
        let responses = self.responses.iter();
        responses.map(|response| response.quads.len()).sum()
    }

    /// A panel of these parts.
    fn add(&mut self, parts: &[Part]) {
        let [first, ..] = parts else {
            return;
        };
        let end = parts.iter().map(|part| part.quads().end).max();
        let quads = first.quads().start..end.unwrap_or_default();
        let harmonics: Vec<[usize; 2]> = parts.iter().flat_map(in_twos).collect();
        let mut place = Place {
            states: [self.states(), 4 * quads.len()],
            turns: [self.turns.len(), harmonics.len()],
            pushes: [self.pushed(), quads.len()],
            responses: [0, 0],
        };
        for (sensor, &coupling) in first.sensors.iter().enumerate() {
            for part in parts {
                let rows = &part.sensor_rows[sensor * part.len()..][..part.len()];
                let quads = rows.as_chunks::<4>().0.iter();
                let turned = quads.map(|rows| [END, RATE].map(|seen| rows.map(|row| row[seen])));
                self.rows.extend(turned);
            }
            let turns = harmonics.iter().map(|&harmonics| Turn {
                coupling,
                harmonics,
            });
            self.turns.extend(turns);
            self.looks.push(Look {
                coupling,
                quads: quads.clone(),
            });
        }
        self.pushes
            .extend(first.actuators.iter().map(|&coupling| Push {
                coupling,
                quads: quads.clone(),
            }));
        for part in parts {
            place.responses = [self.answering(), part.quads().len()];
            let responses = in_twos(part).map(|harmonics| Response {
                harmonics,
                quads: part.quads(),
            });
            self.responses.extend(responses);
            self.of_parts.push(place);
            place.states[0] += part.len();
            place.turns[0] += in_twos(part).count();
            place.pushes[0] += part.quads().len();
        }
    }
}

/// The harmonics of a part, two at a time.
fn in_twos(part: &Part) -> impl Iterator<Item = [usize; 2]> {
    let twos = part.harmonics.chunks(2);
    twos.map(|two| [two[0].0, two[two.len() - 1].0])
}
