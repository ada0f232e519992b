//! Tables of numbers and words, as text and as JSON.

use serde_json::{Map, Value};

/// One table with the rule by which its rows were selected.
pub(super) struct Table {
    /// Key in the JSON document, and heading.
    pub(super) name: &'static str,
    pub(super) rule: String,
    pub(super) columns: &'static [&'static str],
    pub(super) rows: Vec<Vec<Value>>,
}

/// Returns one document: an object of arrays of rows. Each row is an object with the columns as
/// keys.
pub(super) fn json(tables: &[Table]) -> String {
    let row = |table: &Table, row: &Vec<Value>| {
        let keys = table.columns.iter().map(|c| (*c).to_owned());
        Value::Object(keys.zip(row.iter().cloned()).collect())
    };
    let all = tables.iter().map(|t| {
        let rows = t.rows.iter().map(|r| row(t, r)).collect();
        (t.name.to_owned(), Value::Array(rows))
    });
    format!("{:#}", Value::Object(all.collect::<Map<_, _>>()))
}

/// Returns the tables as text, one after another. Numbers are right-aligned.
pub(super) fn plain(tables: &[Table]) -> String {
    tables.iter().map(plain_one).collect::<Vec<_>>().join("\n")
}

fn plain_one(table: &Table) -> String {
    let words = |row: &Vec<Value>| row.iter().map(word).collect::<Vec<_>>();
    let mut lines: Vec<Vec<String>> = vec![table.columns.iter().map(|c| (*c).into()).collect()];
    lines.extend(table.rows.iter().map(words));
    let width = |column: usize| lines.iter().map(|l| l[column].chars().count()).max();
    let widths: Vec<usize> = (0..table.columns.len()).filter_map(width).collect();
    let is_number = |c: usize| {
        table
            .rows
            .iter()
            .all(|r| r[c].is_number() || r[c].is_null())
    };
    let mut text = format!("{}: {}\n", table.name, table.rule);
    for line in &lines {
        let cells = line
            .iter()
            .zip(&widths)
            .enumerate()
            .map(|(column, (cell, &width))| {
                if is_number(column) {
                    format!("{cell:>width$}")
                } else {
                    format!("{cell:<width$}")
                }
            });
        let line = cells.collect::<Vec<_>>().join("  ");
        text += &format!("  {}\n", line.trim_end());
    }
    text
}

fn word(value: &Value) -> String {
    match value {
        Value::Null => String::new(),
        Value::String(text) => text.clone(),
        Value::Array(parts) => parts.iter().map(word).collect::<Vec<_>>().join(" "),
        other => other.to_string(),
    }
}
