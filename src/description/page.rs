//! The documentation page inside the FMU: what this model is, how to drive it, every variable.

use super::html::{Cell, Html};
use super::number;
use crate::config::{Config, Kind};
use crate::drawing::{axial_view, mesh_stiffness, side_view};
use crate::interface::{Causality, Interface, Variable};
use crate::model::ModalModel;
use crate::train::{GearTrain, Housing};

/// The text of `documentation/index.html`, well-formed as XML too.
pub fn documentation_page(
    config: &Config,
    train: &GearTrain,
    model: &ModalModel,
    interface: &Interface,
) -> String {
    let mut html = Html::new();
    html.text("h1", &config.name);
    html.classed("p", "lead", &config.description);
    let has_rotors = !train.rotors.is_empty();
    let sections = [
        ("train", "The train", has_rotors),
        ("usage", "Usage", true),
        ("rotors", "Rotors and meshes", has_rotors),
        ("housing", "Housing", train.housing.is_some()),
        ("variables", "Variables", true),
    ];
    let shown = sections.iter().filter(|(_, _, shown)| *shown);
    let links: Vec<(&str, &str)> = shown.map(|(id, title, _)| (*id, *title)).collect();
    html.links(&links);
    for (id, title) in links {
        html.heading(id, title);
        match (id, &train.housing) {
            ("train", _) => pictures(&mut html, train),
            ("usage", _) => usage(&mut html, config, train),
            ("rotors", _) => rotors_and_meshes(&mut html, train, model),
            ("housing", Some(housing)) => modes(&mut html, housing),
            _ => variables(&mut html, interface),
        }
    }
    html.finish(&config.name)
}

fn pictures(html: &mut Html, train: &GearTrain) {
    html.figure(
        &side_view(train),
        "From the side, to scale, unfolded: shafts one below the other, z to the right. Gears have their pitch radii; widths of gears and \
         disks, and radii of disks, are those of solid bodies with their mass and inertia. Arrows are torques, dots unbalances.",
    );
    html.figure(
        &axial_view(train),
        "Along the shafts, to scale, z towards the reader: pitch circles, base circles (dotted), lines of action, centre distances.",
    );
}

fn rotors_and_meshes(html: &mut Html, train: &GearTrain, model: &ModalModel) {
    rotors(html, train, model);
    if !train.meshes.is_empty() {
        meshes(html, train, model);
        html.figure(
            &mesh_stiffness(train),
            "Mesh stiffness over two tooth pitches.",
        );
    }
}

fn usage(html: &mut Html, config: &Config, train: &GearTrain) {
    let (paragraphs, code) = match config.kind {
        Kind::GearTrain => (usage_of_train(config), coupling(train)),
        Kind::Housing => (usage_of_housing(config), coupling_of_housing(train)),
    };
    for (number, paragraph) in paragraphs.iter().enumerate() {
        html.text("p", paragraph);
        match number {
            0 => html.code(&format!("fmpy simulate {}.fmu --show-plot", config.name)),
            1 => html.code(&code),
            _ => {}
        }
    }
    html.text(
        "p",
        "The state can be saved, restored and written as bytes, and continues to the bit; directional derivatives of all outputs along all \
         inputs, and output derivatives of order 1, are exact. Read a force or an acceleration after setting an input that it follows at \
         once, and it answers without a step.",
    );
    html.text(
        "p",
        "Parameters may be set until initialization ends, within the ranges below. Calls out of order and numbers that are not finite are \
         refused with a log message and change nothing. The model file is model.toml beside this page.",
    );
}

fn usage_of_housing(config: &Config) -> [String; 4] {
    [
        format!(
            "An FMI 2.0 co-simulation FMU made by geartrain {}: a gearbox structure by its vibration modes, shaken by forces at named \
             points. Without any input it runs alone:",
            env!("CARGO_PKG_VERSION")
        ),
        "To couple a gear train, feed the force of each rotor on the gearbox, <rotor>.<bearing>.force_x and .force_y, into \
         <point>.force_x and .force_y, and return <point>.x .y .vx .vy to <rotor>.<bearing>.housing.x .y .vx .vy. Points \
         that are only looked at have no force; <point>.ax and .ay are what an acceleration sensor there sees."
            .to_string(),
        format!(
            "Every mode is propagated exactly over a step of any length, for forces that are held over it or, with \
             fmi2SetRealInputDerivatives, change linearly ({:?} s is the file's step).",
            config.simulation.step_size
        ),
        "Initial state: the static deflection under the forces set by the end of initialization (start = equilibrium), or \
         rest."
            .to_string(),
    ]
}

fn usage_of_train(config: &Config) -> [String; 4] {
    let simulation = &config.simulation;
    [
        format!(
            "An FMI 2.0 co-simulation FMU made by geartrain {}: shafts reduced to their vibration modes, coupled by their gear meshes, on \
             bearings that the gearbox shakes. Without any input it runs alone:",
            env!("CARGO_PKG_VERSION")
        ),
        "To couple a gearbox structure, feed its displacement and velocity at each bearing into <rotor>.<bearing>.housing.x .y .vx .vy and \
         return <rotor>.<bearing>.force_x and .force_y, the forces of the rotor on the gearbox. Angles, torques and speeds are positive \
         about +z."
            .to_string(),
        format!(
            "Any communication step works; inputs are held over a step, or change linearly with fmi2SetRealInputDerivatives, so that the \
             step decides how well a changing input is seen ({:?} s is the file's). The slave takes its own steps inside, such that the \
             RMS error of every mesh force stays within simulation.tolerance = {:?} of its RMS.",
            simulation.step_size, simulation.tolerance
        ),
        "Initial state: the static solution with the mean mesh stiffness under the torques and gearbox displacements set by the end of \
         initialization (start = equilibrium), or rest."
            .to_string(),
    ]
}

/// A coupling with FMPy at the first bearing that no housing in the model holds.
fn coupling(train: &GearTrain) -> String {
    let rotors = train.rotors.iter();
    let mut names = rotors.flat_map(|rotor| {
        let bearings = rotor.bearings.iter();
        bearings.map(|bearing| format!("{}.{}", rotor.name, bearing.name))
    });
    let place = names
        .by_ref()
        .enumerate()
        .find(|(bearing, _)| !train.is_held(*bearing));
    let place = place.map_or("<rotor>.<bearing>".to_string(), |(_, name)| name);
    format!(
        "# each step, with the value references vr[name] of fmpy.read_model_description\n\
         train.setReal([vr[\"{place}.housing.x\"], vr[\"{place}.housing.vx\"]], [x, vx])\n\
         [force] = train.getReal([vr[\"{place}.force_x\"]])\n\
         train.doStep(currentCommunicationPoint=t, communicationStepSize=h)"
    )
}

/// A coupling with FMPy at the first point that takes forces.
fn coupling_of_housing(train: &GearTrain) -> String {
    let points = train.housing.iter().flat_map(|housing| &housing.points);
    let point = points.into_iter().find(|point| point.takes_forces);
    let place = point.map_or("<point>", |point| point.name.as_str());
    format!(
        "# each step, with the value references vr[name] of fmpy.read_model_description\n\
         housing.setReal([vr[\"{place}.force_x\"]], [force])\n\
         housing.doStep(currentCommunicationPoint=t, communicationStepSize=h)\n\
         [x, vx] = housing.getReal([vr[\"{place}.x\"], vr[\"{place}.vx\"]])"
    )
}

fn rotors(html: &mut Html, train: &GearTrain, model: &ModalModel) {
    let head = [
        "Rotor",
        "Length [m]",
        "Speed [rad/s]",
        "Lateral frequencies [Hz]",
        "Torsional frequencies [Hz]",
    ];
    let row = |(rotor, modal): (&crate::train::Rotor, &crate::model::Rotor)| {
        let shown = |frequencies: &[f64]| {
            let elastic = frequencies.iter().copied().filter(|&hertz| hertz > 0.0);
            Cell::list(&elastic.collect::<Vec<f64>>(), 1)
        };
        vec![
            rotor.name.as_str().into(),
            Cell::fixed(rotor.length(), 4),
            Cell::fixed(rotor.speed, 4),
            shown(&modal.lateral_frequencies),
            shown(&modal.torsional_frequencies),
        ]
    };
    let rows: Vec<Vec<Cell>> = train.rotors.iter().zip(&model.rotors).map(row).collect();
    html.table(&head, &rows);
}

fn meshes(html: &mut Html, train: &GearTrain, model: &ModalModel) {
    let head = [
        "Mesh",
        "Gear a",
        "Gear b",
        "Mesh frequency [Hz]",
        "Mean stiffness [N/m]",
        "Damping [N s/m]",
    ];
    let row = |(mesh, modal): (&crate::train::Mesh, &crate::model::Mesh)| {
        let [a, b] = mesh.gears.map(|gear| train.gear_name(gear));
        vec![
            mesh.name.as_str().into(),
            a.into(),
            b.into(),
            Cell::fixed(modal.frequency(), 3),
            Cell::scientific(modal.mean_stiffness(), 4),
            Cell::fixed(modal.damping, 1),
        ]
    };
    let rows: Vec<Vec<Cell>> = train.meshes.iter().zip(&model.meshes).map(row).collect();
    html.table(&head, &rows);
}

fn modes(html: &mut Html, housing: &Housing) {
    let modes = housing.modes.iter().zip(1..);
    let rows = modes.map(|(mode, number)| {
        vec![
            format!("{number}").into(),
            Cell::fixed(mode.frequency, 3),
            Cell::fixed(mode.damping_ratio, 4),
        ]
    });
    let rows: Vec<Vec<Cell>> = rows.collect();
    html.table(&["Mode", "Frequency [Hz]", "Damping ratio"], &rows);
}

fn variables(html: &mut Html, interface: &Interface) {
    let groups = [
        ("Inputs", Causality::Input),
        ("Outputs", Causality::Output),
        ("Parameters", Causality::Parameter),
        ("Calculated parameters", Causality::CalculatedParameter),
        ("Local variables", Causality::Local),
    ];
    for (title, causality) in groups {
        let numbered = interface.variables.iter().enumerate();
        let members = numbered.filter(|(_, variable)| variable.causality() == causality);
        let members: Vec<(usize, &Variable)> = members.collect();
        if members.is_empty() {
            continue;
        }
        html.text("h3", title);
        let starts = members.iter().any(|(_, variable)| variable.start.is_some());
        let ranges = causality == Causality::Parameter;
        let mut head = vec!["Name", "Unit"];
        head.extend(starts.then_some("Start"));
        head.extend(ranges.then_some("Range"));
        head.extend(["Description", "Reference"]);
        let row = |(reference, variable): &(usize, &Variable)| {
            let mut cells: Vec<Cell> =
                vec![variable.name.as_str().into(), variable.unit.name().into()];
            if starts {
                cells.push(variable.start.map(number).unwrap_or_default().into());
            }
            if ranges {
                cells.push(range(variable).into());
            }
            cells.push(variable.description.as_str().into());
            cells.push(reference.to_string().into());
            cells
        };
        let rows: Vec<Vec<Cell>> = members.iter().map(row).collect();
        html.table(&head, &rows);
    }
}

/// The values a parameter may take.
fn range(variable: &Variable) -> String {
    let range = variable.quantity.range();
    match (range.min, range.max) {
        (None, None) => "any".to_string(),
        (Some(min), None) => format!("≥ {min}"),
        (None, Some(max)) => format!("≤ {max}"),
        (Some(min), Some(max)) => format!("{min:?} to {max:?}"),
    }
}
