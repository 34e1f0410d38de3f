//! How many modes are enough: the modal model against the full finite-element model.
//!
//! Authority: independent figures. `docs/theory.md`, "How many modes": measured with another program, steady mesh and
//! bearing forces of the three-stage example under gearbox vibration at 1200 Hz.

mod support;

use geartrain::analysis::{Reference, range_of_interest, recommend};
use geartrain::config::BasisModes;
use geartrain::model::ModalModel;
use geartrain::train::{Basis, GearTrain};
use support::{assembled, compound, three_stage, valid};

fn with_basis(train: &GearTrain, modes: BasisModes, static_shapes: bool) -> ModalModel {
    let mut changed = train.clone();
    changed.basis = Basis {
        modes,
        static_shapes,
    };
    ModalModel::assemble(&changed, None).expect("the rotors have these modes")
}

fn counts(lateral_modes: usize, torsional_modes: usize) -> BasisModes {
    BasisModes::Counts {
        lateral_modes,
        torsional_modes,
    }
}

#[test]
fn errors_at_1200_hz_are_those_found_independently() {
    let train = valid(&three_stage()).train;
    let reference = Reference::of(&train, 5400.0).unwrap();
    // Lateral and torsional modes; least and largest error given.
    for (lateral, torsional, least, largest) in [
        (3, 3, 0.7, 1.1),
        (8, 6, 0.03, 0.07),
        (10, 8, 0.01, 0.01),
        (16, 10, 0.002, 0.002),
    ] {
        let model = with_basis(&train, counts(lateral, torsional), false);
        let errors = reference
            .vibration_errors(&model, &train.gearbox_vibration)
            .unwrap();
        assert_eq!(errors.frequency, 1200.0);
        let all = || errors.meshes.iter().chain(&errors.bearings);
        let rms = (all().map(|error| error * error).sum::<f64>() / all().count() as f64).sqrt();
        // The figures are one digit, over forces that are not named and a motion of the supports whose amplitudes
        // are not given: a factor of 3 either way still tells them apart.
        assert!(
            rms > least / 3.0 && rms < 3.0 * largest,
            "{lateral}/{torsional}: {rms} of {errors:?}"
        );
    }
}

#[test]
fn three_modes_per_rotor_are_not_enough_and_the_recommended_basis_is() {
    let train = valid(&three_stage()).train;
    let model = assembled(&three_stage());
    let range = range_of_interest(&train, &model);
    assert!(
        (range - 5400.0).abs() < 1e-9,
        "three times 36 teeth at 50 Hz"
    );
    let reference = Reference::of(&train, range).unwrap();
    let errors = reference.errors(&model);
    assert!(!errors.sufficient());
    assert!(errors.good_to() < 1200.0, "{} Hz", errors.good_to());
    let at_1200_hz = errors
        .bands
        .iter()
        .find(|band| (band.from..band.to).contains(&1200.0))
        .unwrap();
    assert!(at_1200_hz.worst() > 0.7, "{at_1200_hz:?}");

    let enough = recommend(&train, &reference).unwrap().unwrap();
    let recommended = BasisModes::MaxFrequency(enough.max_frequency);
    let errors = reference.errors(&with_basis(&train, recommended, true));
    assert!(errors.sufficient());
    assert_eq!(errors, enough.errors);
}

#[test]
fn all_modes_have_no_error_and_static_shapes_no_static_error() {
    for text in [three_stage(), compound()] {
        let train = valid(&text).train;
        let reference = Reference::of(&train, 2000.0).unwrap();
        let all = reference.errors(&reference.model);
        assert_eq!((all.worst_response(), all.worst_compliance()), (0.0, 0.0));
        assert_eq!(all.good_to(), 2000.0);
        let few = reference.errors(&with_basis(&train, counts(3, 3), false));
        let shaped = reference.errors(&with_basis(&train, counts(3, 3), true));
        assert!(few.worst_compliance() > 0.05);
        // 1e-7: differences of compliances a thousand times as large.
        assert!(
            shaped.worst_compliance() < 1e-7,
            "{}",
            shaped.worst_compliance()
        );
    }
}
