//! The method of Dormand and Prince, order 5(4), with adaptive steps.
//!
//! Coefficients and step control: Hairer, Norsett, Wanner, Solving Ordinary Differential Equations I, table II.5.2 and
//! section II.4.

use super::widest;
use crate::problem::{Problem, Run};

const NODES: [f64; 6] = [0.2, 0.3, 0.8, 8.0 / 9.0, 1.0, 1.0];
const MATRIX: [[f64; 6]; 6] = [
    [1.0 / 5.0, 0.0, 0.0, 0.0, 0.0, 0.0],
    [3.0 / 40.0, 9.0 / 40.0, 0.0, 0.0, 0.0, 0.0],
    [44.0 / 45.0, -56.0 / 15.0, 32.0 / 9.0, 0.0, 0.0, 0.0],
    [
        19372.0 / 6561.0,
        -25360.0 / 2187.0,
        64448.0 / 6561.0,
        -212.0 / 729.0,
        0.0,
        0.0,
    ],
    [
        9017.0 / 3168.0,
        -355.0 / 33.0,
        46732.0 / 5247.0,
        49.0 / 176.0,
        -5103.0 / 18656.0,
        0.0,
    ],
    // The last stage is taken at the solution of fifth order.
    [
        35.0 / 384.0,
        0.0,
        500.0 / 1113.0,
        125.0 / 192.0,
        -2187.0 / 6784.0,
        11.0 / 84.0,
    ],
];
/// Weights of the difference between the solutions of fifth and fourth order.
const ERROR: [f64; 7] = [
    71.0 / 57600.0,
    0.0,
    -71.0 / 16695.0,
    71.0 / 1920.0,
    -17253.0 / 339200.0,
    22.0 / 525.0,
    -1.0 / 40.0,
];

/// Steps such that the estimated error of each stays below `tolerance` times the size of x.
pub fn run(problem: &Problem, tolerance: f64) -> Run {
    widest(
        #[inline(always)]
        || {
            let mut method = Method::new(problem, tolerance);
            problem.run(
                #[inline(always)]
                |x, span| method.advance(problem, x, span),
            )
        },
    )
}

struct Method {
    slopes: [Vec<f64>; 7],
    point: Vec<f64>,
    /// 1 / what an error of each coordinate is compared with.
    weights: Vec<f64>,
    wanted: f64,
}

impl Method {
    fn new(problem: &Problem, tolerance: f64) -> Method {
        let zeros = || vec![0.0; problem.start.len()];
        let mut slopes = core::array::from_fn(|_| zeros());
        problem
            .equations
            .evaluate(0.0, &problem.start, &mut slopes[0]);
        let scale = problem.scale.iter();
        Method {
            slopes,
            point: zeros(),
            weights: scale.map(|scale| 1.0 / (tolerance * scale)).collect(),
            wanted: 1e-6,
        }
    }

    #[inline(always)]
    fn advance(&mut self, problem: &Problem, x: &mut Vec<f64>, [start, end]: [f64; 2]) -> u64 {
        let (mut time, mut tried) = (start, 0);
        while time < end {
            let last = self.wanted >= end - time;
            let step = if last { end - time } else { self.wanted };
            let error = self.try_step(problem, time, step, x);
            tried += 1;
            let ratio = (0.9 / libm::pow(error, 0.2)).clamp(0.2, 5.0);
            if error <= 1.0 {
                core::mem::swap(x, &mut self.point);
                self.slopes.swap(0, 6);
                time = if last { end } else { time + step };
                // A step cut short says nothing about longer ones.
                self.wanted = self.wanted.max(step * ratio);
                if !last {
                    self.wanted = step * ratio;
                }
            } else {
                self.wanted = step * if error.is_nan() { 0.2 } else { ratio.min(1.0) };
            }
        }
        tried
    }

    /// Leaves the new x in `point` and its derivative in the last slope. Gives the error relative to the tolerance.
    #[inline(always)]
    fn try_step(&mut self, problem: &Problem, time: f64, step: f64, x: &[f64]) -> f64 {
        for (stage, (row, node)) in MATRIX.iter().zip(NODES).enumerate() {
            let (known, next) = self.slopes.split_at_mut(stage + 1);
            self.point.copy_from_slice(x);
            for (slope, weight) in known.iter().zip(row).filter(|(_, weight)| **weight != 0.0) {
                for (point, slope) in self.point.iter_mut().zip(slope) {
                    *point += step * weight * slope;
                }
            }
            let equations = &problem.equations;
            equations.evaluate(time + node * step, &self.point, &mut next[0]);
        }
        let mut squares = 0.0;
        for (i, weight) in self.weights.iter().enumerate() {
            let mut sum = 0.0;
            for (slope, part) in self.slopes.iter().zip(ERROR) {
                sum += part * slope[i];
            }
            let error = step * sum * weight;
            squares += error * error;
        }
        (squares / self.weights.len() as f64).sqrt()
    }
}
