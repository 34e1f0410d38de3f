//! How large the errors of a modal basis are, over frequency.

use super::axes::{Axes, Scale, Titles};
use super::svg::{Anchor, Svg};
use crate::analysis::{Answers, BasisErrors, CHANNELS, Excites, LIMIT};

const WIDTH: f64 = 960.0;
const HEIGHT: f64 = 340.0;
/// Smaller errors are drawn as this one [%].
const LEAST: f64 = 0.01;

/// The errors of forces at meshes (full lines) and bearings (dashed) by what excites, third by third.
pub fn basis_check(errors: &BasisErrors) -> Option<String> {
    let (first, last) = (errors.bands.first()?, errors.bands.last()?);
    let axes = Axes {
        x: Scale::logarithmic([first.from, last.to], [56.0, WIDTH - 200.0]),
        y: Scale::logarithmic([LEAST, 1000.0], [HEIGHT - 44.0, 30.0]),
    };
    let mut svg = Svg::new(WIDTH, HEIGHT);
    let titles = Titles {
        x: "frequency [Hz]",
        y: "error of forces [%]",
    };
    axes.draw(&mut svg, &titles);
    let limit = 100.0 * LIMIT;
    let [from, to] = [axes.at(first.from, limit), axes.at(last.to, limit)];
    svg.line("limit", from, to);
    svg.text(
        "label",
        [from[0] + 6.0, from[1] - 5.0],
        Anchor::Start,
        &format!("limit {limit} %"),
    );
    let mut row = 44.0;
    for (channel, (excites, answers)) in CHANNELS.iter().enumerate() {
        let steps = errors.bands.iter().flat_map(|band| {
            let percent = band.channels[channel].map(|error| (100.0 * error).clamp(LEAST, 1000.0));
            let y = percent.unwrap_or(f64::NAN);
            [axes.at(band.from, y), axes.at(band.to, y)]
        });
        let steps: Vec<[f64; 2]> = steps.collect();
        if steps.iter().all(|point| point[1].is_nan()) {
            continue;
        }
        let (number, exciter) = match excites {
            Excites::Supports => (1, "all supports"),
            Excites::Bearing => (2, "one support"),
            Excites::TransmissionError => (3, "transmission error"),
            Excites::Torque => (4, "torque"),
        };
        let (dashed, force) = match answers {
            Answers::Meshes => ("", "mesh"),
            Answers::Bearings => (" dashed", "bearing"),
        };
        let class = format!("series s{number}{dashed}");
        svg.curve(&class, steps);
        let x = WIDTH - 186.0;
        svg.line(&class, [x, row - 4.0], [x + 22.0, row - 4.0]);
        svg.text(
            "label",
            [x + 28.0, row],
            Anchor::Start,
            &format!("{exciter}: {force}"),
        );
        row += 18.0;
    }
    Some(svg.finish("Errors of the modal basis over frequency"))
}
