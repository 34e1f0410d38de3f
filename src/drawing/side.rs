//! The train seen from the side, unfolded into the plane and to scale.

use super::axes::round_step;
use super::bodies::{self, Body, is_ring, pitch_radius, shaft_radius};
use super::labels::{Label, Labels};
use super::stack::{Place, Stack};
use super::svg::{Anchor, Svg};
use super::{rpm, short};
use crate::train::{GearAddress, GearTrain, Mesh, Rotor};

/// Size of the picture [pixels]: its width, and what is left and right of the shafts.
const WIDTH: f64 = 960.0;
const LEFT: f64 = 120.0;
const RIGHT: f64 = 40.0;
/// Room above and below, for labels.
const MARGIN: f64 = 56.0;
/// Centre lines are at least so far apart [pixels].
const ROOM: f64 = 84.0;
const HIGHEST: f64 = 1300.0;

/// Shafts with their sections, gears, disks, bearings, torques, unbalances and probes.
pub fn side_view(train: &GearTrain) -> String {
    let length = train.rotors.iter().zip(Stack::of(train, 0.0).places);
    let length = length.map(|(rotor, place)| place.left + rotor.length());
    let mut scale = (WIDTH - LEFT - RIGHT) / length.fold(0.0, f64::max);
    let mut stack = Stack::of(train, ROOM / scale);
    let height = |stack: &Stack| {
        let of = |sign: f64| {
            let edges = train.rotors.iter().zip(&stack.places);
            let edges = edges.map(move |(rotor, place)| sign * place.down + bodies::extent(rotor));
            edges.fold(f64::NEG_INFINITY, f64::max)
        };
        [of(-1.0), of(1.0)]
    };
    let total = |[above, below]: [f64; 2]| above + below;
    let tall = scale * total(height(&stack));
    if tall > HIGHEST {
        scale *= HIGHEST / tall;
        stack = Stack::of(train, ROOM / scale);
    }
    let [above, below] = height(&stack);
    let top = MARGIN + scale * above;
    let frame = Frame {
        train,
        scale,
        top,
        places: stack.places.clone(),
    };
    let bottom = top + scale * below + MARGIN;
    let mut svg = Svg::new(WIDTH, bottom + 34.0);
    let mut labels = Labels::new([LEFT - 10.0, WIDTH - 4.0]);
    for (index, mesh) in train.meshes.iter().enumerate() {
        if !stack.touching[index] {
            frame.link(&mut svg, &mut labels, mesh);
        }
    }
    for index in 0..train.rotors.len() {
        frame.rotor(&mut svg, &mut labels, index);
    }
    for (index, mesh) in train.meshes.iter().enumerate() {
        if stack.touching[index] {
            frame.contact(&mut svg, &mut labels, mesh);
        }
    }
    labels.draw(&mut svg);
    frame.scale_bar(&mut svg, bottom + 14.0);
    svg.finish("The train from the side, shafts one below the other, to scale")
}

/// From metres to pixels.
struct Frame<'a> {
    train: &'a GearTrain,
    scale: f64,
    top: f64,
    places: Vec<Place>,
}

impl Frame<'_> {
    fn x(&self, rotor: usize, position: f64) -> f64 {
        LEFT + self.scale * (self.places[rotor].left + position)
    }

    fn y(&self, rotor: usize) -> f64 {
        self.top + self.scale * self.places[rotor].down
    }

    fn rotor(&self, svg: &mut Svg, labels: &mut Labels, index: usize) {
        let rotor = &self.train.rotors[index];
        let y = self.y(index);
        let ends = [self.x(index, 0.0), self.x(index, rotor.length())];
        svg.text("name", [6.0, y - 2.0], Anchor::Start, &rotor.name);
        svg.text("small", [6.0, y + 13.0], Anchor::Start, &rpm(rotor.speed));
        self.shaft(svg, index);
        for disk in &rotor.disks {
            let body = bodies::disk(rotor, disk);
            let hint = format!("disk: {} kg, {} kg m^2", disk.mass, disk.polar_inertia);
            self.body(svg, "disk", [self.x(index, disk.position), y], body, &hint);
        }
        for (number, gear) in rotor.gears.iter().enumerate() {
            let address = GearAddress {
                rotor: index,
                gear: number,
            };
            let body = bodies::gear(rotor, &gear.body, pitch_radius(self.train, address));
            let at = [self.x(index, gear.body.position), y];
            let class = if is_ring(self.train, address) {
                "ring"
            } else {
                "gear"
            };
            let hint = format!("{}: {} teeth, {} kg", gear.name, gear.teeth, gear.body.mass);
            self.body(svg, class, at, body, &hint);
            let text = format!("{}, z = {}", gear.name, gear.teeth);
            let [width, radius] = [body.half_width, body.radius].map(|size| size * self.scale);
            labels.beside([at[0] - width, at[0] + width], y - radius + 11.0, text);
        }
        svg.line("centre", [ends[0] - 10.0, y], [ends[1] + 10.0, y]);
        self.attachments(svg, labels, index);
    }

    fn shaft(&self, svg: &mut Svg, index: usize) {
        let rotor = &self.train.rotors[index];
        let (y, mut start) = (self.y(index), 0.0);
        for section in &rotor.sections {
            let [from, to] = [start, section.end].map(|position| self.x(index, position));
            let hint = format!(
                "{} mm long, diameter {} mm",
                short(1e3 * (section.end - start)),
                short(1e3 * section.outer_diameter)
            );
            let radius = 0.5 * self.scale * section.outer_diameter;
            svg.rectangle(
                "shaft",
                [from, y - radius],
                [to - from, 2.0 * radius],
                &hint,
            );
            let bore = 0.5 * self.scale * section.inner_diameter;
            for side in [-bore, bore].into_iter().filter(|_| bore > 0.0) {
                svg.line("hidden", [from, y + side], [to, y + side]);
            }
            start = section.end;
        }
    }

    fn body(&self, svg: &mut Svg, class: &str, [x, y]: [f64; 2], body: Body, hint: &str) {
        let [width, radius] = [body.half_width, body.radius].map(|size| size * self.scale);
        svg.rectangle(
            class,
            [x - width, y - radius],
            [2.0 * width, 2.0 * radius],
            hint,
        );
    }

    /// Bearings, unbalances and probes with names below the shaft, torques with names above it.
    fn attachments(&self, svg: &mut Svg, labels: &mut Labels, index: usize) {
        let rotor = &self.train.rotors[index];
        let y = self.y(index);
        let surface = |position: f64| (self.scale * shaft_radius(rotor, position)).max(2.0);
        for bearing in &rotor.bearings {
            let (x, radius) = (self.x(index, bearing.position), surface(bearing.position));
            draw_bearing(svg, [x, y], radius);
            labels.push(Label::below(x, y + radius + 17.0, bearing.name.clone()));
        }
        for unbalance in &rotor.unbalances {
            let (x, radius) = (
                self.x(index, unbalance.position),
                surface(unbalance.position),
            );
            svg.line("unbalance", [x, y], [x, y - radius - 7.0]);
            svg.circle("mass", [x, y - radius - 9.0], 3.5, &unbalance.name);
        }
        for probe in &rotor.probes {
            let (x, radius) = (self.x(index, probe.position), surface(probe.position));
            let [low, high] = [y + radius, y + radius + 10.0];
            svg.path("probe", &format!("M{x:.2} {low:.2}l4 10h-8Z"));
            labels.push(Label::below(x, high + 2.0, probe.name.clone()));
        }
        for torque in &rotor.torques {
            let (x, radius) = (self.x(index, torque.position), surface(torque.position));
            draw_torque(svg, [x, y], radius + 9.0, torque.value);
            let text = format!("{} {} N m", torque.name, short(torque.value));
            let near = rotor
                .disks
                .iter()
                .filter(|disk| disk.position == torque.position);
            let near = near.map(|disk| self.scale * bodies::disk(rotor, disk).radius);
            let edge = near.fold(radius + 8.0, f64::max);
            labels.push(Label::above(x, y - edge - 5.0, text));
        }
    }

    /// The gears of a mesh touch.
    fn contact(&self, svg: &mut Svg, labels: &mut Labels, mesh: &Mesh) {
        let [a, b] = mesh.gears;
        let position = |gear: GearAddress| self.train.gear(gear).body.position;
        let widths = mesh.gears.map(|gear| {
            let rotor: &Rotor = &self.train.rotors[gear.rotor];
            let body = &self.train.gear(gear).body;
            bodies::gear(rotor, body, pitch_radius(self.train, gear)).half_width * self.scale
        });
        let (x, width) = (
            self.x(a.rotor, position(a)),
            widths[0].min(widths[1]).max(4.0),
        );
        let [ya, yb] = [self.y(a.rotor), self.y(b.rotor)];
        let [ra, rb] = mesh.pitch_radii();
        let y = ya + (yb - ya) * ra / (ra + rb);
        svg.line("contact", [x - width, y], [x + width, y]);
        labels.before(x - widths[0].max(widths[1]), y + 4.0, mesh.name.clone());
    }

    /// A mesh between shafts that are not neighbours.
    fn link(&self, svg: &mut Svg, labels: &mut Labels, mesh: &Mesh) {
        let at = |gear: GearAddress| {
            let position = self.train.gear(gear).body.position;
            [self.x(gear.rotor, position), self.y(gear.rotor)]
        };
        let [a, b] = mesh.gears.map(at);
        svg.line("link", a, b);
        let middle = [0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1])];
        labels.before(middle[0] - 2.0, middle[1] + 4.0, mesh.name.clone());
    }

    fn scale_bar(&self, svg: &mut Svg, y: f64) {
        let length = round_step(90.0 / self.scale);
        let [from, to] = [LEFT, LEFT + self.scale * length];
        svg.line("bar", [from, y], [to, y]);
        for x in [from, to] {
            svg.line("bar", [x, y - 4.0], [x, y + 4.0]);
        }
        let text = format!("{} mm", short(1e3 * length));
        svg.text("small", [to + 8.0, y + 4.0], Anchor::Start, &text);
    }
}

/// Rolling elements on both sides of the shaft, and the ground.
fn draw_bearing(svg: &mut Svg, [x, y]: [f64; 2], radius: f64) {
    const SIZE: f64 = 9.0;
    for (from, ground) in [
        (y - radius - SIZE, y - radius - SIZE),
        (y + radius, y + radius + SIZE),
    ] {
        let left = x - 0.5 * SIZE;
        svg.rectangle("bearing", [left, from], [SIZE, SIZE], "");
        svg.line("cross", [left, from], [left + SIZE, from + SIZE]);
        svg.line("cross", [left, from + SIZE], [left + SIZE, from]);
        svg.line("ground", [x - SIZE, ground], [x + SIZE, ground]);
    }
}

/// The near side of a turn about +z: a positive torque points down in front of the shaft.
fn draw_torque(svg: &mut Svg, [x, y]: [f64; 2], radius: f64, value: f64) {
    let sign = if value < 0.0 { -1.0 } else { 1.0 };
    let [from, to] = [y - sign * radius, y + sign * radius];
    let sweep = if sign > 0.0 { 1 } else { 0 };
    svg.path(
        "torque",
        &format!("M{x:.2} {from:.2}A7 {radius:.2} 0 0 {sweep} {x:.2} {to:.2}"),
    );
    svg.arrowhead("torque-head", [x - 2.0, to], [-0.8, 0.6 * sign]);
}
