//! All runs of the example with one basis and one kind of mesh torque.

use geartrain::analysis::{Kind, Place, static_compliances, vibrations};
use geartrain::config::{Start, TorqueCoupling};
use geartrain::model::ModalModel;

use crate::machine::{Shapes, Variant};
use crate::record::Record;

/// Shafts are made twice as stiff to see what that does.
const STIFFER: f64 = 2.0;

/// The runs with one basis and one kind of mesh torque.
#[derive(Debug)]
pub struct Family {
    /// The paper's cases 1 to 4.
    cases: [Record; 4],
    /// Case 4 from rest: the torques come as a jump.
    pub from_rest: Record,
    /// Case 4 with a shaft of stage III that is twice as stiff.
    pub stiffer_third: Record,
    /// Case 2 with a shaft of stage I that is twice as stiff.
    pub stiffer_first: Record,
    /// Case 4 at its start.
    pub model: ModalModel,
}

impl Family {
    /// Runs everything.
    pub fn of(shapes: Shapes, torque: TorqueCoupling) -> Family {
        let case = |case| Variant {
            torque,
            ..Variant::of(case, shapes)
        };
        let from_rest = Variant {
            start: Start::Rest,
            ..case(4)
        };
        let stiffer = |number, rotor| Variant {
            stiffened: Some((rotor, STIFFER)),
            ..case(number)
        };
        Family {
            cases: [1, 2, 3, 4].map(|number| Record::of(&case(number))),
            from_rest: Record::of(&from_rest),
            stiffer_third: Record::of(&stiffer(4, 2)),
            stiffer_first: Record::of(&stiffer(2, 0)),
            model: ModalModel::assemble(&case(4).train(), None).expect("the example has modes"),
        }
    }

    /// A case of the paper, 1 to 4.
    pub fn case(&self, number: usize) -> &Record {
        &self.cases[number - 1]
    }

    /// Static lateral compliance at a stage's gear, the mean of x and y [m/N].
    pub fn lateral_compliance(&self, stage: usize) -> f64 {
        let at_gear = static_compliances(&self.model).into_iter().find(|one| {
            let spot = one.spot;
            spot.rotor == stage - 1 && spot.place == Place::Gear(0) && !spot.torsional
        });
        at_gear.map_or(f64::NAN, |one| (one.values[0] + one.values[1]) / 2.0)
    }

    /// Frequencies of the coupled torsional vibrations up to 2 kHz [Hz].
    pub fn torsional_frequencies(&self) -> Vec<f64> {
        let found = vibrations(&self.model)
            .expect("eigenvalues converge")
            .oscillating;
        let torsional = found.iter().filter(|one| one.kind == Kind::Torsional);
        let frequencies = torsional.map(|one| one.natural.damped_frequency);
        frequencies.filter(|&hertz| hertz < 2000.0).collect()
    }
}
