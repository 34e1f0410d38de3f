//! What the solver's error control watches.

use super::{Mesh, Rotor};
use crate::solver::{Monitor, Row, System};

/// The tolerance holds for the mesh forces; on rotors without a mesh for the motion at bearings and of
/// everything that turns.
pub(super) fn monitors(system: &System, rotors: &[Rotor], meshes: &[Mesh]) -> Vec<Monitor> {
    let monitor = |mesh: &Mesh| {
        let (k, c) = (mesh.mean_stiffness(), mesh.damping);
        let own = k * mesh.row.dot_row(&mesh.row); // squared frequency of the mesh by itself
        let damping_ratio = lightest_damping(system, &mesh.row, k, c, 0.25 * own);
        Monitor {
            row: mesh.row.clone(),
            damping_ratio,
            rate_weight: c / k,
        }
    };
    let mut monitors: Vec<Monitor> = meshes.iter().map(monitor).collect();
    let meshed = |index: usize| {
        meshes
            .iter()
            .any(|mesh| mesh.gears.iter().any(|gear| gear.rotor == index))
    };
    for (_, rotor) in rotors
        .iter()
        .enumerate()
        .filter(|(index, _)| !meshed(*index))
    {
        let bearings = rotor
            .bearings
            .iter()
            .flat_map(|bearing| [&bearing.station.x, &bearing.station.y]);
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
                    row: row.clone(),
                    damping_ratio: lightest_damping(system, row, 0.0, 0.0, 0.0),
                    rate_weight: 0.0,
                }),
        );
    }
    monitors
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
