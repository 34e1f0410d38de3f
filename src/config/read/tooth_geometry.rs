//! `[mesh.stiffness]` with `law = "tooth_geometry"`.

use core::f64::consts::PI;

use super::super::dimension::{ANGLE, Dimension, LENGTH, MODULES};
use super::super::document::Table;
use super::super::{MeshStiffness, ToothGeometry};

pub(super) fn tooth_geometry(table: &Table<'_, '_>) -> MeshStiffness {
    let pair = |key, default: f64| pair(table, key, &MODULES).unwrap_or([default; 2]);
    MeshStiffness::ToothGeometry(ToothGeometry {
        face_width: table.number("face_width", &LENGTH),
        module: table.number("module", &LENGTH),
        rack_pressure_angle: table.number_or("rack_pressure_angle", &ANGLE, 20.0 * PI / 180.0),
        addendum: pair("addendum", 1.0),
        dedendum: pair("dedendum", 1.25),
        profile_shift: pair("profile_shift", 0.0),
        bore_radius: self::pair(table, "bore_radius", &LENGTH),
        material: materials(table),
    })
}

/// Numbers for gears a and b; `None` when there are none.
fn pair(table: &Table<'_, '_>, key: &'static str, kind: &Dimension) -> Option<[f64; 2]> {
    let numbers = table.optional_numbers(key, kind)?;
    let found = numbers.len();
    <[f64; 2]>::try_from(numbers).ok().or_else(|| {
        if found > 0 {
            let rule = "must be a list of two numbers, for gears a and b";
            table.problem(key, format!("{rule}, found {found}"));
        }
        Some([f64::NAN; 2])
    })
}

/// One name for both gears, or a list of two.
fn materials(table: &Table<'_, '_>) -> [String; 2] {
    let both = |name: String| [name.clone(), name];
    let Some(names) = table.strings("material") else {
        return both("default".to_string());
    };
    match <[String; 2]>::try_from(names) {
        Ok(names) => names,
        Err(one) if one.len() == 1 => both(one.concat()),
        Err(_) => {
            let rule = "must be the name of a material, or a list of two, for gears a and b";
            table.problem("material", rule);
            both(String::new())
        }
    }
}
