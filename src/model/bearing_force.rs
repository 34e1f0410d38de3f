//! How bearings push: what a moving gearbox does to the rotors through them, and what they do to the gearbox.
//!
//! ```text
//!   on the rotor     K u_b + C u_b'                                       from the gearbox's motion alone
//!   on the gearbox   K u + C u' - (K u_b + C u_b')                         with a linear bearing, whose K u + C u' the solver reads off
//!                    K (u - u_b) + C (u' - u_b') + F_r (u - u_b) / r       with any
//! ```

use super::inputs::product;
use super::radial::Stiffness;
use super::{BaseMotion, Bearing, Motion, Rotor};
use crate::config::Planar;
use crate::solver::{Reading, Row, System};

/// What the force of one bearing follows from.
#[derive(Debug, Clone, Copy)]
pub(super) struct BearingForce {
    /// K and C by columns: force in x and y [N] per x, y, x' and y' of the gearbox.
    by_gearbox: [[f64; 2]; 4],
    /// The first of the two readings of the system that are its forces on a gearbox that stands still, where these follow from
    /// displacements and velocities by constant factors.
    reading: Option<usize>,
}

impl BearingForce {
    /// Those of all bearings in the order of the inputs, with their readings put among those of the system. Through one that
    /// follows a free speed the gearbox acts by [`super::Excitation`] instead.
    pub(super) fn of_all(system: &mut System, rotors: &[Rotor]) -> Vec<BearingForce> {
        let bearings = rotors.iter().flat_map(|rotor| &rotor.bearings);
        let mut of = |bearing: &Bearing| {
            let is_linear = !bearing.follows_speed && bearing.bearing.nonlinear.is_none();
            let reading = is_linear.then_some(system.readings.len());
            if is_linear {
                system.readings.extend(bearing.readings());
            }
            let by_gearbox = match bearing.follows_speed {
                true => [[0.0; 2]; 4],
                false => bearing.columns(),
            };
            BearingForce {
                by_gearbox,
                reading,
            }
        };
        bearings.map(&mut of).collect()
    }

    /// K u_b + C u_b', where the gearbox moves by x, y, x' and y'.
    #[inline]
    pub(super) fn by_gearbox(&self, base: [f64; 4]) -> [f64; 2] {
        sum_of(&self.by_gearbox, base)
    }
}

impl Bearing {
    /// Stiffness and damping by columns.
    fn columns(&self) -> [[f64; 2]; 4] {
        let columns = |matrix: &Planar| {
            let [x, y] = matrix.rows();
            [[x[0], y[0]], [x[1], y[1]]]
        };
        let ([x, y], [x_rate, y_rate]) = (columns(&self.stiffness), columns(&self.damping));
        [x, y, x_rate, y_rate]
    }

    /// load += r' (K u_b + C u_b').
    pub(super) fn base_load(&self, base: BaseMotion, load: &mut [f64]) {
        let force = sum_of(&self.columns(), base.numbers());
        for (row, force) in self.relative.iter().zip(force) {
            row.add_to(force, load);
        }
    }

    /// K u + C u' in x and y, where the gearbox stands still.
    fn readings(&self) -> [Reading; 2] {
        let along = |matrix: &Planar, axis: usize| {
            let mut row = Row::default();
            for (factor, relative) in matrix.rows()[axis].into_iter().zip(&self.relative) {
                row.add(factor, relative);
            }
            row
        };
        [0, 1].map(|axis| Reading {
            position: along(&self.stiffness, axis),
            velocity: along(&self.damping, axis),
        })
    }
}

/// Spring and damper in x and y.
#[inline]
fn sum_of(columns: &[[f64; 2]; 4], [x, y, x_rate, y_rate]: [f64; 4]) -> [f64; 2] {
    let [per_x, per_y, per_x_rate, per_y_rate] = columns;
    [0, 1].map(|axis| {
        let spring = per_x[axis] * x + per_y[axis] * y;
        let damper = per_x_rate[axis] * x_rate + per_y_rate[axis] * y_rate;
        spring + damper
    })
}

impl Motion<'_> {
    /// Force of the rotor on the gearbox through a bearing [N]; `input` is the bearing's place among the
    /// inputs.
    pub fn bearing_force(&self, rotor: usize, bearing: &Bearing, input: usize) -> [f64; 2] {
        let read = self.read_force(&self.model.bearing_forces[input], self.inputs.base(input));
        read.unwrap_or_else(|| self.force_by_laws(rotor, bearing, input))
    }

    /// Overwrites the forces of all bearings in the order of the inputs.
    pub fn bearing_forces_into(&self, forces: &mut [[f64; 2]]) {
        let bearings = self.model.bearing_forces.iter().zip(self.inputs.bases());
        for (input, (force, (bearing, &base))) in forces.iter_mut().zip(bearings).enumerate() {
            match self.read_force(bearing, BaseMotion::of(base)) {
                Some(read) => *force = read,
                None => *force = self.force_on_gearbox(input),
            }
        }
    }

    /// The force of the bearing at a place among the inputs.
    pub(super) fn force_on_gearbox(&self, input: usize) -> [f64; 2] {
        let (rotor, bearing) = self.model.bearing_of(input);
        self.bearing_force(rotor, bearing, input)
    }

    /// The force of a linear bearing where the gearbox moves like this beside its vibration; `None` for any other.
    #[inline]
    fn read_force(&self, bearing: &BearingForce, base: BaseMotion) -> Option<[f64; 2]> {
        let first = bearing.reading?;
        let by_gearbox = bearing.by_gearbox(base.plus(&self.vibration).numbers());
        Some([0, 1].map(|axis| self.state.reading(first + axis) - by_gearbox[axis]))
    }

    /// The force of any bearing.
    fn force_by_laws(&self, rotor: usize, bearing: &Bearing, input: usize) -> [f64; 2] {
        let BaseMotion {
            displacement,
            velocity,
        } = self.relative_to_gearbox(bearing, input);
        let (stiffness, damping) = bearing.at_speed(self.speed(rotor));
        let spring = product(&stiffness, displacement);
        let damper = product(&damping, velocity);
        let mut force = [spring[0] + damper[0], spring[1] + damper[1]];
        let mut radial = self.model.radial.iter();
        if let Some(radial) = radial.find(|radial| radial.input == input) {
            let [x, y] = displacement;
            let secant = Stiffness::of(&radial.force, libm::hypot(x, y)).secant;
            force[0] += secant * x;
            force[1] += secant * y;
        }
        force
    }
}
