//! Mesh forces (figure 14) and torsional modal coordinates (figures 15 and 16).

use geartrain::element::Shaft;

use super::{LINE, MESHING, Part, Row, Rule, TORSIONAL, VIBRATION, highest, prominence};
use crate::family::Family;
use crate::machine::{Shapes, Variant};
use crate::record::Record;
use crate::record::Signal::{At, MeshForce};
use crate::record::Window::{Settled, Start};
use crate::spectrum::Spectrum;

/// Figure 14.
pub fn mesh_forces() -> Part {
    Part {
        title: "Figure 14: mesh forces",
        rows: vec![
            Row {
                claim: "\"the major component of these forces is the dc component ... due to the constant applied torque\"",
                quantity: "mean of mesh I-II in case 4, kN; T / 2R is 10.47",
                holds: Rule::Between(10.4, 10.5),
                measure: |family| 1e-3 * force(family, 2).mean,
            },
            Row {
                claim: "",
                quantity: "mean / highest line, mesh I-II",
                holds: Rule::Above(1.0),
                measure: |family| mean_to_highest(&force(family, 2)),
            },
            Row {
                claim: "",
                quantity: "mesh I-III",
                holds: Rule::Above(1.0),
                measure: |family| mean_to_highest(&force(family, 3)),
            },
            Row {
                claim: "\"the other sizable force component is at the tooth meshing frequency of 1800 Hz\"",
                quantity: "1800 Hz, mesh I-II in case 4, kN",
                holds: Rule::Above(0.5),
                measure: |family| 1e-3 * force(family, 2).at(MESHING),
            },
            Row {
                claim: "",
                quantity: "1800 Hz / highest other line, mesh I-II",
                holds: Rule::Above(1.0),
                measure: |family| prominence(&force(family, 2), MESHING),
            },
            Row {
                claim: "",
                quantity: "mesh I-III",
                holds: Rule::Above(1.0),
                measure: |family| prominence(&force(family, 3), MESHING),
            },
            Row {
                claim: "",
                quantity: "1200 Hz / 1800 Hz, mesh I-III",
                holds: Rule::Below(1.0),
                measure: |family| force(family, 3).at(VIBRATION) / force(family, 3).at(MESHING),
            },
            Row {
                claim: "\"higher meshing frequency component between gears I and III\"",
                quantity: "1800 Hz, mesh I-III / I-II",
                holds: Rule::Above(1.0),
                measure: |family| force(family, 3).at(MESHING) / force(family, 2).at(MESHING),
            },
            Row {
                claim: "\"because of the lower rotational stiffness in the stage III rotor\"",
                quantity: "torsional stiffness of the shaft from gear to load, III / II",
                holds: Rule::Below(1.0),
                measure: |_| torsional_stiffness(3) / torsional_stiffness(2),
            },
            Row {
                claim: "\"only a very small force component\" at the first torsional frequencies",
                quantity: "highest line at 280, 355, 550 Hz / mean, both meshes, case 4, start, %",
                holds: Rule::Below(1.0),
                measure: |family| {
                    let shares = [2, 3].map(|stage| {
                        let spectrum = family.case(4).spectrum(MeshForce(stage), Start);
                        let lines = TORSIONAL.map(|[first, _]| spectrum.near(first, LINE));
                        100.0 * lines.into_iter().fold(0.0, f64::max) / spectrum.mean
                    });
                    shares[0].max(shares[1])
                },
            },
            Row {
                claim: "and \"at the gear mesh frequency (1800 Hz)\" (of figures 15, 16)",
                quantity: "first torsional mode, case 4: 1800 Hz / mean, largest of the stages, %",
                holds: Rule::Below(1.0),
                measure: |family| {
                    let share = |stage| {
                        let spectrum = family.case(4).spectrum(At(stage, 1), Settled);
                        100.0 * spectrum.at(MESHING) / spectrum.mean.abs()
                    };
                    [1, 2, 3].map(share).into_iter().fold(0.0, f64::max)
                },
            },
        ],
        remarks: &[
            "Lines at 3600 and 5400 Hz are nearly as high as that at 1800 Hz: they follow from the assumed course of the mesh stiffness, \
             which the paper does not give.",
            "The line at 1200 Hz is proportional to the assumed 25 um of the supports; at 10 um it is below that at 1800 Hz in both meshes \
             with either basis.",
        ],
    }
}

/// Figures 15 and 16.
pub fn torsional_modes() -> Part {
    Part {
        title: "Figures 15 and 16: torsional modes",
        rows: vec![
            Row {
                claim: "\"higher dc (zero frequency component) in stage III compared to stage II\"",
                quantity: "mean of the first mode, III / II",
                holds: Rule::Above(1.0),
                measure: |family| mean(family, 3).abs() / mean(family, 2).abs(),
            },
            Row {
                claim: "figure 15: \"the other sizable vibration is at its own rotational modal frequency\"",
                quantity: "first mode, start: own frequency / highest line, least of the stages, %",
                holds: Rule::Above(50.0),
                measure: |family| 100.0 * own_frequency(family, family.case(4), 1),
            },
            Row {
                claim: "",
                quantity: "the same when the torque is switched on at the start, %",
                holds: Rule::Above(50.0),
                measure: |family| 100.0 * own_frequency(family, &family.from_rest, 1),
            },
            Row {
                claim: "figure 16: \"similar conclusions can be reached for the second modal frequencies\"",
                quantity: "second mode, start: own frequency / highest line, least of the stages, %",
                holds: Rule::Above(50.0),
                measure: |family| 100.0 * own_frequency(family, family.case(4), 2),
            },
            Row {
                claim: "",
                quantity: "the same when the torque is switched on at the start, %",
                holds: Rule::Above(50.0),
                measure: |family| 100.0 * own_frequency(family, &family.from_rest, 2),
            },
        ],
        remarks: &[
            "Own frequency is that of Table I or the nearest one of the coupled train, whichever has the higher line: the meshes lower the \
             first three from 280, 355, 550 Hz to 271, 320, 529 Hz.",
            "Free torsional vibration decays within tenths of a second; it is large only where the start of the simulation excites it, as a \
             torque that is switched on does.",
        ],
    }
}

/// G I_p / L of the uniform shaft between gear and load [N m/rad].
fn torsional_stiffness(stage: usize) -> f64 {
    let train = Variant::of(1, Shapes::Three).train();
    let rotor = &train.rotors[stage - 1];
    let section = &rotor.sections[0];
    let material = &section.material;
    let element = Shaft {
        length: (rotor.torques[0].position - rotor.gears[0].body.position).abs(),
        outer_diameter: section.outer_diameter,
        inner_diameter: section.inner_diameter,
        youngs_modulus: material.youngs_modulus,
        poisson_ratio: material.poisson_ratio,
        density: material.density,
    };
    element.torsional_stiffness()[(0, 0)]
}

fn force(family: &Family, stage: usize) -> Spectrum {
    family.case(4).spectrum(MeshForce(stage), Settled)
}

fn mean_to_highest(spectrum: &Spectrum) -> f64 {
    spectrum.mean / highest(spectrum)
}

fn mean(family: &Family, stage: usize) -> f64 {
    family.case(4).spectrum(At(stage, 1), Settled).mean
}

/// Least share over the stages.
fn own_frequency(family: &Family, record: &Record, mode: usize) -> f64 {
    let coupled = family.torsional_frequencies();
    let share = |stage: usize| {
        let spectrum = record.spectrum(At(stage, mode), Start);
        let own = TORSIONAL[stage - 1][mode - 1];
        let distance = |hertz: &&f64| (**hertz - own).abs();
        let nearest = coupled
            .iter()
            .min_by(|one, two| distance(one).total_cmp(&distance(two)));
        let line = spectrum.near(own, LINE);
        let line = nearest.map_or(line, |&hertz| line.max(spectrum.near(hertz, LINE)));
        line / highest(&spectrum)
    };
    [1, 2, 3]
        .map(share)
        .into_iter()
        .fold(f64::INFINITY, f64::min)
}
