//! What the solver's error control watches.

use super::radial::{RadialBearing, Stiffness};
use super::spin::Spin;
use super::{Mesh, Rotor};
use crate::solver::{Monitor, Row, System};

/// A mesh force counts as zero where the teeth are pressed by less than this [m].
const SMALLEST_DEFLECTION: f64 = 1e-12;
/// Depth of contact [m] at which a bearing's force is judged as a spring.
const TYPICAL_DEPTH: f64 = 1e-5;
/// Modal coordinates below this [m sqrt(kg)] count as zero.
const SMALLEST_MOTION: f64 = 1e-12;

/// The tolerance holds for the mesh forces; on rotors without a mesh for the motion at bearings and of
/// everything that turns. Forces of bearings that are not linear, on rotors with meshes, are to be right beside the
/// forces of these: what they shake slowly, the meshes feel much later.
pub(super) fn monitors(
    system: &System,
    rotors: &[Rotor],
    meshes: &[Mesh],
    radial: &[RadialBearing],
    spins: &[Spin],
) -> Vec<Monitor> {
    let mut monitors: Vec<Monitor> = meshes.iter().map(|mesh| of_mesh(system, mesh)).collect();
    let meshes_of = |index: usize| -> Vec<usize> {
        let numbered = meshes.iter().enumerate();
        let own = numbered.filter(|(_, mesh)| mesh.gears.iter().any(|gear| gear.rotor == index));
        own.map(|(number, _)| number).collect()
    };
    let mut input = 0;
    for (index, rotor) in rotors.iter().enumerate() {
        let inputs = input..input + rotor.bearings.len();
        input = inputs.end;
        let own_meshes = meshes_of(index);
        let own = radial
            .iter()
            .filter(|bearing| inputs.contains(&bearing.input));
        monitors.extend(own.map(|bearing| of_bearing(system, bearing, own_meshes.clone())));
        if !own_meshes.is_empty() {
            continue;
        }
        // Unbalance, bow and gyroscopic moment of a rotor that turns freely: its lateral coordinates follow them.
        let spin = spins.iter().find(|spin| spin.rotor == index);
        let motion = spin.map_or(0..0, |spin| spin.first..spin.first + 2 * spin.n);
        let bearings = rotor.bearings.iter().flat_map(|bearing| &bearing.relative);
        let stations = rotor
            .gears
            .iter()
            .chain(&rotor.probes)
            .map(|station| &station.theta);
        monitors.extend(
            bearings
                .chain(stations)
                .chain(&rotor.torques)
                .map(|row| Monitor {
                    couplings: 0..0,
                    beside: Vec::new(),
                    motion: motion.clone(),
                    row: row.clone(),
                    damping_ratio: lightest_damping(system, row, 0.0, 0.0, 0.0),
                    frequency: 0.0,
                    rate_weight: 0.0,
                    stiffness: 0.0,
                    impedance: 0.0,
                    floor: SMALLEST_MOTION,
                }),
        );
    }
    monitors
}

fn of_mesh(system: &System, mesh: &Mesh) -> Monitor {
    let (k, c) = (mesh.mean_stiffness(), mesh.damping);
    let own = k * mesh.row.dot_row(&mesh.row); // squared frequency of the mesh by itself
    let flanks = if mesh.backlash.is_some() { 2 } else { 1 };
    Monitor {
        couplings: mesh.couplings.start..mesh.couplings.start + flanks,
        beside: Vec::new(),
        motion: 0..0,
        row: mesh.row.clone(),
        damping_ratio: lightest_damping(system, &mesh.row, k, c, 0.25 * own),
        frequency: own.sqrt(),
        rate_weight: c / k,
        stiffness: if mesh.backlash.is_some() { k } else { 0.0 },
        impedance: impedance(k, own),
        floor: k * SMALLEST_DEFLECTION,
    }
}

fn of_bearing(system: &System, bearing: &RadialBearing, beside: Vec<usize>) -> Monitor {
    let row = &system.couplings[bearing.first_coupling].row;
    let k = Stiffness::of(&bearing.force, bearing.force.clearance + TYPICAL_DEPTH).secant;
    let own = k * row.dot_row(row);
    Monitor {
        couplings: bearing.first_coupling..bearing.first_coupling + 2,
        beside,
        motion: 0..0,
        row: row.clone(),
        damping_ratio: lightest_damping(system, row, k, 0.0, 0.25 * own),
        frequency: own.sqrt(),
        rate_weight: 0.0,
        stiffness: k,
        impedance: impedance(k, own),
        floor: k * SMALLEST_DEFLECTION,
    }
}

/// Force per rate [N s/m] of a spring k that vibrates with a squared frequency.
fn impedance(k: f64, squared: f64) -> f64 {
    if squared > 0.0 {
        k / squared.sqrt()
    } else {
        0.0
    }
}

/// Damping ratio of the most lightly damped motion that a row takes part in above a squared frequency
/// [rad^2/s^2], each modal coordinate by itself with a spring k and a damper c along the row:
/// w_i^2 = K_ii + k w_i^2, 2 zeta_i w_i = D_ii + c w_i^2.
fn lightest_damping(system: &System, row: &Row, k: f64, c: f64, above: f64) -> f64 {
    let mut lightest = f64::INFINITY;
    for block in &system.blocks {
        for i in 0..block.len() {
            let share = row.entry(block.offset + i);
            let squared = block.stiffness[(i, i)] + k * share * share;
            if share != 0.0 && squared > above {
                let damping = block.damping[(i, i)] + c * share * share;
                lightest = lightest.min(0.5 * damping / squared.sqrt());
            }
        }
    }
    if lightest.is_finite() { lightest } else { 0.0 }
}
