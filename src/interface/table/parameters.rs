//! The rows of parameters.

use super::super::parameter::{Parameter, PlanarEntry, VibrationEntry};
use super::super::{Quantity, Unit};
use super::Table;
use crate::train::{Bearing, GearTrain, Rotor, speed_ratios};

impl Table<'_> {
    pub(super) fn parameters(&mut self, train: &GearTrain) {
        let ratios = speed_ratios(train);
        for (index, rotor) in train.rotors.iter().enumerate() {
            let name = format!("{}.mean_speed", rotor.name);
            if ratios[index].leader == index {
                let text = format!(
                    "Mean speed of {}, positive about +z; rotors meshed with it follow",
                    rotor.name
                );
                self.parameter(
                    name,
                    Unit::RadianPerSecond,
                    Parameter::MeanSpeed { rotor: index },
                    text,
                );
            } else {
                let leader = ratios[index].leader;
                let text = format!(
                    "Mean speed of {}, follows from {}.mean_speed",
                    rotor.name, train.rotors[leader].name
                );
                self.row(
                    name,
                    Unit::RadianPerSecond,
                    Quantity::DerivedSpeed {
                        rotor: index,
                        leader,
                    },
                    text,
                );
            }
            self.rotor_parameters(index, rotor);
        }
        for (index, mesh) in train.meshes.iter().enumerate() {
            let parameter = Parameter::StiffnessFactor { mesh: index };
            let text = format!(
                "Factor on the stiffness of mesh {}, greater than 0",
                mesh.name
            );
            self.parameter(
                format!("{}.stiffness_factor", mesh.name),
                Unit::One,
                parameter,
                text,
            );
            if mesh.backlash.is_some() {
                let text = format!(
                    "Backlash of mesh {}: distance that the back flank travels along its line of action before it touches",
                    mesh.name
                );
                let parameter = Parameter::Backlash { mesh: index };
                self.parameter(
                    format!("{}.backlash", mesh.name),
                    Unit::Meter,
                    parameter,
                    text,
                );
            }
        }
        if !train.rotors.is_empty() {
            self.run_parameters();
        }
        self.parameter(
            "simulation.input_extrapolation".to_string(),
            Unit::One,
            Parameter::InputExtrapolation,
            "1: inputs go on through a step as they went before, where the master gives no derivatives; 0: they are held"
                .to_string(),
        );
    }

    /// Parameters of the whole train.
    fn run_parameters(&mut self) {
        let vibration = [
            (
                "amplitude_x",
                Unit::Meter,
                VibrationEntry::AmplitudeX,
                "Amplitude in x",
            ),
            (
                "amplitude_y",
                Unit::Meter,
                VibrationEntry::AmplitudeY,
                "Amplitude in y",
            ),
            (
                "phase_y",
                Unit::Radian,
                VibrationEntry::PhaseY,
                "Phase of y ahead of x",
            ),
            (
                "frequency",
                Unit::Hertz,
                VibrationEntry::Frequency,
                "Frequency",
            ),
        ];
        for (name, unit, entry, what) in vibration {
            let text = format!(
                "{what} of a sinusoidal motion of all bearing supports, added to the inputs"
            );
            self.parameter(
                format!("gearbox_vibration.{name}"),
                unit,
                Parameter::Vibration(entry),
                text,
            );
        }
        self.parameter(
            "simulation.tolerance".to_string(),
            Unit::One,
            Parameter::Tolerance,
            "Bound on the RMS error of every mesh force over a run, relative to its RMS"
                .to_string(),
        );
    }

    /// Stiffness and damping at a place.
    pub(super) fn coefficients(
        &mut self,
        prefix: &str,
        place: &str,
        stiffness: impl Fn(PlanarEntry) -> Parameter,
        damping: impl Fn(PlanarEntry) -> Parameter,
    ) {
        for (letters, entry) in PlanarEntry::NAMED {
            let name = format!("{prefix}.stiffness.{letters}");
            let text = format!("Stiffness of {place}: {}", per(letters, "displacement"));
            self.parameter(name, Unit::NewtonPerMeter, stiffness(entry), text);
        }
        for (letters, entry) in PlanarEntry::NAMED {
            let name = format!("{prefix}.damping.{letters}");
            let text = format!("Damping of {place}: {}", per(letters, "velocity"));
            self.parameter(name, Unit::NewtonSecondPerMeter, damping(entry), text);
        }
    }

    fn rotor_parameters(&mut self, index: usize, rotor: &Rotor) {
        let shaft = &rotor.name;
        let ratios = [
            ("lateral", Parameter::LateralDampingRatio { rotor: index }),
            (
                "torsional",
                Parameter::TorsionalDampingRatio { rotor: index },
            ),
        ];
        for (kind, parameter) in ratios {
            let text = format!("Damping ratio of every elastic {kind} mode of {shaft}");
            self.parameter(
                format!("{shaft}.{kind}_damping_ratio"),
                Unit::One,
                parameter,
                text,
            );
        }
        // Coefficients that depend on the speed follow from mean_speed.
        let constant = |(_, data): &(usize, &Bearing)| !data.depends_on_speed();
        for (bearing, data) in rotor.bearings.iter().enumerate().filter(constant) {
            self.coefficients(
                &format!("{shaft}.{}", data.name),
                &format!("bearing {} of {shaft}", data.name),
                |entry| Parameter::BearingStiffness {
                    rotor: index,
                    bearing,
                    entry,
                },
                |entry| Parameter::BearingDamping {
                    rotor: index,
                    bearing,
                    entry,
                },
            );
        }
        let radial = rotor.bearings.iter().enumerate();
        for (bearing, data) in radial.filter(|(_, data)| data.nonlinear.is_some()) {
            let text = format!(
                "Radial clearance of bearing {} of {shaft}: no radial force below it",
                data.name
            );
            let parameter = Parameter::Clearance {
                rotor: index,
                bearing,
            };
            let name = format!("{shaft}.{}.clearance", data.name);
            self.parameter(name, Unit::Meter, parameter, text);
        }
        for (unbalance, data) in rotor.unbalances.iter().enumerate() {
            let (prefix, place) = (
                format!("{shaft}.{}", data.name),
                format!("unbalance {} of {shaft}", data.name),
            );
            let parameter = Parameter::UnbalanceMoment {
                rotor: index,
                unbalance,
            };
            let text = format!("Mass times eccentricity of {place}");
            self.parameter(
                format!("{prefix}.moment"),
                Unit::KilogramMeter,
                parameter,
                text,
            );
            let parameter = Parameter::UnbalancePhase {
                rotor: index,
                unbalance,
            };
            let text = format!("Direction of {place}, an angle that turns with the shaft");
            self.parameter(format!("{prefix}.phase"), Unit::Radian, parameter, text);
        }
    }
}

/// What a coefficient is: the first letter is the direction of the force, the second that of the motion.
fn per(letters: &str, motion: &str) -> String {
    let (force, direction) = letters.split_at(1);
    format!("force in {force} per {motion} in {direction}")
}
