//! `[[rotor]]` with everything on it.

use super::super::dimension::{
    ANGLE, ANGULAR_SPEED, CUBIC_STIFFNESS, DAMPING, INERTIA, LENGTH, MASS, NUMBER, STIFFNESS,
    TORQUE, TORSIONAL_DAMPING, TORSIONAL_STIFFNESS, UNBALANCE, force_per_power,
};
use super::super::document::Table;
use super::super::{
    BaseCircle, BasisSupport, Bearing, Bow, Disk, Gear, OutsideSpeeds, Probe, RadialForce, Rotor,
    Segment, SpeedPoint, SpeedTable, Torque, Unbalance,
};
use super::planar::planar;

/// `free`: the rotation is a state, and `speed` its start value, 0 when absent.
pub(super) fn rotor(table: Table<'_, '_>, free: bool) -> Rotor {
    let rotor = Rotor {
        name: table.string("name"),
        speed: if free {
            table.number_or("speed", &ANGULAR_SPEED, 0.0)
        } else {
            table.number("speed", &ANGULAR_SPEED)
        },
        angle: table.number_or("angle", &ANGLE, 0.0),
        max_element_length: table.optional_number("max_element_length", &LENGTH),
        lateral_damping_ratio: table.number_or("lateral_damping_ratio", &NUMBER, 0.0),
        torsional_damping_ratio: table.number_or("torsional_damping_ratio", &NUMBER, 0.0),
        segments: each(&table, "segment", segment),
        disks: each(&table, "disk", disk),
        gears: each(&table, "gear", gear),
        bearings: each(&table, "bearing", bearing),
        unbalances: each(&table, "unbalance", unbalance),
        bows: each(&table, "bow", bow),
        torques: each(&table, "torque", torque),
        basis_supports: each(&table, "basis_support", basis_support),
        probes: each(&table, "probe", probe),
    };
    table.finish();
    rotor
}

/// Reads every table `[[key]]` with `item` and closes it.
fn each<T>(table: &Table<'_, '_>, key: &'static str, item: fn(&Table<'_, '_>) -> T) -> Vec<T> {
    let read_one = |inner: Table<'_, '_>| {
        let value = item(&inner);
        inner.finish();
        value
    };
    table.tables(key).into_iter().map(read_one).collect()
}

fn segment(table: &Table<'_, '_>) -> Segment {
    Segment {
        length: table.number("length", &LENGTH),
        outer_diameter: table.number("outer_diameter", &LENGTH),
        inner_diameter: table.number_or("inner_diameter", &LENGTH, 0.0),
        material: table
            .optional_string("material")
            .unwrap_or_else(|| "default".to_string()),
    }
}

fn disk(table: &Table<'_, '_>) -> Disk {
    Disk {
        position: table.number("position", &LENGTH),
        mass: table.number("mass", &MASS),
        polar_inertia: table.number("polar_inertia", &INERTIA),
        diametral_inertia: table.number("diametral_inertia", &INERTIA),
    }
}

fn gear(table: &Table<'_, '_>) -> Gear {
    let teeth = table.count("teeth");
    Gear {
        name: table.string("name"),
        body: disk(table),
        teeth: u32::try_from(teeth).unwrap_or(u32::MAX),
        base: base_circle(table),
    }
}

fn base_circle(table: &Table<'_, '_>) -> BaseCircle {
    let radius = table.optional_number("base_radius", &LENGTH);
    let module = table.optional_number("module", &LENGTH);
    let pressure_angle = table.optional_number("pressure_angle", &ANGLE);
    match (radius, module, pressure_angle) {
        (Some(radius), None, None) => BaseCircle::Radius(radius),
        (None, Some(module), Some(pressure_angle)) => BaseCircle::Rack {
            module,
            pressure_angle,
        },
        (None, None, None) => {
            let message = "missing; give base_radius, or module and pressure_angle";
            table.problem("base_radius", message);
            BaseCircle::Radius(f64::NAN)
        }
        _ => {
            let message = "give either base_radius alone, or module and pressure_angle together";
            table.problem("base_radius", message);
            BaseCircle::Radius(f64::NAN)
        }
    }
}

fn bearing(table: &Table<'_, '_>) -> Bearing {
    let at_speed = speed_table(table);
    if at_speed.is_some() {
        for key in ["stiffness", "damping"] {
            if table.has(key) {
                table.problem(key, "contradicts at_speed; give one or the other");
            }
        }
    } else if !table.has("stiffness") {
        table.problem("stiffness", "missing; give stiffness, or at_speed");
    }
    Bearing {
        name: table.string("name"),
        position: table.number("position", &LENGTH),
        stiffness: planar(table, "stiffness", &STIFFNESS),
        damping: planar(table, "damping", &DAMPING),
        at_speed,
        nonlinear: table.table("nonlinear").map(radial_force),
    }
}

/// `at_speed` and `outside_speeds`.
fn speed_table(bearing: &Table<'_, '_>) -> Option<SpeedTable> {
    let choices = [
        ("refuse", OutsideSpeeds::Refuse),
        ("hold", OutsideSpeeds::Hold),
    ];
    let outside = bearing.choice("outside_speeds", Some(OutsideSpeeds::Refuse), &choices);
    if bearing.has("at_speed") {
        return Some(SpeedTable {
            points: each(bearing, "at_speed", speed_point),
            outside: outside.unwrap_or(OutsideSpeeds::Refuse),
        });
    }
    if bearing.has("outside_speeds") {
        bearing.problem("outside_speeds", "has a meaning only with at_speed");
    }
    None
}

fn speed_point(table: &Table<'_, '_>) -> SpeedPoint {
    if !table.has("stiffness") {
        table.problem("stiffness", "missing");
    }
    SpeedPoint {
        speed: table.number("speed", &ANGULAR_SPEED),
        stiffness: planar(table, "stiffness", &STIFFNESS),
        damping: planar(table, "damping", &DAMPING),
    }
}

fn radial_force(table: Table<'_, '_>) -> RadialForce {
    type ReadLaw = fn(&Table<'_, '_>) -> RadialForce;
    let laws: [(&str, ReadLaw); 3] = [
        ("clearance", |table| RadialForce {
            clearance: table.number("clearance", &LENGTH),
            coefficient: table.number("stiffness", &STIFFNESS),
            exponent: 1.0,
        }),
        ("cubic", |table| RadialForce {
            clearance: table.number_or("clearance", &LENGTH, 0.0),
            coefficient: table.number("coefficient", &CUBIC_STIFFNESS),
            exponent: 3.0,
        }),
        ("hertz", hertz),
    ];
    // Without a law nobody can say which keys are known: the table is not finished.
    let Some(read_law) = table.choice("law", None, &laws) else {
        return RadialForce::NONE;
    };
    let force = read_law(&table);
    table.finish();
    force
}

fn hertz(table: &Table<'_, '_>) -> RadialForce {
    let exponent = table.number_or("exponent", &NUMBER, 1.5);
    let written = table.as_written("exponent").unwrap_or("1.5");
    // The unit of a coefficient whose exponent is wrong is not known.
    let coefficient = if exponent.is_finite() || !table.has("coefficient") {
        table.number("coefficient", &force_per_power(written))
    } else {
        f64::NAN
    };
    RadialForce {
        clearance: table.number_or("clearance", &LENGTH, 0.0),
        coefficient,
        exponent,
    }
}

fn unbalance(table: &Table<'_, '_>) -> Unbalance {
    Unbalance {
        name: table.string("name"),
        position: table.number("position", &LENGTH),
        moment: table.number("moment", &UNBALANCE),
        phase: table.number_or("phase", &ANGLE, 0.0),
    }
}

fn bow(table: &Table<'_, '_>) -> Bow {
    Bow {
        positions: table.numbers("positions", &LENGTH),
        amplitudes: table.numbers("amplitudes", &LENGTH),
        phase: table.number_or("phase", &ANGLE, 0.0),
    }
}

fn torque(table: &Table<'_, '_>) -> Torque {
    Torque {
        name: table.string("name"),
        position: table.number("position", &LENGTH),
        value: table.number_or("value", &TORQUE, 0.0),
        slope: table.number_or("slope", &TORSIONAL_DAMPING, 0.0),
    }
}

fn basis_support(table: &Table<'_, '_>) -> BasisSupport {
    BasisSupport {
        position: table.number("position", &LENGTH),
        lateral: table.number_or("lateral", &STIFFNESS, 0.0),
        torsional: table.number_or("torsional", &TORSIONAL_STIFFNESS, 0.0),
    }
}

fn probe(table: &Table<'_, '_>) -> Probe {
    Probe {
        name: table.string("name"),
        position: table.number("position", &LENGTH),
    }
}
