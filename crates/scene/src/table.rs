//! A table of the file. The table records which keys were read; all other keys are unknown.

use std::borrow::Cow;
use std::fmt::Display;
use std::ops::Range;
use std::rc::Rc;

use toml::de::DeTable;

use crate::field::Field;
use crate::findings::Findings;
use crate::key::Key;
use crate::language::Language;
use crate::mistake::Mistake;
use crate::nearest::{list, nearest};
use crate::space::SceneSpace;

/// The message for an item that exists only in another space.
pub(crate) fn belongs(what: &str, space: &str) -> String {
    format!("`{what}` belongs to `space = \"{space}\"`")
}

/// A table with a description of its item.
pub(crate) struct Table<'t> {
    /// Description of the table at the start of messages, for example joint `A`, or `[simulate]`.
    pub(crate) subject: Rc<str>,
    /// Position of the header, or of the braces of an inline table.
    pub(crate) header: Range<usize>,
    entries: &'t DeTable<'t>,
    /// Meaning of the numbers in the table.
    pub(crate) language: &'t Language,
    /// The list to which problems are added.
    pub(crate) findings: &'t Findings<'t>,
    known: Vec<&'static str>,
    /// Keys that are missing, each with the index of its problem in the findings.
    absent: Vec<(&'static str, usize)>,
    /// Keys that exist only in the other space, each with the name of this space.
    by_space: Vec<(&'static str, &'static str)>,
}

impl<'t> Table<'t> {
    pub(crate) fn new(
        subject: impl Into<Rc<str>>,
        header: Range<usize>,
        entries: &'t DeTable<'t>,
        (language, findings): (&'t Language, &'t Findings<'t>),
    ) -> Self {
        Self {
            subject: subject.into(),
            header,
            entries,
            language,
            findings,
            known: Vec::new(),
            absent: Vec::new(),
            by_space: Vec::new(),
        }
    }

    /// Adds the keys of both spaces, each with the name of its space. If the table contains a key
    /// of the other space, the report contains the name of that space.
    pub(crate) fn spaces(&mut self, keys: impl Iterator<Item = (&'static str, &'static str)>) {
        self.by_space.extend(keys);
    }

    /// Reads an optional key.
    pub(crate) fn optional(&mut self, key: impl Into<&'static str>) -> Option<Field<'t>> {
        let key = key.into();
        if !self.known.contains(&key) {
            self.known.push(key);
        }
        self.field(key)
    }

    /// Returns the value of a key without marking the key as known.
    pub(crate) fn field(&self, key: &'static str) -> Option<Field<'t>> {
        let value = self.entries.get(key)?;
        Some(Field {
            subject: Rc::clone(&self.subject),
            key: Cow::Borrowed(key),
            value,
            language: self.language,
            findings: self.findings,
        })
    }

    /// Reads a required key.
    pub(crate) fn required(&mut self, key: &Key) -> Option<Field<'t>> {
        self.needed(key.name, key.expected)
    }

    /// Reads a key; a missing required key is reported.
    pub(crate) fn of_key(&mut self, key: &Key) -> Option<Field<'t>> {
        if key.is_required {
            self.required(key)
        } else {
            self.optional(key)
        }
    }

    /// Reads the number of a key.
    pub(crate) fn number(&mut self, key: &Key) -> Option<f64> {
        self.of_key(key)?.number(key.unit)
    }

    /// Reads the vector of a key.
    pub(crate) fn vector<S: SceneSpace>(&mut self, key: &Key) -> Option<S::Vector<f64>> {
        self.of_key(key)?.vector::<S>(key.expected, key.unit)
    }

    /// Reads `true` or `false` of a key.
    pub(crate) fn flag(&mut self, key: &Key) -> Option<bool> {
        self.of_key(key)?.boolean()
    }

    /// Reads the list of a key. The result is empty if the key is missing or its value is not a
    /// list; a value that is not a list is reported.
    pub(crate) fn items(&mut self, key: &Key) -> Vec<Field<'t>> {
        let field = self.of_key(key);
        let items = field.and_then(|field| field.items(key.expected));
        items.unwrap_or_default()
    }

    /// Reads a required key; the definition gives the description of its value.
    pub(crate) fn needed(
        &mut self,
        key: &'static str,
        expected: impl Display,
    ) -> Option<Field<'t>> {
        let field = self.optional(key);
        if field.is_none() {
            let message = format!("{} needs the key `{key}`: {expected}", self.subject);
            self.lacks(key, message, format!("`{key}` is missing here"));
        }
        field
    }

    /// Reports that a key is missing. If a similar unknown key is found later, the misspelling of
    /// that key is reported in place of this problem.
    pub(crate) fn lacks(
        &mut self,
        key: &'static str,
        message: impl Into<String>,
        label: impl Into<String>,
    ) {
        self.absent.push((key, self.findings.next()));
        self.findings
            .error(Mistake::Missing, self.header.clone(), message, label);
    }

    /// Reports that an item is missing; the text before the message is the description of the
    /// table.
    pub(crate) fn missing(&self, message: impl Display, label: impl Into<String>) {
        let message = format!("{}{message}", self.subject);
        let at = self.header.clone();
        self.findings.error(Mistake::Missing, at, message, label);
    }

    /// Reports two values that must not be given together, each with its label. `ways` contains the
    /// keys of the values.
    pub(crate) fn exclusive(&self, ways: impl Display, values: [(Range<usize>, &str); 2]) {
        let message = format!("{} takes {ways}, not both", self.subject);
        let [(first, of_first), (second, of_second)] = values;
        let findings = self.findings;
        findings.collision(
            Mistake::Exclusive,
            second,
            message,
            of_second,
            first,
            of_first,
        );
    }

    /// Returns all keys with their values, for tables whose keys are names.
    pub(crate) fn all(&self) -> Vec<(Range<usize>, Field<'t>)> {
        let field = |(key, value): (&'t toml::Spanned<_>, _)| {
            let name: &'t Cow<str> = key.get_ref();
            let field = Field {
                subject: Rc::clone(&self.subject),
                key: Cow::Borrowed(name),
                value,
                language: self.language,
                findings: self.findings,
            };
            (key.span(), field)
        };
        self.entries.iter().map(field).collect()
    }

    /// Returns whether the table contains a key, without marking the key as known.
    pub(crate) fn has(&self, key: &str) -> bool {
        self.entries.contains_key(key)
    }

    /// Returns the text of a key, if there is one, without marking the key as known.
    pub(crate) fn peek(&self, key: &str) -> Option<&'t str> {
        self.entries.get(key)?.get_ref().as_str()
    }

    /// Returns the positions of all values, each with its key. Known keys need no additional
    /// memory.
    pub(crate) fn spans(&self) -> impl Iterator<Item = (Cow<'static, str>, Range<usize>)> {
        self.entries.iter().map(|(key, value)| {
            let name: &str = key.get_ref();
            let known = self.known.iter().find(|known| **known == name);
            let name = known.map_or_else(|| Cow::Owned(name.to_owned()), |k| Cow::Borrowed(*k));
            (name, value.span())
        })
    }

    /// Returns the position of the value of a key, or of the header if the key is missing.
    pub(crate) fn span_of(&self, key: &str) -> Range<usize> {
        let value = self.entries.get(key);
        value.map_or_else(|| self.header.clone(), toml::Spanned::span)
    }

    /// Reports unknown keys. If an unknown key is similar to a missing key, both keys are reported
    /// together.
    pub(crate) fn close(self) {
        let known = || self.known.iter().copied();
        for key in self.entries.keys() {
            let name = key.get_ref();
            if known().any(|known| known == name) {
                continue;
            }
            let elsewhere = self.by_space.iter().find(|(key, _)| key == name);
            let near = nearest(name, known()).filter(|_| elsewhere.is_none());
            let label = match (elsewhere, near) {
                (Some((_, space)), _) => belongs(name, space),
                (None, Some(near)) => format!("did you mean `{near}`?"),
                (None, None) => "unknown key".to_owned(),
            };
            if let Some((_, problem)) = self.absent.iter().find(|(key, _)| near == Some(key)) {
                self.findings.explain(*problem);
            }
            self.findings.error_with_help(
                Mistake::UnknownKey,
                key.span(),
                format!("{} has no key `{name}`", self.subject),
                label,
                Some(format!("its keys are {}", list(known()))),
            );
        }
    }
}
