//! A TOML document that is read key by key and collects everything that is wrong with it.
//!
//! A [`Table`] hands out values by key and type. What is missing or of the wrong type becomes a
//! [`Problem`] and a placeholder, so that one run finds all problems; [`Table::finish`] reports the keys
//! nobody asked for. Knows TOML and types; knows no gears.

mod numbers;

use std::cell::RefCell;
use std::ops::Range;

use toml::Spanned;
use toml::de::{DeTable, DeValue};

use super::place::{Place, Problem};
use super::spot::{Lines, Text};

/// A parsed file, with the problems found so far.
pub(super) struct Document<'t> {
    root: Place,
    text: Text<'t>,
    problems: RefCell<Vec<Problem>>,
    lines: RefCell<Lines>,
}

/// One table of the document, while it is being read.
pub(super) struct Table<'d, 't> {
    document: &'d Document<'t>,
    entries: &'d DeTable<'t>,
    asked: RefCell<Vec<&'static str>>,
    place: Place,
}

impl<'t> Document<'t> {
    /// The document whose top has this place.
    pub(super) fn new(root: Place, text: &'t str) -> Document<'t> {
        Document {
            root,
            text: Text::new(text),
            problems: RefCell::default(),
            lines: RefCell::default(),
        }
    }

    /// The top table, to be kept by the caller; `None` after syntax errors, which become problems.
    pub(super) fn parse(&self) -> Option<Spanned<DeTable<'t>>> {
        let (table, errors) = DeTable::parse_recoverable(self.text.text);
        if errors.is_empty() {
            return Some(table);
        }
        for error in errors {
            let spot = error.span().map(|span| self.text.spot(span));
            let message = format!("not valid TOML: {}", error.message().replace('\n', ", "));
            self.problems.borrow_mut().push(Problem {
                spot,
                ..self.root.problem("", message)
            });
        }
        None
    }

    pub(super) fn top<'d>(&'d self, entries: &'d DeTable<'t>) -> Table<'d, 't> {
        Table {
            document: self,
            entries,
            asked: RefCell::default(),
            place: self.root.clone(),
        }
    }

    pub(super) fn into_findings(self) -> (Vec<Problem>, Lines) {
        (self.problems.into_inner(), self.lines.into_inner())
    }
}

impl<'d, 't> Table<'d, 't> {
    /// Whether the key is present; marks it as known.
    pub(super) fn has(&self, key: &'static str) -> bool {
        self.value(key).is_some()
    }

    /// A string that must be present.
    pub(super) fn string(&self, key: &'static str) -> String {
        self.optional_string(key)
            .unwrap_or_else(|| self.missing(key, String::new()))
    }

    /// A string that may be absent; it is empty when the value has another type.
    pub(super) fn optional_string(&self, key: &'static str) -> Option<String> {
        Some(match self.value(key)? {
            DeValue::String(string) => string.to_string(),
            other => self.wrong_type(key, "must be a string", other, String::new()),
        })
    }

    pub(super) fn boolean_or(&self, key: &'static str, default: bool) -> bool {
        match self.value(key) {
            None => default,
            Some(DeValue::Boolean(value)) => *value,
            Some(other) => self.wrong_type(key, "must be true or false", other, default),
        }
    }

    /// The meaning of one of a few words; without a default the key must be present. `None` after a problem.
    pub(super) fn choice<T: Copy>(
        &self,
        key: &'static str,
        default: Option<T>,
        choices: &[(&str, T)],
    ) -> Option<T> {
        let word = match self.value(key) {
            Some(DeValue::String(word)) => word,
            Some(other) => return self.wrong_type(key, "must be a string", other, None),
            None if default.is_some() => return default,
            None => return self.missing(key, None),
        };
        let found = choices
            .iter()
            .find(|(name, _)| name == word)
            .map(|(_, meaning)| *meaning);
        if found.is_none() {
            let names: Vec<String> = choices
                .iter()
                .map(|(name, _)| format!("\"{name}\""))
                .collect();
            self.problem(
                key,
                format!("must be {}, found \"{word}\"", names.join(" or ")),
            );
        }
        found
    }

    /// A list of exactly two strings that must be present.
    pub(super) fn pair_of_strings(&self, key: &'static str) -> [String; 2] {
        let nothing = || [String::new(), String::new()];
        let (Some(value), Some(strings)) = (self.value(key), self.strings(key)) else {
            return self.missing(key, nothing());
        };
        <[String; 2]>::try_from(strings).unwrap_or_else(|_| {
            self.wrong_type(key, "must be a list of two strings", value, nothing())
        })
    }

    /// A list of strings, or one string, that may be absent; it is empty when it is neither.
    pub(super) fn strings(&self, key: &'static str) -> Option<Vec<String>> {
        let value = self.value(key)?;
        let string = |item: &DeValue<'_>| item.as_str().map(str::to_string);
        let list: Option<Vec<String>> = match value {
            DeValue::Array(items) => items.iter().map(|item| string(item.get_ref())).collect(),
            single => string(single).map(|one| vec![one]),
        };
        Some(list.unwrap_or_default())
    }

    /// The table under `key`, in words called `key`.
    pub(super) fn table(&self, key: &'static str) -> Option<Table<'d, 't>> {
        match self.value(key)? {
            DeValue::Table(entries) => Some(self.inner(entries, self.place.table(key))),
            other => self.wrong_type(key, "must be a table: { key = value, ... }", other, None),
        }
    }

    /// The tables `[key.NAME]` by name.
    pub(super) fn named_tables(&self, key: &'static str) -> Vec<(String, Table<'d, 't>)> {
        let entries = match self.value(key) {
            None => return Vec::new(),
            Some(DeValue::Table(entries)) => entries,
            Some(other) => return self.wrong_type(key, "must be a table", other, Vec::new()),
        };
        let mut tables = Vec::new();
        for (name, value) in entries {
            let place = self.place.table(&format!("{key}.{}", name.get_ref()));
            self.note(&place.key(""), name.span());
            match value.get_ref() {
                DeValue::Table(inner) => {
                    tables.push((name.get_ref().to_string(), self.inner(inner, place)));
                }
                other => {
                    let message =
                        format!("{}: must be a table, found {}", name.get_ref(), show(other));
                    self.push(place.problem("", message));
                }
            }
        }
        tables
    }

    /// The entries of the table under `key`, each what `meaning` makes of it; others break the rule.
    fn named<T>(
        &self,
        key: &'static str,
        rule: &str,
        meaning: impl Fn(&DeValue<'_>) -> Option<T>,
    ) -> Vec<(String, T)> {
        let Some(table) = self.table(key) else {
            return Vec::new();
        };
        let mut found = Vec::new();
        for (name, value) in table.entries {
            let name = name.get_ref().to_string();
            table.note(&table.place.key(&name), value.span());
            match meaning(value.get_ref()) {
                Some(value) => found.push((name, value)),
                None => {
                    table.wrong_type(&name, rule, value.get_ref(), ());
                }
            }
        }
        found
    }

    /// The strings `name = "string"` under `key`.
    pub(super) fn named_strings(&self, key: &'static str) -> Vec<(String, String)> {
        let string = |value: &DeValue<'_>| value.as_str().map(str::to_string);
        self.named(key, "must be a string", string)
    }

    /// The tables `[[key]]`; in words by their `name`, where they have one.
    pub(super) fn tables(&self, key: &'static str) -> Vec<Table<'d, 't>> {
        let Some(value) = self.value(key) else {
            return Vec::new();
        };
        let items: Option<Vec<_>> = value.as_array().and_then(|array| {
            array
                .iter()
                .map(|item| Some((item.span(), item.get_ref().as_table()?)))
                .collect()
        });
        let Some(items) = items else {
            let rule = format!(
                "must be a list of tables, written [[{}]]",
                self.plain_path(key)
            );
            return self.wrong_type(key, &rule, value, Vec::new());
        };
        let mut tables = Vec::with_capacity(items.len());
        for (index, (span, entries)) in items.into_iter().enumerate() {
            let name = entries.get("name").and_then(|name| name.get_ref().as_str());
            let place = self.place.element(key, index, name);
            self.note(&place.key(""), span);
            tables.push(self.inner(entries, place));
        }
        tables
    }

    /// Reports a problem with one of the table's keys; the message follows the key's name.
    pub(super) fn problem(&self, key: &str, message: impl AsRef<str>) {
        self.push(
            self.place
                .problem(key, format!("{key}: {}", message.as_ref())),
        );
    }

    /// Reports a problem with a part of the value of `key`.
    fn problem_at(&self, span: Range<usize>, key: &str, message: impl AsRef<str>) {
        let message = format!("{key}: {}", message.as_ref());
        let problem = Problem {
            spot: Some(self.document.text.spot(span)),
            ..self.place.problem(key, message)
        };
        self.document.problems.borrow_mut().push(problem);
    }

    /// Marks keys as known that mean nothing here.
    pub(super) fn skip(&self, keys: &[&'static str]) {
        self.asked.borrow_mut().extend(keys);
    }

    /// Reports every key that nobody asked for.
    pub(super) fn finish(self) {
        let asked = self.asked.borrow();
        for (key, _) in self.entries {
            if !asked.contains(&key.get_ref().as_ref()) {
                self.note(&self.place.key(key.get_ref()), key.span());
                let known = asked.join(", ");
                self.problem(key.get_ref(), format!("unknown key; known here: {known}"));
            }
        }
    }

    fn inner(&self, entries: &'d DeTable<'t>, place: Place) -> Table<'d, 't> {
        Table {
            document: self.document,
            entries,
            asked: RefCell::default(),
            place,
        }
    }

    fn value(&self, key: &'static str) -> Option<&'d DeValue<'t>> {
        if !self.asked.borrow().contains(&key) {
            self.asked.borrow_mut().push(key);
        }
        let (name, value) = self.entries.get_key_value(key)?;
        let is_table = |value: &DeValue<'_>| matches!(value, DeValue::Table(_));
        let tables = match value.get_ref() {
            DeValue::Array(items) => items.iter().any(|item| is_table(item.get_ref())),
            other => is_table(other),
        };
        let span = if tables { name.span() } else { value.span() };
        self.note(&self.place.key(key), span);
        Some(value.get_ref())
    }

    fn missing<T>(&self, key: &str, placeholder: T) -> T {
        self.problem(key, "missing");
        placeholder
    }

    fn wrong_type<T>(&self, key: &str, rule: &str, found: &DeValue<'_>, placeholder: T) -> T {
        self.problem(key, format!("{rule}, found {}", show(found)));
        placeholder
    }

    fn push(&self, mut problem: Problem) {
        let lines = self.document.lines.borrow();
        problem.spot = lines.find(self.place.file(), &problem.key);
        self.document.problems.borrow_mut().push(problem);
    }

    /// Keeps where a key path stands.
    fn note(&self, key: &str, span: Range<usize>) {
        let spot = self.document.text.spot(span);
        self.document.lines.borrow_mut().insert(
            self.place.file().map(str::to_string),
            key.to_string(),
            spot,
        );
    }

    /// The key path without element numbers, as TOML headers are written.
    fn plain_path(&self, key: &str) -> String {
        let path = self.place.key(key);
        let mut plain = String::new();
        let mut inside = false;
        for letter in path.chars() {
            inside = (inside || letter == '[') && letter != ']';
            if !inside && letter != ']' {
                plain.push(letter);
            }
        }
        plain
    }
}

fn show(value: &DeValue<'_>) -> String {
    match value {
        DeValue::String(string) => format!("the string \"{string}\""),
        DeValue::Integer(number) => number.to_string(),
        DeValue::Float(number) => number.to_string(),
        DeValue::Boolean(value) => value.to_string(),
        DeValue::Datetime(date) => format!("the date {date}"),
        DeValue::Array(_) => "a list".to_string(),
        DeValue::Table(_) => "a table".to_string(),
    }
}
