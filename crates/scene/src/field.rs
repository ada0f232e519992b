//! One value of the file, read as the expected type. If it has another type, both are reported.

use std::borrow::Cow;
use std::ops::Range;
use std::rc::Rc;

use toml::Spanned;
use toml::de::{DeInteger, DeValue};

use crate::findings::Findings;
use crate::table::Table;
use crate::units;

/// A value with its key.
#[derive(Clone)]
pub(crate) struct Field<'t> {
    /// Description of the table that contains it.
    pub(crate) subject: Rc<str>,
    /// Its key.
    pub(crate) key: Cow<'t, str>,
    /// The value.
    pub(crate) value: &'t Spanned<DeValue<'t>>,
}

impl<'t> Field<'t> {
    pub(crate) fn span(&self) -> Range<usize> {
        self.value.span()
    }

    /// Reports that something else was expected.
    pub(crate) fn mismatch(&self, expected: &str, findings: &mut Findings) {
        let text = self.value.get_ref().as_str();
        let help = text
            .filter(|_| expected.contains("number"))
            .and_then(|text| {
                if units::is_number(text) {
                    Some(format!(
                        "numbers stand without quotes: write `{text}` instead of `\"{text}\"`"
                    ))
                } else {
                    units::advice(text)
                }
            });
        findings.error_with_help(
            self.span(),
            format!(
                "{}: `{}` must be {expected}, found {}",
                self.subject,
                self.key,
                found(self.value.get_ref())
            ),
            format!("expected {expected}"),
            help,
        );
    }

    /// A text.
    pub(crate) fn text(&self, expected: &str, findings: &mut Findings) -> Option<&'t str> {
        let text = self.value.get_ref().as_str();
        if text.is_none() {
            self.mismatch(expected, findings);
        }
        text
    }

    /// `true` or `false`.
    pub(crate) fn boolean(&self, findings: &mut Findings) -> Option<bool> {
        let value = self.value.get_ref().as_bool();
        if value.is_none() {
            self.mismatch("true or false", findings);
        }
        value
    }

    /// A finite number.
    pub(crate) fn number(&self, findings: &mut Findings) -> Option<f64> {
        self.number_expected("a number", findings)
    }

    /// A finite number; `expected` describes it.
    pub(crate) fn number_expected(&self, expected: &str, findings: &mut Findings) -> Option<f64> {
        let Some(value) = as_number(self.value.get_ref()) else {
            self.mismatch(expected, findings);
            return None;
        };
        if !value.is_finite() {
            findings.error(
                self.span(),
                format!(
                    "{}: `{}` is {value}, need a finite number",
                    self.subject, self.key
                ),
                "not a finite number",
            );
            return None;
        }
        Some(value)
    }

    /// A whole number within the range of the type.
    pub(crate) fn integer(&self, expected: &str, findings: &mut Findings) -> Option<i64> {
        let value = match self.value.get_ref() {
            DeValue::Integer(n) => i64::from_str_radix(n.as_str(), n.radix()).ok(),
            _ => None,
        };
        if value.is_none() {
            self.mismatch(expected, findings);
        }
        value
    }

    /// The values of a list, under the same key.
    pub(crate) fn items(&self, expected: &str, findings: &mut Findings) -> Option<Vec<Self>> {
        let Some(array) = self.value.get_ref().as_array() else {
            self.mismatch(expected, findings);
            return None;
        };
        let item = |value| Self {
            value,
            ..self.clone()
        };
        Some(array.iter().map(item).collect())
    }

    /// A list of `n` finite numbers.
    pub(crate) fn numbers(
        &self,
        n: usize,
        expected: &str,
        findings: &mut Findings,
    ) -> Option<Vec<f64>> {
        let items = self.items(expected, findings)?;
        let is_nested = |item: &Self| item.value.get_ref().is_array();
        if items.len() != n || items.iter().any(is_nested) {
            self.mismatch(expected, findings);
            return None;
        }
        all(&items, |item| item.number(findings))
    }

    /// A list of any number of finite numbers.
    pub(crate) fn any_numbers(&self, findings: &mut Findings) -> Option<Vec<f64>> {
        let items = self.items("a list of numbers", findings)?;
        all(&items, |item| item.number(findings))
    }

    /// Two finite numbers.
    pub(crate) fn pair(&self, expected: &str, findings: &mut Findings) -> Option<[f64; 2]> {
        self.numbers(2, expected, findings)?.try_into().ok()
    }

    /// `n` pairs of finite numbers.
    pub(crate) fn pairs(
        &self,
        n: usize,
        expected: &str,
        findings: &mut Findings,
    ) -> Option<Vec<[f64; 2]>> {
        let items = self.items(expected, findings)?;
        if items.len() != n || items.iter().any(|item| !item.value.get_ref().is_array()) {
            self.mismatch(expected, findings);
            return None;
        }
        all(&items, |item| item.pair("a point [x, y]", findings))
    }

    /// A table.
    pub(crate) fn table(&self, expected: &str, findings: &mut Findings) -> Option<Table<'t>> {
        let Some(entries) = self.value.get_ref().as_table() else {
            self.mismatch(expected, findings);
            return None;
        };
        let subject = format!("{}: `{}`", self.subject, self.key);
        Some(Table::new(subject, self.span(), entries))
    }
}

/// Reads all values, even after one that cannot be read.
pub(crate) fn all<X, Y>(from: &[X], read: impl FnMut(&X) -> Option<Y>) -> Option<Vec<Y>> {
    let read: Vec<_> = from.iter().map(read).collect();
    read.into_iter().collect()
}

/// An integer or a float as a float; a value that is too large becomes infinite.
pub(crate) fn as_number(value: &DeValue) -> Option<f64> {
    match value {
        DeValue::Float(x) => x.as_str().parse().ok(),
        DeValue::Integer(n) if n.radix() == 10 => n.as_str().parse().ok(),
        DeValue::Integer(n) => whole(n),
        _ => None,
    }
}

/// An integer with another base, if a float can represent it.
fn whole(n: &DeInteger) -> Option<f64> {
    #[expect(
        clippy::cast_precision_loss,
        reason = "TOML numbers are decimal fractions here"
    )]
    u64::from_str_radix(n.as_str(), n.radix())
        .ok()
        .map(|n| n as f64)
}

/// Length of the longest text that a message repeats.
const EXCERPT: usize = 40;

/// Describes the type of a value.
pub(crate) fn found(value: &DeValue) -> String {
    match value {
        DeValue::String(text) if text.chars().count() <= EXCERPT => format!("the text {text:?}"),
        DeValue::String(_) => "a long text".to_owned(),
        DeValue::Integer(_) | DeValue::Float(_) => match as_number(value) {
            Some(x) => format!("the number {x}"),
            None => "a number that cannot be read".to_owned(),
        },
        DeValue::Boolean(value) => format!("`{value}`"),
        DeValue::Datetime(_) => "a date".to_owned(),
        DeValue::Array(values) if values.len() == 1 => "a list of 1 value".to_owned(),
        DeValue::Array(values) => format!("a list of {} values", values.len()),
        DeValue::Table(_) => "a table".to_owned(),
    }
}
