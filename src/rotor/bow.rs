//! The force of a residual bow: the shaft at rest is not straight.
//!
//! ```text
//!   K_s (x - x_bow):  the bow acts as the force K_s r, r = offsets of the unloaded centre line
//!   offsets r_c are given at some stations; the rest r_f (slopes too) takes the shape of least strain energy:
//!   r' K_s r -> min:   K_ff r_f + K_fc r_c = 0
//!   force at the given stations   S r_c,  S = K_cc - K_cf K_ff^-1 K_fc;    none anywhere else
//! ```
//!
//! A straight shaft through the offsets costs no energy: rigid parts of r_c give no force. The force turns with the
//! shaft: K_s r cos(phi + psi) in x, K_s r sin(phi + psi) in y.

use nalgebra::{DMatrix, DVector};

use super::FiniteElements;
use crate::config::Bow;

/// K_s r, one plane [N, N m]; `None` when the stiffness cannot be condensed.
pub(super) fn force(elements: &FiniteElements, bow: &Bow) -> Option<DVector<f64>> {
    let stiffness = &elements.shaft_stiffness;
    let mut force = DVector::zeros(stiffness.nrows());
    if bow.positions.len() < 3 {
        return Some(force); // a straight shaft passes through two offsets
    }
    let given: Vec<usize> = bow
        .positions
        .iter()
        .map(|&position| 2 * elements.stations.at(position))
        .collect();
    let free: Vec<usize> = (0..stiffness.nrows())
        .filter(|index| !given.contains(index))
        .collect();
    let part = |rows: &[usize], columns: &[usize]| {
        DMatrix::from_fn(rows.len(), columns.len(), |i, j| {
            stiffness[(rows[i], columns[j])]
        })
    };
    let offsets = without_chord(elements, bow, &given);
    let follow = part(&free, &free)
        .cholesky()?
        .solve(&(part(&free, &given) * &offsets)); // -r_f
    let reaction = part(&given, &given) * offsets - part(&given, &free) * follow;
    for (&index, value) in given.iter().zip(&reaction) {
        force[index] = *value;
    }
    Some(force)
}

/// The offsets from the chord through the first and the last of them: without it, rigid parts leave no rounding.
fn without_chord(elements: &FiniteElements, bow: &Bow, given: &[usize]) -> DVector<f64> {
    let z: Vec<f64> = given
        .iter()
        .map(|&index| elements.stations.positions()[index / 2])
        .collect();
    let last = z.len() - 1;
    let (start, end) = (bow.amplitudes[0], bow.amplitudes[last]);
    let tilt = (end - start) / (z[last] - z[0]);
    let offset = |(z_i, amplitude): (&f64, &f64)| amplitude - start - tilt * (z_i - z[0]);
    DVector::from_iterator(z.len(), z.iter().zip(&bow.amplitudes).map(offset))
}
