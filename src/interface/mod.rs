//! The one table of everything the outside may see: name, causality, unit, meaning.
//!
//! A row's place in the table is its value reference. modelDescription.xml, get, set, start values and the
//! documentation page are all made from this table; names are made nowhere else. Modal indices count from
//! one here and from zero everywhere else.

mod coupling;
mod dependencies;
mod fingerprint;
mod parameter;
mod range;
mod table;
mod unit;

use crate::config::Config;
use crate::model::{Change, Inputs, ModalModel, Motion};
use crate::train::{GearAddress, GearTrain};

pub use coupling::{Contact, Link, contacts_by_name, links};
pub use parameter::{Parameter, PlanarEntry, VibrationEntry};
pub use range::Range;
pub use unit::{BaseUnit, DisplayUnit, Unit};

/// The highest order of time derivatives of inputs: they change linearly in a step.
pub const INPUT_DERIVATIVE_ORDER: i32 = 1;

/// The highest order of time derivatives of outputs: [`Quantity::change`].
pub const OUTPUT_DERIVATIVE_ORDER: i32 = 1;

/// The table.
#[derive(Debug, Clone, PartialEq)]
pub struct Interface {
    /// The variables in the order of their value references.
    pub variables: Vec<Variable>,
}

/// One scalar variable.
#[derive(Debug, Clone, PartialEq)]
pub struct Variable {
    /// Structured FMI name.
    pub name: String,
    /// One sentence for a stranger.
    pub description: String,
    /// Unit.
    pub unit: Unit,
    /// What it stands for.
    pub quantity: Quantity,
    /// Start value of inputs and parameters.
    pub start: Option<f64>,
}

/// Causality, and with it FMI's variability and initial.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Causality {
    /// Set by the master at any time; continuous.
    Input,
    /// For the master; continuous, calculated.
    Output,
    /// For plots; continuous, calculated.
    Local,
    /// Set until initialization ends; fixed, exact.
    Parameter,
    /// Follows from parameters; fixed, calculated.
    CalculatedParameter,
}

/// What a variable stands for. Indices count from zero.
#[expect(
    missing_docs,
    reason = "the fields are indices of what they are named after"
)]
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Quantity {
    /// External torque number `torque` of the inputs.
    Torque { torque: usize },
    /// Gearbox displacement at bearing number `bearing` of the inputs; axis 0 is x.
    BaseDisplacement { bearing: usize, axis: usize },
    /// Gearbox velocity at bearing number `bearing` of the inputs.
    BaseVelocity { bearing: usize, axis: usize },
    /// Force number `force` from outside on the housing.
    PointForce { force: usize, axis: usize },
    /// A number of the configuration.
    Parameter(Parameter),
    /// Speed that follows from the leader of the train.
    DerivedSpeed { rotor: usize, leader: usize },
    /// Natural frequency of a lateral basis mode.
    LateralFrequency { rotor: usize, mode: usize },
    /// Natural frequency of a torsional basis mode; `mode` counts the rigid rotation.
    TorsionalFrequency { rotor: usize, mode: usize },
    /// Normal force of a mesh.
    MeshForce { mesh: usize },
    /// Component of the mesh force on gear b.
    MeshForceOnB { mesh: usize, axis: usize },
    /// Tooth deflection.
    MeshDeflection { mesh: usize },
    /// Mesh stiffness.
    MeshStiffness { mesh: usize },
    /// Motion of a gear.
    GearMotion {
        gear: GearAddress,
        direction: Direction,
    },
    /// Sum of the mesh torques on a gear.
    GearTorque { gear: GearAddress },
    /// Force of the rotor on the gearbox; `input` is the bearing's number among the inputs.
    BearingForce {
        rotor: usize,
        bearing: usize,
        input: usize,
        axis: usize,
    },
    /// Shaft displacement at a bearing.
    BearingMotion {
        rotor: usize,
        bearing: usize,
        direction: Direction,
    },
    /// Motion of a probe.
    ProbeMotion {
        rotor: usize,
        probe: usize,
        direction: Direction,
    },
    /// Mean speed of a rotor.
    Speed { rotor: usize },
    /// Rotation angle of a rotor.
    Angle { rotor: usize },
    /// Displacement of a point of the housing.
    PointDisplacement { point: usize, axis: usize },
    /// Velocity of a point of the housing.
    PointVelocity { point: usize, axis: usize },
    /// Acceleration of a point of the housing.
    PointAcceleration { point: usize, axis: usize },
    /// A modal coordinate.
    Modal { coordinate: usize },
}

/// Where the value of a variable stands ready.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Place {
    /// In the list of inputs.
    Input(u32),
    /// In the list of bearing forces, x and y of each.
    BearingForce(u32),
    /// It is looked for when somebody asks.
    Nowhere,
}

/// A direction of motion.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Direction {
    /// x.
    X,
    /// y.
    Y,
    /// Rotation about z.
    Theta,
}

impl Interface {
    /// The table of a model: `config` gives the start values, `train` the names, `model` the numbers of
    /// modes.
    pub fn of(config: &Config, train: &GearTrain, model: &ModalModel) -> Interface {
        table::build(config, train, model)
    }

    /// The FMU's guid: a fingerprint of this table, the model and the library's version.
    pub fn fingerprint(&self, config: &Config) -> String {
        fingerprint::fingerprint(self, config)
    }
}

impl Variable {
    /// The variable's causality.
    #[inline]
    pub fn causality(&self) -> Causality {
        match self.quantity {
            Quantity::Torque { .. }
            | Quantity::BaseDisplacement { .. }
            | Quantity::BaseVelocity { .. }
            | Quantity::PointForce { .. } => Causality::Input,
            Quantity::Parameter(_) => Causality::Parameter,
            Quantity::DerivedSpeed { .. }
            | Quantity::LateralFrequency { .. }
            | Quantity::TorsionalFrequency { .. } => Causality::CalculatedParameter,
            Quantity::Modal { .. } => Causality::Local,
            _ => Causality::Output,
        }
    }
}

impl Quantity {
    /// Where its value stands ready; the inputs are any of the model's.
    pub fn place(self, inputs: &Inputs) -> Place {
        let (list, place): (fn(u32) -> Place, usize) = match self {
            Quantity::Torque { torque } => (Place::Input, inputs.place_of_torque(torque)),
            Quantity::BaseDisplacement { bearing, axis } => {
                (Place::Input, inputs.place_of_displacement(bearing, axis))
            }
            Quantity::BaseVelocity { bearing, axis } => {
                (Place::Input, inputs.place_of_velocity(bearing, axis))
            }
            Quantity::PointForce { force, axis } => {
                (Place::Input, inputs.place_of_force(force, axis))
            }
            Quantity::BearingForce { input, axis, .. } => (Place::BearingForce, 2 * input + axis),
            _ => return Place::Nowhere,
        };
        u32::try_from(place).map_or(Place::Nowhere, list)
    }

    /// Whether it is set from outside or follows from such parameters alone, without a model.
    #[inline]
    pub fn is_given(&self) -> bool {
        matches!(
            self,
            Quantity::Torque { .. }
                | Quantity::BaseDisplacement { .. }
                | Quantity::BaseVelocity { .. }
                | Quantity::PointForce { .. }
                | Quantity::Parameter(_)
                | Quantity::DerivedSpeed { .. }
        )
    }

    /// The value of everything that follows from model, state and inputs. Inputs have their place in
    /// [`Quantity::place`], parameters and speeds derived from them in the configuration: they give NaN here.
    pub fn evaluate(self, motion: &Motion<'_>) -> f64 {
        let rotors = &motion.model.rotors;
        match self {
            Quantity::Torque { .. }
            | Quantity::BaseDisplacement { .. }
            | Quantity::BaseVelocity { .. }
            | Quantity::PointForce { .. }
            | Quantity::Parameter(_)
            | Quantity::DerivedSpeed { .. } => f64::NAN,
            Quantity::LateralFrequency { rotor, mode } => rotors[rotor].lateral_frequencies[mode],
            Quantity::TorsionalFrequency { rotor, mode } => {
                rotors[rotor].torsional_frequencies[mode]
            }
            Quantity::MeshForce { mesh } => motion.mesh_force(mesh),
            Quantity::MeshForceOnB { mesh, axis } => {
                let [_, on_b] = motion.mesh_loads(mesh);
                [on_b.x, on_b.y][axis]
            }
            Quantity::MeshDeflection { mesh } => motion.mesh_deflection(mesh),
            Quantity::MeshStiffness { mesh } => motion.mesh_stiffness(mesh),
            Quantity::GearMotion { gear, direction } => {
                direction.of(gear.rotor, &rotors[gear.rotor].gears[gear.gear], motion)
            }
            Quantity::GearTorque { gear } => motion.mesh_torque(gear),
            Quantity::BearingForce {
                rotor,
                bearing,
                input,
                axis,
            } => motion.bearing_force(rotor, &rotors[rotor].bearings[bearing], input)[axis],
            Quantity::BearingMotion {
                rotor,
                bearing,
                direction,
            } => direction.of(rotor, &rotors[rotor].bearings[bearing].station, motion),
            Quantity::ProbeMotion {
                rotor,
                probe,
                direction,
            } => direction.of(rotor, &rotors[rotor].probes[probe], motion),
            Quantity::Speed { rotor } => motion.speed(rotor),
            Quantity::Angle { rotor } => motion.angle(rotor),
            Quantity::PointDisplacement { point, axis } => motion.point_displacement(point)[axis],
            Quantity::PointVelocity { point, axis } => motion.point_velocity(point)[axis],
            Quantity::PointAcceleration { point, axis } => motion.point_acceleration(point)[axis],
            Quantity::Modal { coordinate } => motion.state.position()[coordinate],
        }
    }
}

impl Quantity {
    /// How the value of [`Quantity::evaluate`] changes; 0 for everything that stays as it is.
    pub fn change(self, change: &Change<'_>) -> f64 {
        let rotors = &change.motion.model.rotors;
        match self {
            Quantity::MeshForce { mesh } => change.mesh_force(mesh),
            Quantity::MeshForceOnB { mesh, axis } => {
                let [_, on_b] = change.mesh_loads(mesh);
                [on_b.x, on_b.y][axis]
            }
            Quantity::MeshDeflection { mesh } => change.mesh_deflection(mesh),
            Quantity::MeshStiffness { mesh } => change.mesh_stiffness(mesh),
            Quantity::GearMotion { gear, direction } => {
                direction.change(gear.rotor, &rotors[gear.rotor].gears[gear.gear], change)
            }
            Quantity::GearTorque { gear } => change.mesh_torque(gear),
            Quantity::BearingForce {
                rotor,
                bearing,
                input,
                axis,
            } => change.bearing_force(rotor, &rotors[rotor].bearings[bearing], input)[axis],
            Quantity::BearingMotion {
                rotor,
                bearing,
                direction,
            } => direction.change(rotor, &rotors[rotor].bearings[bearing].station, change),
            Quantity::ProbeMotion {
                rotor,
                probe,
                direction,
            } => direction.change(rotor, &rotors[rotor].probes[probe], change),
            Quantity::Speed { rotor } => change.speed(rotor),
            Quantity::Angle { rotor } => change.angle(rotor),
            Quantity::PointDisplacement { point, axis } => change.point_displacement(point)[axis],
            Quantity::PointVelocity { point, axis } => change.point_velocity(point)[axis],
            Quantity::PointAcceleration { point, axis } => change.point_acceleration(point)[axis],
            Quantity::Modal { coordinate } => change.position[coordinate],
            Quantity::Torque { .. }
            | Quantity::BaseDisplacement { .. }
            | Quantity::BaseVelocity { .. }
            | Quantity::PointForce { .. }
            | Quantity::Parameter(_)
            | Quantity::DerivedSpeed { .. }
            | Quantity::LateralFrequency { .. }
            | Quantity::TorsionalFrequency { .. } => 0.0,
        }
    }
}

impl Direction {
    fn change(self, rotor: usize, station: &crate::model::Station, change: &Change<'_>) -> f64 {
        match self {
            Direction::X => change.displacement(&station.x),
            Direction::Y => change.displacement(&station.y),
            Direction::Theta => change.torsion(rotor, &station.theta),
        }
    }

    fn of(self, rotor: usize, station: &crate::model::Station, motion: &Motion<'_>) -> f64 {
        match self {
            Direction::X => motion.displacement(&station.x),
            Direction::Y => motion.displacement(&station.y),
            Direction::Theta => motion.torsion(rotor, &station.theta),
        }
    }
}
