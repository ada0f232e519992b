//! `[[body]]`, and references to bodies by name in the rest of the file.

mod orientation;
mod plane;
mod space3;

pub(crate) use orientation::{ANGLE, AXIS, MATRIX, QUATERNION, RPY, read as read_orientation};

use std::cell::RefCell;
use std::collections::{BTreeSet, HashMap};

use model::{BodyRef, FramePose};

use crate::field::Field;
use crate::key::Key;
use crate::mistake::Mistake;
use crate::nearest::all;
use crate::source_map::Entry;
use crate::space::SceneSpace;
use crate::table::Table;

/// A space (plane or space) for which bodies can be read from a scene.
pub(crate) trait SceneBody: SceneSpace {
    /// Keys of a body, except its name.
    const BODY_KEYS: &'static [Key];

    /// Reads one body; values that cannot be read are replaced by zero.
    fn read_body(table: &mut Table, name: &str) -> Self::Body;

    /// The key `start`, which contains the initial pose of a body if this pose differs from the
    /// described pose.
    const START: Key;

    /// Reads the value of the key `start`. Coordinates that are not given have their described
    /// values.
    fn read_start(start: &mut Table, body: &Self::Body) -> FramePose;
}

/// The names of the bodies, with their indices.
#[derive(Default)]
pub(crate) struct BodyNames {
    pub(crate) entries: Vec<Entry>,
    /// Indices by name; if a name is used twice, the index of the first body.
    by_name: HashMap<String, usize>,
    /// Number of bodies without a name. The reader assumes that each of these bodies has one of the
    /// unknown names.
    unnamed: usize,
    /// The unknown names that are assumed to be names of the bodies without a name.
    theirs: RefCell<BTreeSet<String>>,
}

impl BodyNames {
    /// Adds the body of a table.
    pub(crate) fn add(&mut self, name: &str, table: &Table) {
        let at = self.entries.len();
        let is_own = table.peek("name") == Some(name) && name != GROUND;
        if !is_own || self.by_name.contains_key(name) {
            self.unnamed += 1;
        }
        self.by_name.entry(name.to_owned()).or_insert(at);
        self.entries.push(Entry::of(name, table));
    }

    /// Returns the body with the name in this field. The name `ground` refers to the ground.
    pub(crate) fn find(&self, field: &Field) -> Option<BodyRef> {
        let name = field.text("the name of a body")?;
        if name == GROUND {
            return Some(BodyRef::Ground);
        }
        let at = self.position(name);
        if at.is_none() {
            self.unknown(field, name);
        }
        at.map(BodyRef::Body)
    }

    /// The index of a body.
    pub(crate) fn position(&self, name: &str) -> Option<usize> {
        self.by_name.get(name).copied()
    }

    /// Reports that a body does not exist, unless another reported problem of the bodies explains
    /// this.
    pub(crate) fn unknown(&self, field: &Field, name: &str) {
        let Field {
            subject, findings, ..
        } = field;
        let near = findings.suggest(name, self.all());
        if near.is_none() && (self.entries.is_empty() || self.is_of_unnamed(name)) {
            return;
        }
        let label = match near.and_then(|near| self.entries.get(self.position(near)?)) {
            Some(entry) => format!(
                "no such body; `{}` is defined on line {}",
                entry.name,
                findings.line(entry.name_span().start)
            ),
            None => "no such body".to_owned(),
        };
        findings.error_with_help(
            Mistake::UnknownBody,
            field.span(),
            format!("{subject} refers to the unknown body `{name}`"),
            label,
            match near {
                Some(near) => Some(format!("did you mean `{near}`?")),
                None => all("bodies", self.all()),
            },
        );
    }

    /// All names.
    fn all(&self) -> impl Iterator<Item = &str> {
        self.entries.iter().map(|entry| entry.name.as_str())
    }

    /// Returns whether an unknown name may belong to a body without a name.
    fn is_of_unnamed(&self, name: &str) -> bool {
        let mut theirs = self.theirs.borrow_mut();
        if theirs.len() < self.unnamed {
            theirs.insert(name.to_owned());
        }
        theirs.contains(name)
    }

    /// The name of a body.
    pub(crate) fn name(&self, body: BodyRef) -> &str {
        match body {
            BodyRef::Ground => GROUND,
            BodyRef::Body(at) => self.entries.get(at).map_or(GROUND, |entry| &entry.name),
        }
    }
}

/// The name of the ground.
pub(crate) const GROUND: &str = "ground";
