//! Steady orbits under loads that turn with the rotors.

use geartrain::model::{ModalModel, Station};
use geartrain::solver::Row;
use nalgebra::{Complex, DVector};

use super::steady_amplitude;

/// Complex amplitudes of q for each turning load of a model at prescribed speed.
pub fn turning_amplitudes(model: &ModalModel) -> Vec<DVector<Complex<f64>>> {
    let size = model.system.size;
    let harmonics = model.harmonics().iter();
    harmonics
        .map(|harmonic| {
            let spread = |load: &[f64]| {
                let mut whole = vec![0.0; size];
                whole[harmonic.offset..][..load.len()].copy_from_slice(load);
                whole
            };
            let (cosine, sine) = (spread(&harmonic.cosine), spread(&harmonic.sine));
            steady_amplitude(model, harmonic.frequency, &cosine, &sine)
        })
        .collect()
}

/// Largest distance from rest [m] that a station reaches under loads of incommensurable frequencies: in the direction a
/// the amplitudes |X cos a + Y sin a| add up, and the worst direction counts.
pub fn largest_radius(
    model: &ModalModel,
    station: &Station,
    amplitudes: &[DVector<Complex<f64>>],
) -> f64 {
    let size = model.system.size;
    let along = |row: &Row, q: &DVector<Complex<f64>>| -> Complex<f64> {
        let dense = row.to_dense(size);
        dense.iter().zip(q.iter()).map(|(&w, &q)| q * w).sum()
    };
    let ellipses: Vec<_> = amplitudes
        .iter()
        .map(|q| (along(&station.x, q), along(&station.y, q)))
        .collect();
    let reach = |direction: u32| {
        let (sine, cosine) = (f64::from(direction) / 720.0 * std::f64::consts::PI).sin_cos();
        let parts = ellipses.iter().map(|(x, y)| {
            let part = x * cosine + y * sine;
            part.re.hypot(part.im)
        });
        parts.sum()
    };
    // 1e-5: half a step of the direction, squared.
    (0..720).map(reach).fold(0.0, f64::max)
}
