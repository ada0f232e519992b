//! The names in a format: for each supported element, the names of its attributes and child
//! elements. A name that the lists do not contain is rejected at its position, because a misspelt
//! `density` would change the mass. In formats that allow extensions, names that are not similar to
//! a known name are omitted and reported.

use std::ops::Range;

use crate::changing;
use crate::files::Files;
use crate::findings::{EXPAND, Fault, Findings};
use crate::limits::{MOST_LISTED, SHOWN};
use crate::xml::Element;

/// The names of one format.
pub(crate) struct Vocabulary {
    pub(crate) entries: &'static [Entry],
    /// Whether programs for the format ignore unknown names. In this case, names that are not
    /// similar to a known name count as extensions.
    pub(crate) is_open: bool,
}

/// The names of one element. Lists are words separated by spaces: `name` is an attribute, `<name>`
/// an element.
pub(crate) struct Entry {
    /// Name of the element. It has the form `around/name` if the name has a different meaning
    /// within the element `around`.
    element: &'static str,
    /// Names that the reader of the format uses or reports.
    read: &'static str,
    /// Names without an effect on the mechanism, such as appearance and settings of omitted
    /// content.
    idle: &'static str,
    /// Names that are omitted and reported, with their kind.
    left: &'static [(&'static str, &'static str)],
}

impl Entry {
    pub(crate) const fn new(element: &'static str, read: &'static str) -> Self {
        Self {
            element,
            read,
            idle: "",
            left: &[],
        }
    }

    pub(crate) const fn idle(self, idle: &'static str) -> Self {
        Self { idle, ..self }
    }

    pub(crate) const fn left(self, left: &'static [(&'static str, &'static str)]) -> Self {
        Self { left, ..self }
    }

    fn find(&self, word: &str) -> Meaning {
        let has = |list: &str| list.split_whitespace().any(|known| known == word);
        if has(self.read) || has(self.idle) {
            return Meaning::Known;
        }
        let left = self.left.iter().find(|(_, list)| has(list));
        left.map_or(Meaning::Unknown, |(kind, _)| Meaning::Left(kind))
    }

    /// All names of attributes, or of elements.
    fn names(&self, of_elements: bool) -> impl Iterator<Item = &'static str> {
        let left = self.left.iter().map(|(_, list)| *list);
        let lists = [self.read, self.idle].into_iter().chain(left);
        let words = lists.flat_map(str::split_whitespace);
        words.filter_map(move |word| match inner(word) {
            Some(element) => of_elements.then_some(element),
            None => (!of_elements).then_some(word),
        })
    }
}

enum Meaning {
    Known,
    Left(&'static str),
    Unknown,
}

impl Meaning {
    fn is_known(&self) -> bool {
        matches!(self, Self::Known)
    }
}

/// The name of an element in a list.
fn inner(word: &'static str) -> Option<&'static str> {
    word.strip_prefix('<')?.strip_suffix('>')
}

/// Kind of omission for names that the formats do not define.
const EXTENSIONS: &str = "extensions that are not read";

/// Rejects unknown names in an element of a format and in the descendants of the element. Reports
/// omitted content. `files` contains the files that may be included.
pub(crate) fn check<'a>(
    element: Element<'a>,
    vocabulary: &Vocabulary,
    files: Option<&Files<'a>>,
    findings: &mut Findings,
) {
    let mut stack = vec![("", element)];
    while let Some((around, element)) = stack.pop() {
        let name = element.name();
        let Some(entry) = find(vocabulary.entries, around, name) else {
            continue;
        };
        let is_open = vocabulary.is_open;
        attributes(entry, element, is_open, findings);
        let children: Vec<Element> = match files {
            Some(files) => files.children(element, findings),
            None => element.children().collect(),
        };
        for child in element.foreign_children() {
            foreign(entry, element, child, findings);
        }
        for child in &children {
            let known = format!("<{}>", child.name());
            match entry.find(&known) {
                Meaning::Known => {}
                Meaning::Left(kind) => {
                    findings.leave_element(kind, *child, &subject(element, *child));
                }
                Meaning::Unknown => unknown_element(entry, element, *child, is_open, findings),
            }
        }
        stack.extend(children.into_iter().rev().map(|child| (name, child)));
    }
}

/// Returns the entry of an element within another element.
fn find<'t>(table: &'t [Entry], around: &str, name: &str) -> Option<&'t Entry> {
    let special = table
        .iter()
        .find(|entry| entry.element.split_once('/') == Some((around, name)));
    special.or_else(|| table.iter().find(|entry| entry.element == name))
}

fn attributes(entry: &Entry, element: Element, is_open: bool, findings: &mut Findings) {
    let line = |place: &Range<usize>| element.source.line(place.start);
    for (key, is_foreign, place) in element.keys() {
        match entry.find(key) {
            Meaning::Known if !is_foreign => continue,
            Meaning::Left(kind) if !is_foreign => {
                findings.leave(kind, key, element.source, line(&place));
                continue;
            }
            _ => {}
        }
        let near = scene::nearest(key, entry.names(false));
        if is_foreign || (is_open && near.is_none()) {
            let subject = format!("{key} of <{}>", element.name());
            findings.leave(EXTENSIONS, subject, element.source, line(&place));
            continue;
        }
        let shown: String = key.chars().take(SHOWN).collect();
        let message = format!("`<{}>` has no attribute `{shown}`", element.name());
        let help = match near {
            Some(near) => Some(format!("did you mean `{near}`?")),
            None => list(entry.names(false).map(|name| format!("`{name}`"))),
        };
        let fault = Fault::Name;
        findings.fault_with_help(fault, element.source, place, message, "unknown", help);
    }
}

fn unknown_element(
    entry: &Entry,
    around: Element,
    child: Element,
    is_open: bool,
    findings: &mut Findings,
) {
    let near = scene::nearest(child.name(), entry.names(true));
    if is_open && let Some(advice) = changing::advice(child.name()) {
        return changing::refuse(child, &format!("`<{}>`", child.name()), advice, findings);
    }
    if is_open && near.is_none() {
        return findings.leave_element(EXTENSIONS, child, &subject(around, child));
    }
    let shown: String = child.name().chars().take(SHOWN).collect();
    let message = format!("`<{shown}>` is not known in `<{}>`", around.name());
    let help = match near {
        Some(near) => Some(format!("did you mean `<{near}>`?")),
        None => list(entry.names(true).map(|name| format!("`<{name}>`"))),
    };
    let (source, span) = (child.source, child.span());
    findings.fault_with_help(Fault::Name, source, span, message, "unknown", help);
}

/// An element of another name space: a macro, an extension of supported content, or any other
/// element.
fn foreign(entry: &Entry, around: Element, child: Element, findings: &mut Findings) {
    let prefix = child.prefix().unwrap_or_default();
    let name = format!("{prefix}:{}", child.name());
    let (source, span) = (child.source, child.span());
    if prefix == "xacro" || child.name_space().contains("xacro") {
        let message = format!("`<{name}>` is a macro, and macros are not read");
        let help = EXPAND.to_owned();
        return findings.fault_with_help(Fault::Unsupported, source, span, message, "", help);
    }
    if entry.find(&format!("<{name}>")).is_known() {
        return;
    }
    let local = format!("<{}>", child.name());
    if entry.read.split_whitespace().any(|known| known == local) {
        let message = format!("`<{name}>` is an extension that may change the mechanism");
        let help = format!("describe it with {local}, or remove it");
        return findings.fault_with_help(Fault::Unsupported, source, span, message, "", help);
    }
    if let Some(advice) = changing::advice(child.name()) {
        return changing::refuse(child, &format!("`<{name}>`"), advice, findings);
    }
    let of = around.attribute("name").map(|name| name.text.trim());
    let subject = match of.filter(|of| !of.is_empty()) {
        Some(of) => format!("<{name}> of `{of}`"),
        None => format!("<{name}>"),
    };
    findings.leave_element(EXTENSIONS, child, &subject);
}

/// Returns a description of an omitted element: its kind with its name, or with the name of its
/// parent.
fn subject(around: Element, child: Element) -> String {
    let name = |element: Element| {
        let name = element.attribute("name").map(|name| name.text.trim());
        name.filter(|name| !name.is_empty()).map(str::to_owned)
    };
    match (name(child), name(around)) {
        (Some(own), _) => format!("<{}> `{own}`", child.name()),
        (None, Some(of)) => format!("<{}> of `{of}`", child.name()),
        (None, None) => format!("<{}>", child.name()),
    }
}

fn list(names: impl Iterator<Item = String>) -> Option<String> {
    let names: Vec<String> = names.take(MOST_LISTED + 1).collect();
    let more = names.len() > MOST_LISTED;
    let listed = names[..names.len().min(MOST_LISTED)].join(", ");
    let more = if more { ", …" } else { "" };
    (!names.is_empty()).then(|| format!("known are {listed}{more}"))
}

#[cfg(test)]
mod tests {
    /// Checks that no name has two meanings.
    #[test]
    fn tables_say_each_name_once() {
        let tables = [crate::mjcf::NAMES, crate::urdf::NAMES, crate::sdf::NAMES];
        for table in tables {
            for (k, entry) in table.entries.iter().enumerate() {
                let mut words: Vec<&str> = [entry.read, entry.idle]
                    .into_iter()
                    .chain(entry.left.iter().map(|(_, list)| *list))
                    .flat_map(str::split_whitespace)
                    .collect();
                words.sort_unstable();
                for pair in words.windows(2) {
                    assert_ne!(pair[0], pair[1], "{}", entry.element);
                }
                let again = table.entries[..k]
                    .iter()
                    .any(|other| other.element == entry.element);
                assert!(!again, "{}", entry.element);
            }
        }
    }
}
