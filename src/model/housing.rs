//! The structure around the rotors in its own modal coordinates, and how it moves with them.
//!
//! ```text
//!   eta'' + 2 zeta w eta' + w^2 eta = sum over held bearings of psi' F + sum over loaded points of psi' f
//!   u_b = psi eta,   F = K (u - u_b) + C (u' - u_b') + ...                u - u_b = r q,  r = w - psi
//!   K of rotors and structure together: that of the rotors, where w' K w is among it, + sum of w' K d + d' K r,   d = r - w
//! ```
//!
//! Rotors on bearings that it holds share a block with it, so that both are one linear system, solved exactly.

use core::f64::consts::TAU;

use nalgebra::{DMatrix, DVector};

use super::layout::Coordinates;
use super::{Bearing, Change, ModalModel, Motion};
use crate::config::Planar;
use crate::solver::{Block, Row};
use crate::train;

/// A structure by its modes.
#[derive(Debug, Clone)]
pub struct Housing {
    /// Its places.
    pub points: Vec<Point>,
    /// Its modes.
    pub modes: Vec<Mode>,
    /// For every bearing in the order of the inputs the point that it stands on.
    holds: Vec<Option<usize>>,
}

/// A place on the structure.
#[derive(Debug, Clone)]
pub struct Point {
    /// Displacement in x and y [m].
    pub rows: [Row; 2],
    /// The place of the force from outside among the inputs, where one acts.
    pub force: Option<usize>,
}

/// A mode of vibration.
#[derive(Debug, Clone)]
pub struct Mode {
    /// Its coordinate.
    pub place: Coordinates,
    /// Circular frequency w [rad/s].
    pub frequency: f64,
    /// Damping ratio zeta.
    pub damping_ratio: f64,
}

impl Housing {
    /// The structure on these coordinates.
    pub(super) fn of(housing: &train::Housing, places: &[Coordinates]) -> Housing {
        let row = |point: usize, axis: usize| {
            let mut row = Row::default();
            for (place, mode) in places.iter().zip(&housing.modes) {
                row.add(1.0, &place.row(&[mode.shape[point][axis]]));
            }
            row
        };
        let mut forces = 0..;
        let points = housing.points.iter().enumerate();
        let points = points.map(|(index, point)| Point {
            rows: [row(index, 0), row(index, 1)],
            force: point.takes_forces.then(|| forces.next()).flatten(),
        });
        Housing {
            points: points.collect(),
            modes: housing
                .modes
                .iter()
                .zip(places)
                .map(|(mode, place)| Mode {
                    place: place.clone(),
                    frequency: TAU * mode.frequency,
                    damping_ratio: mode.damping_ratio,
                })
                .collect(),
            holds: housing.holds.clone(),
        }
    }

    /// The point that a bearing stands on; `input` is the bearing's place among the inputs.
    pub(super) fn under(&self, input: usize) -> Option<&Point> {
        self.holds[input].map(|point| &self.points[point])
    }

    /// The rows of the points on which forces from outside act, x and y of each.
    pub(super) fn loaded(&self) -> impl Iterator<Item = &Row> {
        let loaded = self.points.iter().filter(|point| point.force.is_some());
        loaded.flat_map(|point| &point.rows)
    }

    /// Overwrites stiffness and damping of the structure, and what the bearings on it add between it and the rotors; those of
    /// the rotors by themselves stay. `coefficients` gives stiffness and damping of a bearing.
    pub(super) fn put<'a>(
        &self,
        bearings: impl Iterator<Item = &'a Bearing>,
        coefficients: impl Fn(usize) -> (Planar, Planar),
        blocks: &mut [Block],
    ) {
        for mode in &self.modes {
            let one = |value: f64| DMatrix::from_element(1, 1, value);
            let Mode {
                frequency: w,
                damping_ratio: zeta,
                ..
            } = mode;
            mode.place.clear(blocks);
            mode.place.put(blocks, &one(w * w), &one(2.0 * zeta * w));
        }
        for ((input, bearing), held) in bearings.enumerate().zip(&self.holds) {
            let station = &bearing.station;
            let Some(index) = held.and(station.x.only_block()) else {
                continue;
            };
            let block = &mut blocks[index];
            let dense = |row: &Row| {
                DVector::from_iterator(block.len(), block.range().map(|i| row.entry(i)))
            };
            let w = [&station.x, &station.y].map(dense);
            let r = bearing.relative.each_ref().map(dense);
            let (stiffness, damping) = coefficients(input);
            for (matrix, planar) in [
                (&mut block.stiffness, stiffness),
                (&mut block.damping, damping),
            ] {
                for (i, entries) in planar.rows().into_iter().enumerate() {
                    for (j, entry) in entries.into_iter().enumerate() {
                        matrix.ger(entry, &w[i], &(&r[j] - &w[j]), 1.0);
                        matrix.ger(entry, &(&r[i] - &w[i]), &r[j], 1.0);
                    }
                }
            }
        }
    }

    /// psi eta'' for a point: what the structure's own stiffness and damping leave of the forces on it. `along` gives a
    /// displacement and a velocity, `held` the force of a bearing, `loads` those from outside.
    fn acceleration(
        &self,
        point: usize,
        [position, velocity]: [&[f64]; 2],
        held: impl Fn(usize) -> [f64; 2],
        loads: &[[f64; 2]],
    ) -> [f64; 2] {
        let rows = &self.points[point].rows;
        let mut acceleration = [0.0; 2];
        for mode in &self.modes {
            let Mode {
                place,
                frequency: w,
                damping_ratio: zeta,
            } = mode;
            for i in place.range() {
                let own = -2.0 * zeta * w * velocity[i] - w * w * position[i];
                for (row, sum) in rows.iter().zip(&mut acceleration) {
                    *sum += row.entry(i) * own;
                }
            }
        }
        let mut push = |point: &Point, force: [f64; 2]| {
            for (row, sum) in rows.iter().zip(&mut acceleration) {
                for (pushed, force) in point.rows.iter().zip(force) {
                    *sum += row.dot_row(pushed) * force;
                }
            }
        };
        for (input, held_at) in self.holds.iter().enumerate() {
            if let Some(point) = held_at {
                push(&self.points[*point], held(input));
            }
        }
        for point in &self.points {
            if let Some(number) = point.force {
                push(point, loads[number]);
            }
        }
        acceleration
    }
}

impl ModalModel {
    /// The housing, for those who look at its points.
    fn housing(&self) -> &Housing {
        self.housing.as_ref().expect("only a housing has points")
    }

    fn point_rows(&self, point: usize) -> [&Row; 2] {
        self.housing().points[point].rows.each_ref()
    }
}

impl Motion<'_> {
    /// Displacement of a point of the housing [m].
    pub fn point_displacement(&self, point: usize) -> [f64; 2] {
        let rows = self.model.point_rows(point);
        rows.map(|row| self.displacement(row))
    }

    /// Its velocity [m/s].
    pub fn point_velocity(&self, point: usize) -> [f64; 2] {
        let rows = self.model.point_rows(point);
        rows.map(|row| self.velocity(row))
    }

    /// Its acceleration [m/s^2].
    pub fn point_acceleration(&self, point: usize) -> [f64; 2] {
        let motion = [self.state.position(), self.state.velocity()];
        let held = |input| self.force_on_gearbox(input);
        self.model
            .housing()
            .acceleration(point, motion, held, self.inputs.forces())
    }
}

impl Change<'_> {
    /// Of the displacement of a point of the housing [m].
    pub fn point_displacement(&self, point: usize) -> [f64; 2] {
        let rows = self.motion.model.point_rows(point);
        rows.map(|row| self.displacement(row))
    }

    /// Of its velocity [m/s].
    pub fn point_velocity(&self, point: usize) -> [f64; 2] {
        let rows = self.motion.model.point_rows(point);
        rows.map(|row| self.velocity(row))
    }

    /// Of its acceleration [m/s^2].
    pub fn point_acceleration(&self, point: usize) -> [f64; 2] {
        let held = |input| self.force_on_gearbox(input);
        let motion = [self.position, self.velocity];
        self.motion
            .model
            .housing()
            .acceleration(point, motion, held, self.inputs.forces())
    }
}
