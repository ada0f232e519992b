//! Positions of all items in the file, for problems that are found after reading.

use std::borrow::Cow;
use std::collections::BTreeMap;
use std::ops::Range;

use model::codes::Code;

use crate::table::Table;
use crate::text::SourceText;

/// Positions of a table and of its values.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Entry {
    /// The name of the item that the table describes, or the name of the section.
    pub name: String,
    /// Position of the header, such as `[[body]]`.
    pub header: Range<usize>,
    /// The values with their keys, in the order of the keys.
    pub keys: Box<[(Cow<'static, str>, Range<usize>)]>,
    /// Whether the item that the table describes is part of the mechanism.
    pub is_active: bool,
}

impl Entry {
    pub(crate) fn of(name: &str, table: &Table) -> Self {
        Self {
            name: name.to_owned(),
            header: table.header.clone(),
            keys: table.spans().collect(),
            is_active: true,
        }
    }

    /// The positions of a table that may be inactive.
    pub(crate) fn switched(name: &str, table: &Table, is_active: bool) -> Self {
        Self {
            is_active,
            ..Self::of(name, table)
        }
    }

    /// Returns the position of the value of `name`. If the table has no name, returns the position
    /// of the header.
    #[must_use]
    pub fn name_span(&self) -> Range<usize> {
        self.value("name").unwrap_or_else(|| self.header.clone())
    }

    /// Returns the position of the value of a key. If the key is missing, returns the position of
    /// the name.
    #[must_use]
    pub fn span(&self, key: &str) -> Range<usize> {
        self.value(key).unwrap_or_else(|| self.name_span())
    }

    /// Position of the value of a key, if it is given.
    fn value(&self, key: &str) -> Option<Range<usize>> {
        let mut keys = self.keys.iter();
        keys.find(|(name, _)| name == key)
            .map(|(_, span)| span.clone())
    }

    /// Returns the position of the value of the first of these keys that is given. If none of these
    /// keys is given, returns the position of the name.
    #[must_use]
    pub fn first_of(&self, keys: &[&str]) -> Range<usize> {
        let given = keys.iter().find_map(|key| self.value(key));
        given.unwrap_or_else(|| self.name_span())
    }
}

/// Keys for the reference point of an element.
pub(crate) const PLACE_KEYS: [&str; 4] = ["at", "points", "point", "markers"];
/// Keys for the bodies of an element.
pub(crate) const BODY_KEYS: [&str; 2] = ["bodies", "body"];

/// The positions of a scene, in the order of its lists.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct SourceMap {
    /// The text.
    pub text: SourceText,
    /// Bodies, in the order of the description.
    pub bodies: Vec<Entry>,
    /// Markers, in the order of the description.
    pub markers: Vec<Entry>,
    /// Measures, in the order of the description.
    pub measures: Vec<Entry>,
    /// Joints, in the order of the description.
    pub joints: Vec<Entry>,
    /// Drives, in the order of the description.
    pub drives: Vec<Entry>,
    /// Forces, in the order of the description.
    pub forces: Vec<Entry>,
    /// Groups, in the order of the scene.
    pub groups: Vec<Entry>,
    /// `scene`, `start`, `simulate` and `output`, if they are given.
    pub sections: BTreeMap<String, Entry>,
    /// Codes of the warnings that the author suppresses.
    pub silenced: Vec<Code>,
}

impl SourceMap {
    /// Bodies, markers and measures, which share one name space.
    pub fn places(&self) -> impl Iterator<Item = &Entry> {
        self.bodies
            .iter()
            .chain(&self.markers)
            .chain(&self.measures)
    }

    /// Joints, drives and forces, which share one name space.
    pub fn elements(&self) -> impl Iterator<Item = &Entry> {
        self.joints.iter().chain(&self.drives).chain(&self.forces)
    }

    /// The body with this name.
    #[must_use]
    pub fn body(&self, name: &str) -> Option<&Entry> {
        self.bodies.iter().find(|entry| entry.name == name)
    }

    /// The joint, drive or force with this name.
    #[must_use]
    pub fn element(&self, name: &str) -> Option<&Entry> {
        self.elements().find(|entry| entry.name == name)
    }

    /// Returns the position of the value of a key of a section. If the key is missing, returns the
    /// position of the section header. If the section is missing, returns the position of
    /// `[scene]`.
    #[must_use]
    pub fn section(&self, section: &str, key: &str) -> Range<usize> {
        self.sections
            .get(section)
            .or_else(|| self.sections.get("scene"))
            .map_or(0..0, |entry| {
                entry.value(key).unwrap_or_else(|| entry.header.clone())
            })
    }
}
