//! The modules of a library, read from its files.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

use syn::{Attribute, File, Item, Meta};

/// One module: its items, and the modules that it declares.
pub(super) struct Module {
    pub(super) items: Vec<Item>,
    pub(super) children: BTreeMap<String, Module>,
}

impl Module {
    /// The module of a file with its submodules.
    pub(super) fn read(path: &Path) -> Result<Self, String> {
        let told = |e: &dyn std::fmt::Display| format!("{}: {e}", path.display());
        let text = fs::read_to_string(path).map_err(|e| told(&e))?;
        let file: File = syn::parse_file(&text).map_err(|e| told(&e))?;
        let folder = path.parent().unwrap_or(path);
        let stem = path.file_stem().unwrap_or_default().to_string_lossy();
        let below = match stem.as_ref() {
            "lib" | "mod" => folder.to_owned(),
            stem => folder.join(stem),
        };
        Self::new(file.items, Some(&below))
    }

    /// A module without files.
    #[cfg(test)]
    pub(super) fn inline(file: File) -> Self {
        Self::new(file.items, None).unwrap_or_else(|e| panic!("{e}"))
    }

    fn new(items: Vec<Item>, below: Option<&Path>) -> Result<Self, String> {
        let mut children = BTreeMap::new();
        let items: Vec<Item> = items
            .into_iter()
            .filter(|item| !is_left_out(attributes(item)))
            .collect();
        for item in &items {
            let Item::Mod(module) = item else { continue };
            let name = module.ident.to_string();
            let child = match (&module.content, below) {
                (Some((_, items)), _) => {
                    Self::new(items.clone(), below.map(|f| f.join(&name)).as_deref())?
                }
                (None, Some(below)) => Self::read(&file_of(below, &name))?,
                (None, None) => continue,
            };
            children.insert(name, child);
        }
        Ok(Self { items, children })
    }

    /// The module at a path below this one.
    pub(super) fn at(&self, path: &[String]) -> Option<&Self> {
        path.iter()
            .try_fold(self, |module, name| module.children.get(name))
    }
}

fn file_of(below: &Path, name: &str) -> PathBuf {
    let file = below.join(format!("{name}.rs"));
    if file.exists() {
        file
    } else {
        below.join(name).join("mod.rs")
    }
}

/// Whether an item is only for tests, or hidden from users.
fn is_left_out(attributes: &[Attribute]) -> bool {
    attributes.iter().any(|a| match &a.meta {
        Meta::List(list) if list.path.is_ident("cfg") => list.tokens.to_string() == "test",
        Meta::List(list) if list.path.is_ident("doc") => list.tokens.to_string() == "hidden",
        _ => false,
    })
}

/// The attributes of an item.
pub(super) fn attributes(item: &Item) -> &[Attribute] {
    match item {
        Item::Const(i) => &i.attrs,
        Item::Enum(i) => &i.attrs,
        Item::Fn(i) => &i.attrs,
        Item::Impl(i) => &i.attrs,
        Item::Macro(i) => &i.attrs,
        Item::Mod(i) => &i.attrs,
        Item::Static(i) => &i.attrs,
        Item::Struct(i) => &i.attrs,
        Item::Trait(i) => &i.attrs,
        Item::Type(i) => &i.attrs,
        Item::Use(i) => &i.attrs,
        _ => &[],
    }
}
