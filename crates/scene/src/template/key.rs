//! Finds the position of a number in the text of a scene by its key.

use model::codes::Code;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

use super::{OldValue, Slot};
use crate::active::ACTIVE;
use crate::field::{as_number, found};
use crate::language::read::{COMPUTING, FORMAT};
use crate::nearest::{list, nearest};
use crate::section;

/// Largest number of names in a message.
const LISTED: usize = 12;

/// Reason why a key does not select a number of a scene.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum KeyError {
    /// The text is not TOML.
    #[error("the scene cannot be read")]
    NotToml,
    /// A part of the key does not exist.
    #[error("`{key}`: there is no `{part}` in `{within}`{}", advice(.nearest.as_deref(), .known))]
    Unknown {
        /// The given key.
        key: String,
        /// The part that does not exist.
        part: String,
        /// The part of the key that was found.
        within: String,
        /// The name that was probably intended.
        nearest: Option<String>,
        /// The names that exist.
        known: Vec<String>,
    },
    /// An index is not smaller than the length of the list.
    #[error(
        "`{key}`: `{within}` has {length} entries, counted from 0; there is no entry `{index}`"
    )]
    Index {
        /// The given key.
        key: String,
        /// Path of the list.
        within: String,
        /// The text in brackets.
        index: String,
        /// Number of entries.
        length: usize,
    },
    /// The key refers to a value that is not a number.
    #[error("`{key}` is {found}, not a number{}", inside(.parts))]
    NotANumber {
        /// The given key.
        key: String,
        /// The kind of value that the key selects.
        found: String,
        /// The names of the parts of this value.
        parts: Vec<String>,
    },
    /// A state contains a coordinate that no key can state: full revolutions of an angle, or a
    /// state of a force law.
    #[error(
        "the state contains the {coordinate} of `{name}`, which a scene cannot state; start a run at the state itself"
    )]
    Unstated {
        /// The joint, drive or force with the coordinate.
        name: String,
        /// Name of the coordinate.
        coordinate: &'static str,
    },
    /// The key is missing in the text and cannot be added, because its table has neither a header
    /// nor braces.
    #[error("`{key}` is not in the scene; add it to the scene, with any number")]
    NoRoom {
        /// The given key.
        key: String,
    },
    /// Two keys refer to the same number.
    #[error("`{key}` and `{first}` are the same number")]
    Repeated {
        /// The second key.
        key: String,
        /// The first key.
        first: String,
    },
}

impl KeyError {
    /// Error code; see [`model::codes`].
    #[must_use]
    pub fn code(&self) -> Code {
        match self {
            Self::NotToml => const { Code::new(101) },
            Self::Unknown { .. }
            | Self::Index { .. }
            | Self::NotANumber { .. }
            | Self::NoRoom { .. }
            | Self::Unstated { .. }
            | Self::Repeated { .. } => const { Code::new(501) },
        }
    }
}

fn advice(nearest: Option<&str>, known: &[String]) -> String {
    match (nearest, known) {
        (Some(near), _) => format!("; did you mean `{near}`?"),
        (None, []) => String::new(),
        (None, known) => {
            let more = if known.len() > LISTED { ", …" } else { "" };
            let names = list(known.iter().take(LISTED).map(String::as_str));
            format!("; there are {names}{more}")
        }
    }
}

fn inside(parts: &[String]) -> String {
    match parts {
        [] => String::new(),
        parts => format!("; its parts are {}", list(parts.iter().map(String::as_str))),
    }
}

/// Kinds of values that a key may refer to.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum SlotKind {
    /// A number.
    Number,
    /// Any value, but not the header of a table.
    Value,
}

/// The position of a key in the text.
pub(super) fn find(
    key: &str,
    text: &str,
    root: &DeTable,
    kind: SlotKind,
) -> Result<Slot, KeyError> {
    let mut walk = Walk {
        key,
        rest: key,
        computes: computes(root),
    };
    let mut node = walk.first(root)?;
    loop {
        node = match node.get_ref() {
            _ if walk.rest.is_empty() && kind == SlotKind::Value => return walk.value(node, text),
            _ if walk.rest.is_empty() => return walk.number(node),
            DeValue::Table(table) => match walk.entry(table) {
                Ok(next) => next,
                Err(unknown) => return walk.addition(node, table, text, unknown),
            },
            DeValue::Array(items) => walk.item(items)?,
            // A number or a text has no parts.
            _ => return Err(walk.unknown(&[])),
        };
    }
}

/// Whether texts may be expressions.
fn computes(root: &DeTable) -> bool {
    let scene = root.get(section::SCENE.name);
    let scene = scene.and_then(|scene| scene.get_ref().as_table());
    let format = scene.and_then(|scene| scene.get(FORMAT.name));
    let format = format.and_then(|format| as_number(format.get_ref()));
    format == Some(COMPUTING as f64)
}

/// State of the search for a key.
struct Walk<'k> {
    key: &'k str,
    /// The part of the key that has not been read.
    rest: &'k str,
    /// Whether texts may be expressions.
    computes: bool,
}

impl<'k> Walk<'k> {
    /// Returns the part of the key that was found.
    fn within(&self) -> &'k str {
        let within = &self.key[..self.key.len() - self.rest.len()];
        within.strip_suffix('.').unwrap_or(within)
    }

    /// Returns the next part of the key, without brackets.
    fn part(&self) -> &'k str {
        let end = self.rest.find(['.', '[']).filter(|end| *end > 0);
        &self.rest[..end.unwrap_or(self.rest.len())]
    }

    /// Returns whether the rest starts with this name; names may contain dots and brackets.
    fn begins_with(&self, name: &str) -> bool {
        let after = self.rest.strip_prefix(name).map(|rest| rest.bytes().next());
        !name.is_empty() && matches!(after, Some(None | Some(b'.' | b'[')))
    }

    /// Skips this number of bytes.
    fn pass(&mut self, length: usize) {
        let rest = &self.rest[length..];
        self.rest = match rest.strip_prefix('.') {
            // A dot at the end belongs to the missing part.
            Some(next) if !next.is_empty() => next,
            _ => rest,
        };
    }

    fn unknown(&self, known: &[&str]) -> KeyError {
        let part = self.part();
        KeyError::Unknown {
            key: self.key.to_owned(),
            part: part.to_owned(),
            within: match self.within() {
                "" => "the scene".to_owned(),
                within => within.to_owned(),
            },
            nearest: nearest(part, known.iter().copied()).map(str::to_owned),
            known: known.iter().map(|name| (*name).to_owned()).collect(),
        }
    }

    /// Returns the value with the next part as its name; the longest name that fits is used.
    fn named<'t, X>(&mut self, items: &[(&str, &'t X)]) -> Result<&'t X, KeyError> {
        let fitting = items.iter().filter(|(name, _)| self.begins_with(name));
        let Some((name, item)) = fitting.max_by_key(|(name, _)| name.len()) else {
            let known: Vec<&str> = items.iter().map(|(name, _)| *name).collect();
            return Err(self.unknown(&known));
        };
        self.pass(name.len());
        Ok(item)
    }

    /// Returns the value of the first part, which is a section, or otherwise a parameter.
    fn first<'t>(&mut self, root: &'t DeTable<'t>) -> Result<&'t Spanned<DeValue<'t>>, KeyError> {
        let parameters = root.get(section::PARAMETERS.name);
        let parameters = parameters.and_then(|table| table.get_ref().as_table());
        let tables = [Some(root), parameters].into_iter().flatten();
        let entries = tables.flat_map(|table| table.iter());
        let entries = entries.map(|(key, value)| (&**key.get_ref(), value));
        self.named(&entries.collect::<Vec<_>>())
    }

    fn entry<'t>(&mut self, table: &'t DeTable<'t>) -> Result<&'t Spanned<DeValue<'t>>, KeyError> {
        let entries = table.iter().map(|(key, value)| (&**key.get_ref(), value));
        self.named(&entries.collect::<Vec<_>>())
    }

    /// Returns an entry of a list, selected by its index or by its name.
    fn item<'t>(
        &mut self,
        items: &'t [Spanned<DeValue<'t>>],
    ) -> Result<&'t Spanned<DeValue<'t>>, KeyError> {
        let bracket = self.rest.strip_prefix('[').and_then(|r| r.split_once(']'));
        if let Some((index, _)) = bracket {
            let found = index.parse().ok().and_then(|k: usize| items.get(k));
            let item = found.ok_or_else(|| KeyError::Index {
                key: self.key.to_owned(),
                within: self.within().to_owned(),
                index: index.to_owned(),
                length: items.len(),
            })?;
            self.pass(index.len() + 2);
            return Ok(item);
        }
        let name = |item: &'t Spanned<DeValue<'t>>| {
            let name = item.get_ref().as_table()?.get("name")?;
            Some((name.get_ref().as_str()?, item))
        };
        let named: Vec<_> = items.iter().filter_map(name).collect();
        if named.is_empty() {
            Err(not_a_number(self.within(), items))
        } else {
            self.named(&named)
        }
    }

    /// Returns whether a number may replace a value.
    fn takes(&self, value: &DeValue) -> bool {
        let is_switch = self.key.ends_with(&format!(".{}", ACTIVE.name));
        as_number(value).is_some()
            || self.computes && value.is_str()
            || is_switch && value.is_bool()
    }

    /// Returns the value at the end of the key, if its text is contiguous.
    fn value(&self, node: &Spanned<DeValue>, text: &str) -> Result<Slot, KeyError> {
        let span = node.span();
        let is_table = node.get_ref().is_table();
        if is_table && !text[span.clone()].starts_with('{') {
            let key = self.key.to_owned();
            return Err(KeyError::NoRoom { key });
        }
        Ok(Slot {
            span,
            before: String::new(),
            after: "",
            old: OldValue::Other,
        })
    }

    /// Returns the number at the end of the key.
    fn number(&self, node: &Spanned<DeValue>) -> Result<Slot, KeyError> {
        match node.get_ref() {
            value if self.takes(value) => Ok(Slot {
                span: node.span(),
                before: String::new(),
                after: "",
                old: match (as_number(value), value.as_str()) {
                    (Some(x), _) => OldValue::Number(x),
                    (None, Some(text)) => OldValue::Expression(text.to_owned()),
                    (None, None) => OldValue::Other,
                },
            }),
            DeValue::Array(items) => Err(not_a_number(self.key, items)),
            value => Err(KeyError::NotANumber {
                key: self.key.to_owned(),
                found: found(value),
                parts: match value.as_table() {
                    Some(table) => table
                        .keys()
                        .map(|part| format!("{}.{}", self.key, part.get_ref()))
                        .collect(),
                    None => Vec::new(),
                },
            }),
        }
    }

    /// Returns the position at which a missing last key can be added: after the header line of its
    /// table, or after its opening brace. Whether the key is valid is checked later, by the reader
    /// of scenes.
    fn addition(
        &self,
        node: &Spanned<DeValue>,
        table: &DeTable,
        text: &str,
        unknown: KeyError,
    ) -> Result<Slot, KeyError> {
        let letter = |c: char| c.is_ascii_alphanumeric() || "_-".contains(c);
        let name = self.rest;
        if !name.chars().all(letter) {
            return Err(unknown);
        }
        let span = node.span();
        let written = &text[span.clone()];
        let (at, before, after) = match (written.as_bytes().first(), table.is_empty()) {
            (Some(b'['), _) => {
                let rest = text[span.end..].lines().next().unwrap_or_default();
                (span.end + rest.len(), format!("\n{name} = "), "")
            }
            (Some(b'{'), false) => (span.start + 1, format!(" {name} = "), ","),
            (Some(b'{'), true) => (span.start + 1, format!(" {name} = "), " "),
            _ => {
                return Err(KeyError::NoRoom {
                    key: self.key.to_owned(),
                });
            }
        };
        Ok(Slot {
            span: at..at,
            before,
            after,
            old: OldValue::Other,
        })
    }
}

/// Returns the error for a list in place of a number.
fn not_a_number(key: &str, items: &[Spanned<DeValue>]) -> KeyError {
    let part = |(k, item): (usize, &Spanned<DeValue>)| {
        let name = item
            .get_ref()
            .as_table()
            .and_then(|table| table.get("name"));
        match name.and_then(|name| name.get_ref().as_str()) {
            Some(name) => format!("{key}.{name}"),
            None => format!("{key}[{k}]"),
        }
    };
    KeyError::NotANumber {
        key: key.to_owned(),
        found: match items.len() {
            1 => "a list of 1 value".to_owned(),
            n => format!("a list of {n} values"),
        },
        parts: items.iter().enumerate().take(LISTED).map(part).collect(),
    }
}
