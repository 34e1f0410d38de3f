//! Frequencies that somebody published or measured for the same rotors.

use std::path::Path;

use crate::shell;

/// The table `<model>.published.csv` beside a model file (rotor,kind,mode,frequency_hz,source).
pub struct Published(Vec<Row>);

struct Row {
    rotor: String,
    kind: String,
    mode: usize,
    hertz: f64,
    source: String,
}

impl Published {
    /// Reads the table beside a model file; without a file there is nothing to compare with.
    pub fn beside(model: &Path) -> Result<Published, String> {
        let path = model.with_extension("published.csv");
        if !path.is_file() {
            return Ok(Published(Vec::new()));
        }
        let text = shell::read(&path)?;
        let rows = text
            .lines()
            .enumerate()
            .skip(1)
            .filter(|(_, line)| !line.trim().is_empty());
        let parsed = rows.map(|(index, line)| {
            let rule = "must have the columns rotor,kind,mode,frequency_hz,source";
            Row::parse(line)
                .ok_or_else(|| format!("{}:{}: {rule}, found `{line}`", path.display(), index + 1))
        });
        Ok(Published(parsed.collect::<Result<_, _>>()?))
    }

    /// Whether there is nothing to compare with.
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// The published frequency [Hz] of a mode (counted from 1) and where it stands.
    pub fn find(&self, rotor: &str, kind: &str, mode: usize) -> Option<(f64, &str)> {
        let same = |row: &&Row| row.rotor == rotor && row.kind == kind && row.mode == mode;
        self.0
            .iter()
            .find(same)
            .map(|row| (row.hertz, row.source.as_str()))
    }
}

impl Row {
    fn parse(line: &str) -> Option<Row> {
        let mut cells = line.splitn(5, ',').map(str::trim);
        Some(Row {
            rotor: cells.next()?.to_string(),
            kind: cells.next()?.to_string(),
            mode: cells.next()?.parse().ok()?,
            hertz: cells.next()?.parse().ok()?,
            source: cells.next()?.to_string(),
        })
    }
}
