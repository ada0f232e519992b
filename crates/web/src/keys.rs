//! Completion and hover of scenes. The keys, their values and descriptions are those of the schema,
//! which the reader of scenes states.

use std::sync::LazyLock;

use pfaff::scene::schema;
use serde::Serialize;
use serde_json::{Map, Value};

use crate::cursor::{Cursor, Outline, Part};
use crate::position;
use crate::registry::REGISTRY;

static SCHEMA: LazyLock<Value> = LazyLock::new(|| schema(&REGISTRY));

/// A text that can be written.
#[derive(Serialize)]
pub(crate) struct Completion {
    label: String,
    /// `section`, `key`, `value` or `name`.
    kind: &'static str,
    detail: String,
    /// Whether the table needs this key.
    is_required: bool,
}

/// The texts that can replace a part of the scene.
#[derive(Serialize)]
pub(crate) struct Completions {
    from: usize,
    to: usize,
    /// Whether the part is a string in quotes.
    is_quoted: bool,
    options: Vec<Completion>,
}

/// The description of a part of the scene.
#[derive(Serialize)]
pub(crate) struct Hover {
    from: usize,
    to: usize,
    title: String,
    text: String,
}

/// Returns the texts that can be written at an offset.
pub(crate) fn complete(text: &str, offset: usize) -> Completions {
    let (outline, cursor) = outline(text, offset);
    let keys = Keys::new(&outline);
    let options = match cursor.part {
        Part::Header => keys.sections(),
        Part::Key if cursor.path.is_empty() => keys.sections(),
        Part::Key => keys.missing(&cursor),
        Part::Value => keys.values(&cursor),
    };
    Completions {
        from: position::to_utf16(text, cursor.word.start),
        to: position::to_utf16(text, cursor.word.end),
        is_quoted: cursor.is_quoted,
        options,
    }
}

/// Returns the description of the part at an offset.
pub(crate) fn hover(text: &str, offset: usize) -> Option<Hover> {
    let (outline, cursor) = outline(text, offset);
    let keys = Keys::new(&outline);
    let word = text.get(cursor.word.clone())?;
    if word.is_empty() {
        return None;
    }
    let (title, text_of) = match cursor.part {
        Part::Header => {
            let name = cursor.path.first()?;
            (name.clone(), described(keys.section(name)?))
        }
        Part::Key if cursor.path.is_empty() => (word.to_owned(), described(keys.section(word)?)),
        Part::Key => {
            let node = keys.key(&cursor, word)?;
            (word.to_owned(), with_default(node))
        }
        Part::Value => {
            let node = keys.key(&cursor, &cursor.key)?;
            let values = keys.values(&cursor);
            let own = values.into_iter().find(|value| value.label == word);
            match own {
                Some(value) if !value.detail.is_empty() => (value.label, value.detail),
                _ => (cursor.key.clone(), with_default(node)),
            }
        }
    };
    Some(Hover {
        from: position::to_utf16(text, cursor.word.start),
        to: position::to_utf16(text, cursor.word.end),
        title,
        text: text_of,
    })
}

fn outline(text: &str, offset: usize) -> (Outline, Cursor) {
    let mut outline = Outline::read(text, position::to_byte(text, offset));
    let cursor = outline.cursor.take().unwrap_or(Cursor {
        part: Part::Key,
        path: Vec::new(),
        key: String::new(),
        word: text.len()..text.len(),
        is_quoted: false,
        table: 0,
    });
    (outline, cursor)
}

/// The schema for the space of a scene.
struct Keys<'o> {
    outline: &'o Outline,
    /// The sections that the space defines, and the common sections.
    sections: [&'static Map<String, Value>; 2],
}

impl<'o> Keys<'o> {
    fn new(outline: &'o Outline) -> Self {
        let scenes = outline.texts("scene", "space");
        let is_spatial = scenes.last()
            == SCHEMA["if"]["properties"]["scene"]["properties"]["space"]["const"].as_str();
        let space = if is_spatial { "then" } else { "else" };
        let of = |node: &'static Value| node["properties"].as_object().unwrap_or(&EMPTY);
        Self {
            outline,
            sections: [of(&SCHEMA[space]), of(&SCHEMA)],
        }
    }

    fn section(&self, name: &str) -> Option<&'static Value> {
        self.sections.iter().find_map(|own| own.get(name))
    }

    fn sections(&self) -> Vec<Completion> {
        let all = self.sections[1]
            .keys()
            .filter_map(|name| Some((name, self.section(name)?)));
        all.map(|(name, node)| Completion {
            label: name.clone(),
            kind: "section",
            detail: described(node),
            is_required: false,
        })
        .collect()
    }

    /// The tables that may be at the cursor: one for each type, until the type is known.
    fn tables(&self, cursor: &Cursor) -> Vec<&'static Value> {
        let Some((section, inner)) = cursor.path.split_first() else {
            return Vec::new();
        };
        let mut tables = self.section(section).map_or(Vec::new(), variants);
        for key in inner {
            let nodes = tables.iter().filter_map(|table| property(table, key));
            tables = nodes.flat_map(variants).collect();
        }
        let own = self.outline.tables.get(cursor.table);
        let Some(kind) = own.and_then(|table| table.text("type")) else {
            return tables;
        };
        let is_own = |table: &&Value| {
            let of = property(table, "type").and_then(|node| node["const"].as_str());
            of.is_none_or(|of| of == kind)
        };
        let known: Vec<&Value> = tables.iter().copied().filter(is_own).collect();
        if known.is_empty() { tables } else { known }
    }

    fn key(&self, cursor: &Cursor, name: &str) -> Option<&'static Value> {
        let tables = self.tables(cursor);
        let mut nodes = tables.iter().filter_map(|table| property(table, name));
        nodes.next()
    }

    /// The keys that the table at the cursor does not have.
    fn missing(&self, cursor: &Cursor) -> Vec<Completion> {
        let own = self.outline.tables.get(cursor.table);
        let has = |name: &str| {
            name != cursor.key && own.is_some_and(|own| own.keys.iter().any(|(key, _)| key == name))
        };
        let mut options: Vec<Completion> = Vec::new();
        for table in self.tables(cursor) {
            let needed = table["required"].as_array();
            for (name, node) in table["properties"].as_object().unwrap_or(&EMPTY) {
                if has(name) || options.iter().any(|known| known.label == *name) {
                    continue;
                }
                options.push(Completion {
                    label: name.clone(),
                    kind: "key",
                    detail: with_default(node),
                    is_required: needed.is_some_and(|all| all.iter().any(|key| key == name)),
                });
            }
        }
        options.sort_by_key(|option| !option.is_required);
        options
    }

    /// The values of the key at the cursor.
    fn values(&self, cursor: &Cursor) -> Vec<Completion> {
        let mut untyped = cursor.clone();
        if cursor.key == "type" {
            // The type that is written does not restrict the types that can be written.
            untyped.table = usize::MAX;
        }
        let mut options: Vec<Completion> = Vec::new();
        let mut add = |label: String, kind, detail: String| {
            if options.iter().all(|known| known.label != label) {
                options.push(Completion {
                    label,
                    kind,
                    detail,
                    is_required: false,
                });
            }
        };
        for table in self.tables(&untyped) {
            let Some(node) = property(table, &cursor.key) else {
                continue;
            };
            for node in variants(node) {
                let listed = node["enum"].as_array().into_iter().flatten();
                for value in listed.chain(node.get("const")) {
                    let text = value
                        .as_str()
                        .map_or_else(|| value.to_string(), str::to_owned);
                    add(text, "value", described(node));
                }
                let types = node.get("type");
                if types.is_some_and(|types| types == "boolean") {
                    add("true".to_owned(), "value", String::new());
                    add("false".to_owned(), "value", String::new());
                }
            }
        }
        if let Some(section) = named_section(&cursor.key, self.sections[1]) {
            if section == "body" {
                add("ground".to_owned(), "name", String::new());
            }
            for name in self.outline.texts(section, "name") {
                add(name.to_owned(), "name", section.to_owned());
            }
        }
        options
    }
}

static EMPTY: LazyLock<Map<String, Value>> = LazyLock::new(Map::new);

/// The section whose items a key names: `bodies` and `body` name items of `[[body]]`.
fn named_section<'s>(key: &str, sections: &'s Map<String, Value>) -> Option<&'s str> {
    let plural = |name: &str| match name.strip_suffix('y') {
        Some(stem) => format!("{stem}ies"),
        None => format!("{name}s"),
    };
    let mut names = sections.keys().map(String::as_str);
    names.find(|name| key == *name || key == plural(name))
}

/// The schemas that a value may match: references are followed, and the items of a list count.
fn variants(node: &'static Value) -> Vec<&'static Value> {
    if let Some(path) = node["$ref"].as_str() {
        let name = path.rsplit('/').next().unwrap_or_default();
        return variants(&SCHEMA["$defs"][name]);
    }
    let items = &node["items"];
    if items.is_object() {
        return variants(items);
    }
    let branches = ["oneOf", "anyOf"]
        .into_iter()
        .filter_map(|key| node[key].as_array());
    let branches: Vec<&Value> = branches.flatten().flat_map(variants).collect();
    let is_table = node["properties"].is_object();
    if branches.is_empty() || is_table {
        vec![node]
    } else {
        branches
    }
}

fn property<'v>(table: &'v Value, key: &str) -> Option<&'v Value> {
    table["properties"].get(key)
}

fn described(node: &Value) -> String {
    node["description"].as_str().unwrap_or_default().to_owned()
}

fn with_default(node: &Value) -> String {
    let text = described(node);
    match node.get("default") {
        Some(default) => format!("{text} [default: {default}]"),
        None => text,
    }
}
