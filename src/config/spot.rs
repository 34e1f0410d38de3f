//! Places in the text of a model file, and how a message points at them.

use std::collections::BTreeMap;
use std::ops::Range;

/// A piece of one line.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct Spot {
    /// Counted from one.
    pub line: usize,
    /// Letters before it in the line.
    pub column: usize,
    /// Letters that belong to it, at least one; what goes on in further lines is left out.
    pub width: usize,
}

/// Where every key and table of a model file and of the files it names stands, by file and key path: at its value, or at the
/// key of a table.
#[derive(Debug, Clone, Default)]
pub struct Lines(BTreeMap<Option<String>, BTreeMap<String, Spot>>);

/// A file with the offset of the first letter of every line.
pub(super) struct Text<'t> {
    pub(super) text: &'t str,
    line_starts: Vec<usize>,
}

/// A line is shown up to so many letters.
const LONGEST_LINE: usize = 120;

impl Lines {
    /// The spot of a key path, or of the nearest table around it that the file contains; `file` is the path of one that the
    /// model file names.
    pub fn find(&self, file: Option<&str>, key: &str) -> Option<Spot> {
        let keys = self.0.get(&file.map(str::to_string))?;
        let mut path = key;
        loop {
            if let Some(&spot) = keys.get(path) {
                return Some(spot);
            }
            path = &path[..path.rfind('.')?];
        }
    }

    pub(super) fn insert(&mut self, file: Option<String>, key: String, spot: Spot) {
        self.0.entry(file).or_default().insert(key, spot);
    }

    pub(super) fn extend(&mut self, others: Lines) {
        self.0.extend(others.0);
    }
}

impl<'t> Text<'t> {
    pub(super) fn new(text: &'t str) -> Text<'t> {
        let ends = text.match_indices('\n').map(|(offset, _)| offset + 1);
        Text {
            text,
            line_starts: std::iter::once(0).chain(ends).collect(),
        }
    }

    /// The spot of a line, counted from one.
    pub(super) fn line(&self, number: usize) -> Spot {
        let start = self
            .line_starts
            .get(number - 1)
            .copied()
            .unwrap_or(self.text.len());
        let end = self.text[start..]
            .find('\n')
            .map_or(self.text.len(), |end| start + end);
        self.spot(start..end)
    }

    /// The spot of a range of bytes.
    pub(super) fn spot(&self, range: Range<usize>) -> Spot {
        let line = self
            .line_starts
            .partition_point(|&start| start <= range.start);
        let line_start = self.line_starts[line - 1];
        let letters = |range: Range<usize>| {
            let part = self.text.get(range).unwrap_or("");
            part.lines().next().unwrap_or("").chars().count()
        };
        Spot {
            line,
            column: letters(line_start..range.start),
            width: letters(range).max(1),
        }
    }
}

impl Spot {
    /// The line with a caret under the spot, as compilers show it; `text` is the file.
    ///
    /// ```text
    ///    |
    /// 41 | position = "3000 rpm"
    ///    |            ^^^^^^^^^^
    /// ```
    pub fn excerpt(&self, text: &str) -> String {
        let line = text.split('\n').nth(self.line - 1).unwrap_or("");
        let letter = |letter: char| if letter.is_control() { ' ' } else { letter };
        let letters: Vec<char> = line.trim_end().chars().map(letter).collect();
        // Of a long line, the part around the spot.
        let from = match self.column {
            column if letters.len() <= LONGEST_LINE || column < LONGEST_LINE / 2 => 0,
            column => column - LONGEST_LINE / 4,
        };
        let shown: String = letters.iter().skip(from).take(LONGEST_LINE).collect();
        let indent = " ".repeat(self.column - from);
        let caret = "^".repeat(self.width.min(LONGEST_LINE - indent.len()));
        let number = self.line.to_string();
        let margin = " ".repeat(number.len());
        format!("{margin} |\n{number} | {shown}\n{margin} | {indent}{caret}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_caret_stands_under_the_spot() {
        let text = "a = 1\nπ = \"x\" # two letters, three bytes\n";
        let start = text.find("\"x\"").unwrap();
        let spot = Text::new(text).spot(start..start + 3);
        let excerpt = spot.excerpt(text);
        let expected = "  |\n2 | π = \"x\" # two letters, three bytes\n  |     ^^^";
        assert_eq!(excerpt, expected);
    }

    #[test]
    fn a_list_over_several_lines_is_marked_in_its_first_and_the_end_of_a_file_too() {
        let text = "a = [\n1,\n]";
        let spot = Text::new(text).spot(4..text.len());
        assert_eq!((spot.line, spot.column, spot.width), (1, 4, 1));
        let end = Text::new(text).spot(text.len()..text.len());
        assert_eq!(end.excerpt(text), "  |\n3 | ]\n  |  ^");
    }

    #[test]
    fn long_lines_are_cut_around_the_spot() {
        let text = format!("{} = wrong{}", "k".repeat(500), "!".repeat(500));
        let excerpt = Text::new(&text).spot(503..508).excerpt(&text);
        let lines: Vec<&str> = excerpt.lines().collect();
        let caret = lines[2].find('^').unwrap();
        assert_eq!(&lines[1][caret..caret + 5], "wrong");
        assert!(lines.iter().all(|line| line.chars().count() < 130));
    }
}
