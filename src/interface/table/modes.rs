//! The rows of natural frequencies and modal coordinates. Modes count from one in their names; frequencies are
//! those of elastic modes, and static shapes, which have none of their own, follow the modes.

use super::super::{Quantity, Unit};
use super::{AXES, Table};
use crate::model::Rotor as ModalRotor;
use crate::train::Rotor;

impl Table<'_> {
    pub(super) fn frequencies(&mut self, index: usize, rotor: &Rotor, modal: &ModalRotor) {
        let shaft = &rotor.name;
        // A shaft that no bearing holds has lateral modes without frequency.
        let rigid = modal
            .lateral_frequencies
            .iter()
            .take_while(|&&hertz| hertz == 0.0)
            .count();
        for mode in rigid..modal.counts.lateral_modes {
            let number = mode + 1 - rigid;
            let quantity = Quantity::LateralFrequency { rotor: index, mode };
            let text = format!(
                "Natural frequency of lateral mode {number} of {shaft} by itself, without its meshes"
            );
            self.row(
                format!("{shaft}.lateral_frequency[{number}]"),
                Unit::Hertz,
                quantity,
                text,
            );
        }
        let rigid = usize::from(modal.has_rigid_rotation);
        for mode in rigid..modal.counts.torsional_modes {
            let number = mode + 1 - rigid;
            let quantity = Quantity::TorsionalFrequency { rotor: index, mode };
            let text = format!(
                "Natural frequency of elastic torsional mode {number} of {shaft} by itself, without its meshes"
            );
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
        let (n, offset) = (modal.counts.lateral, modal.lateral.range().start);
        for (plane, letter) in AXES.into_iter().enumerate() {
            for mode in 0..n {
                let number = mode + 1;
                let quantity = Quantity::Modal {
                    coordinate: offset + plane * n + mode,
                };
                let kind = kind("lateral mode", mode, modal.counts.lateral_modes, number);
                let text =
                    format!("Modal coordinate of {kind} of {shaft} in {letter}, mass normalised");
                self.row(
                    format!("{shaft}.modal.{letter}[{number}]"),
                    Unit::One,
                    quantity,
                    text,
                );
            }
        }
        let first = modal.torsional.range().start;
        let rigid = usize::from(modal.has_rigid_rotation);
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
            let kind = kind(
                "elastic torsional mode",
                mode,
                modal.counts.torsional_modes,
                number,
            );
            let text = format!("Modal coordinate of {kind} of {shaft}, mass normalised");
            self.row(
                format!("{shaft}.modal.theta[{number}]"),
                Unit::One,
                quantity,
                text,
            );
        }
    }
}

/// What a coordinate stands for: the modes come first, then the static shapes, which count anew.
fn kind(mode: &str, coordinate: usize, modes: usize, number: usize) -> String {
    if coordinate < modes {
        format!("{mode} {number}")
    } else {
        format!("static shape {}", coordinate - modes + 1)
    }
}
