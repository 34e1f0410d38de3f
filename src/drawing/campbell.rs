//! Natural frequencies over speed, and what excites them.

use core::f64::consts::TAU;

use super::axes::{Axes, Scale, Titles};
use super::svg::{Anchor, Svg};
use crate::analysis::{Campbell, Kind};
use crate::train::GearTrain;

const WIDTH: f64 = 960.0;
const HEIGHT: f64 = 520.0;

/// The table over speed up to `highest` [Hz], with the crossings that are critical speeds. None with fewer than two speeds.
pub fn campbell_diagram(train: &GearTrain, table: &Campbell, highest: f64) -> Option<String> {
    let (first, last) = (table.points.first()?, table.points.last()?);
    if first.speed >= last.speed {
        return None;
    }
    let rpm = |speed: f64| speed * 60.0 / TAU;
    let axes = Axes {
        x: Scale::linear([rpm(first.speed), rpm(last.speed)], [56.0, WIDTH - 130.0]),
        y: Scale::linear([0.0, highest], [HEIGHT - 44.0, 34.0]),
    };
    let mut svg = Svg::new(WIDTH, HEIGHT);
    let titles = Titles {
        x: &format!("speed of {} [rpm]", train.rotors[0].name),
        y: "frequency [Hz]",
    };
    axes.draw(&mut svg, &titles);
    for excitation in &table.excitations {
        let hertz = |speed: f64| excitation.order * speed / TAU;
        // Where the ray leaves the diagram.
        let end = last.speed.min(highest * TAU / excitation.order);
        if end <= first.speed {
            continue;
        }
        let [from, to] = [first.speed, end].map(|speed| axes.at(rpm(speed), hertz(speed)));
        svg.line("ray", from, to);
        let name = name_of(train, excitation);
        let (at, anchor) = if end < last.speed {
            ([to[0] + 6.0, to[1] + 12.0], Anchor::Start)
        } else {
            ([to[0] + 6.0, to[1] + 4.0], Anchor::Start)
        };
        svg.text("label", at, anchor, &name);
    }
    draw_branches(&mut svg, &axes, table, highest);
    let speed = rpm(train.rotors[0].speed.abs());
    if speed > rpm(first.speed) && speed < rpm(last.speed) {
        svg.line("now", axes.at(speed, 0.0), axes.at(speed, highest));
        let [x, y] = axes.at(speed, highest);
        svg.text(
            "label",
            [x - 5.0, y + 28.0],
            Anchor::End,
            "speed of the file",
        );
    }
    for critical in &table.critical_speeds {
        let hertz = critical.vibration.natural.damped_frequency;
        if hertz <= highest {
            let hint = format!("{:.1} rpm, {hertz:.2} Hz", rpm(critical.speed));
            svg.circle("critical", axes.at(rpm(critical.speed), hertz), 4.0, &hint);
        }
    }
    legend(&mut svg, train.housing.is_some());
    Some(svg.finish("Campbell diagram"))
}

/// Vibrations that are one at every speed, as lines; the others as points.
fn draw_branches(svg: &mut Svg, axes: &Axes, table: &Campbell, highest: f64) {
    let rpm = |speed: f64| speed * 60.0 / TAU;
    let numbers = table
        .points
        .iter()
        .flat_map(|point| point.branches.iter().flatten());
    let count = numbers.max().map_or(0, |most| most + 1);
    for number in 0..count {
        let along = table.points.iter().map(|point| {
            let place = point
                .branches
                .iter()
                .position(|branch| *branch == Some(number));
            let vibration = place.map(|place| &point.vibrations[place]);
            let hertz = vibration.map(|one| one.natural.damped_frequency);
            let kind = vibration.map(|one| one.kind);
            (point.speed, hertz.filter(|&hertz| hertz <= highest), kind)
        });
        let along: Vec<(f64, Option<f64>, Option<Kind>)> = along.collect();
        let kind = along.iter().rev().find_map(|(_, _, kind)| *kind);
        let points = along
            .iter()
            .map(|(speed, hertz, _)| axes.at(rpm(*speed), hertz.unwrap_or(f64::NAN)));
        svg.curve(&format!("series {}", class_of(kind)), points);
    }
    for point in &table.points {
        for (vibration, branch) in point.vibrations.iter().zip(&point.branches) {
            let hertz = vibration.natural.damped_frequency;
            if branch.is_none() && hertz <= highest {
                let class = format!("point {}", class_of(Some(vibration.kind)));
                svg.circle(&class, axes.at(rpm(point.speed), hertz), 1.8, "");
            }
        }
    }
}

fn class_of(kind: Option<Kind>) -> &'static str {
    match kind {
        Some(Kind::Lateral) | None => "s1",
        Some(Kind::Torsional) => "s2",
        Some(Kind::Mesh) => "s3",
        Some(Kind::Housing) => "s4",
    }
}

fn name_of(train: &GearTrain, excitation: &crate::analysis::Excitation) -> String {
    let meshes = excitation.meshes.iter().map(|&(mesh, harmonic)| {
        let name = &train.meshes[mesh].name;
        if harmonic == 1 {
            name.clone()
        } else {
            format!("{harmonic}× {name}")
        }
    });
    let rotors = excitation
        .rotors
        .iter()
        .map(|&rotor| train.rotors[rotor].name.clone());
    let names: Vec<String> = rotors.chain(meshes).collect();
    match names.as_slice() {
        [one] => one.clone(),
        [first, ..] => format!("{first}, ..."),
        [] => String::new(),
    }
}

fn legend(svg: &mut Svg, with_housing: bool) {
    let housing = ("series s4", "housing", 82.0);
    let mut x = if with_housing { 150.0 } else { 250.0 };
    for (class, text, width) in [
        ("series s1", "lateral", 76.0),
        ("series s2", "torsional", 90.0),
        ("series s3", "mesh", 68.0),
    ]
    .into_iter()
    .chain(with_housing.then_some(housing))
    .chain([("ray", "excitation", 94.0)])
    {
        svg.line(class, [x, 12.0], [x + 20.0, 12.0]);
        svg.text("label", [x + 25.0, 16.0], Anchor::Start, text);
        x += width + 18.0;
    }
    svg.circle("critical", [x + 4.0, 12.0], 4.0, "");
    svg.text("label", [x + 13.0, 16.0], Anchor::Start, "critical speed");
}
