//! Bearings: constant coefficients, or coefficients over the speed of the rotor.

use super::rules::Rules;
use crate::config::{
    self, OutsideSpeeds, Place, Planar, Problem, RadialForce, SpeedPoint, SpeedTable,
};
use crate::interpolation::MonotoneCubic;

/// A spring and damper between shaft and gearbox.
#[derive(Debug, Clone, PartialEq)]
pub struct Bearing {
    /// Unique name on its rotor.
    pub name: String,
    /// Distance from the shaft's left end [m].
    pub position: f64,
    /// Stiffness and damping.
    pub law: BearingLaw,
    /// A radial force in addition.
    pub nonlinear: Option<RadialForce>,
}

/// Where the coefficients of a bearing come from.
#[derive(Debug, Clone, PartialEq)]
pub enum BearingLaw {
    /// The same at every speed.
    Constant(Coefficients),
    /// Interpolated over the speed.
    AtSpeed(CoefficientCurves),
}

/// Stiffness and damping of a bearing.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Coefficients {
    /// [N/m]
    pub stiffness: Planar,
    /// [N s/m]
    pub damping: Planar,
}

/// Every coefficient as a monotone curve over |speed|, with its end values outside the table.
#[derive(Debug, Clone, PartialEq)]
pub struct CoefficientCurves {
    stiffness: [MonotoneCubic; 4],
    damping: [MonotoneCubic; 4],
}

impl Bearing {
    /// The coefficients at a speed of the rotor [rad/s]. The x-y frame does not turn: only the magnitude of
    /// the speed counts, and cross terms keep their sign.
    pub fn coefficients(&self, speed: f64) -> Coefficients {
        match &self.law {
            BearingLaw::Constant(coefficients) => *coefficients,
            BearingLaw::AtSpeed(curves) => Coefficients {
                stiffness: planar_at(&curves.stiffness, speed.abs()),
                damping: planar_at(&curves.damping, speed.abs()),
            },
        }
    }

    /// The change of the coefficients with the speed of the rotor [per rad/s].
    pub fn coefficient_slopes(&self, speed: f64) -> Coefficients {
        match &self.law {
            BearingLaw::Constant(_) => Coefficients {
                stiffness: Planar::ZERO,
                damping: Planar::ZERO,
            },
            BearingLaw::AtSpeed(curves) => {
                let slopes = |curves: &[MonotoneCubic; 4]| {
                    let [xx, xy, yx, yy] = curves
                        .each_ref()
                        .map(|curve| speed.signum() * curve.slope(speed.abs()));
                    Planar { xx, xy, yx, yy }
                };
                Coefficients {
                    stiffness: slopes(&curves.stiffness),
                    damping: slopes(&curves.damping),
                }
            }
        }
    }

    /// Whether the coefficients depend on the speed.
    pub fn depends_on_speed(&self) -> bool {
        matches!(self.law, BearingLaw::AtSpeed(_))
    }
}

fn planar_at([xx, xy, yx, yy]: &[MonotoneCubic; 4], speed: f64) -> Planar {
    Planar {
        xx: xx.value(speed),
        xy: xy.value(speed),
        yx: yx.value(speed),
        yy: yy.value(speed),
    }
}

impl CoefficientCurves {
    fn through(table: &SpeedTable) -> CoefficientCurves {
        let entries: [fn(&Planar) -> f64; 4] = [|c| c.xx, |c| c.xy, |c| c.yx, |c| c.yy];
        let curves = |of: fn(&SpeedPoint) -> &Planar| {
            entries.map(|entry| {
                let point = |point: &SpeedPoint| (point.speed, entry(of(point)));
                let points: Vec<(f64, f64)> = table.points.iter().map(point).collect();
                MonotoneCubic::through(&points)
            })
        };
        CoefficientCurves {
            stiffness: curves(|point| &point.stiffness),
            damping: curves(|point| &point.damping),
        }
    }
}

/// Checks a bearing on a rotor with this speed [rad/s], which in free spin is only the first one.
pub(super) fn resolve_bearing(
    place: &Place,
    bearing: &config::Bearing,
    (speed, free): (f64, bool),
    problems: &mut Vec<Problem>,
) -> Bearing {
    if let Some(force) = &bearing.nonlinear {
        check_radial_force(&place.table("nonlinear"), force, problems);
    }
    let before = problems.len();
    let law = match &bearing.at_speed {
        None => {
            check_coefficients(place, &bearing.stiffness, &bearing.damping, problems);
            None
        }
        Some(table) => {
            check_table(place, table, speed, problems);
            let mut rules = Rules { place, problems };
            let holds = !free || table.outside == OutsideSpeeds::Hold;
            rules.ensure("outside_speeds", holds, || {
                "must be \"hold\" in free spin, where the speed goes where the torques take it"
                    .to_string()
            });
            // A wrong table may not even have a curve.
            (problems.len() == before).then(|| CoefficientCurves::through(table))
        }
    };
    let constant = Coefficients {
        stiffness: bearing.stiffness,
        damping: bearing.damping,
    };
    Bearing {
        name: bearing.name.clone(),
        position: bearing.position,
        law: law.map_or(BearingLaw::Constant(constant), BearingLaw::AtSpeed),
        nonlinear: bearing.nonlinear,
    }
}

fn check_radial_force(place: &Place, force: &RadialForce, problems: &mut Vec<Problem>) {
    let mut rules = Rules { place, problems };
    rules.not_negative("clearance", force.clearance, "m");
    // The law "clearance" calls its coefficient a stiffness.
    let (key, unit) = if force.exponent == 1.0 {
        ("stiffness", "N/m")
    } else {
        ("coefficient", "N/m^exponent")
    };
    rules.not_negative(key, force.coefficient, unit);
    rules.ensure("exponent", (1.0..=3.0).contains(&force.exponent), || {
        format!("must be from 1 to 3, found {}", force.exponent)
    });
}

fn check_table(place: &Place, table: &SpeedTable, speed: f64, problems: &mut Vec<Problem>) {
    let before = problems.len();
    for (index, point) in table.points.iter().enumerate() {
        let place = place.element("at_speed", index, None);
        let mut rules = Rules {
            place: &place,
            problems,
        };
        rules.not_negative("speed", point.speed, "rad/s");
        let previous = index.checked_sub(1).map(|one| table.points[one].speed);
        if let Some(previous) = previous.filter(|&previous| previous >= point.speed) {
            rules.ensure("speed", false, || {
                let found = point.speed;
                format!("must be greater than the {previous} rad/s before it, found {found} rad/s")
            });
        }
        check_coefficients(&place, &point.stiffness, &point.damping, problems);
    }
    let count = table.points.len();
    let mut rules = Rules { place, problems };
    rules.ensure("at_speed", count >= 2, || {
        format!("needs at least two speeds, found {count}")
    });
    if rules.problems.len() > before || table.outside == OutsideSpeeds::Hold {
        return;
    }
    let (first, last) = (table.points[0].speed, table.points[count - 1].speed);
    rules.ensure("at_speed", (first..=last).contains(&speed.abs()), || {
        format!(
            "covers {first} to {last} rad/s, but the rotor turns at {} rad/s; add speeds, or hold the end \
             values with outside_speeds = \"hold\"",
            speed.abs()
        )
    });
}

/// Direct terms are not negative, cross terms are numbers.
pub(super) fn check_coefficients(
    place: &Place,
    stiffness: &Planar,
    damping: &Planar,
    problems: &mut Vec<Problem>,
) {
    for (key, planar, unit) in [
        ("stiffness", stiffness, "N/m"),
        ("damping", damping, "N s/m"),
    ] {
        let place = place.table(key);
        let mut rules = Rules {
            place: &place,
            problems,
        };
        rules.not_negative("xx", planar.xx, unit);
        rules.not_negative("yy", planar.yy, unit);
        rules.finite("xy", planar.xy);
        rules.finite("yx", planar.yx);
    }
}
