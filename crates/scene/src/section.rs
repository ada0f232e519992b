//! The tables of the first level: those that occur once, and lists of things with names.

use std::collections::BTreeMap;

use crate::field::Field;
use crate::findings::Findings;
use crate::source_map::Entry;
use crate::table::Table;

/// A table that occurs once, if it is given.
pub(crate) fn section<'t>(
    root: &mut Table<'t>,
    name: &str,
    sections: &mut BTreeMap<String, Entry>,
    findings: &mut Findings,
) -> Option<Table<'t>> {
    let field = root.optional(name)?;
    let mut table = field.table(&format!("one table `[{name}]`"), findings)?;
    table.subject = format!("`[{name}]`");
    sections.insert(name.to_owned(), Entry::of(name, &table));
    Some(table)
}

/// Tables that may occur many times, with the names of what they describe.
pub(crate) fn list<'t>(
    root: &mut Table<'t>,
    kind: &str,
    findings: &mut Findings,
) -> Vec<(Table<'t>, String)> {
    let expected = format!("a list of tables `[[{kind}]]`");
    let Some(field) = root.optional(kind) else {
        return Vec::new();
    };
    let items = match field.value.get_ref().is_table() {
        // One pair of brackets too few: say so, and read on.
        true => {
            field.mismatch(&expected, findings);
            vec![field]
        }
        false => field.items(&expected, findings).unwrap_or_default(),
    };
    let numbered = items.iter().enumerate();
    numbered
        .filter_map(|(k, item)| named(item, kind, k + 1, findings))
        .collect()
}

/// A table with its name, or with its number where it has none.
fn named<'t>(
    item: &Field<'t>,
    kind: &str,
    number: usize,
    findings: &mut Findings,
) -> Option<(Table<'t>, String)> {
    let mut table = item.table(&format!("a list of tables `[[{kind}]]`"), findings)?;
    table.subject = format!("{kind} number {number}");
    let name = table
        .required("name", "a text", findings)
        .and_then(|field| {
            let name = field.text("a text", findings)?;
            if name.trim().is_empty() {
                let message = format!("{}: `name` is empty", table.subject);
                findings.error(field.span(), message, "expected a name");
                return None;
            }
            if let Some(reason) = unfit(name) {
                let message = format!("{}: `name` {reason}", table.subject);
                findings.error(field.span(), message, "choose another name");
                return None;
            }
            Some(name)
        });
    let name = match name {
        Some(name) => {
            table.subject = format!("{kind} `{name}`");
            name.to_owned()
        }
        None => table.subject.clone(),
    };
    Some((table, name))
}

/// Why a name cannot stand at the head of a column, if it cannot: tables have one line for their header, and are opened by spreadsheets.
fn unfit(name: &str) -> Option<String> {
    if let Some(c) = name.chars().find(|c| c.is_control()) {
        return Some(format!(
            "has the control character {c:?}: names are of one line"
        ));
    }
    let sign = name.chars().next().filter(|c| "=+-@".contains(*c))?;
    Some(format!(
        "begins with `{sign}`: spreadsheets take such names for formulas"
    ))
}
