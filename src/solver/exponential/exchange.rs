//! How the forces of couplings change what couplings see.
//!
//! Every block that a coupling looks at and another one acts on joins the two. Over all blocks that is a sparse list of
//! **pairs** (sensor, actuator), sorted by sensor; for one step length each pair has a number for the force at every node, for
//! every node of the step, for deflection and rate there:
//!
//! ```text
//!   d_i = free response - sum over pairs and nodes j of e_d F_actuator(j)          d' likewise with e_v
//! ```

use super::lanes::{Quad, add_multiple};
use super::part::Part;
use super::polynomials::{BUBBLES, CHECKS, END, LAGRANGE, NODES, POWERS};
use super::sight::{Readings, STILL};

/// A coupling that sees and one that acts.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
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

/// What the force at every node does to one pair's sensor.
type Influence = [Readings; NODES];

/// The numbers of all pairs for one step length.
#[derive(Debug, Clone)]
pub(super) struct Influences {
    pub(super) of_pairs: Vec<Influence>,
    /// Deflection and rate at the end per bubble of the force at either check.
    bubbles: Vec<[[f64; CHECKS]; 2]>,
}

impl Exchange {
    pub(super) fn between(parts: &[Part]) -> Exchange {
        let joined = |part: &Part| -> Vec<Pair> {
            let actuators = part.actuators.iter();
            let pairs = actuators.flat_map(|&actuator| {
                let sensors = part.sensors.iter();
                sensors.map(move |&sensor| Pair { sensor, actuator })
            });
            pairs.collect()
        };
        let mut pairs: Vec<Pair> = parts.iter().flat_map(joined).collect();
        pairs.sort_unstable();
        pairs.dedup();
        let number = |pair: &Pair| pairs.partition_point(|other| other < pair);
        let of_part = |part: &Part| joined(part).iter().map(number).collect();
        Exchange {
            of_part: parts.iter().map(of_part).collect(),
            pairs,
        }
    }

    /// How what is missing in the forces at the checks would change deflections and rates at the end.
    #[inline(always)]
    pub(super) fn exert_missing(
        &self,
        influences: &Influences,
        missing: &[[f64; CHECKS]],
        drift: &mut [[f64; 2]],
    ) {
        drift.fill([0.0; 2]);
        for (pair, bubbles) in self.pairs.iter().zip(&influences.bubbles) {
            let [first, second] = missing[pair.actuator];
            for (drift, bubble) in drift[pair.sensor].iter_mut().zip(bubbles) {
                *drift -= bubble[0] * first + bubble[1] * second;
            }
        }
    }
}

impl Influences {
    /// Room for the numbers of all pairs.
    pub(super) fn unused(exchange: &Exchange) -> Influences {
        let count = exchange.pairs.len();
        Influences {
            of_pairs: vec![[STILL; NODES]; count],
            bubbles: vec![[[0.0; CHECKS]; 2]; count],
        }
    }

    /// Memory in use [bytes].
    pub(super) fn bytes(&self) -> usize {
        self.bubbles.len() * (size_of::<Influence>() + size_of::<[[f64; 2]; 2]>())
    }

    /// No influence, before the parts add theirs.
    pub(super) fn clear(&mut self) {
        self.of_pairs.fill([STILL; NODES]);
        self.bubbles.fill([[0.0; CHECKS]; 2]);
    }

    /// The influence of a pair of part number `part` grows by what the powers (s/h)^k of its force do to deflection and rate at the
    /// nodes.
    #[inline(always)]
    pub(super) fn add(
        &mut self,
        exchange: &Exchange,
        (part, entry): (usize, usize),
        seen: &[[Quad; POWERS]; 2],
    ) {
        let pair = exchange.of_part[part][entry];
        for (readings, polynomial) in self.of_pairs[pair].iter_mut().zip(&LAGRANGE) {
            for (reading, seen) in readings.iter_mut().zip(seen) {
                for (coefficient, seen) in polynomial.iter().zip(seen) {
                    add_multiple(reading, *coefficient, seen);
                }
            }
        }
        for (bubbles, seen) in self.bubbles[pair].iter_mut().zip(seen) {
            for (bubble, polynomial) in bubbles.iter_mut().zip(&BUBBLES) {
                let terms = polynomial.iter().zip(seen);
                *bubble += terms.map(|(c, seen)| c * seen[END]).sum::<f64>();
            }
        }
    }
}
