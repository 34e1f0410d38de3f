//! Numbers in a table: plain ones are SI, strings carry their unit.

use toml::Spanned;
use toml::de::DeValue;

use super::super::dimension::Dimension;
use super::super::quantity::quantity;
use super::{Table, show};

impl Table<'_, '_> {
    /// A number that must be present; NaN stands in when it is not.
    pub(in crate::config) fn number(&self, key: &'static str, kind: &Dimension) -> f64 {
        self.optional_number(key, kind)
            .unwrap_or_else(|| self.missing(key, f64::NAN))
    }

    pub(in crate::config) fn number_or(
        &self,
        key: &'static str,
        kind: &Dimension,
        default: f64,
    ) -> f64 {
        self.optional_number(key, kind).unwrap_or(default)
    }

    /// A number that may be absent; NaN stands in for what is not one of this kind.
    pub(in crate::config) fn optional_number(
        &self,
        key: &'static str,
        kind: &Dimension,
    ) -> Option<f64> {
        let value = self.value(key)?;
        let number = number(value, kind, "must be a number");
        Some(number.unwrap_or_else(|message| {
            self.problem(key, message);
            f64::NAN
        }))
    }

    /// A list of numbers of one kind that must be present; it is empty when it is not one.
    pub(in crate::config) fn numbers(&self, key: &'static str, kind: &Dimension) -> Vec<f64> {
        self.optional_numbers(key, kind)
            .unwrap_or_else(|| self.missing(key, Vec::new()))
    }

    /// A list of numbers of one kind that may be absent.
    pub(in crate::config) fn optional_numbers(
        &self,
        key: &'static str,
        kind: &Dimension,
    ) -> Option<Vec<f64>> {
        let value = self.value(key)?;
        let Some(array) = value.as_array() else {
            return self.wrong_type(key, "must be a list of numbers", value, Some(Vec::new()));
        };
        let one = |item: &Spanned<DeValue<'_>>| {
            let number = number(item.get_ref(), kind, "must be a list of numbers only");
            number.unwrap_or_else(|message| {
                self.problem_at(item.span(), key, message);
                f64::NAN
            })
        };
        Some(array.iter().map(one).collect())
    }

    /// The pairs of plain numbers `name = [x, y]` under `key`.
    pub(in crate::config) fn named_pairs(&self, key: &'static str) -> Vec<(String, [f64; 2])> {
        self.named(key, "must be a list of two numbers", |value| {
            let items = value.as_array()?.iter();
            let numbers: Option<Vec<f64>> = items.map(|item| plain(item.get_ref())).collect();
            numbers?.try_into().ok()
        })
    }

    /// A number as the file writes it, without the quotes of a string.
    pub(in crate::config) fn as_written(&self, key: &'static str) -> Option<&str> {
        match self.value(key)? {
            DeValue::String(text) => Some(text),
            DeValue::Float(number) => Some(number.as_str()),
            DeValue::Integer(number) => Some(number.as_str()),
            _ => None,
        }
    }

    /// A whole number >= 0 that must be present; 0 stands in when it is not.
    pub(in crate::config) fn count(&self, key: &'static str) -> usize {
        let Some(value) = self.value(key) else {
            return self.missing(key, 0);
        };
        let count = integer(value).and_then(|whole| usize::try_from(whole).ok());
        count.unwrap_or_else(|| self.wrong_type(key, "must be a whole number, 0 or more", value, 0))
    }
}

fn number(value: &DeValue<'_>, kind: &Dimension, rule: &str) -> Result<f64, String> {
    if let DeValue::String(text) = value {
        return quantity(text, kind);
    }
    plain(value).ok_or_else(|| format!("{rule}, found {}", show(value)))
}

/// A number without unit.
fn plain(value: &DeValue<'_>) -> Option<f64> {
    match value {
        DeValue::Float(float) => float.as_str().parse().ok(),
        _ => integer(value).map(|whole| whole as f64),
    }
}

fn integer(value: &DeValue<'_>) -> Option<i64> {
    let integer = value.as_integer()?;
    i64::from_str_radix(integer.as_str(), integer.radix()).ok()
}
