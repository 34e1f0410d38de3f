//! How the forces of couplings change what couplings see.
//!
//! Every block that a coupling looks at and another one acts on joins the two. Over all blocks that is a sparse list of
//! **pairs** (sensor, actuator); for one step length each pair has a number for every point of the step, for deflection
//! and rate, and for the force at every node:
//!
//! ```text
//!   d(point) = free response - sum over pairs and nodes of e_d F_actuator(node)          d' likewise with e_v
//! ```

use super::part::Part;
use super::polynomials::{BUBBLES, CHECKS, LAGRANGE, NODES, POINTS, POWERS};

/// A coupling that sees and one that acts.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Pair {
    pub(super) sensor: usize,
    pub(super) actuator: usize,
}

/// All pairs of a system.
#[derive(Debug, Clone)]
pub(super) struct Exchange {
    pub(super) pairs: Vec<Pair>,
    /// For every part the pair of each actuator and sensor, sensors running fastest.
    of_part: Vec<Vec<usize>>,
}

/// What the forces at the nodes do to one pair's sensor: to its deflection, to its rate.
type Influence = [[f64; NODES]; 2];

/// The numbers of all pairs for one step length.
#[derive(Debug, Clone)]
pub(super) struct Influences {
    points: [Vec<Influence>; POINTS],
    /// Deflection and rate at the end per bubble of the force at either check.
    bubbles: Vec<[[f64; CHECKS.len()]; 2]>,
}

impl Exchange {
    pub(super) fn between(parts: &[Part]) -> Exchange {
        let mut pairs: Vec<Pair> = Vec::new();
        let mut of_part = Vec::new();
        for part in parts {
            let mut own = Vec::new();
            for &actuator in &part.actuators {
                for &sensor in &part.sensors {
                    let pair = Pair { sensor, actuator };
                    let known = pairs.iter().position(|&other| other == pair);
                    own.push(known.unwrap_or(pairs.len()));
                    if known.is_none() {
                        pairs.push(pair);
                    }
                }
            }
            of_part.push(own);
        }
        Exchange { pairs, of_part }
    }

    /// Deflections and rates at a point become smaller by what the forces do to them.
    pub(super) fn exert(
        &self,
        influences: &Influences,
        point: usize,
        forces: &[[f64; NODES]],
        [deflection, rate]: &mut [Vec<f64>; 2],
    ) {
        for (pair, [on_deflection, on_rate]) in self.pairs.iter().zip(&influences.points[point]) {
            let force = &forces[pair.actuator];
            deflection[pair.sensor] -= product(on_deflection, force);
            rate[pair.sensor] -= product(on_rate, force);
        }
    }

    /// Deflections and rates at the end become smaller by what is missing in the forces at a check.
    pub(super) fn exert_missing(
        &self,
        influences: &Influences,
        check: usize,
        missing: &[f64],
        [deflection, rate]: &mut [Vec<f64>; 2],
    ) {
        for (pair, [on_deflection, on_rate]) in self.pairs.iter().zip(&influences.bubbles) {
            let force = missing[pair.actuator];
            deflection[pair.sensor] -= on_deflection[check] * force;
            rate[pair.sensor] -= on_rate[check] * force;
        }
    }
}

impl Influences {
    /// Room for the numbers of all pairs.
    pub(super) fn unused(exchange: &Exchange) -> Influences {
        let count = exchange.pairs.len();
        Influences {
            points: core::array::from_fn(|_| vec![[[0.0; NODES]; 2]; count]),
            bubbles: vec![[[0.0; CHECKS.len()]; 2]; count],
        }
    }

    /// Memory in use [bytes].
    pub(super) fn bytes(&self) -> usize {
        self.bubbles.len() * (POINTS * size_of::<Influence>() + size_of::<[[f64; 2]; 2]>())
    }

    /// No influence, before the parts add theirs.
    pub(super) fn clear(&mut self) {
        for points in &mut self.points {
            points.fill([[0.0; NODES]; 2]);
        }
        self.bubbles.fill([[0.0; CHECKS.len()]; 2]);
    }

    /// The influence of a pair of part number `part` grows by what the powers (s/h)^k of its force do at a point to the
    /// deflection (`what` = 0) or rate (1).
    pub(super) fn add(
        &mut self,
        exchange: &Exchange,
        (part, entry): (usize, usize),
        (point, what): (usize, usize),
        seen: &[f64; POWERS],
    ) {
        let pair = exchange.of_part[part][entry];
        for (target, polynomial) in self.points[point][pair][what].iter_mut().zip(&LAGRANGE) {
            *target += product(polynomial, seen);
        }
    }

    /// The same for the bubbles at the end of the step.
    pub(super) fn add_bubbles(
        &mut self,
        exchange: &Exchange,
        (part, entry): (usize, usize),
        what: usize,
        seen: &[f64; POWERS],
    ) {
        let pair = exchange.of_part[part][entry];
        for (target, polynomial) in self.bubbles[pair][what].iter_mut().zip(&BUBBLES) {
            *target += product(polynomial, seen);
        }
    }
}

/// Sum of the products of the entries that both have.
fn product(one: &[f64], two: &[f64]) -> f64 {
    one.iter().zip(two).map(|(one, two)| one * two).sum()
}
