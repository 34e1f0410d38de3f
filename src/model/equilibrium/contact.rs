//! The static solution where forces are not proportional to displacements: teeth that part, radial bearings.
//!
//! ```text
//!   r(q) = f - K q - sum of b F(w q) = 0            K + mu + tangents of F:  step = (...)^-1 r
//! ```
//!
//! Newton's method, damped in two ways: mu, a soft hold on everything, shrinks with the residual and is dropped at the
//! end; and a step stops where r has no component along it any more. The load is first freed of what only accelerates
//! the rotors together.

use super::super::radial::Stiffness;
use super::super::{Inputs, Mesh, ModalModel, RadialBearing};
use super::NoEquilibrium;
use super::linear::{Held, StaticSpring, free_rotations};
use crate::linalg::{dot, multiply_add};
use crate::solver::Row;

/// mu at the first step [rad^2/s^2]: that of 10 Hz.
const FIRST_HOLD: f64 = 4e3;
/// Part of the first residual from which on nothing is held any more.
const FREE: f64 = 1e-4;
/// Steps after which contact counts as not to be found, and the last step relative to the position.
const MOST_STEPS: usize = 500;
const SETTLED: f64 = 1e-15;
/// A step may turn the residual along it round by this part.
const OVERSHOOT: f64 = 0.1;
/// A step is not cut to less than this part.
const LEAST_PART: f64 = 1e-6;
/// Halvings of the interval in which a step ends.
const HALVINGS: usize = 40;

/// The static laws of meshes and bearings.
pub(super) struct Laws<'a> {
    model: &'a ModalModel,
    inputs: &'a Inputs,
}

impl<'a> Laws<'a> {
    pub(super) fn of(model: &'a ModalModel, inputs: &'a Inputs) -> Laws<'a> {
        Laws { model, inputs }
    }

    /// Whether all forces are proportional to displacements.
    pub(super) fn are_linear(&self) -> bool {
        let one_sided = |mesh: &Mesh| mesh.backlash.is_some();
        self.model.radial.is_empty() && !self.model.meshes.iter().any(one_sided)
    }

    /// Deflection of a mesh's coupling beyond its gap [m].
    fn depth(&self, mesh: &Mesh, coupling: usize, position: &[f64]) -> f64 {
        let deflection = self.model.system.couplings[coupling].row.dot(position);
        let back = coupling > mesh.couplings.start;
        deflection - mesh.backlash.filter(|_| back).unwrap_or(0.0)
    }

    /// Force of the reference flank less that of the back flank [N].
    pub(super) fn mesh_force(&self, mesh: &Mesh, position: &[f64]) -> f64 {
        let depth = |coupling: usize| self.depth(mesh, coupling, position);
        let front = depth(mesh.couplings.start);
        let depth = match mesh.backlash {
            None => front,
            Some(_) => front.max(0.0) - depth(mesh.couplings.start + 1).max(0.0),
        };
        mesh.mean_stiffness() * depth
    }

    /// The laws linearized: springs whose forces agree with the laws at this position.
    pub(super) fn tangent(&self, position: &[f64]) -> Vec<StaticSpring> {
        let mut springs = Vec::new();
        for MeshSpring { spring, gap, .. } in self.mesh_springs(position) {
            springs.push(StaticSpring { gap, ..spring });
        }
        for contact in self.radial_contacts(position) {
            let [outward, across] = contact.directions;
            // F_r' (n u - gap) = F_r at the present radius; across there is no force.
            let gap = contact.radius - contact.force / contact.slope;
            let base = |[x, y]: [f64; 2]| x * contact.base[0] + y * contact.base[1];
            springs.push(contact.spring(outward, contact.slope, gap + base(outward)));
            springs.push(contact.spring(across, contact.secant, base(across)));
        }
        springs
    }

    /// The laws linearized: springs whose forces change as those of the laws when the inputs change.
    pub(super) fn tangent_change(&self, position: &[f64], direction: &Inputs) -> Vec<StaticSpring> {
        let meshes = self.mesh_springs(position).into_iter();
        let mut springs: Vec<StaticSpring> = meshes.map(|one| one.spring).collect();
        for contact in self.radial_contacts(position) {
            let [dx, dy] = direction.base(contact.input).displacement;
            for ([x, y], stiffness) in contact
                .directions
                .into_iter()
                .zip([contact.slope, contact.secant])
            {
                springs.push(contact.spring([x, y], stiffness, x * dx + y * dy));
            }
        }
        springs
    }

    /// The meshes' couplings that carry force.
    fn mesh_springs(&self, position: &[f64]) -> Vec<MeshSpring> {
        let mut springs = Vec::new();
        for mesh in &self.model.meshes {
            for coupling in mesh.couplings.clone() {
                let depth = self.depth(mesh, coupling, position);
                if mesh.backlash.is_none() || depth > 0.0 {
                    let data = &self.model.system.couplings[coupling];
                    springs.push(MeshSpring {
                        spring: StaticSpring {
                            row: data.row.clone(),
                            column: data.column.clone(),
                            stiffness: mesh.mean_stiffness(),
                            gap: 0.0,
                            block: None,
                        },
                        gap: data.row.dot(position) - depth,
                        depth,
                    });
                }
            }
        }
        springs
    }

    /// The radial bearings in contact.
    fn radial_contacts(&self, position: &[f64]) -> Vec<RadialContact<'_>> {
        let couplings = &self.model.system.couplings;
        let contact = |bearing: &RadialBearing| {
            let rows = [0, 1].map(|axis| &couplings[bearing.first_coupling + axis].row);
            let base = self.inputs.base(bearing.input).displacement;
            let [x, y] = [0, 1].map(|axis| rows[axis].dot(position) - base[axis]);
            let radius = libm::hypot(x, y);
            let Stiffness { secant, slope } = Stiffness::of(&bearing.force, radius);
            let outward = if radius > 0.0 {
                [x / radius, y / radius]
            } else {
                [1.0, 0.0]
            };
            (slope > 0.0).then(|| RadialContact {
                input: bearing.input,
                block: bearing.block,
                rows,
                base,
                radius,
                force: secant * radius,
                slope,
                secant: if radius > 0.0 { secant } else { slope },
                directions: [outward, [-outward[1], outward[0]]],
            })
        };
        self.model.radial.iter().filter_map(contact).collect()
    }

    /// r(q).
    fn residual(&self, load: &[f64], position: &[f64]) -> Vec<f64> {
        let mut residual = load.to_vec();
        for block in &self.model.system.blocks {
            let range = block.range();
            let (q, target) = (&position[range.clone()], &mut residual[range]);
            multiply_add(-1.0, block.stiffness.as_slice(), q, target);
        }
        for MeshSpring { spring, depth, .. } in self.mesh_springs(position) {
            spring
                .column
                .add_to(-spring.stiffness * depth, &mut residual);
        }
        for contact in self.radial_contacts(position) {
            for (row, part) in contact.rows.into_iter().zip(contact.directions[0]) {
                row.add_to(-contact.force * part, &mut residual);
            }
        }
        residual
    }

    /// The load without what only accelerates rotors that no mesh holds.
    fn balanced(&self, load: &[f64]) -> Vec<f64> {
        let rows: Vec<&Row> = self
            .model
            .meshes
            .iter()
            .flat_map(|mesh| mesh.couplings.clone())
            .map(|coupling| &self.model.system.couplings[coupling].row)
            .collect();
        let mut balanced = load.to_vec();
        for rotation in free_rotations(self.model, &rows) {
            rotation.add_to(-rotation.dot(load), &mut balanced);
        }
        balanced
    }

    /// The position without residual.
    pub(super) fn settle(&self, load: &[f64]) -> Result<Vec<f64>, NoEquilibrium> {
        let load = self.balanced(load);
        let mut position = vec![0.0; load.len()];
        let mut residual = self.residual(&load, &position);
        let first = norm(&residual);
        let mut before = f64::INFINITY;
        for _ in 0..MOST_STEPS {
            let part = norm(&residual) / first;
            if part == 0.0 || first == 0.0 {
                return Ok(position);
            }
            let target = self.target(&load, &position, part)?;
            let mut step: Vec<f64> = target.iter().zip(&position).map(|(t, q)| t - q).collect();
            if part >= FREE {
                self.shorten(&load, &position, &residual, &mut step);
            }
            for (q, step) in position.iter_mut().zip(&step) {
                *q += step;
            }
            residual = self.residual(&load, &position);
            // Near the end steps become shorter by orders of magnitude, until rounding keeps them from it.
            let length = norm(&step);
            if part < FREE && (length <= SETTLED * norm(&position) || length > 0.5 * before) {
                return Ok(position);
            }
            before = length;
        }
        Err(NoEquilibrium { rotor: None })
    }

    /// Where the linearized equations have no residual, softly held while it is still a large part of the first.
    fn target(&self, load: &[f64], position: &[f64], part: f64) -> Result<Vec<f64>, NoEquilibrium> {
        let springs = self.tangent(position);
        let unheld = (part < FREE).then(|| Held::of(self.model, &springs, 0.0));
        if let Some(Ok(held)) = unheld {
            return held.solve(load, &springs);
        }
        let mu = FIRST_HOLD * part.min(1.0);
        let mut load = load.to_vec();
        load.iter_mut()
            .zip(position)
            .for_each(|(load, q)| *load += mu * q);
        Held::of(self.model, &springs, mu)?.solve(&load, &springs)
    }

    /// Ends a step where the residual along it vanishes.
    fn shorten(&self, load: &[f64], position: &[f64], residual: &[f64], step: &mut [f64]) {
        let along = |part: f64| {
            let at = position.iter().zip(&*step).map(|(q, step)| q + part * step);
            dot(step, &self.residual(load, &at.collect::<Vec<f64>>()))
        };
        if along(1.0) >= -OVERSHOOT * dot(step, residual).abs() {
            return;
        }
        let (mut low, mut high) = (0.0, 1.0);
        for _ in 0..HALVINGS {
            let middle = 0.5 * (low + high);
            if along(middle) > 0.0 {
                low = middle;
            } else {
                high = middle;
            }
        }
        // Nothing to be gained along the step: what is left of the residual is rounding.
        let part = if high < LEAST_PART { 1.0 } else { high };
        step.iter_mut().for_each(|step| *step *= part);
    }
}

/// A mesh as a spring along one of its couplings.
struct MeshSpring {
    /// The spring, without its gap.
    spring: StaticSpring,
    gap: f64,
    /// Deflection beyond the gap [m].
    depth: f64,
}

/// A radial bearing in contact.
struct RadialContact<'a> {
    input: usize,
    block: usize,
    /// x and y.
    rows: [&'a Row; 2],
    /// Displacement of the gearbox [m].
    base: [f64; 2],
    /// r [m].
    radius: f64,
    /// F_r [N].
    force: f64,
    /// dF_r/dr and F_r / r [N/m].
    slope: f64,
    secant: f64,
    /// Outward and across.
    directions: [[f64; 2]; 2],
}

impl RadialContact<'_> {
    fn spring(&self, [x, y]: [f64; 2], stiffness: f64, gap: f64) -> StaticSpring {
        let mut row = Row::default();
        row.add(x, self.rows[0]);
        row.add(y, self.rows[1]);
        StaticSpring {
            column: row.clone(),
            row,
            stiffness,
            gap,
            block: Some(self.block),
        }
    }
}

fn norm(vector: &[f64]) -> f64 {
    dot(vector, vector).sqrt()
}
