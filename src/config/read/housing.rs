//! `kind = "housing"`, and the files that `[housing]` and `[modes]` name.

use std::collections::BTreeMap;
use std::path::Path;

use super::super::dimension::{DAMPING, FREQUENCY, NUMBER, STIFFNESS};
use super::super::document::{Document, Table};
use super::super::place::{Place, Problem};
use super::super::spot::{Lines, Spot, Text};
use super::super::{Connection, Housing, HousingMode, HousingPoint, Kind, KnownBearing};
use super::KINDS;
use super::planar::planar;

/// Gives the text of a file by its path from the model file, or says why not.
pub type Files<'a> = &'a dyn Fn(&str) -> Result<String, String>;

/// What was found in the files beside the model file.
#[derive(Default)]
pub(super) struct Beside {
    pub(super) problems: Vec<Problem>,
    pub(super) lines: Lines,
}

impl Beside {
    fn take_over(&mut self, document: Document<'_>) {
        let (problems, lines) = document.into_findings();
        self.problems.extend(problems);
        self.lines.extend(lines);
    }
}

/// `[housing]` of a gear train: the structure in another file, and which bearings stand on it.
pub(super) fn embedded(table: &Table<'_, '_>, files: Files<'_>, beside: &mut Beside) -> Housing {
    let file = table.string("file");
    let connections = table.named_strings("connect").into_iter();
    let connections = connections.map(|(bearing, point)| Connection { bearing, point });
    let mut housing = Housing {
        file: Some(file.clone()),
        modes_file: None,
        points: Vec::new(),
        modes: Vec::new(),
        connections: connections.collect(),
    };
    if file.is_empty() {
        return housing; // has its problem already
    }
    let text = match files(&file) {
        Ok(text) => text,
        Err(why) => {
            table.problem("file", why);
            return housing;
        }
    };
    let document = Document::new(Place::of_file(&file), &text);
    if let Some(entries) = document.parse() {
        let top = document.top(entries.get_ref());
        if top.choice("kind", None, &KINDS) == Some(Kind::GearTrain) {
            top.problem("kind", "must be \"housing\" in a file that [housing] names");
        }
        top.skip(&["name", "description", "simulation"]);
        structure(&top, &mut housing, files, beside);
        top.finish();
    }
    beside.take_over(document);
    housing
}

/// A housing that is the model file.
pub(super) fn alone(top: &Table<'_, '_>, files: Files<'_>, beside: &mut Beside) -> Housing {
    let mut housing = Housing {
        file: None,
        modes_file: None,
        points: Vec::new(),
        modes: Vec::new(),
        connections: Vec::new(),
    };
    structure(top, &mut housing, files, beside);
    housing
}

/// Points and modes.
fn structure(top: &Table<'_, '_>, housing: &mut Housing, files: Files<'_>, beside: &mut Beside) {
    housing.points = top.tables("point").into_iter().map(point).collect();
    housing.modes = top.tables("mode").into_iter().map(mode).collect();
    let Some(table) = top.table("modes") else {
        return;
    };
    let (name, damping_ratio) = (
        table.string("file"),
        table.optional_number("damping_ratio", &NUMBER),
    );
    if !housing.modes.is_empty() {
        top.problem("modes", "either [modes] or [[mode]], not both");
    }
    let file = neighbour(housing.file.as_deref(), &name);
    match files(&file) {
        _ if name.is_empty() => {}
        Ok(text) => {
            let place = Place::of_file(&file);
            housing.modes = ModesFile::read(&text, place, damping_ratio, beside);
            housing.modes_file = Some(file);
        }
        Err(why) => table.problem("file", why),
    }
    table.finish();
}

fn point(table: Table<'_, '_>) -> HousingPoint {
    let point = HousingPoint {
        name: table.string("name"),
        observe: table.boolean_or("observe", false),
        bearing: known_bearing(&table),
    };
    table.finish();
    point
}

fn known_bearing(point: &Table<'_, '_>) -> Option<KnownBearing> {
    if !point.has("stiffness") && !point.has("damping") {
        return None;
    }
    if !point.has("stiffness") {
        point.problem("stiffness", "missing beside damping");
    }
    Some(KnownBearing {
        stiffness: planar(point, "stiffness", &STIFFNESS),
        damping: planar(point, "damping", &DAMPING),
    })
}

fn mode(table: Table<'_, '_>) -> HousingMode {
    let mode = HousingMode {
        frequency: table.number("frequency", &FREQUENCY),
        damping_ratio: table.number("damping_ratio", &NUMBER),
        shape: table.named_pairs("shape").into_iter().collect(),
    };
    table.finish();
    mode
}

/// The path of a file named in another one.
fn neighbour(file: Option<&str>, name: &str) -> String {
    let folder = file.and_then(|file| Path::new(file).parent());
    let path = folder.unwrap_or(Path::new("")).join(name);
    path.to_string_lossy().into_owned()
}

/// A table of modes as text: a line of titles, then one line per mode.
///
/// ```text
///   frequency,damping_ratio,left.x,left.y,right.x,right.y
///   412.7,0.02,0.11,-0.05,0.08,0.03
/// ```
struct ModesFile<'a> {
    place: Place,
    text: Text<'a>,
    /// For modes that name none.
    damping_ratio: Option<f64>,
    titles: Vec<String>,
    beside: &'a mut Beside,
}

/// What a column of a modes file holds.
enum Column {
    Frequency,
    DampingRatio,
    Shape { point: String, axis: usize },
}

impl<'a> ModesFile<'a> {
    fn read(
        text: &'a str,
        place: Place,
        damping_ratio: Option<f64>,
        beside: &'a mut Beside,
    ) -> Vec<HousingMode> {
        let mut reader = csv::ReaderBuilder::new()
            .trim(csv::Trim::All)
            .comment(Some(b'#'))
            .from_reader(text.as_bytes());
        let mut file = ModesFile {
            place,
            text: Text::new(text),
            damping_ratio,
            titles: Vec::new(),
            beside,
        };
        match reader.headers() {
            Ok(titles) => file.titles = titles.iter().map(str::to_string).collect(),
            Err(error) => {
                file.problem(None, error.to_string());
                return Vec::new();
            }
        }
        let Some(columns) = file.columns() else {
            return Vec::new();
        };
        let mut modes = Vec::new();
        for record in reader.records() {
            match record {
                Ok(record) => modes.push(file.mode(modes.len(), &columns, &record)),
                Err(error) => file.problem(error.position().map(line_of), error.to_string()),
            }
        }
        modes
    }

    /// What the titles stand for.
    fn columns(&mut self) -> Option<Vec<Column>> {
        let mut columns = Vec::new();
        let mut unknown = Vec::new();
        for title in &self.titles {
            columns.push(match (title.as_str(), title.rsplit_once('.')) {
                ("frequency", _) => Column::Frequency,
                ("damping_ratio", _) => Column::DampingRatio,
                (_, Some((point, axis @ ("x" | "y")))) => Column::Shape {
                    point: point.to_string(),
                    axis: usize::from(axis == "y"),
                },
                _ => {
                    unknown.push(title.clone());
                    continue;
                }
            });
        }
        for title in &unknown {
            self.problem(
                Some(1),
                format!(
                    "column \"{title}\": must be frequency, damping_ratio, or POINT.x and POINT.y of a point"
                ),
            );
        }
        let has = |title: &str| self.titles.iter().any(|other| other == title);
        let missing: Vec<&str> = ["frequency", "damping_ratio"]
            .into_iter()
            .filter(|title| !has(title) && (*title == "frequency" || self.damping_ratio.is_none()))
            .collect();
        for title in &missing {
            let otherwise = match *title {
                "damping_ratio" => ", and [modes] gives no damping_ratio for all",
                _ => "",
            };
            self.problem(Some(1), format!("no column {title}{otherwise}"));
        }
        let twice = (1..self.titles.len()).find(|&i| self.titles[..i].contains(&self.titles[i]));
        if let Some(index) = twice {
            let title = self.titles[index].clone();
            self.problem(Some(1), format!("column \"{title}\" is there twice"));
        }
        (unknown.is_empty() && missing.is_empty() && twice.is_none()).then_some(columns)
    }

    fn mode(
        &mut self,
        index: usize,
        columns: &[Column],
        record: &csv::StringRecord,
    ) -> HousingMode {
        let line = record.position().map(line_of);
        if let Some(spot) = line.map(|line| self.text.line(line)) {
            let (file, mode) = (self.place.file(), self.place.element("mode", index, None));
            let lines = &mut self.beside.lines;
            lines.insert(file.map(str::to_string), mode.key(""), spot);
        }
        let mut mode = HousingMode {
            frequency: f64::NAN,
            damping_ratio: self.damping_ratio.unwrap_or(f64::NAN),
            shape: BTreeMap::new(),
        };
        for ((column, cell), number) in columns.iter().zip(record).zip(0..) {
            let value = cell.parse::<f64>().unwrap_or_else(|_| {
                let title = self.titles[number].clone();
                self.problem(line, format!("{title}: must be a number, found \"{cell}\""));
                f64::NAN
            });
            match column {
                Column::Frequency => mode.frequency = value,
                Column::DampingRatio => mode.damping_ratio = value,
                Column::Shape { point, axis } => {
                    mode.shape.entry(point.clone()).or_default()[*axis] = value;
                }
            }
        }
        mode
    }

    fn problem(&mut self, line: Option<usize>, message: String) {
        let spot: Option<Spot> = line.map(|line| self.text.line(line));
        self.beside.problems.push(Problem {
            spot,
            ..self.place.problem("", message)
        });
    }
}

fn line_of(position: &csv::Position) -> usize {
    usize::try_from(position.line()).unwrap_or(usize::MAX)
}
