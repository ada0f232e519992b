//! Circular dependencies of modules.
//!
//! A module is a file with the modules inside the file. Tests and generated files are omitted. The
//! module A **uses** the module B if code of A names an item that B defines: in a `use` that is not
//! a re-export, or by a path anywhere in code, including the arguments of macros. The position of
//! the definition counts: a path through re-exports is a use of the definition, so
//! `mod b; pub use b::X;` is not a use of `b`, and `use super::X` of a child is a use of the parent
//! only if the parent defines `X`. The following are not uses: `mod b;` alone, `use super::b`,
//! which only gives the module a name, and a path that only passes through a module. In contrast,
//! `use super::b::*` is a use. If the `impl` blocks of a type are in several files, `self.f()` uses
//! the file that contains `f`. Other method calls are not followed, because code that has a value
//! has named its type or received it from code that has named it.
//!
//! A **circle** is a maximal set of modules in which each module uses every other module, directly
//! or through other modules.

use std::collections::{BTreeMap, BTreeSet};

use proc_macro2::{Delimiter, TokenStream, TokenTree};
use syn::visit::{self, Visit};
use syn::{Expr, ImplItem, Item};

use super::modules::{Modules, imports};
use super::source::{Source, is_test};

/// A maximal set of modules that use each other.
pub(super) struct Circle {
    /// Sorted paths.
    pub(super) modules: Vec<String>,
    /// Each use between modules, with the names of the used items. `.f` is a method of a shared
    /// type.
    pub(super) uses: Vec<(String, String, Vec<String>)>,
}

/// Used module → names of its used items.
type Uses = BTreeMap<usize, BTreeSet<String>>;

/// All circles of a crate with more than `most` modules. The largest circle comes first.
pub(super) fn circles(modules: &Modules, most: usize) -> Vec<Circle> {
    let uses = uses(modules);
    let reached: Vec<BTreeSet<usize>> = (0..uses.len()).map(|m| reached(&uses, m)).collect();
    let mut circles = BTreeSet::new();
    for module in 0..uses.len() {
        let mutual = |&m: &usize| reached[m].contains(&module);
        let circle: Vec<usize> = reached[module].iter().copied().filter(mutual).collect();
        if circle.len() > most {
            circles.insert(circle);
        }
    }
    let name = |m: &usize| modules.0[*m].path.clone();
    let tell = |circle: Vec<usize>| {
        let mut within = Vec::new();
        for from in &circle {
            let targets = uses[*from].iter().filter(|(m, _)| circle.contains(m));
            within
                .extend(targets.map(|(m, by)| (name(from), name(m), by.iter().cloned().collect())));
        }
        Circle {
            modules: circle.iter().map(name).collect(),
            uses: within,
        }
    };
    let mut circles: Vec<Circle> = circles.into_iter().map(tell).collect();
    circles.sort_by_key(|c| std::cmp::Reverse(c.modules.len()));
    circles
}

/// All modules that can be reached from a module by one or more uses.
fn reached(uses: &[Uses], from: usize) -> BTreeSet<usize> {
    let (mut seen, mut next) = (BTreeSet::new(), vec![from]);
    while let Some(module) = next.pop() {
        next.extend(uses[module].keys().filter(|m| seen.insert(**m)));
    }
    seen
}

/// For each module, the modules that it uses, by file.
fn uses(modules: &Modules) -> Vec<Uses> {
    let mut uses = vec![Uses::new(); modules.0.len()];
    for (id, module) in modules.0.iter().enumerate().filter(|(id, m)| m.file == *id) {
        let mut paths = Paths {
            modules,
            source: module.source,
            targets: Uses::new(),
        };
        paths.stream(id, module.source.tokens.clone());
        uses[id] = paths.targets;
    }
    for (from, to, method) in calls_of_own_methods(modules) {
        uses[from]
            .entry(to)
            .or_default()
            .insert(format!(".{method}"));
    }
    for (id, targets) in uses.iter_mut().enumerate() {
        targets.remove(&id);
    }
    uses
}

struct Paths<'a> {
    modules: &'a Modules<'a>,
    source: &'a Source,
    targets: Uses,
}

impl Paths<'_> {
    /// Adds the target of a path, if the target is an item or all items of a module.
    fn add(&mut self, module: usize, path: &[String], is_glob: bool) {
        if let Some(target) = self.modules.resolve(module, path)
            && (target.is_item || is_glob)
        {
            let name = path.last().filter(|_| !is_glob);
            let what = name.map_or("*", String::as_str).to_owned();
            let target = self.modules.0[target.module].file;
            self.targets.entry(target).or_default().insert(what);
        }
    }

    fn stream(&mut self, module: usize, stream: TokenStream) {
        let tokens: Vec<TokenTree> = stream
            .into_iter()
            .filter(|t| !self.source.is_test(t.span()))
            .collect();
        let mut at = 0;
        while at < tokens.len() {
            at = match &tokens[at] {
                TokenTree::Group(group) => {
                    self.stream(self.inside(module, &tokens[..at]), group.stream());
                    at + 1
                }
                TokenTree::Ident(word) if word == "use" && !is_punct(tokens.get(at + 1), '<') => {
                    self.import(module, &tokens, at)
                }
                TokenTree::Ident(_) => self.path(module, &tokens, at),
                _ => at + 1,
            };
        }
    }

    /// The module that contains a group of tokens: `mod name { … }` or the module around it.
    fn inside(&self, module: usize, before: &[TokenTree]) -> usize {
        match before {
            [.., TokenTree::Ident(word), TokenTree::Ident(name)] if word == "mod" => {
                let children = &self.modules.0[module].children;
                children.get(&name.to_string()).copied().unwrap_or(module)
            }
            _ => module,
        }
    }

    /// Reads a `use`, and returns the index of the token after it.
    fn import(&mut self, module: usize, tokens: &[TokenTree], at: usize) -> usize {
        let is_reexport = match at.checked_sub(1).map(|i| &tokens[i]) {
            Some(TokenTree::Ident(word)) => word == "pub",
            Some(TokenTree::Group(group)) => group.delimiter() == Delimiter::Parenthesis,
            _ => false,
        };
        let length = tokens[at..].iter().position(|t| is_punct(Some(t), ';'));
        let end = length.map_or(tokens.len(), |n| at + n + 1);
        let statement = tokens[at..end].iter().cloned().collect();
        if let (false, Ok(import)) = (is_reexport, syn::parse2::<syn::ItemUse>(statement)) {
            for (name, path) in imports(&import.tree) {
                self.add(module, &path, name.is_none());
            }
        }
        end
    }

    /// Reads a path, or a single name that can only be an item. Returns the index of the token
    /// after it.
    fn path(&mut self, module: usize, tokens: &[TokenTree], at: usize) -> usize {
        let (mut path, mut end) = (Vec::new(), at);
        while let Some(TokenTree::Ident(word)) = tokens.get(end) {
            path.push(word.to_string());
            let joined = is_punct(tokens.get(end + 1), ':') && is_punct(tokens.get(end + 2), ':');
            end += if joined { 3 } else { 1 };
            if !joined {
                break;
            }
        }
        let before = |n: usize| at.checked_sub(n).map(|i| &tokens[i]);
        let is_field = is_punct(before(1), '.') && !is_punct(before(2), '.');
        let is_continued = is_punct(before(1), ':') && is_punct(before(2), ':');
        let is_definition =
            matches!(before(1), Some(TokenTree::Ident(w)) if w == "fn" || w == "mod");
        let is_item = path.len() > 1
            || path[0].starts_with(char::is_uppercase)
            || matches!(tokens.get(end), Some(TokenTree::Group(g)) if g.delimiter() == Delimiter::Parenthesis);
        if is_item && !is_field && !is_continued && !is_definition && path != ["self"] {
            self.add(module, &path, false);
        }
        end
    }
}

fn is_punct(token: Option<&TokenTree>, expected: char) -> bool {
    matches!(token, Some(TokenTree::Punct(p)) if p.as_char() == expected)
}

/// Uses between the files that share the `impl` blocks of one type.
fn calls_of_own_methods(modules: &Modules) -> Vec<(usize, usize, String)> {
    let mut homes: BTreeMap<((usize, String), String), usize> = BTreeMap::new();
    let mut calls = Vec::new();
    for (id, module) in modules.0.iter().enumerate() {
        for item in &module.items {
            let Item::Impl(block) = item else { continue };
            let Some(owner) = modules.home_of(id, block) else {
                continue;
            };
            for item in &block.items {
                let ImplItem::Fn(f) = item else { continue };
                if is_test(&f.attrs) {
                    continue;
                }
                let mut own = OwnMethods(Vec::new());
                own.visit_impl_item_fn(f);
                calls.extend(own.0.into_iter().map(|m| (module.file, (owner.clone(), m))));
                if block.trait_.is_none() {
                    homes.insert((owner.clone(), f.sig.ident.to_string()), module.file);
                }
            }
        }
    }
    let target = |(from, method)| Some((from, *homes.get(&method)?, method.1));
    calls.into_iter().filter_map(target).collect()
}

/// Names of the methods that are called on `self`.
struct OwnMethods(Vec<String>);

impl<'a> Visit<'a> for OwnMethods {
    fn visit_expr_method_call(&mut self, call: &'a syn::ExprMethodCall) {
        if matches!(&*call.receiver, Expr::Path(p) if p.path.is_ident("self")) {
            self.0.push(call.method.to_string());
        }
        visit::visit_expr_method_call(self, call);
    }
}
