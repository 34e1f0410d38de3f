//! Neighbouring parts that the same couplings look at, looked at in one go.
//!
//! A rotor's bending and its torsion are parts of their own, and every mesh of the rotor sees both.

use core::ops::Range;

use super::lanes::Quad;
use super::part::Part;

/// Some neighbouring parts.
#[derive(Debug, Clone)]
pub(super) struct Panel {
    /// Their states among those of all parts, in fours.
    pub(super) quads: Range<usize>,
    /// The couplings whose rows look at each of them.
    pub(super) sensors: Vec<usize>,
    /// Their deflections and rates per eta, in fours: for every sensor both for all quads.
    pub(super) rows: Vec<[Quad; 2]>,
    /// The numbers of the harmonics that act on them.
    pub(super) harmonics: Vec<usize>,
}

/// All panels, and where the lists of every part begin in those that run over panels, then sensors, then states or harmonics.
#[derive(Debug, Clone)]
pub(super) struct Panels {
    pub(super) all: Vec<Panel>,
    pub(super) of_parts: Vec<Place>,
    /// The lengths of the list over states and of that over harmonics.
    pub(super) states: usize,
    pub(super) harmonics: usize,
}

/// Where the entries of one part are.
#[derive(Debug, Clone, Copy)]
pub(super) struct Place {
    /// That of the first state for the first sensor, and how far it is to those of the next sensor.
    states: [usize; 2],
    /// The same of the first harmonic.
    harmonics: [usize; 2],
}

impl Place {
    /// The entry of the first state, for a sensor of the panel.
    pub(super) fn states(&self, sensor: usize) -> usize {
        self.states[0] + sensor * self.states[1]
    }

    /// The entry of the first harmonic, for a sensor of the panel.
    pub(super) fn harmonics(&self, sensor: usize) -> usize {
        self.harmonics[0] + sensor * self.harmonics[1]
    }
}

impl Panel {
    fn of(parts: &[Part]) -> Panel {
        let sensors = parts
            .first()
            .map_or(Vec::new(), |part| part.sensors.clone());
        let first = parts.first().map_or(0, |part| part.quads().start);
        let rows = |sensor: usize| {
            let of_part = move |part: &Part| {
                let rows = &part.sensor_rows[sensor * part.len()..][..part.len()];
                let quads = rows.as_chunks::<4>().0.iter();
                let turned = quads.map(|rows| [0, 1].map(|what| rows.map(|row| row[what])));
                turned.collect::<Vec<[Quad; 2]>>()
            };
            parts.iter().flat_map(of_part)
        };
        let harmonics = parts.iter().flat_map(|part| &part.harmonics);
        Panel {
            quads: first..parts.last().map_or(first, |part| part.quads().end),
            rows: (0..sensors.len()).flat_map(rows).collect(),
            harmonics: harmonics.map(|(number, _)| *number).collect(),
            sensors,
        }
    }

    /// Number of states.
    pub(super) fn len(&self) -> usize {
        4 * self.quads.len()
    }
}

impl Panels {
    pub(super) fn of(parts: &[Part]) -> Panels {
        let mut panels = Panels {
            all: Vec::new(),
            of_parts: Vec::new(),
            states: 0,
            harmonics: 0,
        };
        for parts in parts.chunk_by(|one, next| one.sensors == next.sensors) {
            let panel = Panel::of(parts);
            let mut place = Place {
                states: [panels.states, panel.len()],
                harmonics: [panels.harmonics, panel.harmonics.len()],
            };
            for part in parts {
                panels.of_parts.push(place);
                place.states[0] += part.len();
                place.harmonics[0] += part.harmonics.len();
            }
            panels.states += panel.sensors.len() * panel.len();
            panels.harmonics += panel.sensors.len() * panel.harmonics.len();
            panels.all.push(panel);
        }
        panels
    }
}
