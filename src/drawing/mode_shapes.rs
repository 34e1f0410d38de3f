//! The shapes of a rotor's basis modes over its length.

use super::axes::{Axes, Scale, Titles};
use super::svg::{Anchor, Svg};
use crate::rotor::ModalRotor;
use crate::train::Rotor;

const WIDTH: f64 = 960.0;
const HEIGHT: f64 = 240.0;
/// Shapes shown at most, so that they can be told apart.
const MOST: usize = 4;

/// A natural frequency [Hz] and the deflection of every station.
type Mode = (f64, Vec<f64>);

/// Lateral shapes on the left, elastic torsional ones on the right, each with its largest deflection 1.
pub fn mode_shapes(rotor: &Rotor, reduced: &ModalRotor) -> String {
    let mut svg = Svg::new(WIDTH, HEIGHT);
    // Displacement and slope of every station.
    let lateral = (0..reduced.lateral_frequencies.len()).map(|mode| {
        let shape = reduced.lateral_shapes.column(mode);
        let values = shape.iter().step_by(2).copied().collect();
        (reduced.lateral_frequencies[mode], values)
    });
    let elastic = usize::from(reduced.has_rigid_rotation())..reduced.torsional_frequencies.len();
    let torsional = elastic.map(|mode| {
        let shape = reduced.torsional_shapes.column(mode);
        (
            reduced.torsional_frequencies[mode],
            shape.iter().copied().collect(),
        )
    });
    let positions = reduced.stations.positions();
    let panels: [(f64, &str, Vec<Mode>); 2] = [
        (44.0, "lateral", lateral.take(MOST).collect()),
        (524.0, "torsional", torsional.take(MOST).collect()),
    ];
    for (left, kind, modes) in panels {
        let axes = Axes {
            x: Scale::linear([0.0, rotor.length()], [left, left + 336.0]),
            y: Scale::linear([-1.1, 1.1], [HEIGHT - 42.0, 30.0]),
        };
        let title = format!("{} of {}", kind, rotor.name);
        axes.draw(
            &mut svg,
            &Titles {
                x: "z [m]",
                y: &title,
            },
        );
        mark_places(&mut svg, &axes, rotor);
        for (number, (hertz, shape)) in modes.iter().enumerate() {
            let class = format!("series s{}", number + 1);
            let largest = shape
                .iter()
                .copied()
                .max_by(|a, b| a.abs().total_cmp(&b.abs()));
            let unit = largest.filter(|value| *value != 0.0).unwrap_or(1.0);
            let points = positions.iter().zip(shape);
            svg.curve(&class, points.map(|(z, value)| axes.at(*z, value / unit)));
            let y = 44.0 + 17.0 * number as f64;
            svg.line(&class, [left + 344.0, y - 4.0], [left + 362.0, y - 4.0]);
            let text = format!("{hertz:.1} Hz");
            svg.text("label", [left + 367.0, y], Anchor::Start, &text);
        }
        if modes.is_empty() {
            svg.text(
                "label",
                axes.at(0.5 * rotor.length(), 0.3),
                Anchor::Middle,
                "no elastic mode in the basis",
            );
        }
    }
    svg.finish(&format!("Mode shapes of {}", rotor.name))
}

/// Bearings as triangles below the axis, gears as lines across.
fn mark_places(svg: &mut Svg, axes: &Axes, rotor: &Rotor) {
    let zero = axes.y.at(0.0);
    svg.line("zero", [axes.x.pixels[0], zero], [axes.x.pixels[1], zero]);
    for gear in &rotor.gears {
        let x = axes.x.at(gear.body.position);
        svg.line("gear-place", [x, axes.y.pixels[0]], [x, axes.y.pixels[1]]);
    }
    for bearing in &rotor.bearings {
        let x = axes.x.at(bearing.position);
        svg.path("bearing", &format!("M{x:.2} {zero:.2}l5 9h-10Z"));
    }
}
