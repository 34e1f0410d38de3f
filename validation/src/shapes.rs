//! How much mode shapes are alike.
//!
//! ```text
//!   likeness = (integral a b dz)^2 / (integral a^2 dz  integral b^2 dz)      over z / length from 0 to 1
//! ```
//!
//! 1 for shapes that differ by a factor only, 0 for orthogonal ones.

use geartrain::rotor::ModalRotor;

use crate::machine::{Shapes, Variant};

/// Points along a shaft.
const POINTS: usize = 401;

/// Displacement or rotation along a shaft.
#[derive(Debug, Clone)]
pub struct Shape(Vec<f64>);

impl Shape {
    /// Lateral mode of a stage of the example, both counted from 1.
    pub fn lateral(stage: usize, mode: usize) -> Shape {
        let rotor = reduced(stage);
        let column = rotor.lateral_shapes.column(mode - 1);
        Shape::along(
            &rotor,
            &column.iter().step_by(2).copied().collect::<Vec<_>>(),
        )
    }

    /// Elastic torsional mode of a stage.
    pub fn torsional(stage: usize, mode: usize) -> Shape {
        let rotor = reduced(stage);
        // The first one is the rigid rotation.
        Shape::along(&rotor, rotor.torsional_shapes.column(mode).as_slice())
    }

    /// The same seen from the other end.
    pub fn mirrored(mut self) -> Shape {
        self.0.reverse();
        self
    }

    /// Likeness to another shape.
    pub fn likeness(&self, other: &Shape) -> f64 {
        let product = |a: &Shape, b: &Shape| a.0.iter().zip(&b.0).map(|(a, b)| a * b).sum::<f64>();
        let both = product(self, other);
        both * both / (product(self, self) * product(other, other))
    }

    /// Linear between the stations.
    fn along(rotor: &ModalRotor, values: &[f64]) -> Shape {
        let stations = rotor.stations.positions();
        let length = stations[stations.len() - 1];
        let value = |point: usize| {
            let z = length * point as f64 / (POINTS - 1) as f64;
            let right = stations
                .partition_point(|&station| station < z)
                .clamp(1, stations.len() - 1);
            let part = (z - stations[right - 1]) / (stations[right] - stations[right - 1]);
            values[right - 1] + part * (values[right] - values[right - 1])
        };
        Shape((0..POINTS).map(value).collect())
    }
}

fn reduced(stage: usize) -> ModalRotor {
    let train = Variant::of(1, Shapes::Three).train();
    let rotor = &train.rotors[stage - 1];
    ModalRotor::reduce(rotor, &train.basis, None).expect("the example has modes")
}
