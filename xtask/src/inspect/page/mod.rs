//! The answers as one page that needs nothing else: pictures, tables, all parameters.

mod answers;
mod tables;

use geartrain::description::html::Html;
use geartrain::drawing::{axial_view, mesh_stiffness, mode_shapes, side_view};

use super::Inspection;

const SECTIONS: [(&str, &str); 7] = [
    ("train", "The train"),
    ("rotors", "Rotors"),
    ("meshes", "Meshes"),
    ("vibrations", "Coupled vibrations"),
    ("basis", "Modal basis"),
    ("step", "Communication step"),
    ("parameters", "Parameters"),
];

/// The text of the page; `source` is the model file.
pub fn page(inspection: &Inspection, source: &str) -> String {
    let train = &inspection.train;
    let mut html = Html::new();
    html.text("h1", &train.name);
    html.classed("p", "lead", &train.description);
    html.links(&SECTIONS);
    html.cards(&answers::cards(inspection));
    for (id, title) in SECTIONS {
        html.heading(id, title);
        match id {
            "train" => the_train(&mut html, inspection),
            "rotors" => rotors(&mut html, inspection),
            "meshes" => meshes(&mut html, inspection),
            "vibrations" => answers::vibrations(&mut html, inspection),
            "basis" => answers::basis(&mut html, inspection),
            "step" => answers::step(&mut html, &inspection.step),
            _ => parameters(&mut html, inspection, source),
        }
    }
    html.classed(
        "p",
        "note",
        &format!(
            "Written by cargo xtask inspect, geartrain {}. Every number is defined in docs/inspect.md.",
            env!("CARGO_PKG_VERSION")
        ),
    );
    html.finish(&train.name)
}

fn the_train(html: &mut Html, inspection: &Inspection) {
    html.figure(
        &side_view(&inspection.train),
        "From the side, to scale; z runs to the right in every shaft. The train is unfolded: shafts stand one below the other, one centre \
         distance apart where neighbours mesh, further where they do not. Gears have their pitch radii; widths of gears and disks, and \
         radii of disks, are those of solid bodies with their mass and inertia. Arrows are torques, dots unbalances.",
    );
    html.figure(
        &axial_view(&inspection.train),
        "Along the shafts, to scale, z towards the reader: pitch circles (full), base circles (dotted), lines of action and centre distances.",
    );
}

fn rotors(html: &mut Html, inspection: &Inspection) {
    html.text(
        "p",
        "Each rotor by itself, undamped, on its bearings; the rigid rotation is left out.",
    );
    html.table(&tables::ROTORS, &tables::rotors(inspection));
    for (rotor, reduced) in inspection.train.rotors.iter().zip(&inspection.reduced) {
        html.figure(&mode_shapes(rotor, reduced), "");
    }
    html.classed(
        "p",
        "note",
        "Shapes of the basis modes, each with its largest deflection 1. Triangles are bearings, broad lines gears.",
    );
}

fn meshes(html: &mut Html, inspection: &Inspection) {
    if inspection.train.meshes.is_empty() {
        html.text("p", "There is no mesh.");
        return;
    }
    html.table(&tables::MESHES, &tables::meshes(inspection));
    html.figure(
        &mesh_stiffness(&inspection.train),
        "Stiffness along the line of action over two tooth pitches.",
    );
}

fn parameters(html: &mut Html, inspection: &Inspection, source: &str) {
    html.text(
        "p",
        "Parameters of the FMU with their start values; a master may set them until initialization ends.",
    );
    html.table(&tables::PARAMETERS, &tables::parameters(inspection));
    html.folded("The model file", |html| html.code(source));
}
