//! Where something stands in a model file, and what is wrong there.

use std::fmt;

use super::spot::Spot;

/// A table of the model file, by key path for machines and in words for people.
///
/// ```
/// let bearing = geartrain::config::Place::root()
///     .element("rotor", 1, Some("stage2"))
///     .element("bearing", 0, Some("b1"));
/// assert_eq!(bearing.words(), "rotor \"stage2\", bearing \"b1\"");
/// assert_eq!(bearing.key("position"), "rotor[2].bearing[1].position");
/// ```
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Place {
    /// The file that it stands in, where that is not the model file.
    file: Option<String>,
    path: String,
    words: String,
}

/// One thing that is wrong in a model file, or worth a warning.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Problem {
    /// The file, by its path from the model file, where it is not that one.
    pub file: Option<String>,
    /// Where in the file; unknown for models that do not come from a file.
    pub spot: Option<Spot>,
    /// Key path, such as `rotor[2].bearing[1].position`.
    pub key: String,
    /// The table in words, such as `rotor "stage2", bearing "b1"`; empty at the top.
    pub place: String,
    /// Key, rule and found value.
    pub message: String,
}

impl Place {
    /// The top of the file.
    pub fn root() -> Place {
        Place {
            file: None,
            path: String::new(),
            words: String::new(),
        }
    }

    /// The file that it stands in, by its path from the model file; `None` for that one.
    pub fn file(&self) -> Option<&str> {
        self.file.as_deref()
    }

    /// The top of another file, given by its path from the model file.
    pub fn of_file(file: &str) -> Place {
        Place {
            file: Some(file.to_string()),
            ..Place::root()
        }
    }

    /// The table `name` inside this one.
    pub fn table(&self, name: &str) -> Place {
        Place {
            file: self.file.clone(),
            path: self.key(name),
            words: joined(&self.words, ", ", name),
        }
    }

    /// Number `index` (from zero) of the tables `kind` inside this one; counted from one for people.
    pub fn element(&self, kind: &str, index: usize, name: Option<&str>) -> Place {
        let number = index + 1;
        let own = match name {
            Some(name) if !name.is_empty() => format!("{kind} \"{name}\""),
            _ => format!("{kind} {number}"),
        };
        Place {
            file: self.file.clone(),
            path: format!("{}[{number}]", self.key(kind)),
            words: joined(&self.words, ", ", &own),
        }
    }

    /// The key path of `key` in this table, or of the table itself when `key` is empty.
    pub fn key(&self, key: &str) -> String {
        joined(&self.path, ".", key)
    }

    /// This table in words.
    pub fn words(&self) -> &str {
        &self.words
    }

    /// A problem with `key` of this table. The message names key, rule and value.
    pub fn problem(&self, key: &str, message: String) -> Problem {
        Problem {
            file: self.file.clone(),
            spot: None,
            key: self.key(key),
            place: self.words.clone(),
            message,
        }
    }
}

fn joined(left: &str, separator: &str, right: &str) -> String {
    if left.is_empty() || right.is_empty() {
        format!("{left}{right}")
    } else {
        format!("{left}{separator}{right}")
    }
}

impl fmt::Display for Problem {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&shortened(&joined(&self.place, ": ", &self.message)))
    }
}

/// A name or value in a message is shown up to so many characters.
const LONGEST_WORD: usize = 200;

/// The text with words that nobody would read to their end cut off.
fn shortened(text: &str) -> String {
    let word = |word: &str| {
        let length = word.chars().count();
        if length <= LONGEST_WORD {
            return word.to_string();
        }
        let start: String = word.chars().take(LONGEST_WORD).collect();
        format!("{start}... ({length} characters)")
    };
    text.split(' ').map(word).collect::<Vec<String>>().join(" ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn messages_stay_readable_whatever_a_file_contains() {
        let problem =
            Place::root().problem("law", format!("law: found \"{}\"", "ä".repeat(100_000)));
        let text = problem.to_string();
        assert!(text.starts_with("law: found \"ää") && text.ends_with("ä... (100002 characters)"));
        assert!(text.chars().count() < 300);
    }
}
