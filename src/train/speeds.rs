//! Meshes tie speeds together: Om_b = -Om_a z_a / z_b, or +Om_a z_a / z_b in a ring b.

use super::{GearAddress, GearTrain, Mesh, Rotor};
use crate::config::{Place, Problem};

/// Highest mesh frequency [Hz]: a step ends at every breakpoint of the stiffness.
const FASTEST_MESH: f64 = 1e6;
/// Largest relative deviation of speeds and base radii from the ratio of the teeth: files give seven digits.
const RATIO_TOLERANCE: f64 = 1e-6;

/// The speed of a rotor as a multiple of the speed of the first rotor it is meshed with.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SpeedRatio {
    /// Index of the first rotor of the connected train; a rotor without meshes leads itself.
    pub leader: usize,
    /// Speed of this rotor per speed of the leader.
    pub ratio: f64,
}

/// One mesh seen as a transmission between two rotors.
#[derive(Debug, Clone, Copy)]
struct Transmission {
    /// Rotor a and rotor b.
    rotors: [usize; 2],
    /// Om_b / Om_a.
    ratio: f64,
}

/// A mesh that closes a loop with another ratio than the way around it.
struct Contradiction {
    /// Index of the transmission.
    transmission: usize,
    /// Its ratio around the other way.
    other_ratio: f64,
    /// The transmissions of the other way.
    around: Vec<usize>,
}

/// What is known of a rotor that the spreading has reached.
#[derive(Clone)]
struct Reached {
    ratio: SpeedRatio,
    /// The transmissions from the leader to it.
    way: Vec<usize>,
}

/// Ratios of `count` rotors, spreading from the first rotor of each connected train.
fn spread(count: usize, transmissions: &[Transmission]) -> Vec<Reached> {
    let mut found: Vec<Option<Reached>> = vec![None; count];
    for leader in 0..count {
        if found[leader].is_some() {
            continue;
        }
        let start = Reached {
            ratio: SpeedRatio { leader, ratio: 1.0 },
            way: Vec::new(),
        };
        found[leader] = Some(start.clone());
        let mut pending = vec![(leader, start)];
        while let Some((rotor, own)) = pending.pop() {
            for (index, transmission) in transmissions.iter().enumerate() {
                let [a, b] = transmission.rotors;
                let (other, ratio) = match rotor {
                    _ if rotor == a => (b, own.ratio.ratio * transmission.ratio),
                    _ if rotor == b => (a, own.ratio.ratio / transmission.ratio),
                    _ => continue,
                };
                if found[other].is_none() {
                    let mut next = own.clone();
                    next.ratio.ratio = ratio;
                    next.way.push(index);
                    found[other] = Some(next.clone());
                    pending.push((other, next));
                }
            }
        }
    }
    found.into_iter().flatten().collect()
}

/// Loops of meshes that cannot turn.
fn contradictions(reached: &[Reached], transmissions: &[Transmission]) -> Vec<Contradiction> {
    let contradiction = |(index, transmission): (usize, &Transmission)| {
        let [a, b] = transmission.rotors.map(|rotor| &reached[rotor]);
        let other_ratio = b.ratio.ratio / a.ratio.ratio;
        // The way from the leader that both have in common is not part of the loop.
        let only = |one: &Reached, other: &Reached| -> Vec<usize> {
            let own = one.way.iter().filter(|step| !other.way.contains(step));
            own.copied().collect()
        };
        let deviation = (other_ratio / transmission.ratio - 1.0).abs();
        (deviation > RATIO_TOLERANCE).then(|| Contradiction {
            transmission: index,
            other_ratio,
            around: [only(a, b), only(b, a)].concat(),
        })
    };
    transmissions
        .iter()
        .enumerate()
        .filter_map(contradiction)
        .collect()
}

/// The meshes as transmissions.
fn transmissions(rotors: &[Rotor], meshes: &[Mesh]) -> Vec<Transmission> {
    let transmission = |mesh: &Mesh| {
        let [a, b] = mesh.gears.map(|gear| f64::from(teeth(rotors, gear)));
        let sense = if mesh.line.is_internal() { 1.0 } else { -1.0 };
        Transmission {
            rotors: mesh.gears.map(|gear| gear.rotor),
            ratio: sense * a / b,
        }
    };
    meshes.iter().map(transmission).collect()
}

fn teeth(rotors: &[Rotor], gear: GearAddress) -> u32 {
    rotors[gear.rotor].gears[gear.gear].teeth
}

/// The speed ratios of a valid train, one per rotor.
pub fn speed_ratios(train: &GearTrain) -> Vec<SpeedRatio> {
    let transmissions = transmissions(&train.rotors, &train.meshes);
    let reached = spread(train.rotors.len(), &transmissions);
    reached.into_iter().map(|rotor| rotor.ratio).collect()
}

/// Speeds must fit the tooth numbers, around loops too, and no mesh may be too fast.
pub(super) fn check_speeds(rotors: &[Rotor], meshes: &[Mesh], problems: &mut Vec<Problem>) {
    let transmissions = transmissions(rotors, meshes);
    let place = |index: usize| Place::root().element("mesh", index, Some(&meshes[index].name));
    let stuck = contradictions(&spread(rotors.len(), &transmissions), &transmissions);
    for Contradiction {
        transmission,
        other_ratio,
        around,
    } in &stuck
    {
        let ways: Vec<String> = around
            .iter()
            .map(|&index| format!("\"{}\"", meshes[index].name))
            .collect();
        let message = format!(
            "gears: closes a loop of meshes that cannot turn: the speed ratio is {} here and {other_ratio} the \
             other way around, through {}; change tooth numbers, or take a mesh out of the loop",
            transmissions[*transmission].ratio,
            ways.join(", ")
        );
        problems.push(place(*transmission).problem("gears", message));
    }
    for (index, (mesh, transmission)) in meshes.iter().zip(&transmissions).enumerate() {
        let [a, b] = transmission.rotors.map(|rotor| &rotors[rotor]);
        let expected = a.speed * transmission.ratio;
        let fits =
            (b.speed - expected).abs() <= RATIO_TOLERANCE * expected.abs().max(b.speed.abs());
        if !fits && stuck.iter().all(|one| one.transmission != index) {
            let [teeth_a, teeth_b] = mesh.gears.map(|gear| teeth(rotors, gear));
            let kind = if mesh.line.is_internal() {
                " in a ring"
            } else {
                ""
            };
            let message = format!(
                "gears: {teeth_a} : {teeth_b} teeth{kind} ask for a speed of {expected} rad/s of rotor \"{}\" (that \
                 of \"{}\" is {} rad/s), found {} rad/s",
                b.name, a.name, a.speed, b.speed
            );
            problems.push(place(index).problem("gears", message));
        }
        let rate = mesh.phase_rate.abs();
        if rate > FASTEST_MESH {
            let message = format!(
                "gears: their teeth pass with {rate} Hz, at most {FASTEST_MESH} Hz can be followed"
            );
            problems.push(place(index).problem("gears", message));
        }
    }
}

/// Meshes whose base radii are not in the ratio of their teeth: their base pitches 2 pi R / z differ, so that such
/// teeth cannot roll on each other without slipping a little at every tooth. Harmless while speeds are prescribed.
pub(super) fn unequal_base_pitches(train: &GearTrain) -> Vec<Problem> {
    let mut problems = Vec::new();
    for (index, mesh) in train.meshes.iter().enumerate() {
        let [a, b] = mesh.gears.map(|gear| train.gear(gear));
        let [ratio, expected] = [
            a.base_radius / b.base_radius,
            f64::from(a.teeth) / f64::from(b.teeth),
        ];
        if (ratio / expected - 1.0).abs() > RATIO_TOLERANCE {
            let place = Place::root().element("mesh", index, Some(&mesh.name));
            let message = format!(
                "gears: base radii of {} m and {} m have the ratio {ratio}, their {} : {} teeth have {expected}: such \
                 teeth do not fit each other; change a base_radius",
                a.base_radius, b.base_radius, a.teeth, b.teeth
            );
            problems.push(place.problem("gears", message));
        }
    }
    problems
}
