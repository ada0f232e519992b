//! Names of types. Each name should be used only once in a crate, and the name of a type should be
//! a noun.

use std::collections::BTreeMap;

use syn::Item;

use super::modules::Modules;

/// Largest number of names that several types of one crate share.
pub(super) const SHARED_MOST: usize = 20;

/// Participles and adjectives that do not end with *-ed*.
const NO_NOUNS: [&str; 24] = [
    "Begun", "Borne", "Both", "Built", "Chosen", "Drawn", "Found", "Free", "Given", "Gone", "Held",
    "Kept", "Known", "Lasting", "Left", "Lost", "Made", "Meant", "Seen", "Sought", "Taken", "Told",
    "Until", "Written",
];

/// Nouns that end with *-ed*.
const NOUNS: [&str; 4] = ["Feed", "Need", "Seed", "Speed"];

/// A name that several types share, or that is not a noun.
#[derive(Debug, PartialEq, Eq)]
pub(super) struct Name {
    pub(super) name: String,
    /// Files of the types, relative to the directory of the crate.
    pub(super) files: Vec<String>,
    pub(super) is_noun: bool,
}

/// The names of structs, enums, traits and aliases of a crate that are not specific enough.
pub(super) fn unclear(modules: &Modules) -> Vec<Name> {
    let mut all: BTreeMap<String, Vec<String>> = BTreeMap::new();
    for module in &modules.0 {
        for item in &module.items {
            let name = match item {
                Item::Struct(s) => &s.ident,
                Item::Enum(e) => &e.ident,
                Item::Trait(t) => &t.ident,
                Item::Type(t) => &t.ident,
                _ => continue,
            };
            let files = all.entry(name.to_string()).or_default();
            files.push(module.source.path.clone());
        }
    }
    let names = all.into_iter().map(|(name, files)| Name {
        is_noun: is_noun(&name),
        name,
        files,
    });
    names
        .filter(|name| name.files.len() > 1 || !name.is_noun)
        .collect()
}

/// Whether the last word of a name may be a noun.
fn is_noun(name: &str) -> bool {
    let begin = name.rfind(|c: char| c.is_ascii_uppercase()).unwrap_or(0);
    let word = &name[begin..];
    NOUNS.contains(&word) || !(NO_NOUNS.contains(&word) || word.ends_with("ed"))
}
