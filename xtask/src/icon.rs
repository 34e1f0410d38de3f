//! `model.png`: the picture that a master shows for an FMU. Two meshing gears, drawn from formulas.

use std::f64::consts::TAU;

/// Width and height [pixels].
const SIZE: u32 = 96;
/// Points per pixel and direction, for smooth edges.
const FINE: u32 = 4;

/// A gear in the unit square, y down.
struct Gear {
    centre: [f64; 2],
    /// Pitch radius.
    radius: f64,
    teeth: f64,
    /// Angle of the middle of a tooth [rad].
    phase: f64,
    colour: [u8; 3],
}

/// 11 and 17 teeth of the same module; a tooth of the first points into a gap of the second.
const GEARS: [Gear; 2] = [
    Gear {
        centre: [0.265, 0.335],
        radius: 0.198,
        teeth: 11.0,
        phase: 0.5522,
        colour: [0x1f, 0x6f, 0xb2],
    },
    Gear {
        centre: [0.6941, 0.5994],
        radius: 0.306,
        teeth: 17.0,
        phase: 0.1826,
        colour: [0x5c, 0x68, 0x74],
    },
];

/// The file's bytes, the same every time.
pub fn model_png() -> Result<Vec<u8>, String> {
    let mut pixels = Vec::new();
    for y in 0..SIZE {
        for x in 0..SIZE {
            pixels.extend(pixel(x, y));
        }
    }
    let mut file = Vec::new();
    let mut encoder = png::Encoder::new(&mut file, SIZE, SIZE);
    encoder.set_color(png::ColorType::Rgba);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_compression(png::Compression::High);
    let written = encoder.write_header().and_then(|mut writer| {
        writer.write_image_data(&pixels)?;
        writer.finish()
    });
    written.map_err(|error| format!("model.png: {error}"))?;
    Ok(file)
}

/// Colour and opacity of a pixel: the mean of its points.
fn pixel(x: u32, y: u32) -> [u8; 4] {
    let mut covered = [0_u32; GEARS.len()];
    for i in 0..FINE {
        for j in 0..FINE {
            let fine = f64::from(SIZE * FINE);
            let point = [
                (f64::from(x * FINE + i) + 0.5) / fine,
                (f64::from(y * FINE + j) + 0.5) / fine,
            ];
            if let Some(gear) = GEARS.iter().position(|gear| gear.contains(point)) {
                covered[gear] += 1;
            }
        }
    }
    let most = if covered[0] >= covered[1] { 0 } else { 1 };
    let [red, green, blue] = GEARS[most].colour;
    let points = covered.iter().sum::<u32>();
    let opacity = u8::try_from(255 * points / (FINE * FINE)).unwrap_or(u8::MAX);
    if opacity == 0 {
        [0; 4]
    } else {
        [red, green, blue, opacity]
    }
}

impl Gear {
    /// Whether a point is metal: inside the teeth, outside the bore.
    fn contains(&self, point: [f64; 2]) -> bool {
        let [x, y] = [0, 1].map(|axis| point[axis] - self.centre[axis]);
        let distance = (x * x + y * y).sqrt();
        let module = 2.0 * self.radius / self.teeth;
        // Flanks as straight lines over the angle: full width at the root, half of it at the tip.
        let turns = self.teeth * (libm::atan2(y, x) - self.phase) / TAU;
        let from_tooth = (turns - turns.round()).abs();
        let height = (distance - self.radius) / module;
        let half_width = 0.23 - 0.11 * height;
        let outer = height < -1.1 || (height < 0.92 && from_tooth < half_width);
        outer && distance > 0.3 * self.radius
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_icon_is_small_and_the_same_every_time() {
        let one = model_png().unwrap();
        assert_eq!(one, model_png().unwrap());
        assert!(
            one.starts_with(b"\x89PNG") && one.len() < 8000,
            "{} bytes",
            one.len()
        );
    }

    #[test]
    fn the_gears_touch_and_do_not_overlap() {
        let [a, b] = &GEARS;
        let [x, y] = [0, 1].map(|axis| b.centre[axis] - a.centre[axis]);
        let distance = (x * x + y * y).sqrt();
        // Centres have four digits.
        assert!((distance / (a.radius + b.radius) - 1.0).abs() < 1e-3);
        let points =
            (0..400).flat_map(|i| (0..400).map(move |j| [i, j].map(|one| f64::from(one) / 400.0)));
        let both = points.filter(|point| a.contains(*point) && b.contains(*point));
        assert_eq!(both.count(), 0);
    }
}
