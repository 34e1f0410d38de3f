//! What is drawn.

use std::f64::consts::{PI, TAU};

use proptest::prelude::*;
use proptest::strategy::ValueTree;
use proptest::test_runner::{Config, RngAlgorithm, TestRng, TestRunner};

use crate::{Law, Link, Shaft, Support, Train};

/// From rest or from equilibrium, at prescribed speeds or in free spin.
const SIMULATIONS: [&str; 4] = [
    "start = \"rest\"",
    "start = \"equilibrium\"",
    "start = \"rest\"\nspeed = \"free\"",
    "start = \"equilibrium\"\nspeed = \"free\"",
];
/// Exponents of radial forces: a spring, rollers, balls, rubber.
const EXPONENTS: [f64; 4] = [1.0, 10.0 / 9.0, 1.5, 3.0];

/// What is drawn for one more shaft.
#[derive(Debug, Clone)]
struct Growth {
    parent: usize,
    own_gear: bool,
    teeth: (u32, u32),
    internal: bool,
    twice: bool,
    backwards: bool,
    angles: (f64, f64),
    law: (u8, f64, f64),
    loads: (f64, f64, f64, f64),
    apart: bool,
}

/// Trains of two to four shafts in linear bearings, from rest at prescribed speed.
pub fn trains() -> impl Strategy<Value = Train> {
    let unit = || -1.0..1.0_f64;
    let growth = (
        (0..4_usize, any::<bool>(), (15..40_u32, 15..60_u32)),
        (
            prop::bool::weighted(0.25),
            prop::bool::weighted(0.3),
            any::<bool>(),
        ),
        (0.0..TAU, unit()),
        (0..4_u8, unit(), unit()),
        (unit(), unit(), unit(), unit()),
        prop::bool::weighted(0.3),
    )
        .prop_map(|(place, kind, angles, law, loads, apart)| Growth {
            parent: place.0,
            own_gear: place.1,
            teeth: place.2,
            internal: kind.0,
            twice: kind.1,
            backwards: kind.2,
            angles,
            law,
            loads,
            apart,
        });
    let speed = prop_oneof![-300.0..-50.0, 50.0..300.0_f64];
    (speed, prop::collection::vec(growth, 1..4)).prop_map(|(speed, growth)| grow(speed, &growth))
}

/// Trains that differ in everything that users vary.
pub fn varied() -> impl Strategy<Value = Train> {
    let support = prop_oneof![
        Just(Support::Linear),
        (-0.5..0.5_f64).prop_map(Support::OverSpeed),
        (0..EXPONENTS.len(), prop_oneof![Just(0.0), 1e-6..3e-5_f64])
            .prop_map(|(exponent, clearance)| Support::Radial(EXPONENTS[exponent], clearance)),
    ];
    let shaft = (support, prop_oneof![Just(0.0), 0.01..1.0_f64]);
    let mesh = (0.01..0.1_f64, prop_oneof![Just(0.0), 1e-6..1e-4_f64]);
    let whole = (
        0..SIMULATIONS.len(),
        [2..7_u32, 1..6_u32],
        prop_oneof![Just(0.0), -6e6..6e6_f64],
        (prop_oneof![Just(0.0), 1e-6..2e-5_f64], 50.0..500.0_f64),
    );
    let more = (
        prop::collection::vec(shaft, 4),
        prop::collection::vec(mesh, 6),
        whole,
    );
    (trains(), more).prop_map(|(mut train, (shafts, meshes, whole))| {
        for (shaft, (support, slope)) in train.shafts.iter_mut().zip(shafts) {
            (shaft.support, shaft.slope) = (support, slope);
        }
        for (link, (damping, backlash)) in train.links.iter_mut().zip(meshes) {
            link.damping = damping;
            link.backlash = link.backlash.map(|_| backlash);
        }
        train.simulation = SIMULATIONS[whole.0];
        (train.modes, train.skew, train.vibration) = (whole.1, whole.2, whole.3);
        train
    })
}

/// The varied train of a seed.
pub fn of_seed(seed: u64) -> Train {
    let mut bytes = [0; 32];
    bytes[..8].copy_from_slice(&seed.to_le_bytes());
    let rng = TestRng::from_seed(RngAlgorithm::ChaCha, &bytes);
    let mut runner = TestRunner::new_with_rng(Config::default(), rng);
    let tree = varied().new_tree(&mut runner);
    tree.expect("nothing is rejected").current()
}

fn shaft(speed: f64, (torque, moment, phase, bearing): (f64, f64, f64, f64)) -> Shaft {
    Shaft {
        speed,
        teeth: Vec::new(),
        torque: 100.0 * torque,
        slope: 0.0,
        unbalance: (1e-3 * (1.0 + moment), PI * phase),
        bearing: 1e8 * (1.5 + bearing),
        support: Support::Linear,
    }
}

fn grow(speed: f64, growth: &[Growth]) -> Train {
    let mut shafts = vec![shaft(speed, growth[0].loads)];
    let mut links: Vec<Link> = Vec::new();
    for new in growth {
        let parent = new.parent % shafts.len();
        if new.own_gear || shafts[parent].teeth.is_empty() {
            shafts[parent].teeth.push(new.teeth.0);
        }
        let gear = shafts[parent].teeth.len() - 1;
        let teeth = shafts[parent].teeth[gear];
        let other = if new.internal {
            teeth + new.teeth.1
        } else {
            new.teeth.1
        };
        let ratio = f64::from(teeth) / f64::from(other);
        let sense = if new.internal { 1.0 } else { -1.0 };
        let mut child = shaft(sense * ratio * shafts[parent].speed, new.loads);
        child.teeth.push(other);
        let index = shafts.len();
        let link = Link {
            gears: [(parent, gear), (index, 0)],
            center_angle: new.angles.0,
            internal: new.internal,
            flank: if new.backwards { -1.0 } else { 1.0 },
            phase: new.angles.1,
            law: match new.law.0 {
                0 => Law::Constant,
                1 => Law::Rectangular(1.5 + 0.4 * new.law.1),
                2 => Law::ToothPair(1.6 + 0.3 * new.law.1),
                _ => Law::Fourier(0.2 * new.law.1, 0.2 * new.law.2),
            },
            error: (3e-6 * new.law.2, PI * new.law.1),
            damping: 0.05,
            backlash: new.apart.then_some(2e-5),
        };
        if new.twice {
            // The same pair once more beside it: a loop that turns.
            let further = shafts[parent].teeth.len();
            shafts[parent].teeth.push(teeth);
            child.teeth.push(other);
            links.push(Link {
                gears: [(parent, further), (index, 1)],
                ..link.clone()
            });
        }
        links.push(link);
        shafts.push(child);
    }
    Train {
        shafts,
        links,
        skew: 0.0,
        damped: true,
        simulation: SIMULATIONS[0],
        modes: [3, 3],
        vibration: (0.0, 0.0),
    }
}
