//! `[[mesh]]` with its stiffness law.

use super::super::dimension::{ANGLE, DAMPING, LENGTH, NUMBER, PITCHES, STIFFNESS};
use super::super::document::Table;
use super::super::{
    Contact, ErrorHarmonic, Flank, Mesh, MeshDamping, MeshStiffness, TorqueCoupling,
};
use super::tooth_geometry::tooth_geometry;

pub(super) fn mesh(table: Table<'_, '_>) -> Mesh {
    let consistent = TorqueCoupling::Consistent;
    let couplings = [
        ("consistent", consistent),
        ("as_printed", TorqueCoupling::AsPrinted),
    ];
    let (contact, backlash) = contact(&table);
    let mesh = Mesh {
        name: table.string("name"),
        gears: table.pair_of_strings("gears"),
        center_angle: table.number("center_angle", &ANGLE),
        pressure_angle: table.number("pressure_angle", &ANGLE),
        internal: table.boolean_or("internal", false),
        flank: flank(&table),
        phase: table.optional_number("phase", &PITCHES),
        damping: mesh_damping(&table),
        contact,
        backlash,
        torque_coupling: table
            .choice("torque_coupling", Some(consistent), &couplings)
            .unwrap_or(consistent),
        stiffness: mesh_stiffness(&table),
        stiffness_factor: 1.0,
        transmission_error: table
            .tables("transmission_error")
            .into_iter()
            .map(error_harmonic)
            .collect(),
    };
    table.finish();
    mesh
}

fn error_harmonic(table: Table<'_, '_>) -> ErrorHarmonic {
    let harmonic = ErrorHarmonic {
        order: table.count("order"),
        amplitude: table.number("amplitude", &LENGTH),
        phase: table.number_or("phase", &ANGLE, 0.0),
    };
    table.finish();
    harmonic
}

fn contact(table: &Table<'_, '_>) -> (Contact, f64) {
    let contacts = [
        ("bilateral", Contact::Bilateral),
        ("unilateral", Contact::Unilateral),
    ];
    let contact = table.choice("contact", Some(Contact::Bilateral), &contacts);
    let backlash = table.number_or("backlash", &LENGTH, 0.0);
    if contact == Some(Contact::Bilateral) && backlash != 0.0 {
        let message = format!(
            "must be 0 with bilateral contact, found {backlash}; backlash needs contact = \"unilateral\""
        );
        table.problem("backlash", message);
    }
    (contact.unwrap_or(Contact::Bilateral), backlash)
}

fn flank(table: &Table<'_, '_>) -> Flank {
    match table.number_or("flank", &NUMBER, 1.0) {
        1.0 => Flank::Positive,
        -1.0 => Flank::Negative,
        other => {
            if other.is_finite() {
                table.problem("flank", format!("must be +1 or -1, found {other}"));
            }
            Flank::Positive
        }
    }
}

fn mesh_damping(table: &Table<'_, '_>) -> MeshDamping {
    match (
        table.optional_number("damping_ratio", &NUMBER),
        table.optional_number("damping", &DAMPING),
    ) {
        (Some(_), Some(_)) => {
            let message = "contradicts damping_ratio; give one or the other";
            table.problem("damping", message);
            MeshDamping::Ratio(0.0)
        }
        (Some(ratio), None) => MeshDamping::Ratio(ratio),
        (None, Some(coefficient)) => MeshDamping::Coefficient(coefficient),
        (None, None) => MeshDamping::Ratio(0.0),
    }
}

fn mesh_stiffness(mesh: &Table<'_, '_>) -> MeshStiffness {
    let placeholder = MeshStiffness::Constant { mean: 1.0 };
    let Some(table) = mesh.table("stiffness") else {
        if !mesh.has("stiffness") {
            mesh.problem("stiffness", "missing; write a table [mesh.stiffness]");
        }
        return placeholder;
    };
    type ReadLaw = fn(&Table<'_, '_>) -> MeshStiffness;
    let laws: [(&str, ReadLaw); 6] = [
        ("constant", |table| MeshStiffness::Constant {
            mean: table.number("mean", &STIFFNESS),
        }),
        ("rectangular", rectangular),
        ("tooth_pair", tooth_pair),
        ("tooth_geometry", tooth_geometry),
        ("fourier", fourier),
        ("table", |table| MeshStiffness::Table {
            phase: table.numbers("phase", &PITCHES),
            value: table.numbers("value", &STIFFNESS),
        }),
    ];
    // Without a law nobody can say which keys are known: the table is not finished.
    let Some(read_law) = table.choice("law", None, &laws) else {
        return placeholder;
    };
    let stiffness = read_law(&table);
    table.finish();
    stiffness
}

fn rectangular(table: &Table<'_, '_>) -> MeshStiffness {
    let contact_ratio = table.number("contact_ratio", &NUMBER);
    let pair = table.optional_number("pair", &STIFFNESS);
    let single = table.optional_number("single", &STIFFNESS);
    let double = table.optional_number("double", &STIFFNESS);
    match (pair, single, double) {
        (Some(pair), None, None) => MeshStiffness::Rectangular {
            fewer_pairs: contact_ratio.floor() * pair,
            more_pairs: (contact_ratio.floor() + 1.0) * pair,
            contact_ratio,
        },
        (None, Some(single), Some(double)) => {
            if contact_ratio >= 2.0 {
                let rule = "with single and double must be in [1, 2)";
                table.problem("contact_ratio", format!("{rule}, found {contact_ratio}"));
            }
            MeshStiffness::Rectangular {
                fewer_pairs: single,
                more_pairs: double,
                contact_ratio,
            }
        }
        _ => {
            let message = "missing or ambiguous; give either pair alone, or single and double";
            table.problem("pair", message);
            MeshStiffness::Constant { mean: 1.0 }
        }
    }
}

fn tooth_pair(table: &Table<'_, '_>) -> MeshStiffness {
    MeshStiffness::ToothPair {
        pair: table.number("pair", &STIFFNESS),
        quadratic: table.number_or("quadratic", &NUMBER, 0.0),
        quartic: table.number_or("quartic", &NUMBER, 0.0),
        ramp: table.number_or("ramp", &PITCHES, 0.0),
        contact_ratio: table.number("contact_ratio", &NUMBER),
    }
}

fn fourier(table: &Table<'_, '_>) -> MeshStiffness {
    let cosine = table.optional_numbers("cosine", &NUMBER);
    let sine = table.optional_numbers("sine", &NUMBER);
    if cosine.is_none() && sine.is_none() {
        table.problem("cosine", "missing; give cosine, sine, or both");
    }
    MeshStiffness::Fourier {
        mean: table.number("mean", &STIFFNESS),
        cosine: cosine.unwrap_or_default(),
        sine: sine.unwrap_or_default(),
    }
}
