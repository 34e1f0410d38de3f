//! What a file with a housing alone describes: its modes and where they move its points.

use geartrain::train::{Housing, HousingMode};
use serde_json::{Value, json};

/// The point that a mode moves most, and how far in x and y [1/sqrt(kg)].
fn loudest<'h>(housing: &'h Housing, mode: &HousingMode) -> (&'h str, [f64; 2]) {
    let size = |[x, y]: &[f64; 2]| x * x + y * y;
    let shapes = housing.points.iter().zip(&mode.shape);
    let most = shapes.max_by(|(_, one), (_, two)| size(one).total_cmp(&size(two)));
    most.map_or(("", [0.0; 2]), |(point, shape)| (&point.name, *shape))
}

/// For people.
pub(super) fn print(name: &str, housing: &Housing) {
    println!("{name}: a housing with {} modes\n", housing.modes.len());
    println!("  mode   frequency   damping   moves most");
    for (mode, number) in housing.modes.iter().zip(1..) {
        let (point, [x, y]) = loudest(housing, mode);
        println!(
            "{number:6} {:9.2} Hz {:7.2} %   {point} ({x:.3}, {y:.3}) 1/sqrt(kg)",
            mode.frequency,
            100.0 * mode.damping_ratio
        );
    }
    let names = |takes_forces: bool| {
        let points = housing.points.iter();
        let those = points.filter(|point| point.takes_forces == takes_forces);
        let names: Vec<&str> = those.map(|point| point.name.as_str()).collect();
        if names.is_empty() {
            "none".to_string()
        } else {
            names.join(", ")
        }
    };
    println!(
        "\nforces act on: {}\nonly looked at: {}",
        names(true),
        names(false)
    );
}

/// For programs.
pub(super) fn report(name: &str, housing: &Housing) -> Value {
    let point = |index: usize| {
        json!({
            "name": housing.points[index].name,
            "takes_forces": housing.points[index].takes_forces,
        })
    };
    let mode = |mode: &HousingMode| {
        json!({
            "frequency": mode.frequency,
            "damping_ratio": mode.damping_ratio,
            "shape": mode.shape,
        })
    };
    json!({
        "name": name,
        "points": (0..housing.points.len()).map(point).collect::<Vec<Value>>(),
        "modes": housing.modes.iter().map(mode).collect::<Vec<Value>>(),
    })
}
