//! The same for programs. Names are part of the interface: `docs/inspect.md`.

use geartrain::analysis::{
    Answers, BandErrors, CHANNELS, Campbell, Excites, LIMIT, Place, Spot, Vibration,
};
use geartrain::model::Rotor;
use geartrain::rotor::ModalRotor;
use serde_json::{Value, json};

use super::frequencies::iso_stiffness;
use super::{BasisReport, Inspection, kind, whirl};

/// Everything as one object.
pub fn report(inspection: &Inspection) -> Value {
    let Inspection {
        train,
        model,
        vibrations,
        ..
    } = inspection;
    let rotor = |((rotor, modal), reduced): ((&geartrain::train::Rotor, &Rotor), &ModalRotor)| {
        let gears = rotor.gears.iter();
        let gears = gears.map(|gear| at(&gear.name, gear.body.position));
        let bearings = rotor.bearings.iter();
        let bearings = bearings.map(|bearing| at(&bearing.name, bearing.position));
        json!({
            "name": rotor.name,
            "speed": modal.speed,
            "gears": gears.collect::<Value>(),
            "bearings": bearings.collect::<Value>(),
            "lateral_frequencies": modal.lateral_frequencies,
            "torsional_frequencies": elastic(modal),
            "mode_shapes": mode_shapes(reduced),
        })
    };
    let mesh = |(mesh, modal): (&geartrain::train::Mesh, &geartrain::model::Mesh)| {
        json!({
            "name": mesh.name,
            "gears": mesh.gears.map(|gear| train.gear_name(gear)),
            "frequency": modal.frequency(),
            "mean_stiffness": modal.mean_stiffness(),
            "iso_6336_stiffness": iso_stiffness(mesh),
            "damping": modal.damping,
        })
    };
    let list = |vibrations: &[Vibration]| -> Value {
        vibrations
            .iter()
            .map(|one| vibration(inspection, one))
            .collect()
    };
    let creeping = |one: &Vibration| {
        json!({
            "decay_rate": one.natural.damping_ratio * one.natural.frequency * std::f64::consts::TAU,
            "kind": kind(one.kind),
            "rotor": inspection.rotor_name(one.rotor),
        })
    };
    let (table, critical_speeds) = match &inspection.campbell {
        Ok(table) => (
            campbell(inspection, table),
            critical_speeds(inspection, table),
        ),
        Err(reason) => (json!({ "points": [], "reason": reason }), json!([])),
    };
    json!({
        "name": train.name,
        "rotors": train.rotors.iter().zip(&model.rotors).zip(&inspection.reduced).map(rotor).collect::<Value>(),
        "meshes": train.meshes.iter().zip(&model.meshes).map(mesh).collect::<Value>(),
        "coupled": list(&vibrations.oscillating),
        "not_oscillating": vibrations.creeping.iter().map(creeping).collect::<Value>(),
        "rigid_motions": vibrations.rigid,
        "campbell": table,
        "critical_speeds": critical_speeds,
        "basis": basis(inspection, &inspection.basis),
        "suggested_step": inspection.step.held,
        "suggested_step_with_input_derivatives": inspection.step.with_derivatives,
    })
}

/// Torsional frequencies without the rigid rotation.
pub fn elastic(rotor: &Rotor) -> Vec<f64> {
    let frequencies = rotor.torsional_frequencies.iter().copied();
    frequencies.filter(|&hertz| hertz > 0.0).collect()
}

/// Something with a name at a position.
fn at(name: &str, position: f64) -> Value {
    json!({ "name": name, "position": position })
}

/// The shapes in the order of the frequencies, over the positions of the stations.
fn mode_shapes(rotor: &ModalRotor) -> Value {
    let lateral = (0..rotor.lateral_frequencies.len()).map(|mode| {
        let shape = rotor.lateral_shapes.column(mode);
        // Displacement and slope of every station.
        shape.iter().step_by(2).copied().collect::<Vec<f64>>()
    });
    let elastic = usize::from(rotor.has_rigid_rotation())..rotor.torsional_frequencies.len();
    let torsional = elastic.map(|mode| {
        let shape = rotor.torsional_shapes.column(mode);
        shape.iter().copied().collect::<Vec<f64>>()
    });
    json!({
        "positions": rotor.stations.positions(),
        "lateral": lateral.collect::<Vec<_>>(),
        "torsional": torsional.collect::<Vec<_>>(),
    })
}

fn vibration(inspection: &Inspection, one: &Vibration) -> Value {
    json!({
        "frequency_hz": one.natural.frequency,
        "damped_frequency_hz": one.natural.damped_frequency,
        "damping_ratio": one.natural.damping_ratio,
        "kind": kind(one.kind),
        "rotor": inspection.rotor_name(one.rotor),
        "whirl": whirl(one.whirl),
    })
}

fn campbell(inspection: &Inspection, table: &Campbell) -> Value {
    let points = table.points.iter().map(|point| {
        let modes = point.vibrations.iter().zip(&point.branches);
        let mode = |(one, branch): (&Vibration, &Option<usize>)| {
            let mut mode = vibration(inspection, one);
            mode["coupled"] = json!(branch);
            mode
        };
        json!({
            "speed": point.speed,
            "rotor_speeds": point.rotor_speeds,
            "modes": modes.map(mode).collect::<Value>(),
        })
    });
    let refused = table.refused.iter();
    json!({
        "points": points.collect::<Value>(),
        "refused": refused.map(|(speed, reason)| json!({ "speed": speed, "reason": reason })).collect::<Value>(),
    })
}

fn critical_speeds(inspection: &Inspection, table: &Campbell) -> Value {
    let found = table.critical_speeds.iter().map(|critical| {
        let excitation = &table.excitations[critical.excitation];
        let ratio = |rotor: &usize| inspection.rotor_name(*rotor);
        let mesh = |&(mesh, harmonic): &(usize, u32)| {
            json!({ "mesh": inspection.train.meshes[mesh].name, "harmonic": harmonic })
        };
        let mut entry = vibration(inspection, &critical.vibration);
        entry["speed"] = json!(critical.speed);
        entry["excitation"] = json!({
            "unbalance": excitation.rotors.iter().map(ratio).collect::<Value>(),
            "meshes": excitation.meshes.iter().map(mesh).collect::<Value>(),
        });
        entry
    });
    found.collect()
}

fn basis(inspection: &Inspection, report: &BasisReport) -> Value {
    let (errors, model) = (&report.errors, &inspection.model);
    let counts = inspection.train.rotors.iter().zip(&model.rotors);
    let counts = counts.map(|(rotor, modal)| {
        let counts = modal.counts;
        json!({
            "rotor": rotor.name,
            "lateral_modes": counts.lateral_modes,
            "torsional_modes": counts.torsional_modes,
            "lateral_static_shapes": counts.lateral - counts.lateral_modes,
            "torsional_static_shapes": counts.torsional - counts.torsional_modes,
        })
    });
    let band = |band: &BandErrors| {
        let channels = CHANNELS.iter().zip(band.channels);
        let present = channels.filter_map(|(channel, error)| error.map(|error| (channel, error)));
        let channel = |((excites, answers), error): (&(Excites, Answers), f64)| json!({ "excitation": excitation(*excites), "force": force(*answers), "error": error });
        json!({ "from": band.from, "to": band.to, "channels": present.map(channel).collect::<Value>() })
    };
    let compliances = errors.compliances.iter().map(|(spot, error)| {
        json!({
            "rotor": inspection.rotor_name(spot.rotor),
            "place": place(inspection, spot),
            "direction": if spot.torsional { "torsional" } else { "lateral" },
            "error": error,
        })
    });
    let recommended = report.recommendation.as_ref().map(|one| {
        json!({
            "max_frequency": one.max_frequency,
            "static_shapes": true,
            "lateral_modes": one.counts.iter().map(|counts| counts.lateral_modes).max(),
            "torsional_modes": one.counts.iter().map(|counts| counts.torsional_modes).max(),
            "worst_response_error": one.errors.worst_response(),
            "worst_compliance_error": one.errors.worst_compliance(),
        })
    });
    let vibration = report.vibration.as_ref().map(|one| {
        json!({ "frequency": one.frequency, "mesh_errors": one.meshes, "bearing_errors": one.bearings })
    });
    json!({
        "modes": counts.collect::<Value>(),
        "sufficient": errors.sufficient(),
        "limit": LIMIT,
        "highest_frequency": report.reference.highest_frequency,
        "good_to": errors.good_to(),
        "worst_response_error": errors.worst_response(),
        "worst_compliance_error": errors.worst_compliance(),
        "bands": errors.bands.iter().map(band).collect::<Value>(),
        "compliances": compliances.collect::<Value>(),
        "gearbox_vibration": vibration,
        "recommended": recommended,
    })
}

fn excitation(excites: Excites) -> &'static str {
    match excites {
        Excites::Supports => "supports_together",
        Excites::Bearing => "each_support",
        Excites::TransmissionError => "transmission_error",
        Excites::Torque => "torque",
    }
}

fn force(answers: Answers) -> &'static str {
    match answers {
        Answers::Meshes => "mesh",
        Answers::Bearings => "bearing",
    }
}

/// The name of what sits at a spot.
pub fn place<'a>(inspection: &'a Inspection, spot: &Spot) -> &'a str {
    let rotor = &inspection.train.rotors[spot.rotor];
    match spot.place {
        Place::Gear(index) => &rotor.gears[index].name,
        Place::Bearing(index) => &rotor.bearings[index].name,
        Place::Torque(index) => &rotor.torques[index].name,
    }
}
