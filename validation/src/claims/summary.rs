//! The seven points of the summary, as far as they are not rows above.

use super::lateral::share_of_meshing;
use super::orbits::transmissibility;
use super::{HIGHEST, MESHING, Part, ROTATION, Row, Rule, VIBRATION, highest};
use crate::family::Family;
use crate::machine::{IMBALANCES, Shapes, VIBRATION_AMPLITUDE, Variant};
use crate::record::Record;
use crate::record::Signal::{At, MeshForce};
use crate::record::Window::Settled;
use crate::spectrum::Line;
use geartrain::rotor::Stations;

/// Summary of results.
pub fn summary() -> Part {
    Part {
        title: "Summary of results",
        rows: vec![
            Row {
                claim: "2: modes \"reduce the degrees of freedom\"",
                quantity: "coordinates / those of the finite elements, %",
                holds: Rule::Below(50.0),
                measure: |family| {
                    100.0 * family.model.system.size as f64 / finite_element_coordinates()
                },
            },
            Row {
                claim: "3: mesh forces \"provide good insights into the source of dominating response forces\"",
                quantity: "lines of more than 1 % of the mean or the highest line in case 4 that are no sum of multiples of 1800, 1200 and 50 Hz",
                holds: Rule::Below(1.0),
                measure: |family| {
                    [2, 3]
                        .map(|stage| unexplained(family, stage))
                        .into_iter()
                        .sum()
                },
            },
            Row {
                claim: "4: \"the magnitude of the gear mesh force is inversely proportional to the rotor stiffness\"",
                quantity: "shaft III twice as stiff: mean of mesh I-III / that before",
                holds: Rule::Between(0.4, 0.6),
                measure: |family| {
                    stiffened(family, |record| record.spectrum(MeshForce(3), Settled).mean)
                },
            },
            Row {
                claim: "",
                quantity: "1800 Hz / that before",
                holds: Rule::Between(0.4, 0.6),
                measure: |family| {
                    stiffened(family, |record| {
                        record.spectrum(MeshForce(3), Settled).at(MESHING)
                    })
                },
            },
            Row {
                claim: "",
                quantity: "1200 Hz / that before",
                holds: Rule::Between(0.4, 0.6),
                measure: |family| {
                    stiffened(family, |record| {
                        record.spectrum(MeshForce(3), Settled).at(VIBRATION)
                    })
                },
            },
            Row {
                claim: "5: \"the influence of the gearbox motion ... is more pronounced in a stiffer rotor\"",
                quantity: "shaft I twice as stiff: gear I at 1200 Hz / that before, case 2",
                holds: Rule::Above(1.0),
                measure: |family| {
                    let gear = |record: &Record| record.gear(1, Settled).at(VIBRATION);
                    gear(&family.stiffer_first) / gear(family.case(2))
                },
            },
            Row {
                claim: "",
                quantity: "gear / supports at 1200 Hz, the statically stiffest stage over the most flexible one",
                holds: Rule::Above(1.0),
                measure: stiffest_to_softest,
            },
            Row {
                claim: "6: mesh frequency has \"substantial effects on rotational\" vibration",
                quantity: "first torsional modes, case 4: 1800 Hz / highest line, least of the stages, %",
                holds: Rule::Above(10.0),
                measure: |family| {
                    let share = |stage| {
                        let spectrum = family.case(4).spectrum(At(stage, 1), Settled);
                        100.0 * spectrum.at(MESHING) / highest(&spectrum)
                    };
                    [1, 2, 3]
                        .map(share)
                        .into_iter()
                        .fold(f64::INFINITY, f64::min)
                },
            },
            Row {
                claim: "\"but not on lateral vibrations\"",
                quantity: "first two lateral modes, case 4: 1800 Hz / highest line, largest of the stages, %",
                holds: Rule::Below(10.0),
                measure: |family| {
                    let shares = [1, 2, 3].map(|stage| 100.0 * share_of_meshing(family, stage));
                    shares.into_iter().fold(0.0, f64::max)
                },
            },
            Row {
                claim: "7: \"modal amplifications under various excitations\"",
                quantity: "first lateral mode of stage I at 50 Hz, um sqrt(kg) per 100 g mm of imbalance",
                holds: Rule::Above(0.0),
                measure: |family| {
                    let amplitude = family.case(3).lateral(1, 1, Settled).at(ROTATION);
                    1e6 * amplitude / (IMBALANCES[1] / 1e-4)
                },
            },
            Row {
                claim: "",
                quantity: "at 1200 Hz, sqrt(kg) (per motion of the supports)",
                holds: Rule::Above(0.0),
                measure: |family| {
                    let amplitude = family.case(2).lateral(1, 1, Settled).at(VIBRATION);
                    amplitude / libm::hypot(VIBRATION_AMPLITUDE, VIBRATION_AMPLITUDE)
                },
            },
        ],
        remarks: &[
            "Point 1, that lateral, torsional and mesh dynamics are combined, is the model itself; what says that it is computed right is \
             the table at the top of this page.",
            "Point 2: how few are enough depends on the frequency. At 50 Hz the columns of this page agree within 1 %, at 1200 Hz hardly \
             anything does; `cargo xtask inspect` says it of any model.",
            "Point 4: the mean follows from the torque alone. A stiffer shaft moves resonances, so that lines may grow or shrink.",
        ],
    }
}

/// Two planes with displacement and slope, and torsion, at every station.
fn finite_element_coordinates() -> f64 {
    let train = Variant::of(1, Shapes::Three).train();
    let stations = train.rotors.iter().map(|rotor| Stations::of(rotor).count());
    5.0 * stations.sum::<usize>() as f64
}

fn stiffened(family: &Family, force: impl Fn(&Record) -> f64) -> f64 {
    force(&family.stiffer_third) / force(family.case(4))
}

fn unexplained(family: &Family, stage: usize) -> f64 {
    let spectrum = family.case(4).spectrum(MeshForce(stage), Settled);
    let least = 0.01 * spectrum.mean.abs().max(highest(&spectrum));
    let strong = |line: &Line| line.amplitude > least;
    let explained = |line: &Line| {
        let combinations =
            (0..=4).flat_map(|meshing| (-1..=1).map(move |vibration| (meshing, vibration)));
        combinations.into_iter().any(|(meshing, vibration)| {
            let middle = f64::from(meshing) * MESHING + f64::from(vibration) * VIBRATION;
            (line.frequency - middle).abs() <= ROTATION + 1.0
        })
    };
    let lines = spectrum.lines(HIGHEST);
    lines
        .iter()
        .filter(|line| strong(line) && !explained(line))
        .count() as f64
}

fn stiffest_to_softest(family: &Family) -> f64 {
    let by_compliance = |one: &usize, two: &usize| {
        family
            .lateral_compliance(*one)
            .total_cmp(&family.lateral_compliance(*two))
    };
    let stiffest = (1..=3).min_by(by_compliance).expect("three stages");
    let softest = (1..=3).max_by(by_compliance).expect("three stages");
    transmissibility(family, stiffest) / transmissibility(family, softest)
}
