//! The modules of a crate, and the targets of paths in the modules.

use std::collections::{BTreeMap, BTreeSet};

use syn::visit::Visit;
use syn::{Item, UseTree};

use super::source::{Crate, Kind, Source, is_test, submodules};

/// Largest depth to which re-exports of re-exports are followed.
const DEPTH_MOST: usize = 16;

/// One module, in its own file or inside another module.
pub(super) struct Module<'a> {
    /// Path in the form `crate::a::b`.
    pub(super) path: String,
    pub(super) source: &'a Source,
    pub(super) items: Vec<&'a Item>,
    /// Index of the file module that contains this module. For a module with its own file, this is
    /// the module itself.
    pub(super) file: usize,
    root: usize,
    parent: usize,
    pub(super) children: BTreeMap<String, usize>,
    /// Items that the module defines.
    names: BTreeSet<String>,
    /// Name → path, for names that the module imports or re-exports.
    aliases: BTreeMap<String, Vec<String>>,
    globs: Vec<Vec<String>>,
}

/// All modules of a crate that are neither tests nor generated.
pub(super) struct Modules<'a>(pub(super) Vec<Module<'a>>);

/// The target of a path: a module, or an item that a module defines.
#[derive(Clone, Copy)]
pub(super) struct Target {
    pub(super) module: usize,
    pub(super) is_item: bool,
}

impl<'a> Modules<'a> {
    pub(super) fn of(home: &'a Crate) -> Self {
        let mut modules = Self(Vec::new());
        for source in code(home) {
            let is_root = ["src/lib.rs", "src/main.rs"].contains(&source.path.as_str())
                || source.path.starts_with("src/bin/");
            if is_root && let Some(file) = &source.items {
                let name = match source.path.as_str() {
                    "src/lib.rs" => "crate".to_owned(),
                    path => path
                        .trim_start_matches("src/")
                        .trim_end_matches(".rs")
                        .to_owned(),
                };
                let root = modules.0.len();
                modules.add(home, source, &file.items, name, (root, root, root));
            }
        }
        modules
    }

    /// Adds a module below `parent`, and the modules that this module declares. The arguments are
    /// `(root, parent, file)`.
    fn add(
        &mut self,
        home: &'a Crate,
        source: &'a Source,
        items: &'a [Item],
        path: String,
        (root, parent, file): (usize, usize, usize),
    ) {
        let id = self.0.len();
        let items: Vec<&Item> = items.iter().filter(|i| !is_test(named(i).0)).collect();
        let names = items.iter().filter_map(|i| named(i).1);
        let (mut aliases, mut globs) = (BTreeMap::new(), Vec::new());
        let mut found = Imports(Vec::new());
        items.iter().for_each(|item| found.visit_item(item));
        for (name, path) in found.0 {
            match name {
                Some(name) => _ = aliases.entry(name).or_insert(path),
                None => globs.push(path),
            }
        }
        self.0.push(Module {
            path: path.clone(),
            source,
            names: names.map(ToString::to_string).collect(),
            items: items.clone(),
            file,
            root,
            parent,
            children: BTreeMap::new(),
            aliases,
            globs,
        });
        for item in items {
            let Item::Mod(module) = item else { continue };
            let (name, child) = (module.ident.to_string(), self.0.len());
            let below = format!("{path}::{name}");
            if let Some((_, items)) = &module.content {
                self.add(home, source, items, below, (root, id, file));
            } else if let Some((source, file)) = file_of(home, source, &name) {
                self.add(home, source, &file.items, below, (root, id, child));
            }
            if self.0.len() > child {
                self.0[id].children.insert(name, child);
            }
        }
    }

    /// Returns the target of a path in the module `from`. Re-exports are followed. Returns `None`
    /// for local names, and if the target is not in this crate.
    pub(super) fn resolve(&self, from: usize, path: &[String]) -> Option<Target> {
        self.resolve_within(from, path, DEPTH_MOST)
    }

    fn resolve_within(&self, from: usize, path: &[String], depth: usize) -> Option<Target> {
        let depth = depth.checked_sub(1)?;
        let here = &self.0[from];
        let Some((name, rest)) = path.split_first() else {
            return Some(Target {
                module: from,
                is_item: false,
            });
        };
        match name.as_str() {
            "crate" => return self.resolve_within(here.root, rest, depth),
            "self" => return self.resolve_within(from, rest, depth),
            "super" => return self.resolve_within(here.parent, rest, depth),
            _ => {}
        }
        let item_of = |module| {
            Some(Target {
                module,
                is_item: true,
            })
        };
        let child = here.children.get(name);
        if here.names.contains(name) && (rest.is_empty() || child.is_none()) {
            return item_of(from);
        }
        if let Some(&child) = child {
            let inside = self.resolve_within(child, rest, depth);
            // Names that a macro defines are not visible to this program.
            return inside.or(item_of(child));
        }
        if let Some(alias) = here.aliases.get(name) {
            let whole: Vec<String> = alias.iter().chain(rest).cloned().collect();
            return (whole != path).then(|| self.resolve_within(from, &whole, depth))?;
        }
        here.globs.iter().find_map(|glob| {
            let whole: Vec<String> = glob.iter().chain(path).cloned().collect();
            let target = self.resolve_within(from, glob, depth)?;
            (target.module != from).then(|| self.resolve_within(from, &whole, depth))?
        })
    }

    /// Module and name of the type of an `impl` in the module `from`.
    pub(super) fn home_of(
        &self,
        from: usize,
        implementation: &syn::ItemImpl,
    ) -> Option<(usize, String)> {
        let syn::Type::Path(path) = &*implementation.self_ty else {
            return None;
        };
        let segments = path.path.segments.iter();
        let path: Vec<String> = segments.map(|s| s.ident.to_string()).collect();
        Some((self.resolve(from, &path)?.module, path.last()?.clone()))
    }
}

/// All imports by `use`, including those within functions, but not in submodules.
struct Imports(Vec<(Option<String>, Vec<String>)>);

impl<'a> Visit<'a> for Imports {
    fn visit_item_use(&mut self, import: &'a syn::ItemUse) {
        self.0.extend(imports(&import.tree));
    }

    fn visit_item_mod(&mut self, _: &'a syn::ItemMod) {}
}

/// Files that count as code.
fn code(home: &Crate) -> impl Iterator<Item = &Source> {
    home.files.iter().filter(|f| f.kind == Kind::Code)
}

/// The file of a module that is declared in another file.
fn file_of<'a>(
    home: &'a Crate,
    source: &Source,
    name: &str,
) -> Option<(&'a Source, &'a syn::File)> {
    let folder = submodules(&source.path);
    let places = [
        format!("{folder}{name}.rs"),
        format!("{folder}{name}/mod.rs"),
    ];
    let file = code(home).find(|f| places.contains(&f.path))?;
    Some((file, file.items.as_ref()?))
}

/// Attributes of an item, and its name in the module.
fn named(item: &Item) -> (&[syn::Attribute], Option<&syn::Ident>) {
    match item {
        Item::Const(i) => (&i.attrs, Some(&i.ident)),
        Item::Enum(i) => (&i.attrs, Some(&i.ident)),
        Item::Fn(i) => (&i.attrs, Some(&i.sig.ident)),
        Item::Impl(i) => (&i.attrs, None),
        Item::Macro(i) => (&i.attrs, i.ident.as_ref()),
        Item::Mod(i) => (&i.attrs, None),
        Item::Static(i) => (&i.attrs, Some(&i.ident)),
        Item::Struct(i) => (&i.attrs, Some(&i.ident)),
        Item::Trait(i) => (&i.attrs, Some(&i.ident)),
        Item::Type(i) => (&i.attrs, Some(&i.ident)),
        Item::Use(i) => (&i.attrs, None),
        _ => (&[], None),
    }
}

/// The imports of a `use`: name and path, without a name for `*`.
pub(super) fn imports(tree: &UseTree) -> Vec<(Option<String>, Vec<String>)> {
    let below = |ident: &syn::Ident, tree: &UseTree| {
        let mut found = imports(tree);
        found
            .iter_mut()
            .for_each(|(_, path)| path.insert(0, ident.to_string()));
        // `a::{self}` imports `a`.
        for (name, path) in &mut found {
            if path.len() == 2 && path[1] == "self" {
                path.pop();
                if name.as_deref() == Some("self") {
                    *name = path.first().cloned();
                }
            }
        }
        found
    };
    match tree {
        UseTree::Path(path) => below(&path.ident, &path.tree),
        UseTree::Name(name) => vec![(Some(name.ident.to_string()), vec![name.ident.to_string()])],
        UseTree::Rename(r) => vec![(Some(r.rename.to_string()), vec![r.ident.to_string()])],
        UseTree::Group(group) => group.items.iter().flat_map(imports).collect(),
        _ => vec![(None, Vec::new())],
    }
}
