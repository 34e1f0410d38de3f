//! `cargo xtask inspect --html`: one page that needs nothing else, with the numbers of `--format json`.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::process::Command;

use quick_xml::events::Event;
use serde_json::Value;

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

/// Models that between them show every kind of picture: loops, rings, trains without mesh, bows, bearings over speed.
const MODELS: [&str; 6] = [
    "examples/three_stage.toml",
    "examples/two_shaft.toml",
    "tests/models/star.toml",
    "tests/models/ring.toml",
    "tests/models/bowed.toml",
    "tests/models/journal.toml",
];

fn inspect(model: &Path, words: &[&str]) -> String {
    let mut command = Command::new(env!("CARGO_BIN_EXE_xtask"));
    let output = command
        .arg("inspect")
        .arg(model)
        .args(words)
        .output()
        .unwrap();
    assert!(output.status.success(), "{}: {output:?}", model.display());
    String::from_utf8(output.stdout).unwrap()
}

/// The page of a model, and its file.
fn page(model: &Path) -> (String, PathBuf) {
    let out = Path::new(env!("CARGO_TARGET_TMPDIR")).join("pages");
    let printed = inspect(model, &["--html", "--out", out.to_str().unwrap()]);
    let file = PathBuf::from(printed.trim());
    (std::fs::read_to_string(&file).unwrap(), file)
}

/// Element names, attributes and the numbers that programs can read; panics where the page is not well-formed.
fn parts(page: &str) -> (Vec<(String, String, String)>, BTreeSet<u64>) {
    let mut reader = quick_xml::Reader::from_str(page);
    let (mut attributes, mut numbers) = (Vec::new(), BTreeSet::new());
    loop {
        match reader.read_event().unwrap() {
            Event::Start(element) | Event::Empty(element) => {
                let name = element.name().as_ref().to_string();
                for attribute in element.attributes() {
                    let attribute = attribute.unwrap();
                    let key = attribute.key.as_ref().to_string();
                    let value = attribute.value.to_string();
                    if name == "data" {
                        numbers.insert(value.parse::<f64>().unwrap().to_bits());
                    }
                    attributes.push((name.clone(), key, value));
                }
            }
            Event::Eof => return (attributes, numbers),
            _ => {}
        }
    }
}

/// The numbers below a JSON value with their paths.
fn numbers(path: &str, value: &Value, found: &mut Vec<(String, f64)>) {
    match value {
        Value::Number(number) => found.push((path.to_string(), number.as_f64().unwrap())),
        Value::Array(items) => items.iter().for_each(|item| numbers(path, item, found)),
        Value::Object(items) => {
            for (key, item) in items {
                numbers(&format!("{path}.{key}"), item, found);
            }
        }
        _ => {}
    }
}

#[test]
fn pages_are_well_formed_and_need_nothing_from_outside() {
    for model in MODELS.map(|name| root().join(name)) {
        let (page, _) = page(&model);
        let (attributes, _) = parts(&page);
        for (element, key, value) in &attributes {
            assert_ne!(element, "script");
            let link = ["href", "src", "srcset", "data", "action"].contains(&key.as_str());
            assert!(!link || value.starts_with('#'), "<{element} {key}={value}>");
            assert!(
                !value.contains("NaN") && !value.contains("inf"),
                "<{element} {key}={value}>"
            );
        }
        assert!(!page.contains("@import") && !page.contains("url("));
        let drawings = page.matches("<svg").count();
        assert!(drawings >= 5, "{}: {drawings} pictures", model.display());
    }
}

#[test]
fn the_page_has_the_numbers_of_the_json_form() {
    for name in [MODELS[0], MODELS[2], MODELS[5]] {
        let model = root().join(name);
        let (_, shown) = parts(&page(&model).0);
        let json: Value = serde_json::from_str(&inspect(&model, &["--format", "json"])).unwrap();
        let mut wanted = Vec::new();
        numbers("", &json, &mut wanted);
        // Shapes, positions and vibrations at the speeds of the table are drawn; the table has the damped frequencies of
        // branches. The number of rigid motions and the harmonic of a mesh are words.
        let drawn = [
            "mode_shapes",
            ".position",
            "points.modes",
            "rotor_speeds",
            "points.speed",
            "refused",
            "rigid_motions",
            ".harmonic",
        ];
        wanted.retain(|(path, _)| !drawn.iter().any(|part| path.contains(part)));
        assert!(wanted.len() > 100);
        for (path, value) in wanted {
            // serde_json reads numbers to within a bit or two.
            let bits = value.to_bits();
            let near = bits.saturating_sub(2)..=bits.saturating_add(2);
            assert!(
                shown.range(near).next().is_some(),
                "{name}: {path} = {value}"
            );
        }
    }
}

/// The first of these programs that is installed.
fn browser() -> Option<&'static str> {
    let answers = |program: &&str| {
        let output = Command::new(program).arg("--version").output();
        output.is_ok_and(|output| output.status.success())
    };
    ["chromium", "chromium-browser", "google-chrome"]
        .into_iter()
        .find(answers)
}

/// Where a browser is installed: it draws the page, dark on light, and as wide as the window.
#[test]
fn a_browser_shows_the_page() {
    let Some(browser) = browser() else { return };
    let (_, file) = page(&root().join("examples/two_shaft.toml"));
    let folder = file.parent().unwrap();
    let picture = folder.join("page.png");
    let _ = std::fs::remove_file(&picture);
    let status = Command::new(browser)
        .args([
            "--headless",
            "--no-sandbox",
            "--disable-gpu",
            "--hide-scrollbars",
        ])
        .arg(format!(
            "--user-data-dir={}",
            folder.join("profile").display()
        ))
        .arg("--window-size=1100,3000")
        .arg(format!("--screenshot={}", picture.display()))
        .arg(format!("file://{}", file.display()))
        .output()
        .unwrap();
    assert!(status.status.success(), "{status:?}");
    let bytes = std::fs::read(&picture).unwrap();
    let mut reader = png::Decoder::new(std::io::Cursor::new(bytes))
        .read_info()
        .unwrap();
    let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
    let info = reader.next_frame(&mut pixels).unwrap();
    assert_eq!((info.width, info.height), (1100, 3000));
    let colours = info.color_type.samples();
    let pixels: Vec<&[u8]> = pixels.chunks(colours).collect();
    let brightness = |pixel: &[u8]| pixel[..3].iter().map(|&part| u32::from(part)).sum::<u32>();
    let ink = pixels
        .iter()
        .filter(|pixel| brightness(pixel) < 600)
        .count();
    let share = ink as f64 / pixels.len() as f64;
    // Text and thin lines: neither an empty page nor a black one.
    assert!(
        (0.01..0.3).contains(&share),
        "{share} of the page is drawn on"
    );
    let coloured = pixels.iter().filter(|pixel| {
        let [least, most] =
            [pixel[..3].iter().min(), pixel[..3].iter().max()].map(|one| *one.unwrap());
        most - least > 60
    });
    assert!(
        coloured.count() > 2000,
        "the pictures have colours: the style sheet is found"
    );
}
