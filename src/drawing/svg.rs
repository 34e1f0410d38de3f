//! A picture as SVG text: shapes with classes, whose colours a style sheet gives.

use core::fmt::Write;

use quick_xml::escape::escape;

/// A picture while it is drawn; x to the right, y down, in pixels.
#[derive(Debug, Clone)]
pub(super) struct Svg {
    width: f64,
    height: f64,
    body: String,
}

/// Which end of a text stands at its place.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Anchor {
    Start,
    Middle,
    End,
}

impl Svg {
    pub(super) fn new(width: f64, height: f64) -> Svg {
        Svg {
            width,
            height,
            body: String::new(),
        }
    }

    /// The finished picture; `title` says what it shows.
    pub(super) fn finish(self, title: &str) -> String {
        let [width, height] = [self.width, self.height].map(pixels);
        format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width} {height}\" width=\"{width}\" height=\"{height}\" \
             role=\"img\" class=\"drawing\">\n<title>{}</title>\n{}</svg>\n",
            escape(title),
            self.body
        )
    }

    pub(super) fn line(&mut self, class: &str, from: [f64; 2], to: [f64; 2]) {
        let [[x1, y1], [x2, y2]] = [from, to].map(|point| point.map(pixels));
        self.push(format_args!(
            "<line class=\"{class}\" x1=\"{x1}\" y1=\"{y1}\" x2=\"{x2}\" y2=\"{y2}\"/>"
        ));
    }

    /// A rectangle by its upper left corner and its size; `hint` appears under the pointer.
    pub(super) fn rectangle(&mut self, class: &str, corner: [f64; 2], size: [f64; 2], hint: &str) {
        let ([x, y], [width, height]) = (corner.map(pixels), size.map(pixels));
        let shape = format!(
            "<rect class=\"{class}\" x=\"{x}\" y=\"{y}\" width=\"{width}\" height=\"{height}\""
        );
        self.hinted(&shape, "rect", hint);
    }

    pub(super) fn circle(&mut self, class: &str, centre: [f64; 2], radius: f64, hint: &str) {
        let ([x, y], r) = (centre.map(pixels), pixels(radius));
        let shape = format!("<circle class=\"{class}\" cx=\"{x}\" cy=\"{y}\" r=\"{r}\"");
        self.hinted(&shape, "circle", hint);
    }

    pub(super) fn path(&mut self, class: &str, path: &str) {
        self.push(format_args!("<path class=\"{class}\" d=\"{path}\"/>"));
    }

    /// A line through points; parts that are not numbers interrupt it.
    pub(super) fn curve(&mut self, class: &str, points: impl IntoIterator<Item = [f64; 2]>) {
        let mut path = String::new();
        let mut letter = 'M';
        for point in points {
            if point.iter().any(|value| !value.is_finite()) {
                letter = 'M';
                continue;
            }
            let [x, y] = point.map(pixels);
            let _ = write!(path, "{letter}{x} {y}");
            letter = 'L';
        }
        if !path.is_empty() {
            self.path(class, &path);
        }
    }

    pub(super) fn text(&mut self, class: &str, at: [f64; 2], anchor: Anchor, text: &str) {
        let [x, y] = at.map(pixels);
        let anchor = match anchor {
            Anchor::Start => "start",
            Anchor::Middle => "middle",
            Anchor::End => "end",
        };
        let text = escape(text);
        self.push(format_args!(
            "<text class=\"{class}\" x=\"{x}\" y=\"{y}\" text-anchor=\"{anchor}\">{text}</text>"
        ));
    }

    /// An arrowhead that points along `direction` (a unit vector).
    pub(super) fn arrowhead(&mut self, class: &str, tip: [f64; 2], direction: [f64; 2]) {
        const SIZE: f64 = 7.0;
        let ([x, y], [dx, dy]) = (tip, direction);
        let corner = |side: f64| {
            [
                x - SIZE * dx - side * 0.45 * SIZE * dy,
                y - SIZE * dy + side * 0.45 * SIZE * dx,
            ]
            .map(pixels)
        };
        let [[x1, y1], [x2, y2]] = [corner(1.0), corner(-1.0)];
        let [x, y] = tip.map(pixels);
        self.path(class, &format!("M{x} {y}L{x1} {y1}L{x2} {y2}Z"));
    }

    fn hinted(&mut self, shape: &str, element: &str, hint: &str) {
        if hint.is_empty() {
            self.push(format_args!("{shape}/>"));
        } else {
            let hint = escape(hint);
            self.push(format_args!("{shape}><title>{hint}</title></{element}>"));
        }
    }

    fn push(&mut self, element: core::fmt::Arguments<'_>) {
        let _ = writeln!(self.body, "{element}");
    }
}

/// A coordinate with two decimals at most.
fn pixels(value: f64) -> String {
    let text = format!("{value:.2}");
    let text = text.trim_end_matches('0').trim_end_matches('.');
    if text == "-0" {
        "0".to_string()
    } else {
        text.to_string()
    }
}

/// The width of a text in the small font of drawings [pixels]: an estimate from its letters.
pub(super) fn text_width(text: &str) -> f64 {
    6.4 * text.chars().count() as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_from_a_model_file_cannot_break_a_picture() {
        let mut svg = Svg::new(10.0, 10.0);
        svg.text("label", [1.0, 2.5], Anchor::Start, "<b> & \"c\"");
        svg.circle("gear", [0.0, -0.001], 3.0, "a<b");
        let text = svg.finish("x < y");
        assert!(text.contains("&lt;b&gt; &amp; &quot;c&quot;"));
        assert!(text.contains("cy=\"0\"") && text.contains("<title>a&lt;b</title></circle>"));
        assert!(text.contains("<title>x &lt; y</title>"));
    }

    #[test]
    fn a_curve_is_interrupted_where_it_has_no_value() {
        let mut svg = Svg::new(10.0, 10.0);
        svg.curve(
            "series",
            [[0.0, 1.0], [1.0, f64::NAN], [2.0, 1.0], [3.0, 4.0]],
        );
        assert!(svg.finish("").contains("d=\"M0 1M2 1L3 4\""));
    }
}
