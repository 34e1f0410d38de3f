//! Where the shafts of a train stand in a picture seen from the side: unfolded, one below the other.
//!
//! Along z, meshing gears stand opposite each other. Downwards, a shaft and its neighbour are one centre distance apart
//! where their gears mesh; otherwise there is room between them.

use super::bodies::extent;
use crate::train::{GearTrain, Mesh};

/// The place of one shaft.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Place {
    /// Its left end along z [m].
    pub(super) left: f64,
    /// Its centre line, downwards [m].
    pub(super) down: f64,
}

/// The shafts, unfolded.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Stack {
    /// One per rotor.
    pub(super) places: Vec<Place>,
    /// Meshes whose gears touch in the picture.
    pub(super) touching: Vec<bool>,
}

impl Stack {
    /// `room`: least distance of two centre lines [m].
    pub(super) fn of(train: &GearTrain, room: f64) -> Stack {
        let count = train.rotors.len();
        let mut order = Vec::new();
        let mut lefts: Vec<Option<f64>> = vec![None; count];
        for leader in 0..count {
            if lefts[leader].is_none() {
                lefts[leader] = Some(0.0);
                order.extend(unfolded(train, leader, &mut lefts));
            }
        }
        let lefts: Vec<f64> = lefts.into_iter().flatten().collect();
        let first = lefts.iter().copied().fold(f64::INFINITY, f64::min);
        let mut places: Vec<Place> = lefts
            .iter()
            .map(|left| Place {
                left: left - first,
                down: 0.0,
            })
            .collect();
        let mut touching = vec![false; train.meshes.len()];
        for pair in order.windows(2) {
            let [above, below] = [pair[0], pair[1]];
            let apart = extent(&train.rotors[above]) + extent(&train.rotors[below]) + 0.5 * room;
            let meshing = train
                .meshes
                .iter()
                .position(|mesh| touches(mesh, above, below));
            let distance = meshing.map(|index| distance(&train.meshes[index]));
            let close = distance.filter(|&distance| distance >= room);
            if let (Some(index), Some(_)) = (meshing, close) {
                touching[index] = true;
            }
            places[below].down = places[above].down + close.unwrap_or(apart.max(room));
        }
        Stack { places, touching }
    }
}

/// Centre distance [m].
fn distance(mesh: &Mesh) -> f64 {
    let [x, y] = mesh.centre_offset();
    libm::hypot(x, y)
}

fn touches(mesh: &Mesh, one: usize, other: usize) -> bool {
    let [a, b] = mesh.gears.map(|gear| gear.rotor);
    !mesh.line.is_internal() && ((a, b) == (one, other) || (a, b) == (other, one))
}

/// The rotors around `root` from top to bottom: one neighbour above it, one below, and so on down each branch.
fn unfolded(train: &GearTrain, root: usize, lefts: &mut Vec<Option<f64>>) -> Vec<usize> {
    let mut branches = Vec::new();
    while let Some(next) = place_neighbour(train, root, lefts) {
        branches.push(below(train, next, lefts));
    }
    let mut branches = branches.into_iter();
    let down = branches.next().unwrap_or_default();
    let mut order: Vec<usize> = branches.next().unwrap_or_default();
    order.reverse();
    order.push(root);
    order.extend(down);
    order.extend(branches.flatten());
    order
}

/// `top` and the rotors that follow it, downwards.
fn below(train: &GearTrain, top: usize, lefts: &mut Vec<Option<f64>>) -> Vec<usize> {
    let mut order = vec![top];
    while let Some(next) = place_neighbour(train, top, lefts) {
        order.extend(below(train, next, lefts));
    }
    order
}

/// Places the next rotor that meshes with `rotor` and has no place yet.
fn place_neighbour(train: &GearTrain, rotor: usize, lefts: &mut [Option<f64>]) -> Option<usize> {
    let left = lefts[rotor]?;
    for mesh in &train.meshes {
        let [a, b] = mesh.gears;
        for (own, other) in [(a, b), (b, a)] {
            if own.rotor == rotor && lefts[other.rotor].is_none() {
                let opposite = train.gear(own).body.position - train.gear(other).body.position;
                lefts[other.rotor] = Some(left + opposite);
                return Some(other.rotor);
            }
        }
    }
    None
}
