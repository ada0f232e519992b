//! A table of the file. It remembers which keys were asked for: what is left over is unknown.

use std::ops::Range;

use toml::de::DeTable;

use crate::field::Field;
use crate::findings::Findings;
use crate::nearest::{list, nearest};

/// A table and what it describes.
pub(crate) struct Table<'t> {
    /// What it describes, as messages begin: joint `A`, or `[simulate]`.
    pub(crate) subject: String,
    /// Its header, or the braces of an inline table.
    pub(crate) header: Range<usize>,
    entries: &'t DeTable<'t>,
    known: Vec<String>,
}

impl<'t> Table<'t> {
    pub(crate) fn new(subject: String, header: Range<usize>, entries: &'t DeTable<'t>) -> Self {
        Self {
            subject,
            header,
            entries,
            known: Vec::new(),
        }
    }

    /// The value of a key that may be left out.
    pub(crate) fn optional(&mut self, key: &str) -> Option<Field<'t>> {
        if !self.known.iter().any(|known| known == key) {
            self.known.push(key.to_owned());
        }
        let value = self.entries.get(key)?;
        Some(Field {
            subject: self.subject.clone(),
            key: key.to_owned(),
            value,
        })
    }

    /// The value of a key that must be there; `expected` says what it takes.
    pub(crate) fn required(
        &mut self,
        key: &str,
        expected: &str,
        findings: &mut Findings,
    ) -> Option<Field<'t>> {
        let field = self.optional(key);
        if field.is_none() {
            findings.error(
                self.header.clone(),
                format!("{} needs the key `{key}`: {expected}", self.subject),
                format!("`{key}` is missing here"),
            );
        }
        field
    }

    /// All keys with their values, for tables whose keys are names.
    pub(crate) fn all(&self) -> Vec<(Range<usize>, Field<'t>)> {
        let field = |(key, value): (&'t toml::Spanned<_>, _)| {
            let name: &std::borrow::Cow<str> = key.get_ref();
            let field = Field {
                subject: self.subject.clone(),
                key: name.to_string(),
                value,
            };
            (key.span(), field)
        };
        self.entries.iter().map(field).collect()
    }

    /// Spans of all values by key.
    pub(crate) fn spans(&self) -> impl Iterator<Item = (String, Range<usize>)> {
        self.entries
            .iter()
            .map(|(key, value)| (key.get_ref().to_string(), value.span()))
    }

    /// Reports keys that nobody asked for.
    pub(crate) fn close(self, findings: &mut Findings) {
        let known = || self.known.iter().map(String::as_str);
        for key in self.entries.keys() {
            let name = key.get_ref();
            if known().any(|known| known == name) {
                continue;
            }
            let label = match nearest(name, known()) {
                Some(near) => format!("did you mean `{near}`?"),
                None => "unknown key".to_owned(),
            };
            findings.error_with_help(
                key.span(),
                format!("{} has no key `{name}`", self.subject),
                label,
                Some(format!("its keys are {}", list(known()))),
            );
        }
    }
}
