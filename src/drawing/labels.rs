//! Names beside what they name, moved until they do not cover each other.

use super::svg::{Anchor, Svg, text_width};

const ROW: f64 = 13.0;

/// A name and where it would best stand.
#[derive(Debug, Clone)]
pub(super) struct Label {
    /// What it names: where a line to it ends.
    x: f64,
    /// Height of the nearest row's base line.
    y: f64,
    /// +1: further rows lie below; -1: above.
    direction: f64,
    anchor: Anchor,
    class: &'static str,
    text: String,
}

/// All names of a picture.
#[derive(Debug)]
pub(super) struct Labels {
    bounds: [f64; 2],
    /// Left, right, base line.
    taken: Vec<[f64; 3]>,
    placed: Vec<([f64; 2], Label)>,
}

impl Label {
    /// The same in the style of another class.
    pub(super) fn of(self, class: &'static str) -> Label {
        Label { class, ..self }
    }

    pub(super) fn below(x: f64, edge: f64, text: String) -> Label {
        Label {
            x,
            y: edge + 9.0,
            direction: 1.0,
            anchor: Anchor::Middle,
            class: "label",
            text,
        }
    }

    pub(super) fn above(x: f64, edge: f64, text: String) -> Label {
        Label {
            x,
            y: edge,
            direction: -1.0,
            anchor: Anchor::Middle,
            class: "label",
            text,
        }
    }
}

impl Labels {
    pub(super) fn new(bounds: [f64; 2]) -> Labels {
        Labels {
            bounds,
            taken: Vec::new(),
            placed: Vec::new(),
        }
    }

    /// A name right of a body, or left of it where the picture ends.
    pub(super) fn beside(&mut self, [left, right]: [f64; 2], y: f64, text: String) {
        let fits = right + 4.0 + text_width(&text) < self.bounds[1];
        let (x, anchor) = if fits {
            (right + 4.0, Anchor::Start)
        } else {
            (left - 4.0, Anchor::End)
        };
        self.push(Label {
            x,
            y,
            direction: 1.0,
            anchor,
            class: "label",
            text,
        });
    }

    /// A name left of something.
    pub(super) fn before(&mut self, x: f64, y: f64, text: String) {
        self.push(Label {
            x: x - 4.0,
            y,
            direction: 1.0,
            anchor: Anchor::End,
            class: "label",
            text,
        });
    }

    /// Places a label in the first row where there is room.
    pub(super) fn push(&mut self, label: Label) {
        let bold = if label.class == "name" { 1.15 } else { 1.0 };
        let width = bold * text_width(&label.text);
        let start = match label.anchor {
            Anchor::Start => label.x,
            Anchor::Middle => label.x - 0.5 * width,
            Anchor::End => label.x - width,
        };
        let last = (self.bounds[1] - width).max(self.bounds[0]);
        let left = start.clamp(self.bounds[0].min(last), last);
        let mut y = label.y;
        let covered = |y: f64, taken: &[[f64; 3]]| {
            let meets = |other: &[f64; 3]| {
                left < other[1] + 5.0 && left + width > other[0] - 5.0 && (y - other[2]).abs() < ROW
            };
            taken.iter().any(meets)
        };
        while covered(y, &self.taken) {
            y += label.direction * ROW;
        }
        self.taken.push([left, left + width, y]);
        self.placed.push(([left, y], label));
    }

    pub(super) fn draw(self, svg: &mut Svg) {
        for ([left, y], label) in self.placed {
            if label.class == "label" && (y - label.y).abs() > 0.5 {
                let [from, to] = [label.y - 9.0 * label.direction, y - 9.0 * label.direction];
                let to = if label.direction < 0.0 { y + 2.0 } else { to };
                svg.line("leader", [label.x, from], [label.x, to]);
            }
            svg.text(label.class, [left, y], Anchor::Start, &label.text);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_give_way_to_each_other_and_stay_inside() {
        let mut labels = Labels::new([0.0, 200.0]);
        for x in [50.0, 52.0, 150.0, 199.0] {
            labels.push(Label::below(x, 0.0, "bearing".to_string()));
        }
        let rows: Vec<f64> = labels.taken.iter().map(|taken| taken[2]).collect();
        assert_eq!(rows, [9.0, 9.0 + ROW, 9.0, 9.0 + ROW]);
        assert!(labels.taken.iter().all(|taken| taken[1] <= 200.0));
    }
}
