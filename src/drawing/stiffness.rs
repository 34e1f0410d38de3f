//! Mesh stiffness over two tooth pitches.

use super::axes::{Axes, Scale, Titles};
use super::svg::{Anchor, Svg};
use crate::train::{GearTrain, Mesh};

const WIDTH: f64 = 960.0;
const ROW: f64 = 230.0;
/// Points per piece of a law.
const POINTS: u32 = 60;

/// One diagram per mesh, two in a row.
pub fn mesh_stiffness(train: &GearTrain) -> String {
    let rows = train.meshes.len().div_ceil(2);
    let mut svg = Svg::new(WIDTH, ROW * rows as f64);
    for (index, mesh) in train.meshes.iter().enumerate() {
        let corner = [(index % 2) as f64 * 0.5 * WIDTH, (index / 2) as f64 * ROW];
        diagram(&mut svg, corner, mesh);
    }
    svg.finish("Mesh stiffness over two tooth pitches")
}

fn diagram(svg: &mut Svg, [left, top]: [f64; 2], mesh: &Mesh) {
    let points = two_pitches(mesh);
    let mean = 1e-6 * mesh.stiffness_factor * mesh.stiffness.mean();
    let most = points.iter().fold(mean, |most, point| most.max(point[1]));
    let axes = Axes {
        x: Scale::linear([0.0, 2.0], [left + 52.0, left + 448.0]),
        y: Scale::linear([0.0, 1.15 * most], [top + ROW - 42.0, top + 30.0]),
    };
    let title = format!("{}: k [N/µm]", mesh.name);
    let titles = Titles {
        x: "tooth pitches",
        y: &title,
    };
    axes.draw(svg, &titles);
    let [from, to] = [axes.at(0.0, mean), axes.at(2.0, mean)];
    svg.line("mean", from, to);
    let text = format!("mean {mean:.1}");
    svg.text("label", [to[0], to[1] - 4.0], Anchor::End, &text);
    svg.curve("series s1", points.into_iter().map(|[p, k]| axes.at(p, k)));
}

/// Phase [pitches] and stiffness [N/um], both sides of every jump included.
fn two_pitches(mesh: &Mesh) -> Vec<[f64; 2]> {
    let starts = mesh.stiffness.starts();
    let mut points = Vec::new();
    for pitch in [0.0, 1.0] {
        let mut edges = vec![0.0];
        edges.extend(
            starts
                .iter()
                .copied()
                .filter(|&start| start > 0.0 && start < 1.0),
        );
        edges.push(1.0);
        for piece in edges.windows(2) {
            let law = mesh.stiffness.piece(0.5 * (piece[0] + piece[1]));
            for step in 0..=POINTS {
                let part = f64::from(step) / f64::from(POINTS);
                let cycle = piece[0] + part * (piece[1] - piece[0]);
                let value = mesh.stiffness_factor * mesh.stiffness.value(cycle, law);
                points.push([pitch + cycle, 1e-6 * value]);
            }
        }
    }
    points
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::train::load;

    #[test]
    fn a_rectangular_law_jumps_straight_up() {
        let text = include_str!("../../tests/models/reducer.toml");
        let train = load(text).unwrap().train;
        let points = two_pitches(&train.meshes[0]);
        // Two pieces around the period's end make three edges and a jump in the middle of each pitch.
        let jumps = points
            .windows(2)
            .filter(|pair| (pair[1][1] - pair[0][1]).abs() > 100.0);
        let jumps: Vec<f64> = jumps.map(|pair| pair[1][0] - pair[0][0]).collect();
        assert!(
            jumps.len() >= 3 && jumps.iter().all(|&width| width == 0.0),
            "{jumps:?}"
        );
        assert!(
            points
                .iter()
                .all(|point| point[1] == 210.0 || point[1] == 360.0)
        );
    }
}
