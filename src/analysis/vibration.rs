//! Natural vibrations of the coupled train with their shapes: what vibrates, and how.
//!
//! ```text
//!   kinetic energy of coordinate i    |q_i|^2                       mass-normalised coordinates
//!   strain energy                     q* K q = sum over blocks of q_b* K_b q_b + sum over meshes of k |w q|^2
//!   whirl of a rotor                  2 Im sum(conj(b_j) a_j) / sum(|a_j|^2 + |b_j|^2)     +1 about +z, -1 about -z
//! ```
//!
//! * **kind**: `mesh` when the meshes hold the largest of the three strain energies (bending and bearings,
//!   twist, meshes); otherwise lateral, torsional or housing, whichever has most kinetic energy.
//! * **rotor**: the one with the most kinetic energy.
//! * **whirl**: of a lateral vibration, on that rotor, forward when it turns as the rotor does. Motion that is
//!   flatter than an ellipse of 1 : 20 has none, nor has any on a rotor that stands still.
//! * A motion whose strain energy is below that of 0.05 Hz is **rigid**: nothing holds it.

use core::f64::consts::TAU;

use nalgebra::Complex;

use crate::linalg::eigenpairs;
use crate::model::{Coordinates, ModalModel, NaturalVibration};
use crate::solver::Block;

/// q* K q per q* q below which nothing holds a motion [rad^2/s^2]: (2 pi 0.05 Hz)^2.
const RIGID: f64 = 0.1;
/// Whirl of an ellipse of 1 : 20, 2 e / (1 + e^2).
const ROUND: f64 = 0.1;

/// What a vibration bends, twists or presses.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// Shafts and bearings sideways.
    Lateral,
    /// Shafts in torsion.
    Torsional,
    /// The teeth.
    Mesh,
    /// The housing around the rotors.
    Housing,
}

/// Sense of a lateral vibration relative to the rotation of its rotor.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Whirl {
    /// As the rotor turns.
    Forward,
    /// Against it.
    Backward,
}

/// A natural vibration and what takes part in it.
#[derive(Debug, Clone, PartialEq)]
pub struct Vibration {
    /// Frequency and damping.
    pub natural: NaturalVibration,
    /// What it is.
    pub kind: Kind,
    /// Index of the rotor that moves most.
    pub rotor: usize,
    /// Its sense, when it has one.
    pub whirl: Option<Whirl>,
    /// q; scaled to |q| = 1.
    pub shape: Vec<Complex<f64>>,
}

/// All natural vibrations of a train.
#[derive(Debug, Clone, PartialEq)]
pub struct Vibrations {
    /// Those that oscillate, ascending in frequency.
    pub oscillating: Vec<Vibration>,
    /// Those that creep back without oscillating, ascending in |lambda|.
    pub creeping: Vec<Vibration>,
    /// Number of motions that nothing holds, such as the common rotation of all meshed rotors.
    pub rigid: usize,
}

/// The natural vibrations of a model at its speed; `None` when the eigenvalue iteration fails.
pub fn vibrations(model: &ModalModel) -> Option<Vibrations> {
    let n = model.system.size;
    let state = model.state_matrix();
    let mut found = Vibrations {
        oscillating: Vec::new(),
        creeping: Vec::new(),
        rigid: 0,
    };
    let mut rigid_values = 0;
    for pair in eigenpairs(state.matrix)? {
        // q and q' = lambda q are both in the vector; the larger one has the digits.
        let entry = |i: usize| {
            let upper = pair.vector[i] / state.scale[i];
            let lower = pair.vector[n + i];
            if pair.value.norm_sqr() < 1.0 {
                upper
            } else {
                lower / pair.value
            }
        };
        let shape = normalised((0..n).map(entry).collect());
        match vibration_of(model, pair.value, shape) {
            None => rigid_values += if pair.value.im > 0.0 { 2 } else { 1 },
            Some(vibration) if pair.value.im > 0.0 => found.oscillating.push(vibration),
            Some(vibration) => found.creeping.push(vibration),
        }
    }
    found.rigid = rigid_values / 2;
    for list in [&mut found.oscillating, &mut found.creeping] {
        list.sort_by(|one, two| one.natural.frequency.total_cmp(&two.natural.frequency));
    }
    Some(found)
}

fn normalised(mut shape: Vec<Complex<f64>>) -> Vec<Complex<f64>> {
    let size = shape.iter().map(Complex::norm_sqr).sum::<f64>().sqrt();
    for entry in &mut shape {
        *entry /= size;
    }
    shape
}

/// The vibration of an eigenvalue and its shape, |q| = 1; `None` when it is a rigid motion.
pub(super) fn vibration_of(
    model: &ModalModel,
    value: Complex<f64>,
    shape: Vec<Complex<f64>>,
) -> Option<Vibration> {
    let energy = StrainEnergy::of(model, &shape);
    if energy.total().abs() < RIGID {
        return None;
    }
    let moving = |place: &Coordinates| -> f64 {
        let entries = shape[place.range()].iter();
        entries.map(Complex::norm_sqr).sum()
    };
    let kinetic: Vec<[f64; 2]> = model
        .rotors
        .iter()
        .map(|rotor| [moving(&rotor.lateral), moving(&rotor.torsional)])
        .collect();
    let sums = |rotor: &usize| kinetic[*rotor][0] + kinetic[*rotor][1];
    let rotor = (0..kinetic.len())
        .max_by(|one, two| sums(one).total_cmp(&sums(two)))
        .unwrap_or(0);
    let lateral: f64 = kinetic.iter().map(|energies| energies[0]).sum();
    let torsional: f64 = kinetic.iter().map(|energies| energies[1]).sum();
    let places = model.housing.iter().flat_map(|housing| &housing.modes);
    let of_housing: f64 = places.map(|mode| moving(&mode.place)).sum();
    let kind = if energy.mesh > energy.lateral.max(energy.torsional) {
        Kind::Mesh
    } else if of_housing > lateral.max(torsional) {
        Kind::Housing
    } else if lateral >= torsional {
        Kind::Lateral
    } else {
        Kind::Torsional
    };
    let whirl = (kind == Kind::Lateral)
        .then(|| whirl(model, rotor, &shape))
        .flatten();
    Some(Vibration {
        natural: NaturalVibration::of(value),
        kind,
        rotor,
        whirl,
        shape,
    })
}

impl Vibration {
    /// lambda [1/s].
    pub(super) fn eigenvalue(&self) -> Complex<f64> {
        let NaturalVibration {
            frequency,
            damped_frequency,
            damping_ratio,
        } = self.natural;
        Complex::new(-damping_ratio * frequency, damped_frequency) * TAU
    }

    /// |x* y|^2 of the shapes of two vibrations: 1 when they are the same.
    pub(super) fn likeness(&self, other: &Vibration) -> f64 {
        let pairs = self.shape.iter().zip(&other.shape);
        let along: Complex<f64> = pairs.map(|(x, y)| x.conj() * y).sum();
        along.norm_sqr()
    }

    /// Whether two vibrations are one, as far as rounding can tell.
    pub(super) fn is_like(&self, other: &Vibration) -> bool {
        self.likeness(other) > 1.0 - 1e-6
    }
}

/// Where q* K q is.
struct StrainEnergy {
    lateral: f64,
    torsional: f64,
    mesh: f64,
}

impl StrainEnergy {
    fn of(model: &ModalModel, shape: &[Complex<f64>]) -> StrainEnergy {
        let in_block = |block: &Block| -> f64 {
            let q = &shape[block.range()];
            let mut sum = 0.0;
            for (j, right) in q.iter().enumerate() {
                for (i, left) in q.iter().enumerate() {
                    sum += block.stiffness[(i, j)] * (left.re * right.re + left.im * right.im);
                }
            }
            sum
        };
        let twists = |index: usize| {
            let mut rotors = model.rotors.iter();
            rotors.any(|rotor| rotor.torsional.block() == index)
        };
        let blocks = |torsional: bool| -> f64 {
            let blocks = model.system.blocks.iter().enumerate();
            let those = blocks.filter(|&(index, _)| twists(index) == torsional);
            those.map(|(_, block)| in_block(block)).sum()
        };
        let [re, im] = [
            shape.iter().map(|entry| entry.re).collect::<Vec<f64>>(),
            shape.iter().map(|entry| entry.im).collect(),
        ];
        let in_mesh = |mesh: &crate::model::Mesh| {
            let (re, im) = (mesh.row.dot(&re), mesh.row.dot(&im));
            mesh.mean_stiffness() * (re * re + im * im)
        };
        StrainEnergy {
            lateral: blocks(false),
            torsional: blocks(true),
            mesh: model.meshes.iter().map(in_mesh).sum(),
        }
    }

    fn total(&self) -> f64 {
        self.lateral + self.torsional + self.mesh
    }
}

/// x = Re(a e^(i w t)), y = Re(b e^(i w t)): the part that turns about +z is |a + i b|^2, the other |a - i b|^2.
fn whirl(model: &ModalModel, rotor: usize, shape: &[Complex<f64>]) -> Option<Whirl> {
    let rotor = &model.rotors[rotor];
    let n = rotor.counts.lateral;
    let (a, b) = shape[rotor.lateral.range()].split_at(n);
    let turning: f64 = a
        .iter()
        .zip(b)
        .map(|(a, b)| 2.0 * (b.re * a.im - b.im * a.re))
        .sum();
    let all: f64 = a.iter().chain(b).map(Complex::norm_sqr).sum();
    let sense = turning / all * rotor.speed.signum();
    match sense {
        _ if rotor.speed == 0.0 || sense.abs() < ROUND => None,
        _ if sense > 0.0 => Some(Whirl::Forward),
        _ => Some(Whirl::Backward),
    }
}
