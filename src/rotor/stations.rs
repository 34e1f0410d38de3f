//! The stations (nodes) of a shaft: every place something is attached, and equal elements between.

use crate::train::{Rotor, SAME_PLACE};

/// Distances of the stations from the left end [m], ascending.
#[derive(Debug, Clone, PartialEq)]
pub struct Stations(Vec<f64>);

impl Stations {
    /// Every position named in the rotor is a station; each span between neighbours is divided into
    /// ceil(span / longest element) equal elements.
    pub fn of(rotor: &Rotor) -> Stations {
        let close = SAME_PLACE * rotor.length();
        let mut named = named_positions(rotor);
        named.sort_by(f64::total_cmp);
        named.dedup_by(|next, kept| *next - *kept <= close);
        let mut stations = vec![named[0]];
        for span in named.windows(2) {
            let length = span[1] - span[0];
            // A span that is a multiple of the longest element but for rounding is divided as one.
            let count = (length / rotor.max_element_length * (1.0 - SAME_PLACE))
                .ceil()
                .max(1.0);
            let steps = 1..count as usize;
            stations.extend(steps.map(|step| span[0] + length * (step as f64 / count)));
            stations.push(span[1]);
        }
        Stations(stations)
    }

    /// All positions [m].
    pub fn positions(&self) -> &[f64] {
        &self.0
    }

    /// Number of stations.
    pub fn count(&self) -> usize {
        self.0.len()
    }

    /// The station at a position [m] that was named in the rotor.
    pub fn at(&self, position: f64) -> usize {
        let distance = |index: &usize| (self.0[*index] - position).abs();
        (0..self.count())
            .min_by(|one, two| distance(one).total_cmp(&distance(two)))
            .unwrap_or(0)
    }
}

fn named_positions(rotor: &Rotor) -> Vec<f64> {
    let mut positions = vec![0.0];
    positions.extend(rotor.sections.iter().map(|section| section.end));
    positions.extend(rotor.disks.iter().map(|disk| disk.position));
    positions.extend(rotor.gears.iter().map(|gear| gear.body.position));
    positions.extend(rotor.bearings.iter().map(|bearing| bearing.position));
    positions.extend(rotor.unbalances.iter().map(|unbalance| unbalance.position));
    positions.extend(rotor.bows.iter().flat_map(|bow| &bow.positions));
    positions.extend(rotor.torques.iter().map(|torque| torque.position));
    positions.extend(rotor.basis_supports.iter().map(|support| support.position));
    positions.extend(rotor.probes.iter().map(|probe| probe.position));
    positions
}
