//! The ranges of parameters in modelDescription.xml are those that the rules enforce, and nominal values are sizes that occur.

mod support;

use geartrain::config::read;
use geartrain::description::model_description;
use geartrain::interface::{Interface, Parameter, Quantity};
use geartrain::model::ModalModel;
use geartrain::train::{load_beside, validate};
use support::{beside, three_stage};

/// Models that between them have every parameter.
fn models() -> Vec<String> {
    let file = |name: &str| {
        let path = format!("{}/tests/models/{name}.toml", env!("CARGO_MANIFEST_DIR"));
        std::fs::read_to_string(path).unwrap()
    };
    let housing = concat!(env!("CARGO_MANIFEST_DIR"), "/examples/gearbox_housing.toml");
    let housing = std::fs::read_to_string(housing).unwrap();
    vec![
        three_stage(),
        file("rattle"),
        file("rolling"),
        housing,
        file("known_box"),
    ]
}

#[test]
fn the_ends_of_a_range_are_valid_and_what_lies_beyond_is_refused() {
    let mut bounded = 0;
    for text in models() {
        let loaded = load_beside(&text, &beside).unwrap();
        let model = ModalModel::assemble(&loaded.train, None).unwrap();
        let interface = Interface::of(&loaded.config, &loaded.train, &model);
        for variable in &interface.variables {
            let Quantity::Parameter(parameter) = variable.quantity else {
                continue;
            };
            let valid = |value: f64| {
                let mut config = read(&text, &beside).config.unwrap();
                *parameter.slot(&mut config) = value;
                // Rotors meshed with the first one follow in the slave; here they would only contradict it.
                if matches!(parameter, Parameter::MeanSpeed { .. }) {
                    config.meshes.clear();
                }
                validate(&config).is_ok()
            };
            let range = variable.quantity.range();
            let start = variable.start.unwrap();
            assert!(
                range.min.is_none_or(|min| min <= start)
                    && range.max.is_none_or(|max| start <= max)
            );
            for (end, beyond) in [(range.min, -1.0), (range.max, 1.0)] {
                let Some(end) = end else { continue };
                bounded += 1;
                // Bounds that are not allowed themselves: no stiffness, and a mode that nothing holds.
                let open = matches!(
                    parameter,
                    Parameter::StiffnessFactor { .. } | Parameter::HousingFrequency { .. }
                );
                let inside = if open { 1e-9 } else { end };
                assert!(valid(inside), "{} = {inside}", variable.name);
                let outside = end + beyond * (1e-3 * end.abs()).max(1e-15);
                assert!(!valid(outside), "{} = {outside}", variable.name);
            }
        }
    }
    assert!(bounded > 30);
}

/// The attribute of a variable in the description.
fn attribute(xml: &str, variable: &str, name: &str) -> Option<f64> {
    let element = xml.split(&format!("name=\"{variable}\"")).nth(1)?;
    let real = element.split("<Real").nth(1)?.split("/>").next()?;
    let text = real.split(&format!(" {name}=\"")).nth(1)?;
    text.split('"').next()?.parse().ok()
}

#[test]
fn nominal_values_are_the_sizes_of_the_static_solution() {
    let loaded = load_beside(&three_stage(), &beside).unwrap();
    let model = ModalModel::assemble(&loaded.train, None).unwrap();
    let interface = Interface::of(&loaded.config, &loaded.train, &model);
    let xml = model_description(&loaded.config, &loaded.train, &model, &interface);
    let nominal = |variable: &str| attribute(&xml, variable, "nominal");
    // 1125 N m / 0.1074 m = 10474 N, 6.6e8 N/m, one digit each.
    assert_eq!(nominal("mesh12.force"), Some(1e4));
    assert_eq!(nominal("mesh12.stiffness"), Some(7e8));
    assert_eq!(nominal("mesh12.deflection"), Some(2e-5));
    assert_eq!(nominal("stage2.gear.mesh_torque"), Some(1e3));
    assert_eq!(nominal("stage1.drive.torque"), Some(2e3));
    assert_eq!(nominal("stage1.speed"), Some(3e2));
    assert_eq!(
        nominal("stage1.b1.stiffness.xx"),
        None,
        "parameters have a start value"
    );
    for variable in &interface.variables {
        let scale = nominal(&variable.name);
        assert!(
            scale.is_none_or(|scale| scale > 0.0 && scale.is_finite()),
            "{}",
            variable.name
        );
    }
    assert_eq!(attribute(&xml, "simulation.tolerance", "max"), Some(0.1));
    assert_eq!(attribute(&xml, "stage1.b1.damping.xx", "min"), Some(0.0));
    assert_eq!(attribute(&xml, "stage1.b1.damping.xy", "min"), None);
}
