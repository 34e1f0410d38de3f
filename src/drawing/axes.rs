//! The frame of a diagram: scales, ticks and labels.

use super::svg::{Anchor, Svg};

/// One axis: from a range of values to pixels.
#[derive(Debug, Clone, Copy)]
pub(super) struct Scale {
    pub(super) values: [f64; 2],
    pub(super) pixels: [f64; 2],
    pub(super) logarithmic: bool,
}

/// A diagram's frame in a picture.
pub(super) struct Axes {
    pub(super) x: Scale,
    pub(super) y: Scale,
}

/// What stands along the axes.
pub(super) struct Titles<'a> {
    pub(super) x: &'a str,
    pub(super) y: &'a str,
}

impl Scale {
    pub(super) fn linear(values: [f64; 2], pixels: [f64; 2]) -> Scale {
        Scale {
            values,
            pixels,
            logarithmic: false,
        }
    }

    pub(super) fn logarithmic(values: [f64; 2], pixels: [f64; 2]) -> Scale {
        Scale {
            values,
            pixels,
            logarithmic: true,
        }
    }

    pub(super) fn at(&self, value: f64) -> f64 {
        let along = |value: f64| {
            if self.logarithmic {
                libm::log10(value)
            } else {
                value
            }
        };
        let [from, to] = self.values.map(along);
        let part = (along(value) - from) / (to - from);
        self.pixels[0] + part * (self.pixels[1] - self.pixels[0])
    }

    /// Round values with about `count` intervals between; decades on a logarithmic axis.
    fn ticks(&self, count: f64) -> Vec<f64> {
        let [from, to] = self.values;
        if self.logarithmic {
            let decades =
                libm::floor(libm::log10(from)) as i32..=libm::ceil(libm::log10(to)) as i32;
            let values = decades.map(|decade| libm::pow(10.0, f64::from(decade)));
            let inside = |value: &f64| *value >= from * 0.999 && *value <= to * 1.001;
            return values.filter(inside).collect();
        }
        let step = round_step((to - from) / count);
        let first = libm::ceil(from / step - 1e-9) as i64;
        let last = libm::floor(to / step + 1e-9) as i64;
        (first..=last).map(|index| index as f64 * step).collect()
    }
}

/// 1, 2 or 5 times a power of ten, near `step`.
pub(super) fn round_step(step: f64) -> f64 {
    let power = libm::pow(10.0, libm::floor(libm::log10(step)));
    let lead = [1.0, 2.0, 5.0]
        .into_iter()
        .find(|lead| lead * power >= 0.999 * step);
    lead.unwrap_or(10.0) * power
}

impl Axes {
    /// Draws grid, frame, ticks and titles.
    pub(super) fn draw(&self, svg: &mut Svg, titles: &Titles<'_>) {
        let ([left, right], [bottom, top]) = (self.x.pixels, self.y.pixels);
        for value in self.x.ticks((right - left) / 90.0) {
            let x = self.x.at(value);
            svg.line("grid", [x, bottom], [x, top]);
            svg.text("tick", [x, bottom + 15.0], Anchor::Middle, &tick(value));
        }
        for value in self.y.ticks((bottom - top) / 30.0) {
            let y = self.y.at(value);
            svg.line("grid", [left, y], [right, y]);
            svg.text("tick", [left - 6.0, y + 4.0], Anchor::End, &tick(value));
        }
        svg.line("axis", [left, bottom], [right, bottom]);
        svg.line("axis", [left, bottom], [left, top]);
        svg.text("title", [right, bottom + 31.0], Anchor::End, titles.x);
        svg.text("title", [left - 6.0, top - 9.0], Anchor::Start, titles.y);
    }

    /// The point of a pair of values.
    pub(super) fn at(&self, x: f64, y: f64) -> [f64; 2] {
        [self.x.at(x), self.y.at(y)]
    }
}

/// A tick's number as people write it.
fn tick(value: f64) -> String {
    if value != 0.0 && !(1e-3..1e5).contains(&value.abs()) {
        return format!("{value:e}").replace("e", " e");
    }
    let text = format!("{value:.4}");
    text.trim_end_matches('0').trim_end_matches('.').to_string()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ticks_are_round_and_inside() {
        let scale = Scale::linear([0.0, 4500.0], [0.0, 900.0]);
        assert_eq!(
            scale.ticks(9.0),
            [
                0.0, 500.0, 1000.0, 1500.0, 2000.0, 2500.0, 3000.0, 3500.0, 4000.0, 4500.0
            ]
        );
        let scale = Scale::logarithmic([0.5, 200.0], [0.0, 900.0]);
        assert_eq!(scale.ticks(9.0), [1.0, 10.0, 100.0]);
        assert_eq!(tick(0.25), "0.25");
    }

    #[test]
    fn a_logarithmic_axis_gives_every_decade_the_same_room() {
        let scale = Scale::logarithmic([1.0, 100.0], [0.0, 10.0]);
        assert!((scale.at(10.0) - 5.0).abs() < 1e-12);
    }
}
