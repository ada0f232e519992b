//! Writes documents as JSON with a header, and objects whose keys are names.

use std::io::{self, Write};

use serde::Serialize;
use serde::de::DeserializeOwned;
use serde::ser::{SerializeMap, Serializer};

/// Version of the document format. The version increases when the meaning of an entry changes or an
/// entry is removed.
pub const FORMAT: u32 = 2;

/// A document with its header.
#[derive(Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
struct DocumentWithHead<'d, D> {
    format: u32,
    /// The version of the program.
    version: &'static str,
    #[serde(flatten)]
    document: &'d D,
}

/// Writes the version of the format, the version of the program, and then the document. The JSON is
/// indented and ends with a line feed.
///
/// # Errors
/// Returns an error if the writer fails, or if the document is not an object.
pub fn write_json(mut out: impl Write, document: &impl Serialize) -> io::Result<()> {
    let headed = DocumentWithHead {
        format: FORMAT,
        version: env!("CARGO_PKG_VERSION"),
        document,
    };
    let text = serde_json::to_string_pretty(&headed)?;
    // Control characters and characters that change the direction of text occur only in strings.
    // They are written as escape codes, which a terminal does not interpret.
    let is_obeyed = |c: char| matches!(c, '\u{7f}'..='\u{9f}' | '\u{61c}' | '\u{200e}' | '\u{200f}' | '\u{2028}'..='\u{202e}' | '\u{2066}'..='\u{2069}');
    // Most characters are bytes below all of these.
    let is_candidate = |byte: &u8| *byte >= 0x7f;
    let (mut written, mut at) = (0, 0);
    while let Some(step) = text.as_bytes()[at..].iter().position(is_candidate) {
        at += step;
        let Some(c) = text[at..].chars().next() else {
            break;
        };
        let next = at + c.len_utf8();
        if is_obeyed(c) {
            write!(out, "{}\\u{:04x}", &text[written..at], u32::from(c))?;
            written = next;
        }
        at = next;
    }
    writeln!(out, "{}", &text[written..])?;
    out.flush()
}

/// Reads a request of a user from JSON.
///
/// # Errors
/// Description of the fault, with its position.
pub fn read_json<T: DeserializeOwned>(text: &str) -> Result<T, String> {
    serde_json::from_str(text).map_err(|e| e.to_string())
}

/// Returns a part of a document as text in one line, without a header. This is for programs that
/// process documents in parts.
///
/// # Errors
/// Returns an error if the part cannot be written.
pub fn part_as_json(part: &impl Serialize) -> io::Result<String> {
    Ok(serde_json::to_string(part)?)
}

/// An object whose keys are names, in this order.
///
/// ```
/// use pfaff_report::ByName;
/// let masses = ByName(vec![("crank".to_owned(), 2.0), ("rod".to_owned(), 1.0)]);
/// assert_eq!(masses["rod"], 1.0);
/// assert_eq!(masses.get("slider"), None);
/// assert_eq!(serde_json::to_string(&masses).unwrap(), r#"{"crank":2.0,"rod":1.0}"#);
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct ByName<T>(pub Vec<(String, T)>);

/// An object without names. The type of the values need not have a default.
impl<T> Default for ByName<T> {
    fn default() -> Self {
        Self(Vec::new())
    }
}

impl<T> ByName<T> {
    /// Whether the object is empty.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// The value of a name, if there is one.
    #[must_use]
    pub fn get(&self, name: &str) -> Option<&T> {
        let named = self.0.iter().find(|(key, _)| key == name);
        named.map(|(_, value)| value)
    }
}

/// The value of a name.
///
/// # Panics
/// Panics if the name does not exist; [`ByName::get`] returns `None` in this case.
impl<T> std::ops::Index<&str> for ByName<T> {
    type Output = T;
    fn index(&self, name: &str) -> &T {
        match self.get(name) {
            Some(value) => value,
            None => panic!("there is no `{name}`"),
        }
    }
}

#[cfg(feature = "schema")]
impl<T: schemars::JsonSchema> schemars::JsonSchema for ByName<T> {
    fn schema_name() -> std::borrow::Cow<'static, str> {
        format!("{}ByName", T::schema_name()).into()
    }

    fn json_schema(generator: &mut schemars::SchemaGenerator) -> schemars::Schema {
        let of_each = generator.subschema_for::<T>();
        schemars::json_schema!({ "type": "object", "additionalProperties": of_each })
    }
}

impl<T: Serialize> Serialize for ByName<T> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut map = serializer.serialize_map(Some(self.0.len()))?;
        for (name, value) in &self.0 {
            map.serialize_entry(name, value)?;
        }
        map.end()
    }
}
