//! A model file with the files that it names.

use std::path::{Path, PathBuf};

use geartrain::config::Problem;

use crate::shell;

/// The text of a model file.
pub struct ModelFile {
    path: PathBuf,
    /// What it says.
    pub text: String,
}

impl ModelFile {
    /// Reads a model file.
    pub fn read(path: &Path) -> Result<ModelFile, String> {
        Ok(ModelFile {
            text: shell::read(path)?,
            path: path.to_path_buf(),
        })
    }

    /// The text of a file that it names.
    pub fn beside(&self, file: &str) -> Result<String, String> {
        shell::read(&self.path_of(file))
    }

    /// Whether this is its path, from the root on and without links.
    pub fn is_at(&self, path: &Path) -> bool {
        self.path.canonicalize().is_ok_and(|own| own == path)
    }

    /// A path written in it.
    fn path_of(&self, file: &str) -> PathBuf {
        self.path.parent().unwrap_or(Path::new("")).join(file)
    }

    /// Every problem as `file:line: place: message`, with `kind` before the place, and its line of the file below it.
    pub fn located(&self, kind: &str, problems: &[Problem]) -> String {
        let shown = |problem: &Problem| {
            let (path, text) = match &problem.file {
                None => (self.path.clone(), Some(self.text.clone())),
                Some(file) => (self.path_of(file), self.beside(file).ok()),
            };
            let file = path.display();
            match (problem.spot, text) {
                (Some(spot), Some(text)) => {
                    let line = spot.line;
                    format!("{file}:{line}: {kind}{problem}\n{}", spot.excerpt(&text))
                }
                _ => format!("{file}: {kind}{problem}"),
            }
        };
        problems.iter().map(shown).collect::<Vec<_>>().join("\n")
    }
}
