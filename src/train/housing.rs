//! Rules for the structure around the rotors, and which bearing stands where on it.

use super::bearings::check_coefficients;
use super::rules::Rules;
use crate::config::{self, Config, KnownBearing, Place, Problem, Start};

/// A valid structure.
#[derive(Debug, Clone, PartialEq)]
pub struct Housing {
    /// Its places.
    pub points: Vec<HousingPoint>,
    /// Its modes of vibration.
    pub modes: Vec<HousingMode>,
    /// For every bearing, all rotors in their order, the index of the point that it stands on.
    pub holds: Vec<Option<usize>>,
}

/// A place on the structure.
#[derive(Debug, Clone, PartialEq)]
pub struct HousingPoint {
    /// Unique name.
    pub name: String,
    /// Whether forces from outside act there.
    pub takes_forces: bool,
    /// The bearing of another model that exerts them, as far as they are to follow the motion through it.
    pub bearing: Option<KnownBearing>,
}

/// A mode of vibration, mass normalised.
#[derive(Debug, Clone, PartialEq)]
pub struct HousingMode {
    /// Natural frequency [Hz].
    pub frequency: f64,
    /// Damping ratio.
    pub damping_ratio: f64,
    /// Displacement in x and y at every point [1/sqrt(kg)].
    pub shape: Vec<[f64; 2]>,
}

/// Checks a structure; what is wrong leaves placeholders.
pub(super) fn resolve_housing(
    housing: &config::Housing,
    config: &Config,
    problems: &mut Vec<Problem>,
) -> Housing {
    let (place, root) = (housing.place(), Place::root());
    if housing.points.is_empty() {
        let message = "point: at least one [[point]] is needed".to_string();
        problems.push(place.problem("point", message));
    }
    if housing.modes.is_empty() {
        let message =
            "mode: at least one mode is needed, in [[mode]] or the file that [modes] names";
        problems.push(place.problem("mode", message.to_string()));
    }
    let point = |name: &str| housing.points.iter().position(|point| point.name == name);
    let bearings: Vec<String> = config
        .rotors
        .iter()
        .flat_map(|rotor| {
            let names = rotor.bearings.iter().map(|bearing| &bearing.name);
            names.map(|name| format!("{}.{name}", rotor.name))
        })
        .collect();
    let mut holds = vec![None; bearings.len()];
    let connect = root.table("housing").table("connect");
    for connection in &housing.connections {
        let (name, mut refuse) = (&connection.bearing, |message: String| {
            problems.push(connect.problem(&connection.bearing, message));
        });
        let bearing = bearings.iter().position(|bearing| bearing == name);
        let point = point(&connection.point);
        match (bearing, point) {
            (None, _) => refuse(format!(
                "\"{name}\": no such bearing; there are {}",
                bearings.join(", ")
            )),
            (_, None) => refuse(format!(
                "\"{name}\": the housing has no point \"{}\"",
                connection.point
            )),
            (_, Some(index)) if housing.points[index].observe => refuse(format!(
                "\"{name}\": point \"{}\" is only looked at (observe = true) and holds nothing",
                connection.point
            )),
            (Some(bearing), point) => holds[bearing] = point,
        }
    }
    if housing.file.is_some() && housing.connections.is_empty() {
        let message = "connect: at least one bearing must stand on a point of the housing";
        problems.push(
            root.table("housing")
                .problem("connect", message.to_string()),
        );
    }
    let share = config.simulation.known_bearings;
    let points = housing.points.iter().enumerate().map(|(index, point)| {
        check_known_bearing(
            &place.element("point", index, Some(&point.name)),
            point,
            problems,
        );
        HousingPoint {
            name: point.name.clone(),
            takes_forces: housing.takes_forces(point),
            bearing: point
                .bearing
                .filter(|_| share > 0.0)
                .map(|one| one.times(share)),
        }
    });
    Housing {
        points: points.collect(),
        modes: resolve_modes(housing, config.simulation.start, problems),
        holds,
    }
}

fn check_known_bearing(place: &Place, point: &config::HousingPoint, problems: &mut Vec<Problem>) {
    let Some(bearing) = &point.bearing else {
        return;
    };
    check_coefficients(place, &bearing.stiffness, &bearing.damping, problems);
    let mut rules = Rules { place, problems };
    rules.ensure("stiffness", !point.observe, || {
        "no bearing stands on a point that is only looked at (observe = true)".to_string()
    });
}

fn resolve_modes(
    housing: &config::Housing,
    start: Start,
    problems: &mut Vec<Problem>,
) -> Vec<HousingMode> {
    let mut modes = Vec::new();
    for (index, mode) in housing.modes.iter().enumerate() {
        let place = &housing.place_of_modes().element("mode", index, None);
        let mut rules = Rules { place, problems };
        rules.not_negative("frequency", mode.frequency, "Hz");
        rules.ensure("frequency", mode.frequency != 0.0 || start == Start::Rest, || {
            "nothing holds this mode: a simulation can start with it from rest only (start = \"rest\")"
                .to_string()
        });
        rules.not_negative("damping_ratio", mode.damping_ratio, "");
        for (name, values) in &mode.shape {
            rules.ensure(
                "shape",
                values.iter().all(|value| value.is_finite()),
                || format!("\"{name}\" must have two finite numbers, found {values:?}"),
            );
            let known = housing.points.iter().any(|point| point.name == *name);
            rules.ensure("shape", known, || {
                format!("\"{name}\" is no [[point]] of the housing")
            });
        }
        let at = |point: &config::HousingPoint| mode.shape.get(&point.name).copied();
        modes.push(HousingMode {
            frequency: mode.frequency,
            damping_ratio: mode.damping_ratio,
            shape: housing
                .points
                .iter()
                .map(|one| at(one).unwrap_or_default())
                .collect(),
        });
    }
    modes
}

/// Warns of points that no mode moves.
pub(super) fn points_at_rest(config: &Config, housing: &Housing) -> Vec<Problem> {
    let place = config
        .housing
        .as_ref()
        .map_or_else(Place::root, config::Housing::place);
    let mut warnings = Vec::new();
    for (index, point) in housing.points.iter().enumerate() {
        if housing
            .modes
            .iter()
            .all(|mode| mode.shape[index] == [0.0; 2])
        {
            let place = place.element("point", index, Some(&point.name));
            let message = "name: no mode has a shape here, so that this point never moves";
            warnings.push(place.problem("name", message.to_string()));
        }
    }
    warnings
}

/// Warns of bearings that are to be known of which nothing is.
pub(super) fn no_known_bearings(config: &Config) -> Option<Problem> {
    let mut points = config.housing.iter().flat_map(|housing| &housing.points);
    let any = points.any(|point| point.bearing.is_some());
    let message = "known_bearings: no [[point]] has the stiffness of a bearing; cargo xtask couple writes those of a train";
    let place = Place::root().table("simulation");
    (config.simulation.known_bearings > 0.0 && !any)
        .then(|| place.problem("known_bearings", message.to_string()))
}
