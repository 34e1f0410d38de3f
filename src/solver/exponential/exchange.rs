//! How the forces of couplings change what couplings see.
//!
//! Every block that a coupling looks at and another one acts on joins the two. Over all blocks that is a sparse list of
//! **pairs** (sensor, actuator), those of springs first, each sorted by sensor; for one step length each pair has a number for the
//! force at every node and each of the four that say how the sensor moves:
//!
//! ```text
//!   moved = free response - sum over pairs and nodes j of e_j F_actuator(j)
//! ```

use super::few::FEW;
use super::lanes::{Quad, add_multiple};
use super::part::Part;
use super::polynomials::{BUBBLES, CHECKS, END, LAGRANGE, NODES, POWERS, RATE};
use super::sight::{Moved, rates_at_nodes};

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
    /// So many of them, the first ones, are those of two springs.
    springs: usize,
    /// For every part the pair of each actuator and sensor, sensors running fastest.
    of_part: Vec<Vec<usize>>,
}

/// What the force at every node does to one pair's sensor.
type Influence = [Moved; NODES];

/// The numbers of all pairs for one step length.
#[derive(Debug, Clone)]
pub(super) struct Influences {
    pub(super) of_pairs: Vec<Influence>,
    /// The same for pairs of springs: how the rate moves to every node.
    pub(super) rates: Vec<[Quad; NODES]>,
    /// Deflection and rate at the end per bubble of the force at either check.
    pub(super) bubbles: Vec<[[f64; CHECKS]; 2]>,
}

impl Exchange {
    /// The pairs of these parts; so many couplings, the first ones, are springs. Few of these are all joined, if by nothing.
    pub(super) fn between(parts: &[Part], springs: usize) -> Exchange {
        let joined = |part: &Part| -> Vec<Pair> {
            let actuators = part.actuators.iter();
            let pairs = actuators.flat_map(|&actuator| {
                let sensors = part.sensors.iter();
                sensors.map(move |&sensor| Pair { sensor, actuator })
            });
            pairs.collect()
        };
        let mut pairs: Vec<Pair> = parts.iter().flat_map(joined).collect();
        if springs <= FEW {
            let all = |sensor| (0..springs).map(move |actuator| Pair { sensor, actuator });
            pairs.extend((0..springs).flat_map(all));
        }
        let of_springs = |pair: &Pair| pair.sensor.max(pair.actuator) < springs;
        let place = |pair: &Pair| (!of_springs(pair), *pair);
        pairs.sort_unstable_by_key(place);
        pairs.dedup();
        let number = |pair: &Pair| pairs.partition_point(|other| place(other) < place(pair));
        let of_part = |part: &Part| joined(part).iter().map(number).collect();
        Exchange {
            of_part: parts.iter().map(of_part).collect(),
            springs: pairs.partition_point(of_springs),
            pairs,
        }
    }

    /// The pairs of springs.
    pub(super) fn of_springs(&self) -> &[Pair] {
        &self.pairs[..self.springs]
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
            of_pairs: vec![[[0.0; 4]; NODES]; count],
            rates: vec![[[0.0; 4]; NODES]; exchange.springs],
            bubbles: vec![[[0.0; CHECKS]; 2]; count],
        }
    }

    /// Memory in use [bytes].
    pub(super) fn bytes(&self) -> usize {
        self.bubbles.len() * (size_of::<Influence>() + size_of::<[[f64; CHECKS]; 2]>())
            + self.rates.len() * size_of::<[Quad; NODES]>()
    }

    /// No influence, before the parts add theirs.
    pub(super) fn clear(&mut self) {
        self.of_pairs.fill([[0.0; 4]; NODES]);
        self.bubbles.fill([[0.0; CHECKS]; 2]);
    }

    /// The influence of a pair of part number `part` grows by what the powers (s/h)^k of its force do to how its sensor moves.
    #[inline(always)]
    pub(super) fn add(
        &mut self,
        exchange: &Exchange,
        (part, entry): (usize, usize),
        seen: &[Moved; POWERS],
    ) {
        let pair = exchange.of_part[part][entry];
        for (moved, polynomial) in self.of_pairs[pair].iter_mut().zip(&LAGRANGE) {
            for (coefficient, seen) in polynomial.iter().zip(seen) {
                add_multiple(moved, *coefficient, seen);
            }
        }
        for (bubbles, what) in self.bubbles[pair].iter_mut().zip([END, RATE]) {
            for (bubble, polynomial) in bubbles.iter_mut().zip(&BUBBLES) {
                let terms = polynomial.iter().zip(seen);
                *bubble += terms.map(|(c, seen)| c * seen[what]).sum::<f64>();
            }
        }
    }

    /// What the force at every node does to the sensors of pairs of springs: how they move, and their rates at the nodes.
    #[inline(always)]
    pub(super) fn of_springs(&self) -> impl Iterator<Item = (&Influence, &[Quad; NODES])> {
        self.of_pairs.iter().zip(&self.rates)
    }

    /// Completes them for a step of length h.
    #[inline(always)]
    pub(super) fn complete(&mut self, h: f64) {
        let per_step = 1.0 / h;
        for (rates, influence) in self.rates.iter_mut().zip(&self.of_pairs) {
            *rates = influence
                .each_ref()
                .map(|moved| rates_at_nodes(moved, per_step));
        }
    }
}
