//! The rules of stiffness laws, and the way from their tables to a [`StiffnessLaw`].

use std::collections::BTreeMap;

use super::rules::Rules;
use super::tooth_geometry::{self, MeshedGear};
use crate::config::{self, Material, MeshStiffness, Place, Problem};
use crate::mesh::{StiffnessLaw, ToothPair};

/// Harmonics beyond these are no mesh stiffness: every one of them is evaluated at every step.
pub(super) const MOST_HARMONICS: usize = 100;
/// A step ends at every point of a table.
const MOST_POINTS: usize = 1000;
/// Points closer than this [pitches] are a mistake, or a jump meant to be steep.
const CLOSEST_POINTS: f64 = 1e-6;

/// Checks the numbers of a stiffness law; `place` is its table.
pub(super) fn check_stiffness(
    place: &Place,
    stiffness: &MeshStiffness,
    problems: &mut Vec<Problem>,
) {
    let mut rules = Rules { place, problems };
    let contact_ratio_rule = |rules: &mut Rules<'_>, contact_ratio: f64| {
        rules.ensure(
            "contact_ratio",
            (1.0..=100.0).contains(&contact_ratio),
            || format!("must be from 1 to 100, found {contact_ratio}"),
        );
    };
    match *stiffness {
        MeshStiffness::Constant { mean } => rules.positive("mean", mean, "N/m"),
        MeshStiffness::Rectangular {
            fewer_pairs,
            more_pairs,
            contact_ratio,
        } => {
            contact_ratio_rule(&mut rules, contact_ratio);
            rules.positive("pair or single", fewer_pairs, "N/m");
            rules.ensure("double", more_pairs >= fewer_pairs && more_pairs.is_finite(), || {
                format!("must be at least the single stiffness of {fewer_pairs} N/m, found {more_pairs}")
            });
        }
        MeshStiffness::Fourier {
            mean,
            ref cosine,
            ref sine,
        } => check_fourier(&mut rules, mean, cosine, sine),
        MeshStiffness::Table {
            ref phase,
            ref value,
        } => check_table(&mut rules, phase, value),
        MeshStiffness::ToothGeometry(ref geometry) => {
            tooth_geometry::check_numbers(&mut rules, geometry);
        }
        MeshStiffness::ToothPair {
            pair,
            quadratic,
            quartic,
            ramp,
            contact_ratio,
        } => {
            contact_ratio_rule(&mut rules, contact_ratio);
            rules.positive("pair", pair, "N/m");
            rules.not_negative("ramp", ramp, "pitches");
            let weakest = ToothPair {
                pair,
                quadratic,
                quartic,
                ramp,
                contact_ratio,
            }
            .weakest();
            rules.ensure("quadratic", weakest >= 0.0, || {
                format!(
                    "1 - quadratic xi^2 - quartic xi^4 must not be negative for |xi| <= 1, \
                     found {weakest} with quadratic {quadratic} and quartic {quartic}"
                )
            });
        }
    }
}

fn check_fourier(rules: &mut Rules<'_>, mean: f64, cosine: &[f64], sine: &[f64]) {
    rules.positive("mean", mean, "N/m");
    for (key, coefficients) in [("cosine", cosine), ("sine", sine)] {
        rules.ensure(key, coefficients.len() <= MOST_HARMONICS, || {
            format!(
                "at most {MOST_HARMONICS} harmonics, found {}",
                coefficients.len()
            )
        });
        rules.all_finite(key, coefficients);
    }
    let all = || cosine.iter().chain(sine);
    if cosine.len().max(sine.len()) > MOST_HARMONICS || !all().all(|one| one.is_finite()) {
        return;
    }
    let least = StiffnessLaw::lower_bound_of_fourier(1.0, cosine, sine);
    rules.ensure(if cosine.is_empty() { "sine" } else { "cosine" }, least > 0.0, || {
        format!(
            "the stiffness must stay above 0, found {least:.6} of its mean at its lowest; coefficients are \
             relative to the mean"
        )
    });
}

fn check_table(rules: &mut Rules<'_>, phase: &[f64], value: &[f64]) {
    let points = phase.len();
    let fault = fault_of_phases(phase);
    rules.ensure("phase", fault.is_none(), || fault.unwrap_or_default());
    rules.ensure("value", value.len() == points || points == 0, || {
        let found = value.len();
        format!("must have as many entries as phase, which is {points}, found {found}")
    });
    let positive = |value: &f64| *value > 0.0 && value.is_finite();
    if let Some(wrong) = value.iter().find(|value| !positive(value)) {
        rules.ensure("value", false, || {
            format!("every entry must be greater than 0 and finite, found {wrong} N/m")
        });
    }
}

/// The first rule that the phases of a table break.
fn fault_of_phases(phase: &[f64]) -> Option<String> {
    let (&[first, ..], &[.., last]) = (phase, phase) else {
        return Some(format!("must have 1 to {MOST_POINTS} entries, found 0"));
    };
    if phase.len() > MOST_POINTS {
        let points = phase.len();
        return Some(format!(
            "must have 1 to {MOST_POINTS} entries, found {points}"
        ));
    }
    if let Some(outside) = phase.iter().find(|phase| !(0.0..1.0).contains(*phase)) {
        return Some(format!(
            "every entry must be 0 or more and less than 1, found {outside}"
        ));
    }
    let close = |pair: &&[f64]| pair[1] - pair[0] < CLOSEST_POINTS && pair[0] != pair[1];
    if let Some(pair) = phase.windows(2).find(close) {
        let (one, next) = (pair[0], pair[1]);
        return Some(format!(
            "must ascend in steps of {CLOSEST_POINTS} or more (or stay equal, at a jump), found {next} after {one}"
        ));
    }
    if let Some(triple) = phase.windows(3).find(|points| points[0] == points[2]) {
        let thrice = triple[0];
        return Some(format!(
            "may give a phase twice, at a jump, not more often, found {thrice}"
        ));
    }
    (first + 1.0 - last < CLOSEST_POINTS).then(|| {
        format!(
            "its ends must be {CLOSEST_POINTS} or more apart around the period, found {last} and {first}"
        )
    })
}

/// The law of valid numbers; `None` when they do not fit the gears, which becomes problems.
pub(super) fn stiffness_law(
    rules: &mut Rules<'_>,
    mesh: &config::Mesh,
    gears: [MeshedGear<'_>; 2],
    materials: &BTreeMap<String, Material>,
) -> Option<StiffnessLaw> {
    Some(match mesh.stiffness {
        MeshStiffness::ToothGeometry(ref geometry) => {
            let pair = tooth_geometry::resolve(rules, geometry, mesh, gears, materials)?;
            StiffnessLaw::tooth_geometry(&pair)
        }
        MeshStiffness::Constant { mean } => StiffnessLaw::constant(mean),
        MeshStiffness::Rectangular {
            fewer_pairs,
            more_pairs,
            contact_ratio,
        } => StiffnessLaw::rectangular(fewer_pairs, more_pairs, contact_ratio),
        MeshStiffness::Fourier {
            mean,
            ref cosine,
            ref sine,
        } => StiffnessLaw::fourier(mean, cosine, sine),
        MeshStiffness::Table {
            ref phase,
            ref value,
        } => {
            let points: Vec<(f64, f64)> =
                phase.iter().copied().zip(value.iter().copied()).collect();
            StiffnessLaw::table(&points)
        }
        MeshStiffness::ToothPair {
            pair,
            quadratic,
            quartic,
            ramp,
            contact_ratio,
        } => StiffnessLaw::tooth_pair(ToothPair {
            pair,
            quadratic,
            quartic,
            ramp,
            contact_ratio,
        }),
    })
}
