//! Meshes tie speeds together: Om_b = -Om_a z_a / z_b.

use super::{GearTrain, Mesh, Rotor};

/// The speed of a rotor as a multiple of the speed of the first rotor it is meshed with.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SpeedRatio {
    /// Index of the first rotor of the connected train; a rotor without meshes leads itself.
    pub leader: usize,
    /// Speed of this rotor per speed of the leader.
    pub ratio: f64,
}

/// One mesh seen as a transmission between two rotors.
#[derive(Debug, Clone, Copy)]
pub(super) struct Transmission {
    /// Rotor a and rotor b.
    pub(super) rotors: [usize; 2],
    /// Om_b / Om_a.
    pub(super) ratio: f64,
}

/// A mesh that closes a loop with another ratio than the way around it.
pub(super) struct Contradiction {
    /// Index of the transmission.
    pub(super) transmission: usize,
    /// Its ratio around the other way.
    pub(super) other_ratio: f64,
}

/// Ratios of `count` rotors, spreading from the first rotor of each connected train.
pub(super) fn spread(
    count: usize,
    transmissions: &[Transmission],
) -> (Vec<SpeedRatio>, Vec<Contradiction>) {
    let mut found: Vec<Option<SpeedRatio>> = vec![None; count];
    for leader in 0..count {
        if found[leader].is_some() {
            continue;
        }
        found[leader] = Some(SpeedRatio { leader, ratio: 1.0 });
        let mut reached = vec![leader];
        while let Some(rotor) = reached.pop() {
            let own = found[rotor].map_or(1.0, |known| known.ratio);
            for transmission in transmissions {
                let [a, b] = transmission.rotors;
                let (other, ratio) = match rotor {
                    _ if rotor == a => (b, own * transmission.ratio),
                    _ if rotor == b => (a, own / transmission.ratio),
                    _ => continue,
                };
                if found[other].is_none() {
                    found[other] = Some(SpeedRatio { leader, ratio });
                    reached.push(other);
                }
            }
        }
    }
    let ratios: Vec<SpeedRatio> = found.into_iter().flatten().collect();
    let contradiction = |(index, transmission): (usize, &Transmission)| {
        let [a, b] = transmission.rotors;
        let other_ratio = ratios[b].ratio / ratios[a].ratio;
        let deviation = (other_ratio / transmission.ratio - 1.0).abs();
        (deviation > 1e-6).then_some(Contradiction {
            transmission: index,
            other_ratio,
        })
    };
    let contradictions = transmissions
        .iter()
        .enumerate()
        .filter_map(contradiction)
        .collect();
    (ratios, contradictions)
}

/// The meshes as transmissions.
pub(super) fn transmissions(rotors: &[Rotor], meshes: &[Mesh]) -> Vec<Transmission> {
    let transmission = |mesh: &Mesh| {
        let teeth = mesh
            .gears
            .map(|gear| f64::from(rotors[gear.rotor].gears[gear.gear].teeth));
        Transmission {
            rotors: mesh.gears.map(|gear| gear.rotor),
            ratio: -teeth[0] / teeth[1],
        }
    };
    meshes.iter().map(transmission).collect()
}

/// The speed ratios of a valid train, one per rotor.
pub fn speed_ratios(train: &GearTrain) -> Vec<SpeedRatio> {
    spread(
        train.rotors.len(),
        &transmissions(&train.rotors, &train.meshes),
    )
    .0
}
