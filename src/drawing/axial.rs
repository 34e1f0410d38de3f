//! The train seen along its shafts, to scale: x to the right, y up, z towards the reader.

use core::f64::consts::PI;

use super::bodies::{is_ring, pitch_radius};
use super::labels::{Label, Labels};
use super::svg::{Anchor, Svg};
use super::{rpm, short};
use crate::train::{GearAddress, GearTrain, Mesh, centres, speed_ratios};

const WIDTH: f64 = 960.0;
const MARGIN: f64 = 34.0;
const HIGHEST: f64 = 560.0;
/// A ring's outer edge, relative to its pitch circle.
const RIM: f64 = 1.12;

/// Pitch circles, centre distances, lines of action and directions of rotation.
pub fn axial_view(train: &GearTrain) -> String {
    let radii: Vec<f64> = (0..train.rotors.len())
        .map(|rotor| radius(train, rotor))
        .collect();
    let centres = apart(train, centres(train), &radii);
    let edge = |axis: usize, sign: f64| {
        let edges = centres.iter().zip(&radii);
        let edges = edges.map(|(centre, radius)| sign * centre[axis] + radius);
        edges.fold(f64::NEG_INFINITY, f64::max)
    };
    let [left, right, low, high] = [edge(0, -1.0), edge(0, 1.0), edge(1, -1.0), edge(1, 1.0)];
    let room = [WIDTH - 2.0 * MARGIN, HIGHEST - 2.0 * MARGIN];
    let scale = (room[0] / (left + right)).min(room[1] / (low + high));
    let frame = Frame {
        train,
        scale,
        origin: [
            0.5 * (WIDTH - scale * (right - left)),
            MARGIN + scale * high,
        ],
        centres,
        radii,
    };
    let mut svg = Svg::new(WIDTH, 2.0 * MARGIN + scale * (low + high));
    for index in 0..train.rotors.len() {
        frame.rotor(&mut svg, index);
    }
    let mut labels = Labels::new([4.0, WIDTH - 4.0]);
    for index in 0..train.rotors.len() {
        frame.name(&mut labels, index);
    }
    for (index, mesh) in train.meshes.iter().enumerate() {
        frame.line_of_action(&mut svg, mesh);
        // Of several meshes between the same centres, one tells their distance.
        let ends = |mesh: &Mesh| mesh.gears.map(|gear| frame.centres[gear.rotor]);
        let told = train.meshes[..index]
            .iter()
            .any(|other| frame.same(ends(other), ends(mesh)));
        if !told {
            frame.distance(&mut svg, &mut labels, mesh);
        }
    }
    labels.draw(&mut svg);
    frame.directions(&mut svg);
    svg.finish("The train along its shafts, with centre distances, to scale")
}

/// How far a rotor reaches [m].
fn radius(train: &GearTrain, rotor: usize) -> f64 {
    let shaft = train.rotors[rotor].sections.iter();
    let shaft = shaft.map(|section| 0.5 * section.outer_diameter);
    let gears = (0..train.rotors[rotor].gears.len()).map(|gear| {
        let address = GearAddress { rotor, gear };
        let rim = if is_ring(train, address) { RIM } else { 1.0 };
        rim * pitch_radius(train, address)
    });
    shaft.chain(gears).fold(0.0, f64::max)
}

/// Trains that no mesh connects stand beside each other.
fn apart(train: &GearTrain, mut centres: Vec<[f64; 2]>, radii: &[f64]) -> Vec<[f64; 2]> {
    let ratios = speed_ratios(train);
    let mut edge: Option<f64> = None;
    for leader in 0..centres.len() {
        let members: Vec<usize> = (0..centres.len())
            .filter(|&rotor| ratios[rotor].leader == leader)
            .collect();
        if members.is_empty() {
            continue;
        }
        let reach = |sign: f64, centres: &[[f64; 2]]| {
            let edges = members
                .iter()
                .map(|&one| sign * centres[one][0] + radii[one]);
            edges.fold(f64::NEG_INFINITY, f64::max)
        };
        if let Some(edge) = edge {
            let shift = edge + 0.3 * radii[leader] + reach(-1.0, &centres);
            for &member in &members {
                centres[member][0] += shift;
            }
        }
        edge = Some(reach(1.0, &centres));
    }
    centres
}

struct Frame<'a> {
    train: &'a GearTrain,
    scale: f64,
    origin: [f64; 2],
    centres: Vec<[f64; 2]>,
    radii: Vec<f64>,
}

impl Frame<'_> {
    fn at(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        [
            self.origin[0] + self.scale * x,
            self.origin[1] - self.scale * y,
        ]
    }

    fn rotor(&self, svg: &mut Svg, index: usize) {
        let rotor = &self.train.rotors[index];
        let centre = self.at(self.centres[index]);
        for (number, gear) in rotor.gears.iter().enumerate() {
            let address = GearAddress {
                rotor: index,
                gear: number,
            };
            let pitch = self.scale * pitch_radius(self.train, address);
            let hint = format!("{}.{}: {} teeth", rotor.name, gear.name, gear.teeth);
            if is_ring(self.train, address) {
                svg.circle("ring", centre, RIM * pitch, &hint);
                svg.circle("ring", centre, pitch, &hint);
            } else {
                svg.circle("gear", centre, pitch, &hint);
            }
            svg.circle("base", centre, self.scale * gear.base_radius, "");
        }
        let shaft = rotor.sections.iter().map(|section| section.outer_diameter);
        let shaft = shaft.fold(0.0, f64::max);
        svg.circle("shaft", centre, 0.5 * self.scale * shaft, &rotor.name);
        let tick = 5.0;
        svg.line(
            "centre",
            [centre[0] - tick, centre[1]],
            [centre[0] + tick, centre[1]],
        );
        svg.line(
            "centre",
            [centre[0], centre[1] - tick],
            [centre[0], centre[1] + tick],
        );
        if rotor.speed != 0.0 {
            let smallest = 0.5 * self.scale * shaft + 7.0;
            self.turn(svg, centre, smallest, rotor.speed.signum());
        }
    }

    /// An arrow around a centre; positive is counterclockwise here.
    fn turn(&self, svg: &mut Svg, [x, y]: [f64; 2], radius: f64, sign: f64) {
        let point = |angle: f64| [x + radius * libm::cos(angle), y - radius * libm::sin(angle)];
        let [from, to] = [0.25 * PI, 0.25 * PI + sign * 1.4 * PI].map(point);
        let sweep = if sign > 0.0 { 0 } else { 1 };
        svg.path(
            "turn",
            &format!(
                "M{:.2} {:.2}A{radius:.2} {radius:.2} 0 1 {sweep} {:.2} {:.2}",
                from[0], from[1], to[0], to[1]
            ),
        );
        let end = 0.25 * PI + sign * 1.4 * PI;
        let along = [-sign * libm::sin(end), -sign * libm::cos(end)];
        svg.arrowhead(
            "turn-head",
            [to[0] + 4.0 * along[0], to[1] + 4.0 * along[1]],
            along,
        );
    }

    /// The line along which the teeth push, through the pitch point.
    fn line_of_action(&self, svg: &mut Svg, mesh: &Mesh) {
        let centre = self.centres[mesh.gears[0].rotor];
        let [ra, _] = mesh.pitch_radii();
        // A ring is touched on the far side of its centre.
        let side = if mesh.line.is_internal() { -ra } else { ra };
        let along = mesh.line.center_line;
        let pitch_point = [0, 1].map(|axis| centre[axis] + side * along[axis]);
        let normal = mesh.line.normal;
        let at =
            |length: f64| self.at([0, 1].map(|axis| pitch_point[axis] + length * normal[axis]));
        let half = (0.4 * ra).max(16.0 / self.scale);
        svg.line("action", at(-half), at(half));
        svg.circle("pitch-point", at(0.0), 2.5, &mesh.name);
    }

    /// The line between the centres, with its length.
    fn distance(&self, svg: &mut Svg, labels: &mut Labels, mesh: &Mesh) {
        let [from, to] = mesh.gears.map(|gear| self.at(self.centres[gear.rotor]));
        svg.line("distance", from, to);
        let offset = mesh.centre_offset();
        let distance = libm::hypot(offset[0], offset[1]);
        let [ra, rb] = mesh.pitch_radii();
        // Clear of the line of action: in the larger gear.
        let part = match (mesh.line.is_internal(), rb > ra) {
            (true, _) => 0.5,
            (false, true) => (ra + 0.45 * rb) / distance,
            (false, false) => 0.55 * ra / distance,
        };
        let [x, y] = [0, 1].map(|axis| from[axis] + part * (to[axis] - from[axis]));
        let text = format!("{} mm", short(1e3 * distance));
        labels.push(Label::above(x, y - 5.0, text).of("dimension"));
    }

    /// Whether two lines join the same centres.
    fn same(&self, one: [[f64; 2]; 2], other: [[f64; 2]; 2]) -> bool {
        let close =
            |a: [f64; 2], b: [f64; 2]| self.scale * libm::hypot(a[0] - b[0], a[1] - b[1]) < 2.0;
        let swapped = [other[1], other[0]];
        [other, swapped]
            .iter()
            .any(|other| close(one[0], other[0]) && close(one[1], other[1]))
    }

    /// The rotor's name and speed below its shaft.
    fn name(&self, labels: &mut Labels, index: usize) {
        let here = self.centres[index];
        let near = |&other: &usize| {
            let there = self.centres[other];
            libm::hypot(there[0] - here[0], there[1] - here[1]) < 0.05 * self.radii[index]
        };
        let shafts = (0..self.centres.len()).filter(near).flat_map(|other| {
            let sections = self.train.rotors[other].sections.iter();
            sections.map(|section| section.outer_diameter)
        });
        let shaft = shafts.fold(0.0, f64::max);
        let [x, y] = self.at(here);
        let rotor = &self.train.rotors[index];
        let text = format!("{}, {}", rotor.name, rpm(rotor.speed));
        let edge = y + 0.5 * self.scale * shaft + 16.0;
        labels.push(Label::below(x, edge, text).of("name"));
    }

    fn directions(&self, svg: &mut Svg) {
        let [x, y] = [22.0, 60.0];
        svg.line("bar", [x, y], [x + 30.0, y]);
        svg.arrowhead("bar-head", [x + 34.0, y], [1.0, 0.0]);
        svg.line("bar", [x, y], [x, y - 30.0]);
        svg.arrowhead("bar-head", [x, y - 34.0], [0.0, -1.0]);
        svg.text("small", [x + 38.0, y + 4.0], Anchor::Start, "x");
        svg.text("small", [x - 3.0, y - 39.0], Anchor::Start, "y");
    }
}
