//! The top-level tables of a file: sections that occur once, and lists of named items.

use std::collections::BTreeMap;

use crate::field::Field;
use crate::key::{Key, Takes};
use crate::mistake::Mistake;
use crate::source_map::Entry;
use crate::table::Table;

/// A section: the name of its tables, and their purpose.
pub(crate) struct Section {
    pub(crate) name: &'static str,
    pub(crate) doc: &'static str,
}

impl Section {
    const fn new(name: &'static str, doc: &'static str) -> Self {
        Self { name, doc }
    }
}

pub(crate) const SCENE: Section = Section::new(
    "scene",
    "Name of the scene, and settings for the whole scene",
);
pub(crate) const PARAMETERS: Section = Section::new(
    "parameters",
    "Names of numbers, each a number or an expression; every expression may use them",
);
pub(crate) const BODY: Section =
    Section::new("body", "Rigid bodies; the body `ground` is always there");
pub(crate) const MARKER: Section = Section::new(
    "marker",
    "Positions of bodies by name: for joints and forces, for measures, and for curves",
);
pub(crate) const MEASURE: Section = Section::new(
    "measure",
    "Distances, angles, coordinates and speeds between markers, written for every row",
);
pub(crate) const JOINT: Section = Section::new(
    "joint",
    "Joints between bodies, wheels and blades included; their rows are in the order of this list",
);
pub(crate) const DRIVE: Section = Section::new(
    "drive",
    "Joints whose measure is prescribed as a function of time",
);
pub(crate) const FORCE: Section = Section::new("force", "Springs, dampers, forces and torques");
pub(crate) const GROUP: Section = Section::new(
    "group",
    "Reactions together, or sums of their components, whose verdict is wanted",
);
pub(crate) const CASE: Section = Section::new(
    "case",
    "Load cases: named lists of values that replace those of the scene",
);
pub(crate) const START: Section =
    Section::new("start", "What assembling the start may and may not change");
pub(crate) const SIMULATE: Section = Section::new(
    "simulate",
    "What a run does: how long, how exactly, by which method",
);
pub(crate) const OUTPUT: Section = Section::new(
    "output",
    "Requested output; other quantities are not computed",
);

/// The key for the name of the item that a table in a list describes.
pub(crate) const NAME: Key = Key::required("name", "a text", Takes::Name)
    .doc("Name, unique among elements of this kind; joints, drives and forces share their names, and so do bodies, markers and measures");

/// Reads a section that may occur once, if it is given.
pub(crate) fn section<'t>(
    root: &mut Table<'t>,
    Section { name, .. }: &Section,
    sections: &mut BTreeMap<String, Entry>,
) -> Option<Table<'t>> {
    let field = root.optional(*name)?;
    let mut table = field.table(&format!("one table `[{name}]`"))?;
    table.subject = format!("`[{name}]`").into();
    sections.insert((*name).to_owned(), Entry::of(name, &table));
    Some(table)
}

/// Reads a list of tables, with the names of their items.
pub(crate) fn tables<'t>(
    root: &mut Table<'t>,
    Section { name: kind, .. }: &Section,
) -> Vec<(Table<'t>, String)> {
    let expected = format!("a list of tables `[[{kind}]]`");
    let Some(field) = root.optional(*kind) else {
        return Vec::new();
    };
    let items = if field.value.get_ref().is_table() {
        field.mismatch(&expected);
        vec![field]
    } else {
        field.items(&expected).unwrap_or_default()
    };
    let numbered = items.iter().enumerate();
    numbered
        .filter_map(|(k, item)| named(item, kind, k + 1))
        .collect()
}

/// Reads a table with its name. If the table has no name, its index replaces the name.
fn named<'t>(item: &Field<'t>, kind: &str, number: usize) -> Option<(Table<'t>, String)> {
    let Some(entries) = item.value.get_ref().as_table() else {
        item.mismatch(&format!("a list of tables `[[{kind}]]`"));
        return None;
    };
    let mut table = Table::new("", item.span(), entries, (item.language, item.findings));
    if let Some(name) = table.peek("name").filter(|name| unfit(name).is_none()) {
        table.optional(&NAME);
        table.subject = format!("{kind} `{name}`").into();
        return Some((table, name.to_owned()));
    }
    table.subject = format!("{kind} number {number}").into();
    let field = table.required(&NAME);
    if let Some(field) = field
        && let Some(name) = field.text(NAME.expected)
        && let Some((reason, label)) = unfit(name)
    {
        let message = format!("{}: `name` {reason}", table.subject);
        item.findings
            .error(Mistake::UnfitName, field.span(), message, label);
    }
    let name = table.subject.to_string();
    Some((table, name))
}

/// Largest number of characters of a name, because every message and the column headers repeat it.
pub(crate) const LONGEST_NAME: usize = 1000;

/// Returns the reason why a name is not permitted in a column header, and a suggestion; `None` if
/// it is permitted. An output table has one line for its header and may be opened in a spreadsheet.
pub(crate) fn unfit(name: &str) -> Option<(String, &'static str)> {
    if name.trim().is_empty() {
        return Some(("is empty".to_owned(), "expected a name"));
    }
    if let Some(reason) = unfit_line(name, LONGEST_NAME, "names") {
        return Some((reason, OTHER));
    }
    let sign = name.chars().next().filter(|c| "=+-@".contains(*c))?;
    let reason = format!("begins with `{sign}`: spreadsheets take such names for formulas");
    Some((reason, OTHER))
}

/// A suggestion for names that are not permitted.
const OTHER: &str = "choose another name";

/// Returns the reason why a text is not one line of at most `most` characters. `what` is the word
/// for the text in the message.
pub(crate) fn unfit_line(text: &str, most: usize, what: &str) -> Option<String> {
    if let Some(c) = text.chars().find(|c| c.is_control()) {
        return Some(format!(
            "has the control character {c:?}: {what} are of one line"
        ));
    }
    if text.len() > most && text.chars().count() > most {
        let letters = text.chars().count();
        return Some(format!("has {letters} letters, more than {most}"));
    }
    None
}
