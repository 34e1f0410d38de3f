//! Table I, mode shapes (figures 3 and 4) and orbits (figures 5 to 7).

use geartrain::rotor::ModalRotor;
use geartrain::train::{Basis, Rotor};

use super::{Part, ROTATION, Row, Rule, VIBRATION};
use crate::family::Family;
use crate::machine::{Shapes, VIBRATION_AMPLITUDE, Variant};
use crate::record::Window::Settled;
use crate::shapes::Shape;

/// Table I [Hz]: torsional 1, 2 and lateral 1, 2 per stage.
const TABLE_I: [[f64; 4]; 3] = [
    [355.0, 1090.0, 115.0, 145.0],
    [550.0, 1610.0, 160.0, 189.0],
    [280.0, 820.0, 110.0, 200.0],
];

/// Table I and figures 3 and 4.
pub fn shapes() -> Part {
    Part {
        title: "Table I, figures 3 and 4: frequencies and mode shapes",
        rows: vec![
            Row {
                claim: "Table I",
                quantity: "largest deviation of the twelve frequencies, %",
                holds: Rule::Below(0.5),
                measure: |family| 100.0 * table_deviation(family),
            },
            Row {
                claim: "shapes of stages II and III \"are generally identical\"",
                quantity: "likeness of II and III, first lateral mode",
                holds: Rule::Above(0.8),
                measure: |_| Shape::lateral(2, 1).likeness(&Shape::lateral(3, 1)),
            },
            Row {
                claim: "",
                quantity: "second lateral mode",
                holds: Rule::Above(0.8),
                measure: |_| Shape::lateral(2, 2).likeness(&Shape::lateral(3, 2)),
            },
            Row {
                claim: "",
                quantity: "first torsional mode",
                holds: Rule::Above(0.8),
                measure: |_| Shape::torsional(2, 1).likeness(&Shape::torsional(3, 1)),
            },
            Row {
                claim: "stage I is \"more like a mirror image\" of II and III",
                quantity: "likeness of I mirrored and II, first torsional mode",
                holds: Rule::Above(0.8),
                measure: |_| {
                    let first = Shape::torsional(1, 1).mirrored();
                    first.likeness(&Shape::torsional(2, 1))
                },
            },
            Row {
                claim: "the nominal support at the gears produces \"a substantial difference on the vibratory modes of each rotor stage\"",
                quantity: "largest change of a lateral frequency of Table I when it is left out, %",
                holds: Rule::Above(5.0),
                measure: |_| 100.0 * change_without_supports(),
            },
            Row {
                claim: "the second mode of II and III is \"very similar to the shape of the first mode in stage I\"",
                quantity: "likeness of lateral I-1 mirrored and II-2",
                holds: Rule::Above(0.8),
                measure: |_| {
                    Shape::lateral(1, 1)
                        .mirrored()
                        .likeness(&Shape::lateral(2, 2))
                },
            },
            Row {
                claim: "",
                quantity: "of I-1 mirrored and III-2",
                holds: Rule::Above(0.8),
                measure: |_| {
                    Shape::lateral(1, 1)
                        .mirrored()
                        .likeness(&Shape::lateral(3, 2))
                },
            },
        ],
        remarks: &[
            "The example is fitted to Table I: the first row keeps the fit and predicts nothing. Places of bearings, gears and disks are \
             assumed, and figures 3 and 4 were not part of the fit; what agrees is the overhung bending and the twist \
             between two ends.",
            "The stiffness of the nominal support is not given; ours is 2e5 N/m at every gear. A large one would spoil the modes as a basis: \
             the static compliance of gear I with three modes is 41 % wrong at 1e8 N/m.",
        ],
    }
}

/// Figures 5 to 7.
pub fn orbits() -> Part {
    Part {
        title: "Figures 5 to 7: orbits of the gears",
        rows: vec![
            Row {
                claim: "stage I \"is more influenced by mass imbalance while those of stages II and III are affected by motion of the gearbox\"",
                quantity: "50 Hz in case 3 / 1200 Hz in case 2, stage I",
                holds: Rule::Above(1.0),
                measure: |family| balance(family, 1),
            },
            Row {
                claim: "",
                quantity: "stage II",
                holds: Rule::Below(1.0),
                measure: |family| balance(family, 2),
            },
            Row {
                claim: "",
                quantity: "stage III",
                holds: Rule::Below(1.0),
                measure: |family| balance(family, 3),
            },
            Row {
                claim: "",
                quantity: "stage I / the larger of II and III (amplitudes drop out)",
                holds: Rule::Above(1.0),
                measure: |family| balance(family, 1) / balance(family, 2).max(balance(family, 3)),
            },
            Row {
                claim: "\"the effects of bearing support motion to stage I gear vibrational orbits are quite small\"",
                quantity: "gear at 1200 Hz / motion of the supports, stage I",
                holds: Rule::Below(0.1),
                measure: |family| transmissibility(family, 1),
            },
            Row {
                claim: "",
                quantity: "stage I / the smaller of II and III",
                holds: Rule::Below(1.0),
                measure: |family| {
                    transmissibility(family, 1)
                        / transmissibility(family, 2).min(transmissibility(family, 3))
                },
            },
            Row {
                claim: "\"the rotor of stage I is substantially more flexible than the other two\"",
                quantity: "static lateral compliance at the gear, I / II",
                holds: Rule::Above(1.5),
                measure: |family| family.lateral_compliance(1) / family.lateral_compliance(2),
            },
            Row {
                claim: "",
                quantity: "I / III",
                holds: Rule::Above(1.5),
                measure: |family| family.lateral_compliance(1) / family.lateral_compliance(3),
            },
            Row {
                claim: "orbits of II and III under similar imbalance \"are smaller in amplitude\"",
                quantity: "gear at 50 Hz in case 3, II / I",
                holds: Rule::Below(1.0),
                measure: |family| imbalanced(family, 2) / imbalanced(family, 1),
            },
            Row {
                claim: "",
                quantity: "III / I",
                holds: Rule::Below(1.0),
                measure: |family| imbalanced(family, 3) / imbalanced(family, 1),
            },
        ],
        remarks: &[],
    }
}

fn table_deviation(family: &Family) -> f64 {
    let rotors = family.model.rotors.iter().zip(TABLE_I);
    let deviations = rotors.flat_map(|(rotor, published)| {
        let (torsional, lateral) = (&rotor.torsional_frequencies, &rotor.lateral_frequencies);
        // The rigid rotation is no entry of the table.
        let found = [torsional[1], torsional[2], lateral[0], lateral[1]];
        core::array::from_fn::<f64, 4, _>(|i| (found[i] / published[i] - 1.0).abs())
    });
    deviations.fold(0.0, f64::max)
}

/// Largest relative change of the first two lateral frequencies of the stages.
fn change_without_supports() -> f64 {
    let mut train = Variant::of(1, Shapes::Three).train();
    let basis = train.basis;
    let changes = train.rotors.iter_mut().flat_map(|rotor| {
        let with = lateral_frequencies(rotor, &basis);
        rotor.basis_supports.clear();
        let without = lateral_frequencies(rotor, &basis);
        core::array::from_fn::<f64, 2, _>(|mode| (without[mode] / with[mode] - 1.0).abs())
    });
    changes.fold(0.0, f64::max)
}

fn lateral_frequencies(rotor: &Rotor, basis: &Basis) -> Vec<f64> {
    let reduced = ModalRotor::reduce(rotor, basis, None).expect("the example has modes");
    reduced.lateral_frequencies
}

/// Gear at 50 Hz under the large imbalance [m].
fn imbalanced(family: &Family, stage: usize) -> f64 {
    family.case(3).gear(stage, Settled).at(ROTATION)
}

fn balance(family: &Family, stage: usize) -> f64 {
    imbalanced(family, stage) / family.case(2).gear(stage, Settled).at(VIBRATION)
}

/// Gear over supports; both directions together, as in the spectrum.
pub fn transmissibility(family: &Family, stage: usize) -> f64 {
    let supports = libm::hypot(VIBRATION_AMPLITUDE, VIBRATION_AMPLITUDE);
    family.case(2).gear(stage, Settled).at(VIBRATION) / supports
}
