//! Random valid trains: trees of shafts with compound gears, idlers, rings and parallel pairs that close loops.

use proptest::prelude::*;
use std::f64::consts::{PI, TAU};

const MODULE: f64 = 0.003;
const PRESSURE_ANGLE: f64 = 0.35;

/// A train whose gears roll on each other: base radii and speeds follow from the teeth.
#[derive(Debug, Clone)]
pub struct Train {
    pub shafts: Vec<Shaft>,
    pub links: Vec<Link>,
    /// Cross stiffness of every bearing, +xy and -yx [N/m].
    pub skew: f64,
    /// Whether anything takes energy away.
    pub damped: bool,
    pub simulation: &'static str,
}

#[derive(Debug, Clone)]
pub struct Shaft {
    pub speed: f64,
    /// Teeth of the gears, from left to right.
    pub teeth: Vec<u32>,
    pub torque: f64,
    /// Unbalance [kg m] and its phase.
    pub unbalance: (f64, f64),
    /// Stiffness of both bearings [N/m].
    pub bearing: f64,
}

#[derive(Debug, Clone)]
pub struct Link {
    /// Shaft and gear of a and b.
    pub gears: [(usize, usize); 2],
    pub center_angle: f64,
    pub internal: bool,
    pub flank: f64,
    pub phase: f64,
    pub law: Law,
    /// Amplitude [m] and phase of the transmission error.
    pub error: (f64, f64),
    /// Backlash of teeth that can part [m].
    pub backlash: Option<f64>,
}

#[derive(Debug, Clone, Copy)]
pub enum Law {
    Constant,
    Rectangular(f64),
    ToothPair(f64),
    Fourier(f64, f64),
}

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

/// Two to four shafts.
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

fn shaft(speed: f64, (torque, moment, phase, bearing): (f64, f64, f64, f64)) -> Shaft {
    Shaft {
        speed,
        teeth: Vec::new(),
        torque: 100.0 * torque,
        unbalance: (1e-3 * (1.0 + moment), PI * phase),
        bearing: 1e8 * (1.5 + bearing),
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
        simulation: "start = \"rest\"",
    }
}

pub fn base_radius(teeth: u32) -> f64 {
    0.5 * MODULE * f64::from(teeth) * PRESSURE_ANGLE.cos()
}

impl Train {
    /// The train as a model file.
    pub fn text(&self) -> String {
        let mut text = format!(
            "kind = \"gear_train\"\nname = \"drawn\"\n[simulation]\n{}\n[basis]\nlateral_modes = 3\ntorsional_modes = 3\n\
             [material.default]\nyoungs_modulus = 2.1e11\npoisson_ratio = 0.3\ndensity = 7800.0\n",
            self.simulation
        );
        for (index, shaft) in self.shafts.iter().enumerate() {
            text += &self.shaft_text(index, shaft);
        }
        for (index, link) in self.links.iter().enumerate() {
            text += &self.link_text(index, link);
        }
        text
    }

    fn shaft_text(&self, index: usize, shaft: &Shaft) -> String {
        let (ratio, damper) = if self.damped {
            (0.02, 800.0)
        } else {
            (0.0, 0.0)
        };
        let mut text = format!(
            "[[rotor]]\nname = \"s{index}\"\nspeed = {}\nmax_element_length = 0.08\nlateral_damping_ratio = {ratio}\n\
             torsional_damping_ratio = {ratio}\n[[rotor.segment]]\nlength = 0.5\nouter_diameter = 0.05\n\
             [[rotor.unbalance]]\nname = \"u\"\nposition = 0.3\nmoment = {}\nphase = {}\n\
             [[rotor.torque]]\nname = \"t\"\nposition = 0.0\nvalue = {}\n",
            shaft.speed, shaft.unbalance.0, shaft.unbalance.1, shaft.torque
        );
        for (name, position) in [("b1", 0.02), ("b2", 0.48)] {
            text += &format!(
                "[[rotor.bearing]]\nname = \"{name}\"\nposition = {position}\n\
                 stiffness = {{ xx = {k}, xy = {skew}, yx = {minus} }}\ndamping = {{ xx = {damper} }}\n",
                k = shaft.bearing,
                skew = self.skew,
                minus = -self.skew
            );
        }
        for (gear, &teeth) in shaft.teeth.iter().enumerate() {
            let radius = base_radius(teeth);
            let mass = 7800.0 * PI * radius * radius * 0.03;
            text += &format!(
                "[[rotor.gear]]\nname = \"g{gear}\"\nposition = {}\nteeth = {teeth}\nbase_radius = {radius}\nmass = {mass}\n\
                 polar_inertia = {}\ndiametral_inertia = {}\n",
                0.08 + 0.06 * gear as f64,
                0.5 * mass * radius * radius,
                0.25 * mass * radius * radius
            );
        }
        text
    }

    fn link_text(&self, index: usize, link: &Link) -> String {
        let [a, b] = link
            .gears
            .map(|(shaft, gear)| format!("\"s{shaft}.g{gear}\""));
        let law = match link.law {
            Law::Constant => "law = \"constant\"\nmean = 3e8".to_string(),
            Law::Rectangular(ratio) => {
                format!("law = \"rectangular\"\npair = 2e8\ncontact_ratio = {ratio}")
            }
            Law::ToothPair(ratio) => {
                format!(
                    "law = \"tooth_pair\"\npair = 2e8\nquadratic = 0.3\nramp = 0.2\ncontact_ratio = {ratio}"
                )
            }
            Law::Fourier(cosine, sine) => {
                format!("law = \"fourier\"\nmean = 3e8\ncosine = [{cosine}]\nsine = [{sine}]")
            }
        };
        let contact = link.backlash.map_or(String::new(), |backlash| {
            format!("contact = \"unilateral\"\nbacklash = {backlash}\n")
        });
        format!(
            "[[mesh]]\nname = \"m{index}\"\ngears = [{a}, {b}]\ncenter_angle = {}\npressure_angle = {PRESSURE_ANGLE}\n\
             internal = {}\nflank = {}\nphase = {}\ndamping_ratio = {}\n{contact}[mesh.stiffness]\n{law}\n\
             [[mesh.transmission_error]]\norder = 1\namplitude = {}\nphase = {}\n",
            link.center_angle,
            link.internal,
            link.flank,
            link.phase,
            if self.damped { 0.05 } else { 0.0 },
            link.error.0,
            link.error.1
        )
    }

    /// Linear: teeth that hold on to each other.
    pub fn bilateral(mut self) -> Train {
        self.links.iter_mut().for_each(|link| link.backlash = None);
        self
    }

    /// Nothing that excites and nothing that varies.
    pub fn quiet(mut self) -> Train {
        for shaft in &mut self.shafts {
            shaft.unbalance.0 = 0.0;
        }
        for link in &mut self.links {
            (link.law, link.error.0) = (Law::Constant, 0.0);
        }
        self
    }

    /// The whole machine turned by an angle about z.
    pub fn turned(mut self, angle: f64) -> Train {
        self.links
            .iter_mut()
            .for_each(|link| link.center_angle += angle);
        self.shafts
            .iter_mut()
            .for_each(|shaft| shaft.unbalance.1 += angle);
        self
    }

    /// The machine in a mirror: y, and with it every sense of rotation, the other way.
    pub fn mirrored(mut self) -> Train {
        for shaft in &mut self.shafts {
            shaft.speed = -shaft.speed;
            shaft.torque = -shaft.torque;
            shaft.unbalance.1 = -shaft.unbalance.1;
        }
        for link in &mut self.links {
            link.center_angle = -link.center_angle;
            link.flank = -link.flank;
        }
        self.skew = -self.skew;
        self
    }

    /// Gears a and b of every external mesh in the other order. The phase counts the same contact from its other end:
    /// p' = eps - p, with eps where the law begins at an end of contact, otherwise 0.
    pub fn swapped(mut self) -> Train {
        for link in self.links.iter_mut().filter(|link| !link.internal) {
            link.gears.swap(0, 1);
            link.center_angle += PI;
            let ratio = match &mut link.law {
                Law::Constant => 0.0,
                Law::Rectangular(ratio) | Law::ToothPair(ratio) => *ratio,
                Law::Fourier(_, sine) => {
                    *sine = -*sine;
                    0.0
                }
            };
            link.phase = ratio - link.phase;
            link.error.1 = -link.error.1 - TAU * ratio;
        }
        self
    }
}
