//! The items that a user of a library can name: items of public modules, and items that public
//! modules re-export.

use std::collections::{BTreeMap, BTreeSet};

use syn::{Attribute, Block, Fields, ImplItem, Item, TraitItem, Type, UseTree, Visibility};

use super::module::Module;

/// Largest depth to which re-exports of re-exports are followed.
const DEPTH_MOST: usize = 8;

/// The public items of a library.
pub(super) struct Public<'m> {
    root: &'m Module,
    /// Text of the items, by the path of their public module.
    shown: BTreeMap<String, BTreeSet<String>>,
    /// Names of the types among the items.
    types: BTreeSet<String>,
}

impl<'m> Public<'m> {
    pub(super) fn of(root: &'m Module) -> Self {
        let mut public = Self {
            root,
            shown: BTreeMap::new(),
            types: BTreeSet::new(),
        };
        public.module(&[], "crate", DEPTH_MOST);
        let mut impls = BTreeSet::new();
        public.impls(root, &mut impls);
        if !impls.is_empty() {
            public.shown.insert("impl".to_owned(), impls);
        }
        public
    }

    /// The items, module by module.
    pub(super) fn text(&self) -> String {
        let modules = self.shown.iter().map(|(path, items)| {
            let mut items: Vec<&str> = items.iter().map(String::as_str).collect();
            items.sort_by_key(|item| item.lines().find(|line| !line.starts_with(['#', '/'])));
            format!("// {path}\n\n{}", items.concat())
        });
        modules.collect::<Vec<_>>().join("\n")
    }

    fn show(&mut self, under: &str, text: String) {
        self.shown.entry(under.to_owned()).or_default().insert(text);
    }

    /// Adds a module of the library at its public path.
    fn module(&mut self, at: &[String], under: &str, depth: usize) {
        let Some(module) = self.root.at(at) else {
            return;
        };
        if depth == 0 {
            return;
        }
        for item in &module.items {
            match item {
                Item::Mod(m) if is_public(&m.vis) => {
                    let name = m.ident.to_string();
                    self.module(&below(at, &name), &format!("{under}::{name}"), depth - 1);
                }
                Item::Use(u) if is_public(&u.vis) => {
                    for (path, name) in leaves(&u.tree) {
                        self.reexport((at, &path, &name), under, depth - 1);
                    }
                }
                Item::Macro(m) if m.attrs.iter().any(|a| a.path().is_ident("macro_export")) => {
                    let name = m
                        .ident
                        .as_ref()
                        .map(ToString::to_string)
                        .unwrap_or_default();
                    self.show(under, format!("macro_rules! {name}\n"));
                }
                item if visibility(item).is_some_and(is_public) => self.item(item, "", under),
                _ => {}
            }
        }
    }

    fn item(&mut self, item: &Item, alias: &str, under: &str) {
        if let Some(name) = type_name(item) {
            self.types.insert(name);
        }
        let text = print(bare(item.clone()));
        let alias = if alias.is_empty() {
            String::new()
        } else {
            format!("// as {alias}\n")
        };
        self.show(under, format!("{alias}{text}"));
    }

    /// Adds the item that a path in a module names.
    fn reexport(
        &mut self,
        (at, path, name): (&[String], &[String], &str),
        under: &str,
        depth: usize,
    ) {
        let Some((home, last)) = self.resolve(at, path) else {
            let renamed = path.last().is_some_and(|last| last != name && last != "*");
            let alias = if renamed {
                format!(" as {name}")
            } else {
                String::new()
            };
            return self.show(under, format!("pub use {}{alias};\n", path.join("::")));
        };
        if last == "*" {
            return self.module(&home, under, depth);
        }
        let alias = if last == name { "" } else { name };
        let Some(module) = self.root.at(&home) else {
            return;
        };
        if module.children.contains_key(&last) {
            let shown = format!("{under}::{name}");
            return self.module(&below(&home, &last), &shown, depth);
        }
        let mut is_found = false;
        for item in &module.items {
            if visibility(item).is_some() && item_name(item).as_deref() == Some(&last) {
                self.item(item, alias, under);
                is_found = true;
            }
        }
        if is_found || depth == 0 {
            return;
        }
        for item in &module.items {
            let Item::Use(u) = item else { continue };
            for (inner, inner_name) in leaves(&u.tree) {
                let passes_all = inner.last().is_some_and(|s| s == "*");
                if inner_name == last {
                    self.reexport((&home, &inner, name), under, depth - 1);
                } else if passes_all && let Some((globbed, _)) = self.resolve(&home, &inner) {
                    let has = self.root.at(&globbed).is_some_and(|m| {
                        m.items
                            .iter()
                            .any(|i| item_name(i).as_deref() == Some(&last))
                    });
                    if has {
                        let path = [
                            &["crate".to_owned()][..],
                            &globbed,
                            std::slice::from_ref(&last),
                        ];
                        self.reexport((&[], &path.concat(), name), under, depth - 1);
                    }
                }
            }
        }
    }

    /// Returns the module of the library at the end of a path, and the last name. Returns `None`
    /// for paths to other crates.
    fn resolve(&self, at: &[String], path: &[String]) -> Option<(Vec<String>, String)> {
        let (last, modules) = path.split_last()?;
        let mut home = at.to_vec();
        let mut rest = modules;
        match modules.first().map(String::as_str) {
            Some("crate") => {
                home.clear();
                rest = &modules[1..];
            }
            Some("self") => rest = &modules[1..],
            Some("super") => {}
            Some(first) if self.root.at(at)?.children.contains_key(first) => {}
            Some(_) => return None,
            None if self.root.at(at)?.children.contains_key(last) => {}
            None => return None,
        }
        for name in rest {
            if name == "super" {
                home.pop()?;
            } else {
                home.push(name.clone());
            }
        }
        self.root.at(&home)?;
        Some((home, last.clone()))
    }

    /// The implementations for the public types.
    fn impls(&self, module: &Module, out: &mut BTreeSet<String>) {
        for item in &module.items {
            let Item::Impl(of) = item else { continue };
            let is_shown = match of.self_ty.as_ref() {
                Type::Path(path) => {
                    let name = path.path.segments.last().map(|s| s.ident.to_string());
                    name.is_some_and(|name| self.types.contains(&name))
                }
                _ => false,
            };
            if !is_shown {
                continue;
            }
            let mut of = of.clone();
            of.attrs.retain(is_told);
            if of.trait_.is_some() {
                of.items.clear();
            }
            of.items.retain_mut(|item| match item {
                ImplItem::Fn(f) => {
                    f.attrs.retain(is_told);
                    f.block = nothing();
                    is_public(&f.vis)
                }
                ImplItem::Const(c) => {
                    c.attrs.retain(is_told);
                    is_public(&c.vis)
                }
                _ => false,
            });
            if of.trait_.is_some() || !of.items.is_empty() {
                out.insert(print(Item::Impl(of)));
            }
        }
        module
            .children
            .values()
            .for_each(|child| self.impls(child, out));
    }
}

fn below(at: &[String], name: &str) -> Vec<String> {
    [at, &[name.to_owned()]].concat()
}

/// Paths of an import with their new names.
fn leaves(tree: &UseTree) -> Vec<(Vec<String>, String)> {
    match tree {
        UseTree::Path(path) => {
            let first = path.ident.to_string();
            let mut inner = leaves(&path.tree);
            inner
                .iter_mut()
                .for_each(|(path, _)| path.insert(0, first.clone()));
            // `a::{self}` means `a`.
            for (path, name) in &mut inner {
                if path.last().is_some_and(|last| last == "self") {
                    path.pop();
                    if name == "self" {
                        name.clone_from(&first);
                    }
                }
            }
            inner
        }
        UseTree::Name(name) => vec![(vec![name.ident.to_string()], name.ident.to_string())],
        UseTree::Rename(name) => vec![(vec![name.ident.to_string()], name.rename.to_string())],
        UseTree::Glob(_) => vec![(vec!["*".to_owned()], "*".to_owned())],
        UseTree::Group(group) => group.items.iter().flat_map(leaves).collect(),
    }
}

fn is_public(visibility: &Visibility) -> bool {
    matches!(visibility, Visibility::Public(_))
}

fn visibility(item: &Item) -> Option<&Visibility> {
    Some(match item {
        Item::Const(i) => &i.vis,
        Item::Enum(i) => &i.vis,
        Item::Fn(i) => &i.vis,
        Item::Static(i) => &i.vis,
        Item::Struct(i) => &i.vis,
        Item::Trait(i) => &i.vis,
        Item::Type(i) => &i.vis,
        _ => return None,
    })
}

fn item_name(item: &Item) -> Option<String> {
    Some(match item {
        Item::Const(i) => i.ident.to_string(),
        Item::Fn(i) => i.sig.ident.to_string(),
        Item::Static(i) => i.ident.to_string(),
        item => return type_name(item),
    })
}

fn type_name(item: &Item) -> Option<String> {
    Some(match item {
        Item::Enum(i) => i.ident.to_string(),
        Item::Struct(i) => i.ident.to_string(),
        Item::Trait(i) => i.ident.to_string(),
        Item::Type(i) => i.ident.to_string(),
        _ => return None,
    })
}

/// Whether the text of the API contains an attribute.
fn is_told(attribute: &Attribute) -> bool {
    ["cfg", "cfg_attr", "derive", "non_exhaustive"]
        .iter()
        .any(|name| attribute.path().is_ident(name))
}

fn nothing() -> Block {
    Block {
        brace_token: syn::token::Brace::default(),
        stmts: Vec::new(),
    }
}

fn public_fields(fields: &mut Fields) {
    if let Fields::Named(named) = fields {
        let all = std::mem::take(&mut named.named);
        named.named = all
            .into_iter()
            .filter(|field| is_public(&field.vis))
            .collect();
        named
            .named
            .iter_mut()
            .for_each(|field| field.attrs.retain(is_told));
    }
}

/// The item without bodies, documentation and private fields.
fn bare(mut item: Item) -> Item {
    match &mut item {
        Item::Const(i) => i.attrs.retain(is_told),
        Item::Static(i) => i.attrs.retain(is_told),
        Item::Type(i) => i.attrs.retain(is_told),
        Item::Fn(i) => {
            i.attrs.retain(is_told);
            *i.block = nothing();
        }
        Item::Struct(i) => {
            i.attrs.retain(is_told);
            public_fields(&mut i.fields);
        }
        Item::Enum(i) => {
            i.attrs.retain(is_told);
            for variant in &mut i.variants {
                variant.attrs.retain(is_told);
                for field in &mut variant.fields {
                    field.attrs.retain(is_told);
                }
            }
        }
        Item::Trait(i) => {
            i.attrs.retain(is_told);
            for item in &mut i.items {
                match item {
                    TraitItem::Fn(f) => {
                        f.attrs.retain(is_told);
                        f.default = f.default.as_ref().map(|_| nothing());
                    }
                    TraitItem::Const(c) => c.attrs.retain(is_told),
                    TraitItem::Type(t) => t.attrs.retain(is_told),
                    _ => {}
                }
            }
        }
        _ => {}
    }
    item
}

fn print(item: Item) -> String {
    let mut file: syn::File = syn::parse_quote!();
    file.items.push(item);
    prettyplease::unparse(&file)
}
