//! The documentation page inside the FMU: what this model is, how to drive it, every variable.

use std::io;

use quick_xml::events::{BytesText, Event};

use super::{Xml, number, written};
use crate::config::{Config, Kind};
use crate::interface::{Causality, Interface, Variable};
use crate::model::ModalModel;
use crate::train::{GearTrain, Housing};

const STYLE: &str = "body{font:16px/1.5 system-ui,sans-serif;max-width:70rem;margin:2rem auto;padding:0 1rem;color:#222}\
table{border-collapse:collapse;width:100%;margin:1rem 0;font-size:.9em}\
td,th{border-bottom:1px solid #ddd;padding:.3rem .6rem;text-align:left;vertical-align:top}\
th{background:#f4f4f4}td.n{text-align:right;font-variant-numeric:tabular-nums}\
code{background:#f4f4f4;padding:0 .2em}h1,h2{line-height:1.2}";

/// The text of `documentation/index.html`, well-formed as XML too.
pub fn documentation_page(
    config: &Config,
    train: &GearTrain,
    model: &ModalModel,
    interface: &Interface,
) -> String {
    let page = written(|html| {
        let root = html.create_element("html").with_attribute(("lang", "en"));
        root.write_inner_content(|html| {
            html.create_element("head").write_inner_content(|html| {
                html.create_element("meta")
                    .with_attribute(("charset", "utf-8"))
                    .write_empty()?;
                text(html, "title", &config.name)?;
                text(html, "style", STYLE)
            })?;
            html.create_element("body").write_inner_content(|html| {
                text(html, "h1", &config.name)?;
                text(html, "p", &config.description)?;
                usage(html, config)?;
                if !train.rotors.is_empty() {
                    text(html, "h2", "Rotors")?;
                    rotors(html, train, model)?;
                }
                if !train.meshes.is_empty() {
                    text(html, "h2", "Meshes")?;
                    meshes(html, train, model)?;
                }
                if let Some(housing) = &train.housing {
                    text(html, "h2", "Housing")?;
                    modes(html, housing)?;
                }
                variables(html, interface)
            })?;
            Ok(())
        })?;
        Ok(())
    });
    format!("<!DOCTYPE html>\n{page}")
}

fn usage(html: &mut Xml, config: &Config) -> io::Result<()> {
    let own = match config.kind {
        Kind::GearTrain => usage_of_train(config),
        Kind::Housing => usage_of_housing(config),
    };
    let always = [
        "Beyond that: the state can be saved, restored and written as bytes, and continues to the bit; directional \
         derivatives of all outputs along all inputs, and output derivatives of order 1, are exact. Read a force or an \
         acceleration after setting an input that it follows at once, and it answers without a step.",
        "Parameters may be set until initialization ends. Calls out of order and numbers that are not finite are refused \
         with a log message and change nothing.",
    ];
    let always = always.map(str::to_string);
    own.iter()
        .chain(&always)
        .try_for_each(|paragraph| text(html, "p", paragraph))
}

fn usage_of_housing(config: &Config) -> [String; 4] {
    let name = &config.name;
    [
        format!(
            "An FMI 2.0 co-simulation FMU made by geartrain {}: a gearbox structure by its vibration modes, shaken by \
             forces at named points. Without any input it runs alone: fmpy simulate {name}.fmu",
            env!("CARGO_PKG_VERSION")
        ),
        "To couple a gear train, feed the force of each rotor on the gearbox, <rotor>.<bearing>.force_x and .force_y, into \
         <point>.force_x and .force_y, and return <point>.x .y .vx .vy to <rotor>.<bearing>.housing.x .y .vx .vy. Points \
         that are only looked at have no force; <point>.ax and .ay are what an acceleration sensor there sees."
            .to_string(),
        format!(
            "Every mode is propagated exactly over a step of any length, for forces that are held over it or, with \
             fmi2SetRealInputDerivatives, change linearly ({} s is suggested).",
            config.simulation.step_size
        ),
        "Initial state: the static deflection under the forces set by the end of initialization (start = equilibrium), or \
         rest."
            .to_string(),
    ]
}

fn usage_of_train(config: &Config) -> [String; 4] {
    let Config {
        name, simulation, ..
    } = config;
    [
        format!(
            "An FMI 2.0 co-simulation FMU made by geartrain {}: shafts reduced to their vibration modes, \
             coupled by their gear meshes, on bearings that the gearbox shakes. Without any input it runs \
             alone: fmpy simulate {name}.fmu",
            env!("CARGO_PKG_VERSION")
        ),
        "To couple a gearbox structure, feed its displacement and velocity at each bearing into \
         <rotor>.<bearing>.housing.x .y .vx .vy and return <rotor>.<bearing>.force_x and .force_y, the \
         forces of the rotor on the gearbox. Angles, torques and speeds are positive about +z."
            .to_string(),
        format!(
            "Any communication step works; inputs are held over a step, or change linearly with \
             fmi2SetRealInputDerivatives, so that the step decides how well \
             a changing input is seen ({} s is suggested). The slave takes its own steps inside, such that \
             the RMS error of every mesh force stays within simulation.tolerance = {} of its RMS.",
            simulation.step_size, simulation.tolerance
        ),
        "Initial state: the static solution with the mean mesh stiffness under the torques and gearbox displacements set \
         by the end of initialization (start = equilibrium), or rest."
            .to_string(),
    ]
}

fn rotors(html: &mut Xml, train: &GearTrain, model: &ModalModel) -> io::Result<()> {
    let head = [
        "Rotor",
        "Length [m]",
        "Speed [rad/s]",
        "Lateral frequencies [Hz]",
        "Torsional frequencies [Hz]",
    ];
    table(html, &head, |html| {
        for (rotor, modal) in train.rotors.iter().zip(&model.rotors) {
            let list = |frequencies: &[f64]| {
                let shown = frequencies.iter().filter(|&&hertz| hertz > 0.0);
                shown
                    .map(|hertz| format!("{hertz:.1}"))
                    .collect::<Vec<_>>()
                    .join(", ")
            };
            let cells = [
                rotor.name.clone(),
                format!("{:.4}", rotor.length()),
                format!("{:.4}", rotor.speed),
                list(&modal.lateral_frequencies),
                list(&modal.torsional_frequencies),
            ];
            row(html, &cells)?;
        }
        Ok(())
    })
}

fn meshes(html: &mut Xml, train: &GearTrain, model: &ModalModel) -> io::Result<()> {
    let head = [
        "Mesh",
        "Gear a",
        "Gear b",
        "Mesh frequency [Hz]",
        "Mean stiffness [N/m]",
        "Damping [N s/m]",
    ];
    table(html, &head, |html| {
        for (mesh, modal) in train.meshes.iter().zip(&model.meshes) {
            let [a, b] = mesh.gears.map(|gear| train.gear_name(gear));
            let cells = [
                mesh.name.clone(),
                a,
                b,
                format!("{:.3}", modal.frequency()),
                format!("{:.6e}", modal.mean_stiffness()),
                format!("{:.1}", modal.damping),
            ];
            row(html, &cells)?;
        }
        Ok(())
    })
}

fn modes(html: &mut Xml, housing: &Housing) -> io::Result<()> {
    let head = ["Mode", "Frequency [Hz]", "Damping ratio"];
    table(html, &head, |html| {
        for (mode, number) in housing.modes.iter().zip(1..) {
            let cells = [
                format!("{number}"),
                format!("{:.3}", mode.frequency),
                format!("{:.4}", mode.damping_ratio),
            ];
            row(html, &cells)?;
        }
        Ok(())
    })
}

fn variables(html: &mut Xml, interface: &Interface) -> io::Result<()> {
    let groups = [
        ("Inputs", Causality::Input),
        ("Outputs", Causality::Output),
        ("Parameters", Causality::Parameter),
        ("Calculated parameters", Causality::CalculatedParameter),
        ("Local variables", Causality::Local),
    ];
    for (title, causality) in groups {
        let members: Vec<(usize, &Variable)> = interface
            .variables
            .iter()
            .enumerate()
            .filter(|(_, variable)| variable.causality() == causality)
            .collect();
        if members.is_empty() {
            continue;
        }
        text(html, "h2", title)?;
        table(
            html,
            &["Name", "Unit", "Start", "Description", "Reference"],
            |html| {
                for (reference, variable) in members {
                    let cells = [
                        variable.name.clone(),
                        variable.unit.name().to_string(),
                        variable.start.map(number).unwrap_or_default(),
                        variable.description.clone(),
                        reference.to_string(),
                    ];
                    row(html, &cells)?;
                }
                Ok(())
            },
        )?;
    }
    Ok(())
}

fn table(
    html: &mut Xml,
    head: &[&str],
    rows: impl FnOnce(&mut Xml) -> io::Result<()>,
) -> io::Result<()> {
    html.create_element("table").write_inner_content(|html| {
        html.create_element("tr").write_inner_content(|html| {
            head.iter().try_for_each(|title| text(html, "th", title))
        })?;
        rows(html)
    })?;
    Ok(())
}

fn row(html: &mut Xml, cells: &[String]) -> io::Result<()> {
    html.create_element("tr")
        .write_inner_content(|html| cells.iter().try_for_each(|cell| text(html, "td", cell)))?;
    Ok(())
}

fn text(html: &mut Xml, element: &str, content: &str) -> io::Result<()> {
    html.create_element(element)
        .write_inner_content(|html| html.write_event(Event::Text(BytesText::new(content))))?;
    Ok(())
}
