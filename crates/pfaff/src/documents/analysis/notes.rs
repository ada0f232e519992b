//! Notes of definitions about the meaning of reactions. Each note appears once for all joints of a
//! type.

use std::collections::{BTreeMap, BTreeSet};

use model::Layout;
use model::reaction::ConstraintGroup;
use serde::Serialize;

/// Number of joints that the text names. The document lists all joints.
const NAMED: usize = 12;

/// A note for readers of some reactions.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct NoteDocument {
    /// Joints to which the note applies.
    pub joints: Vec<String>,
    /// The text of the note, with names of joints.
    pub text: String,
}

impl NoteDocument {
    /// Returns the notes of all definitions that have a note, in the order of their first joints. A
    /// joint is omitted if no other joint or force acts on its bodies, because its reaction then
    /// has only one possible meaning.
    #[must_use]
    pub fn all(layout: &Layout) -> Vec<Self> {
        let has_note = |g: &&ConstraintGroup| g.spec.note.is_some();
        if !layout.groups.iter().any(|g| has_note(&g)) {
            return Vec::new();
        }
        let moving = |g: &ConstraintGroup| g.bodies.iter().filter_map(|b| b.moving()).collect();
        let others = layout.groups.iter().filter(|g| !has_note(g));
        let pushing = others.filter(|g| (0..g.rows.len()).any(|row| g.pushes(row)));
        let pushed: BTreeSet<usize> = pushing.flat_map(|g| -> Vec<usize> { moving(g) }).collect();
        let mut order: Vec<&'static str> = Vec::new();
        let mut joints: BTreeMap<&'static str, Vec<String>> = BTreeMap::new();
        for g in &layout.groups {
            let bodies: Vec<usize> = moving(g);
            if let Some(note) = g.spec.note
                && bodies.iter().any(|k| pushed.contains(k))
            {
                let list = joints.entry(note).or_default();
                if list.is_empty() {
                    order.push(note);
                }
                list.push(g.name.clone());
            }
        }
        let document = |note| {
            let joints = joints.remove(note).unwrap_or_default();
            Self {
                text: format!("{}: {note}", named(&joints)),
                joints,
            }
        };
        order.into_iter().map(document).collect()
    }
}

/// Lists the first names, and the number of the other joints.
fn named(joints: &[String]) -> String {
    let first = joints.iter().take(NAMED);
    let first: Vec<String> = first.map(|name| format!("`{name}`")).collect();
    match joints.len().saturating_sub(NAMED) {
        0 => first.join(", "),
        more => format!("{} and {more} more", first.join(", ")),
    }
}
