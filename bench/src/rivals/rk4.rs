//! The classical Runge-Kutta method of fourth order with fixed steps.

use super::widest;
use crate::problem::{Problem, Run};

/// `steps` steps in every interval between two of the problem's times.
pub fn run(problem: &Problem, steps: u64) -> Run {
    widest(
        #[inline(always)]
        || {
            let mut stages = Stages::new(problem.start.len());
            problem.run(
                #[inline(always)]
                |x, [start, end]| {
                    let step = (end - start) / steps as f64;
                    for number in 0..steps {
                        stages.step(problem, start + number as f64 * step, step, x);
                    }
                    steps
                },
            )
        },
    )
}

/// Derivatives and the point where the next one is taken.
struct Stages {
    slopes: [Vec<f64>; 4],
    point: Vec<f64>,
}

impl Stages {
    fn new(size: usize) -> Stages {
        let zeros = || vec![0.0; size];
        Stages {
            slopes: [zeros(), zeros(), zeros(), zeros()],
            point: zeros(),
        }
    }

    #[inline(always)]
    fn step(&mut self, problem: &Problem, time: f64, step: f64, x: &mut [f64]) {
        let Stages {
            slopes: [k1, k2, k3, k4],
            point,
        } = self;
        let equations = &problem.equations;
        equations.evaluate(time, x, k1);
        advance(x, 0.5 * step, k1, point);
        equations.evaluate(time + 0.5 * step, point, k2);
        advance(x, 0.5 * step, k2, point);
        equations.evaluate(time + 0.5 * step, point, k3);
        advance(x, step, k3, point);
        equations.evaluate(time + step, point, k4);
        let slopes = k1.iter().zip(k2).zip(k3).zip(k4);
        for (x, (((k1, k2), k3), k4)) in x.iter_mut().zip(slopes) {
            *x += step / 6.0 * (*k1 + 2.0 * (*k2 + *k3) + *k4);
        }
    }
}

/// point = x + step slope.
#[inline(always)]
fn advance(x: &[f64], step: f64, slope: &[f64], point: &mut [f64]) {
    for ((point, x), slope) in point.iter_mut().zip(x).zip(slope) {
        *point = x + step * slope;
    }
}
