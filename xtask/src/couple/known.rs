//! What a housing is told of the bearings that stand on it: their stiffness and damping, written into its file.

use geartrain::config::{KnownBearing, Planar};
use geartrain::interface::Contact;
use geartrain::model::{BaseMotion, Change};
use geartrain::simulation::Simulation;
use geartrain::train::load_beside;

use super::Model;

/// The housing's file with the bearings on its points, where it does not say anything of them itself.
pub fn with_bearings(
    housing: &Model,
    train: &Model,
    contacts: &[Contact],
) -> Result<String, String> {
    let structure = housing.loaded.config.housing.as_ref();
    let points = &structure.ok_or("a housing is wanted")?.points;
    let coefficients = at_start(train);
    let mut lines: Vec<String> = housing.file.text.lines().map(str::to_string).collect();
    let bearings = train.bearings();
    for (index, point) in points.iter().enumerate() {
        let contact = contacts.iter().find(|contact| contact.point == point.name);
        let (Some(contact), None) = (contact, point.bearing) else {
            continue;
        };
        let input = bearings.iter().position(|name| *name == contact.bearing);
        let bearing = coefficients[input.ok_or("a contact names a bearing")?];
        let key = format!("point[{}].name", index + 1);
        if let (Some(spot), true) = (
            housing.loaded.lines.find(None, &key),
            bearing != KnownBearing::NONE,
        ) {
            let KnownBearing { stiffness, damping } = bearing;
            let line = &mut lines[spot.line - 1];
            line.push_str(&format!(
                "\nstiffness = {}  # of {}\ndamping = {}",
                text(stiffness),
                contact.bearing,
                text(damping)
            ));
        }
    }
    let written = lines.join("\n") + "\n";
    let beside = |name: &str| housing.file.beside(name);
    if load_beside(&written, &beside).is_ok() {
        return Ok(written);
    }
    println!("the housing is not told of its bearings: its points are not written as [[point]]");
    Ok(housing.file.text.clone())
}

fn text(planar: Planar) -> String {
    let Planar { xx, xy, yx, yy } = planar;
    if xy == 0.0 && yx == 0.0 {
        format!("{{ xx = {xx:e}, yy = {yy:e} }}")
    } else {
        format!("{{ xx = {xx:e}, xy = {xy:e}, yx = {yx:e}, yy = {yy:e} }}")
    }
}

/// Of every bearing, as it answers to motion of the gearbox when the train starts: with the coefficients at the mean speed and
/// the tangent of a radial force; from rest where it has no equilibrium.
fn at_start(train: &Model) -> Vec<KnownBearing> {
    let model = &train.model;
    let rotors = train.loaded.train.rotors.iter();
    let torques = rotors.flat_map(|rotor| &rotor.torques);
    let torques: Vec<f64> = torques.map(|torque| torque.value).collect();
    let inputs = model.inputs_at_rest(&torques);
    let settings = &train.loaded.config.simulation;
    let simulation = Simulation::start(model.clone(), inputs.clone(), settings, 0.0)
        .unwrap_or_else(|_| Simulation::at_rest(model.clone(), inputs, settings));
    let still = vec![0.0; model.system.size];
    let count = train.bearings().len();
    let answers = |input: usize, axis: usize| {
        let push = |of: fn(&mut BaseMotion) -> &mut [f64; 2]| {
            let mut direction = model.inputs_at_rest(&vec![0.0; torques.len()]);
            let mut base = BaseMotion::default();
            of(&mut base)[axis] = 1.0;
            direction.set_base(input, base);
            let change = Change {
                motion: simulation.motion(),
                position: &still,
                velocity: &still,
                inputs: &direction,
                time: 0.0,
            };
            change.force_on_gearbox(input).map(|force| 0.0 - force)
        };
        [
            push(|base| &mut base.displacement),
            push(|base| &mut base.velocity),
        ]
    };
    let bearing = |input: usize| {
        let (along_x, along_y) = (answers(input, 0), answers(input, 1));
        let [stiffness, damping] = [0, 1].map(|kind| Planar {
            xx: along_x[kind][0],
            xy: along_y[kind][0],
            yx: along_x[kind][1],
            yy: along_y[kind][1],
        });
        KnownBearing { stiffness, damping }
    };
    (0..count).map(bearing).collect()
}
