//! The rows of the table, in the order in which a person would look for them.

mod housing;
mod modes;
mod parameters;

use super::parameter::Parameter;
use super::{Direction, Interface, Quantity, Unit, Variable};
use crate::config::Config;
use crate::model::ModalModel;
use crate::train::{GearAddress, GearTrain, Rotor};

const AXES: [&str; 2] = ["x", "y"];
const LATERAL: [(&str, Direction); 2] = [("x", Direction::X), ("y", Direction::Y)];

/// Collects rows.
struct Table<'a> {
    variables: Vec<Variable>,
    config: &'a mut Config,
}

pub(super) fn build(config: &Config, train: &GearTrain, model: &ModalModel) -> Interface {
    let mut config = config.clone();
    let mut table = Table {
        variables: Vec::new(),
        config: &mut config,
    };
    table.inputs(train);
    if let Some(housing) = &train.housing {
        table.point_forces(housing);
    }
    table.meshes(train);
    let mut input = 0;
    for (index, rotor) in train.rotors.iter().enumerate() {
        table.rotor_outputs(index, rotor, &mut input);
    }
    if let Some(housing) = &train.housing {
        table.points(housing);
    }
    table.parameters(train);
    if let Some(housing) = &train.housing {
        table.housing_parameters(housing);
        table.known_bearings();
    }
    for (index, (rotor, modal)) in train.rotors.iter().zip(&model.rotors).enumerate() {
        table.frequencies(index, rotor, modal);
    }
    for (rotor, modal) in train.rotors.iter().zip(&model.rotors) {
        table.modal_coordinates(rotor, modal);
    }
    if let Some(housing) = &model.housing {
        table.housing_coordinates(housing);
    }
    Interface {
        variables: table.variables,
    }
}

impl Table<'_> {
    fn row(
        &mut self,
        name: impl Into<String>,
        unit: Unit,
        quantity: Quantity,
        description: impl Into<String>,
    ) {
        let (name, description) = (name.into(), description.into());
        self.variables.push(Variable {
            name,
            description,
            unit,
            quantity,
            start: None,
        });
    }

    fn input(
        &mut self,
        name: String,
        unit: Unit,
        quantity: Quantity,
        start: f64,
        description: String,
    ) {
        self.row(name, unit, quantity, description);
        if let Some(row) = self.variables.last_mut() {
            row.start = Some(start);
        }
    }

    fn parameter(&mut self, name: String, unit: Unit, parameter: Parameter, description: String) {
        let start = *parameter.slot(self.config);
        self.input(
            name,
            unit,
            Quantity::Parameter(parameter),
            start,
            description,
        );
    }

    fn inputs(&mut self, train: &GearTrain) {
        let (mut torque_number, mut bearing_number) = (0, 0);
        for rotor in &train.rotors {
            let shaft = &rotor.name;
            for torque in &rotor.torques {
                self.input(
                    format!("{shaft}.{}.torque", torque.name),
                    Unit::NewtonMeter,
                    Quantity::Torque {
                        torque: torque_number,
                    },
                    torque.value,
                    format!(
                        "External torque {} on {shaft}, positive about +z",
                        torque.name
                    ),
                );
                torque_number += 1;
            }
            for bearing in &rotor.bearings {
                if train.is_held(bearing_number) {
                    bearing_number += 1;
                    continue;
                }
                let (port, place) = (
                    format!("{shaft}.{}.housing", bearing.name),
                    format!("bearing {} of {shaft}", bearing.name),
                );
                for (axis, letter) in AXES.into_iter().enumerate() {
                    let quantity = Quantity::BaseDisplacement {
                        bearing: bearing_number,
                        axis,
                    };
                    let text = format!("Displacement of the gearbox at {place} in {letter}");
                    self.input(format!("{port}.{letter}"), Unit::Meter, quantity, 0.0, text);
                }
                for (axis, letter) in AXES.into_iter().enumerate() {
                    let quantity = Quantity::BaseVelocity {
                        bearing: bearing_number,
                        axis,
                    };
                    let text = format!("Velocity of the gearbox at {place} in {letter}");
                    self.input(
                        format!("{port}.v{letter}"),
                        Unit::MeterPerSecond,
                        quantity,
                        0.0,
                        text,
                    );
                }
                bearing_number += 1;
            }
        }
    }

    fn meshes(&mut self, train: &GearTrain) {
        for (index, mesh) in train.meshes.iter().enumerate() {
            let name = &mesh.name;
            let force = Quantity::MeshForce { mesh: index };
            let text = format!(
                "Normal force of mesh {name} along the line of action; positive presses the teeth of the reference flank"
            );
            self.row(format!("{name}.force"), Unit::Newton, force, text);
            let gear_b = train.gear_name(mesh.gears[1]);
            for (axis, letter) in AXES.into_iter().enumerate() {
                let quantity = Quantity::MeshForceOnB { mesh: index, axis };
                let text = format!("Force of mesh {name} on gear {gear_b} in {letter}");
                self.row(
                    format!("{name}.force_{letter}"),
                    Unit::Newton,
                    quantity,
                    text,
                );
            }
            let text = format!(
                "Tooth deflection of mesh {name} along the line of action (dynamic transmission error), compression positive"
            );
            let quantity = Quantity::MeshDeflection { mesh: index };
            self.row(format!("{name}.deflection"), Unit::Meter, quantity, text);
            let quantity = Quantity::MeshStiffness { mesh: index };
            let text = format!(
                "Stiffness of mesh {name} along the line of action at the present mesh phase"
            );
            self.row(
                format!("{name}.stiffness"),
                Unit::NewtonPerMeter,
                quantity,
                text,
            );
        }
    }

    /// `input` counts the bearings of all rotors.
    fn rotor_outputs(&mut self, index: usize, rotor: &Rotor, input: &mut usize) {
        let shaft = &rotor.name;
        for (number, gear) in rotor.gears.iter().enumerate() {
            let address = GearAddress {
                rotor: index,
                gear: number,
            };
            let place = format!("gear {} of {shaft}", gear.name);
            let motion = |direction| Quantity::GearMotion {
                gear: address,
                direction,
            };
            self.motion(&format!("{shaft}.{}", gear.name), &place, motion);
            self.row(
                format!("{shaft}.{}.mesh_torque", gear.name),
                Unit::NewtonMeter,
                Quantity::GearTorque { gear: address },
                format!("Torque of all meshes on {place}, positive about +z"),
            );
        }
        for (number, bearing) in rotor.bearings.iter().enumerate() {
            let (port, place) = (
                format!("{shaft}.{}", bearing.name),
                format!("bearing {} of {shaft}", bearing.name),
            );
            for (axis, letter) in AXES.into_iter().enumerate() {
                let quantity = Quantity::BearingForce {
                    rotor: index,
                    bearing: number,
                    input: *input,
                    axis,
                };
                let text = format!("Force of the rotor on the gearbox through {place} in {letter}");
                self.row(
                    format!("{port}.force_{letter}"),
                    Unit::Newton,
                    quantity,
                    text,
                );
            }
            for (letter, direction) in LATERAL {
                let quantity = Quantity::BearingMotion {
                    rotor: index,
                    bearing: number,
                    direction,
                };
                let text = format!("Displacement of the shaft at {place} in {letter}");
                self.row(format!("{port}.{letter}"), Unit::Meter, quantity, text);
            }
            *input += 1;
        }
        for (number, probe) in rotor.probes.iter().enumerate() {
            let place = format!("probe {} of {shaft}", probe.name);
            let motion = |direction| Quantity::ProbeMotion {
                rotor: index,
                probe: number,
                direction,
            };
            self.motion(&format!("{shaft}.{}", probe.name), &place, motion);
        }
        let speed = Quantity::Speed { rotor: index };
        let text = format!("Mean speed of {shaft}, positive about +z");
        self.row(format!("{shaft}.speed"), Unit::RadianPerSecond, speed, text);
        let text =
            format!("Mean rotation angle of {shaft}, positive about +z, counted on beyond a turn");
        self.row(
            format!("{shaft}.angle"),
            Unit::Radian,
            Quantity::Angle { rotor: index },
            text,
        );
    }

    /// x, y and theta of a place.
    fn motion(&mut self, prefix: &str, place: &str, quantity: impl Fn(Direction) -> Quantity) {
        for (letter, direction) in LATERAL {
            let text = format!("Displacement of {place} in {letter}");
            self.row(
                format!("{prefix}.{letter}"),
                Unit::Meter,
                quantity(direction),
                text,
            );
        }
        let text = format!(
            "Rotation of {place} beyond the mean rotation of its shaft (torsional vibration)"
        );
        self.row(
            format!("{prefix}.theta"),
            Unit::Radian,
            quantity(Direction::Theta),
            text,
        );
    }
}
