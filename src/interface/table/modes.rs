//! The rows of natural frequencies and modal coordinates. Modes count from one in their names.

use super::super::{Quantity, Unit};
use super::{AXES, Table};
use crate::model::Rotor as ModalRotor;
use crate::train::Rotor;

impl Table<'_> {
    pub(super) fn frequencies(&mut self, index: usize, rotor: &Rotor, modal: &ModalRotor) {
        let shaft = &rotor.name;
        for mode in 0..modal.counts.lateral {
            let number = mode + 1;
            let quantity = Quantity::LateralFrequency { rotor: index, mode };
            let text = format!("Natural frequency of lateral mode {number} of {shaft} alone");
            self.row(
                format!("{shaft}.lateral_frequency[{number}]"),
                Unit::Hertz,
                quantity,
                text,
            );
        }
        let rigid = usize::from(modal.has_rigid_rotation);
        for mode in rigid..modal.counts.torsional {
            let number = mode + 1 - rigid;
            let quantity = Quantity::TorsionalFrequency { rotor: index, mode };
            let text =
                format!("Natural frequency of elastic torsional mode {number} of {shaft} alone");
            self.row(
                format!("{shaft}.torsional_frequency[{number}]"),
                Unit::Hertz,
                quantity,
                text,
            );
        }
    }

    pub(super) fn modal_coordinates(&mut self, rotor: &Rotor, modal: &ModalRotor) {
        let shaft = &rotor.name;
        let (n, offset) = (modal.counts.lateral, modal.offset);
        for (plane, letter) in AXES.into_iter().enumerate() {
            for mode in 0..n {
                let number = mode + 1;
                let quantity = Quantity::Modal {
                    coordinate: offset + plane * n + mode,
                };
                let text = format!(
                    "Modal coordinate of lateral mode {number} of {shaft} in {letter}, mass normalised"
                );
                self.row(
                    format!("{shaft}.modal.{letter}[{number}]"),
                    Unit::One,
                    quantity,
                    text,
                );
            }
        }
        let (first, rigid) = (offset + 2 * n, usize::from(modal.has_rigid_rotation));
        if modal.has_rigid_rotation {
            let quantity = Quantity::Modal { coordinate: first };
            let text =
                format!("Modal coordinate of the rigid rotation of {shaft}, mass normalised");
            self.row(
                format!("{shaft}.modal.theta_rigid"),
                Unit::One,
                quantity,
                text,
            );
        }
        for mode in rigid..modal.counts.torsional {
            let number = mode + 1 - rigid;
            let quantity = Quantity::Modal {
                coordinate: first + mode,
            };
            let text = format!(
                "Modal coordinate of elastic torsional mode {number} of {shaft}, mass normalised"
            );
            self.row(
                format!("{shaft}.modal.theta[{number}]"),
                Unit::One,
                quantity,
                text,
            );
        }
    }
}
