//! Who depends on whom: the dependencies of modelDescription.xml.

use super::{Interface, Parameter, PlanarEntry, Quantity, Variable};
use crate::config::{Bearing, Config, HousingMode, HousingPoint, Planar, SpeedPoint};

impl Interface {
    /// The inputs that a variable reacts to at the same instant, as indices into the table, ascending. An input counts if
    /// parameters can make it count.
    pub fn feed_through(&self, config: &Config, variable: &Variable) -> Vec<usize> {
        let (rotor, bearing, input, axis) = match variable.quantity {
            Quantity::BearingForce {
                rotor,
                bearing,
                input,
                axis,
            } => (rotor, bearing, input, axis),
            Quantity::PointAcceleration { point, axis } => {
                return self.accelerating(config, [point, axis]);
            }
            _ => return Vec::new(),
        };
        let data = &config.rotors[rotor].bearings[bearing];
        self.indices(|quantity| match quantity {
            Quantity::BaseDisplacement { bearing, axis: of } => {
                // A radial force points wherever the shaft goes: it couples both directions.
                let radial = data.nonlinear.is_some_and(|force| force.coefficient != 0.0);
                bearing == input && (radial || counts(data, |at| &at.stiffness, [axis, of]))
            }
            Quantity::BaseVelocity { bearing, axis: of } => {
                bearing == input && counts(data, |at| &at.damping, [axis, of])
            }
            _ => false,
        })
    }

    /// The forces on the housing that a point of it answers to at once: psi psi' of point and force.
    fn accelerating(&self, config: &Config, [point, axis]: [usize; 2]) -> Vec<usize> {
        let Some(housing) = &config.housing else {
            return Vec::new();
        };
        let points = housing.points.iter();
        let loaded: Vec<&HousingPoint> = points.filter(|one| housing.takes_forces(one)).collect();
        let entry = |mode: &HousingMode, point: &HousingPoint, axis: usize| {
            mode.shape.get(&point.name).map_or(0.0, |shape| shape[axis])
        };
        let moved = &housing.points[point];
        self.indices(|quantity| match quantity {
            Quantity::PointForce { force, axis: of } => {
                let modes = housing.modes.iter();
                let share = |mode| entry(mode, moved, axis) * entry(mode, loaded[force], of);
                modes.map(share).sum::<f64>() != 0.0
            }
            _ => false,
        })
    }

    /// The parameters that a calculated parameter follows from, as indices into the table, ascending; `None` for every other
    /// variable.
    pub fn origin(&self, config: &Config, variable: &Variable) -> Option<Vec<usize>> {
        match variable.quantity {
            Quantity::DerivedSpeed { leader, .. } => {
                Some(self.indices(|other| other == mean_speed(leader)))
            }
            Quantity::TorsionalFrequency { .. } => Some(Vec::new()),
            Quantity::LateralFrequency { rotor, .. } => {
                let with_speed = config.rotors[rotor].bearings.iter().any(stiffens);
                let speed = mean_speed(self.leader(rotor));
                Some(self.indices(|other| match other {
                    Quantity::Parameter(Parameter::BearingStiffness {
                        rotor: of, entry, ..
                    }) => of == rotor && entry == PlanarEntry::Xx,
                    other => with_speed && other == speed,
                }))
            }
            _ => None,
        }
    }

    /// The rotor whose mean speed a rotor follows, or the rotor itself.
    fn leader(&self, rotor: usize) -> usize {
        let mut quantities = self.variables.iter().map(|variable| variable.quantity);
        let followed = quantities.find_map(|quantity| match quantity {
            Quantity::DerivedSpeed { rotor: of, leader } if of == rotor => Some(leader),
            _ => None,
        });
        followed.unwrap_or(rotor)
    }

    fn indices(&self, acts: impl Fn(Quantity) -> bool) -> Vec<usize> {
        let variables = self.variables.iter().enumerate();
        let acting = variables.filter(|(_, variable)| acts(variable.quantity));
        acting.map(|(index, _)| index).collect()
    }
}

fn mean_speed(rotor: usize) -> Quantity {
    Quantity::Parameter(Parameter::MeanSpeed { rotor })
}

/// Whether an entry of a bearing's coefficients may differ from zero: constant ones are parameters.
fn counts(bearing: &Bearing, of: fn(&SpeedPoint) -> &Planar, [row, column]: [usize; 2]) -> bool {
    let table = bearing.at_speed.as_ref();
    table.is_none_or(|table| {
        let mut points = table.points.iter();
        points.any(|point| of(point).rows()[row][column] != 0.0)
    })
}

/// Whether the spring of a bearing among those of the basis depends on the speed.
fn stiffens(bearing: &Bearing) -> bool {
    let points = bearing.at_speed.iter().flat_map(|table| &table.points);
    let mut springs = points.map(|point| point.stiffness.xx);
    springs
        .next()
        .is_some_and(|first| springs.any(|spring| spring != first))
}
