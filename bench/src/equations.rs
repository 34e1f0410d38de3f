//! The equations of motion as anybody would hand them to a general integrator: x = [q; q'], x' = f(t, x).
//!
//! ```text
//!   q'' = f(t) - D q' - K q - sum over the meshes of w (k(t) d + c d'),   d = w q
//! ```
//!
//! Made from the matrices of the assembled model, with their structure: dense blocks per rotor, short rows per mesh, loads of one
//! frequency in one pass. Nothing is allocated. Checked against the library's own accelerations.

#![allow(clippy::disallowed_methods)] // the platform's sin and cos: the fastest there are

use core::ops::Range;

use geartrain::config::TorqueCoupling;
use geartrain::mesh::StiffnessLaw;
use geartrain::model::ModalModel;
use geartrain::train::GearTrain;
use serde_json::{Value, json};

/// Rows of a matrix that are computed side by side.
const LANES: usize = 4;

/// f(t, x) of a train with linear contact at prescribed speed.
#[derive(Debug, Clone)]
pub struct Equations {
    size: usize,
    blocks: Vec<Panel>,
    meshes: Vec<Mesh>,
    held: Vec<f64>,
    harmonics: Vec<Harmonic>,
}

/// [K D] of one block: `LANES` rows at a time, column after column.
#[derive(Debug, Clone)]
struct Panel {
    range: Range<usize>,
    strips: Vec<Vec<Columns>>,
}

/// Some rows of K and of D in one column.
#[derive(Debug, Clone, Copy, Default)]
struct Columns {
    stiffness: [f64; LANES],
    damping: [f64; LANES],
}

#[derive(Debug, Clone)]
struct Mesh {
    row: Vec<Part>,
    law: StiffnessLaw,
    factor: f64,
    damping: f64,
    start_phase: f64,
    phase_rate: f64,
}

/// The entries of a row that lie together.
#[derive(Debug, Clone)]
struct Part {
    range: Range<usize>,
    values: Vec<f64>,
}

/// All loads of one circular frequency.
#[derive(Debug, Clone)]
struct Harmonic {
    frequency: f64,
    /// Load along the cosine and along the sine of each coordinate.
    load: Vec<[f64; 2]>,
}

impl Equations {
    /// The equations of a train under these torques; the gearbox moves only as the file says.
    ///
    /// # Panics
    /// The train has something that does not fit into this form: free spin, contact that opens, transmission errors,
    /// bearings with a radial force.
    pub fn of(train: &GearTrain, model: &ModalModel, torques: &[f64]) -> Equations {
        let system = &model.system;
        let linear = train.meshes.iter().all(|mesh| {
            mesh.backlash.is_none()
                && mesh.torque_coupling == TorqueCoupling::Consistent
                && mesh.transmission_error.is_zero()
        });
        let only_meshes = system.couplings.len() == train.meshes.len();
        assert!(linear && only_meshes && !model.is_free(), "not linear");
        let mut held = vec![0.0; system.size];
        for (row, &torque) in model.torques().zip(torques) {
            row.add_to(torque, &mut held);
        }
        let meshes = train.meshes.iter().zip(&system.couplings);
        Equations {
            size: system.size,
            blocks: system.blocks.iter().map(Panel::of).collect(),
            meshes: meshes
                .map(|(mesh, coupling)| Mesh {
                    row: parts(&coupling.row.to_dense(system.size)),
                    law: mesh.stiffness.clone(),
                    factor: mesh.stiffness_factor,
                    damping: mesh.damping,
                    start_phase: mesh.start_phase,
                    phase_rate: mesh.phase_rate,
                })
                .collect(),
            held,
            harmonics: harmonics(model),
        }
    }

    /// Number of equations: the length of x.
    pub fn order(&self) -> usize {
        2 * self.size
    }

    /// f(t, x) into `derivative`.
    #[inline(always)] // into integrators compiled for a vector width
    pub fn evaluate(&self, time: f64, x: &[f64], derivative: &mut [f64]) {
        let load = &mut derivative[self.size..];
        load.copy_from_slice(&self.held);
        for harmonic in &self.harmonics {
            let (sine, cosine) = (harmonic.frequency * time).sin_cos();
            for (entry, [c, s]) in load.iter_mut().zip(&harmonic.load) {
                *entry += c * cosine + s * sine;
            }
        }
        self.add_linear(time, x, derivative);
    }

    /// df/dx times a direction.
    pub fn apply_jacobian(&self, time: f64, direction: &[f64], change: &mut [f64]) {
        change.fill(0.0);
        self.add_linear(time, direction, change);
    }

    /// Column number `column` of df/dx.
    pub fn jacobian_column(&self, time: f64, column: usize) -> Vec<f64> {
        let (mut direction, mut change) = (vec![0.0; self.order()], vec![0.0; self.order()]);
        direction[column] = 1.0;
        self.apply_jacobian(time, &direction, &mut change);
        change
    }

    /// The part of f that is linear in x; the displacements' rates are overwritten.
    #[inline(always)]
    fn add_linear(&self, time: f64, x: &[f64], derivative: &mut [f64]) {
        let (q, v) = x.split_at(self.size);
        let (dq, dv) = derivative.split_at_mut(self.size);
        dq.copy_from_slice(v);
        for block in &self.blocks {
            let range = block.range.clone();
            block.subtract(&q[range.clone()], &v[range.clone()], &mut dv[range]);
        }
        for mesh in &self.meshes {
            let force = mesh.force(time, q, v);
            for part in &mesh.row {
                for (entry, w) in dv[part.range.clone()].iter_mut().zip(&part.values) {
                    *entry -= w * force;
                }
            }
        }
    }

    /// The matrices and loads for a program in another language; k of every mesh at `points` + 1 phases of a pitch.
    pub fn to_json(&self, points: u32) -> Value {
        let alone = Equations {
            meshes: Vec::new(),
            ..self.clone()
        };
        let columns = |first: usize| -> Vec<Vec<f64>> {
            let column = |j: usize| {
                let column = alone.jacobian_column(0.0, j);
                column[self.size..].iter().map(|entry| -entry).collect()
            };
            (first..first + self.size).map(column).collect()
        };
        let of_meshes =
            |value: fn(&Mesh) -> f64| -> Vec<f64> { self.meshes.iter().map(value).collect() };
        let along = |part: usize| -> Vec<Vec<f64>> {
            let load = |harmonic: &Harmonic| harmonic.load.iter().map(|load| load[part]).collect();
            self.harmonics.iter().map(load).collect()
        };
        let row = |mesh: &Mesh| {
            let mut row = vec![0.0; self.size];
            for part in &mesh.row {
                row[part.range.clone()].copy_from_slice(&part.values);
            }
            row
        };
        let over_phase = |mesh: &Mesh| -> Vec<f64> {
            let at = |point| mesh.stiffness(f64::from(point) / f64::from(points));
            (0..=points).map(at).collect()
        };
        json!({
            "stiffness_columns": columns(0),
            "damping_columns": columns(self.size),
            "rows": self.meshes.iter().map(row).collect::<Vec<_>>(),
            "held": self.held,
            "mesh_damping": of_meshes(|mesh| mesh.damping),
            "start_phase": of_meshes(|mesh| mesh.start_phase),
            "phase_rate": of_meshes(|mesh| mesh.phase_rate),
            "stiffness_over_phase": self.meshes.iter().map(over_phase).collect::<Vec<_>>(),
            "frequency": self.harmonics.iter().map(|harmonic| harmonic.frequency).collect::<Vec<_>>(),
            "cosine": along(0),
            "sine": along(1),
        })
    }

    /// Mesh forces [N] in a state.
    pub fn mesh_forces(&self, time: f64, x: &[f64]) -> impl Iterator<Item = f64> {
        let (q, v) = x.split_at(self.size);
        self.meshes.iter().map(move |mesh| mesh.force(time, q, v))
    }
}

impl Panel {
    fn of(block: &geartrain::solver::Block) -> Panel {
        let n = block.len();
        let strip = |first: usize| {
            let column = |j: usize| {
                let mut columns = Columns::default();
                for i in first..n.min(first + LANES) {
                    columns.stiffness[i - first] = block.stiffness[(i, j)];
                    columns.damping[i - first] = block.damping[(i, j)];
                }
                columns
            };
            (0..n).map(column).collect()
        };
        Panel {
            range: block.range(),
            strips: (0..n).step_by(LANES).map(strip).collect(),
        }
    }

    /// target -= K q + D v.
    #[inline(always)]
    fn subtract(&self, q: &[f64], v: &[f64], target: &mut [f64]) {
        for (strip, target) in self.strips.iter().zip(target.chunks_mut(LANES)) {
            let mut sums = [[0.0; LANES]; 2];
            for ((columns, q), v) in strip.iter().zip(q).zip(v) {
                add(q, &columns.stiffness, &mut sums[0]);
                add(v, &columns.damping, &mut sums[1]);
            }
            for (lane, entry) in target.iter_mut().enumerate() {
                *entry -= sums[0][lane] + sums[1][lane];
            }
        }
    }
}

#[inline(always)]
fn add(scale: &f64, lanes: &[f64; LANES], sums: &mut [f64; LANES]) {
    for (sum, lane) in sums.iter_mut().zip(lanes) {
        *sum += scale * lane;
    }
}

impl Mesh {
    #[inline(always)]
    fn stiffness(&self, phase: f64) -> f64 {
        let cycle = phase - phase.floor();
        self.factor * self.law.value(cycle, self.law.piece(cycle))
    }

    #[inline(always)]
    fn force(&self, time: f64, q: &[f64], v: &[f64]) -> f64 {
        let k = self.stiffness(self.start_phase + self.phase_rate * time);
        let (mut deflection, mut rate) = (0.0, 0.0);
        for part in &self.row {
            let motion = q[part.range.clone()].iter().zip(&v[part.range.clone()]);
            for ((q, v), w) in motion.zip(&part.values) {
                deflection += w * q;
                rate += w * v;
            }
        }
        k * deflection + self.damping * rate
    }
}

/// The stretches of a row that are not zero.
fn parts(row: &[f64]) -> Vec<Part> {
    let mut parts: Vec<Part> = Vec::new();
    for (index, &value) in row.iter().enumerate().filter(|(_, value)| **value != 0.0) {
        match parts.last_mut() {
            Some(part) if part.range.end == index => {
                part.range.end += 1;
                part.values.push(value);
            }
            _ => parts.push(Part {
                range: index..index + 1,
                values: vec![value],
            }),
        }
    }
    parts
}

/// The model's harmonic loads, those of one frequency together whichever way they turn.
fn harmonics(model: &ModalModel) -> Vec<Harmonic> {
    let mut harmonics: Vec<Harmonic> = Vec::new();
    for load in model.harmonics() {
        let frequency = load.frequency.abs();
        let known = harmonics
            .iter()
            .position(|known| known.frequency == frequency);
        let index = known.unwrap_or_else(|| {
            let load = vec![[0.0; 2]; model.system.size];
            harmonics.push(Harmonic { frequency, load });
            harmonics.len() - 1
        });
        let (sine, cosine) = load.phase.sin_cos();
        let sign = load.frequency.signum();
        let target = &mut harmonics[index].load[load.offset..];
        for ((target, c), s) in target.iter_mut().zip(&load.cosine).zip(&load.sine) {
            // c cos(sign w t + phase) + s sin(sign w t + phase), expanded.
            target[0] += c * cosine + s * sine;
            target[1] += sign * (s * cosine - c * sine);
        }
    }
    harmonics
}
