//! What the couplings see and exert in one step.

use nalgebra::Complex;

use super::super::{Instant, Monitor};
use super::exchange::{Exchange, Influences};
use super::polynomials::{END, NODES, POINTS};

/// One entry per coupling in every list; deflections and rates in pairs.
#[derive(Debug, Clone)]
pub(super) struct Sight {
    /// At the start of the step.
    pub(super) start: [Vec<f64>; 2],
    /// At the points, without the forces.
    pub(super) free: [[Vec<f64>; 2]; POINTS],
    /// At the points.
    pub(super) points: [[Vec<f64>; 2]; POINTS],
    /// Between two points, or at the end as it would be with what is missing in the forces.
    pub(super) trial: [Vec<f64>; 2],
    /// Forces at the nodes.
    pub(super) forces: Vec<[f64; NODES]>,
    /// Forces at one instant.
    pub(super) present: Vec<f64>,
    /// e^(i angle) of every harmonic at the start of the step.
    pub(super) angles: Vec<Complex<f64>>,
}

impl Sight {
    pub(super) fn new(couplings: usize, harmonics: usize) -> Sight {
        let pair = || [vec![0.0; couplings], vec![0.0; couplings]];
        Sight {
            start: pair(),
            free: core::array::from_fn(|_| pair()),
            points: core::array::from_fn(|_| pair()),
            trial: pair(),
            forces: vec![[0.0; NODES]; couplings],
            present: vec![0.0; couplings],
            angles: vec![Complex::new(0.0, 0.0); harmonics],
        }
    }

    /// Deflections and rates at a point under the present forces.
    pub(super) fn look(&mut self, exchange: &Exchange, influences: &Influences, point: usize) {
        copy(&self.free[point], &mut self.points[point]);
        exchange.exert(influences, point, &self.forces, &mut self.points[point]);
    }

    /// The step ends: the end becomes the start.
    pub(super) fn move_on(&mut self, end: usize) {
        copy(&self.points[end], &mut self.start);
        for forces in &mut self.forces {
            forces[0] = forces[NODES - 1];
        }
    }

    /// Mean over the step of the square of what a monitor watches, by the Lobatto weights 1/12, 5/12, 5/12, 1/12.
    pub(super) fn mean_square(&self, monitor: &Monitor) -> f64 {
        let mean = |[first, second, third, last]: [f64; NODES]| {
            (first * first + last * last + 5.0 * (second * second + third * third)) / 12.0
        };
        let [second, third, last] = [0, 1, END].map(|point| &self.points[point][0]);
        let of_motion = |i: usize| mean([self.start[0][i], second[i], third[i], last[i]]);
        let forces = self.forces[monitor.couplings.clone()].iter();
        forces.map(|&forces| mean(forces)).sum::<f64>()
            + monitor.motion.clone().map(of_motion).sum::<f64>()
    }
}

/// Copies deflections and rates.
pub(super) fn copy(source: &[Vec<f64>; 2], target: &mut [Vec<f64>; 2]) {
    for (target, source) in target.iter_mut().zip(source) {
        target.copy_from_slice(source);
    }
}

/// Deflections and rates as the laws see them.
pub(super) fn instant<'a>(seen: &'a [Vec<f64>; 2], time: f64, slow: &'a [f64]) -> Instant<'a> {
    Instant {
        time,
        deflection: &seen[0],
        rate: &seen[1],
        slow,
    }
}
