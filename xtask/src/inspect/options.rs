//! The words after `cargo xtask inspect`.

use std::f64::consts::TAU;
use std::path::PathBuf;

use geartrain::analysis::SpeedRange;

use crate::workspace;

/// What to look at and how to print it.
#[derive(Debug, PartialEq)]
pub struct Options {
    /// The model file.
    pub model: PathBuf,
    /// For whom.
    pub format: Format,
    /// Speeds of the Campbell table.
    pub speeds: Speeds,
    /// The folder of a page.
    pub out: PathBuf,
}

/// Who reads the output.
#[derive(Debug, PartialEq, Eq)]
pub enum Format {
    /// People.
    Text,
    /// Programs.
    Json,
    /// People, as a page with pictures.
    Html,
}

/// `--speeds FROM:TO:COUNT[:UNIT]`.
#[derive(Debug, PartialEq)]
pub struct Speeds {
    from: f64,
    to: f64,
    count: usize,
    unit: Unit,
}

#[derive(Debug, PartialEq, Eq)]
enum Unit {
    /// Multiples of the first rotor's speed in the file.
    Multiple,
    RadiansPerSecond,
    RevolutionsPerMinute,
}

const SPEEDS: &str = "--speeds needs FROM:TO:COUNT or FROM:TO:COUNT:UNIT with 0 <= FROM < TO, COUNT from 2 \
                      to 1000 and UNIT x (times the file's speed), rpm or rad/s (of the first rotor)";

impl Options {
    /// Reads the arguments.
    pub fn parse(arguments: &[&str]) -> Result<Options, String> {
        let mut model = None;
        let mut format = Format::Text;
        let mut speeds = Speeds {
            from: 0.0,
            to: 1.5,
            count: 13,
            unit: Unit::Multiple,
        };
        let mut out = workspace().join("target/inspect");
        let mut words = arguments.iter();
        while let Some(&word) = words.next() {
            match word {
                "--format" => {
                    format = match words.next() {
                        Some(&"json") => Format::Json,
                        Some(&"text") => Format::Text,
                        _ => return Err("--format needs text or json".to_string()),
                    };
                }
                "--html" => format = Format::Html,
                "--out" => {
                    out = words
                        .next()
                        .map(PathBuf::from)
                        .ok_or("--out needs a folder")?;
                }
                "--speeds" => {
                    let given = words.next().and_then(|text| Speeds::parse(text));
                    speeds = given.ok_or(SPEEDS)?;
                }
                option if option.starts_with("--") => {
                    return Err(format!("unknown option {option}"));
                }
                file if model.is_none() => model = Some(PathBuf::from(file)),
                other => return Err(format!("one model file at a time, found also {other}")),
            }
        }
        let model = model.ok_or("name a model file: cargo xtask inspect MODEL.toml")?;
        Ok(Options {
            model,
            format,
            speeds,
            out,
        })
    }
}

impl Speeds {
    fn parse(text: &str) -> Option<Speeds> {
        let cells: Vec<&str> = text.split(':').collect();
        let (numbers, unit) = match cells.as_slice() {
            [_, _, _] => (&cells[..], Unit::Multiple),
            [numbers @ .., "x"] => (numbers, Unit::Multiple),
            [numbers @ .., "rad/s"] => (numbers, Unit::RadiansPerSecond),
            [numbers @ .., "rpm"] => (numbers, Unit::RevolutionsPerMinute),
            _ => return None,
        };
        let [from, to, count] = numbers else {
            return None;
        };
        let speeds = Speeds {
            from: from.parse().ok()?,
            to: to.parse().ok()?,
            count: count.parse().ok()?,
            unit,
        };
        let sensible = speeds.from >= 0.0
            && speeds.to > speeds.from
            && speeds.to.is_finite()
            && (2..=1000).contains(&speeds.count);
        sensible.then_some(speeds)
    }

    /// The speeds of a train whose first rotor has this speed [rad/s].
    pub fn range(&self, first_rotor: f64) -> Result<SpeedRange, String> {
        let unit = match self.unit {
            Unit::Multiple if first_rotor == 0.0 => {
                return Err(
                    "the first rotor stands still; give speeds with --speeds FROM:TO:COUNT:rpm"
                        .to_string(),
                );
            }
            Unit::Multiple => first_rotor.abs(),
            Unit::RadiansPerSecond => 1.0,
            Unit::RevolutionsPerMinute => TAU / 60.0,
        };
        Ok(SpeedRange {
            from: self.from * unit,
            to: self.to * unit,
            count: self.count,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn speeds_are_multiples_or_have_a_unit() {
        let range = |text: &str| Speeds::parse(text).unwrap().range(-200.0).unwrap();
        let of = |from, to, count| SpeedRange { from, to, count };
        assert_eq!(range("0:1.5:4"), of(0.0, 300.0, 4));
        assert_eq!(range("0.5:1:3:x"), of(100.0, 200.0, 3));
        assert_eq!(range("10:20:2:rad/s"), of(10.0, 20.0, 2));
        assert_eq!(range("0:60:2:rpm"), of(0.0, TAU, 2));
    }

    #[test]
    fn nonsense_is_refused_with_the_rule() {
        for text in [
            "",
            "1",
            "0:1",
            "1:0:5",
            "0:1:1",
            "0:nan:5",
            "0:1:5:mph",
            "-1:1:5",
            "0:inf:3",
        ] {
            let error = Options::parse(&["m.toml", "--speeds", text]).unwrap_err();
            assert!(error.contains("FROM:TO:COUNT"), "{text}: {error}");
        }
        for arguments in [
            &["--format", "xml", "m.toml"][..],
            &["a", "b"],
            &[],
            &["--fast", "a"],
        ] {
            assert!(Options::parse(arguments).is_err(), "{arguments:?}");
        }
    }
}
