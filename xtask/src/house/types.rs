//! Types with much state or many methods.
//!
//! A type is **plain data** if all its fields are `pub`, or as visible as the type itself, and no
//! method of the type in its crate takes `&mut self`. Plain data are records or sets of options.
//! All other types are **stateful**. The fields of an enum are the fields of its largest variant.
//! Methods are the functions of all `impl` blocks of the type without a trait, with or without
//! `self`. Tests and code that macros write are omitted.

use std::collections::BTreeMap;

use syn::{Field, ImplItem, Item, ReceiverKind, Visibility};

use super::modules::Modules;
use super::source::is_test;

/// Largest number of fields.
pub(super) const FIELDS_MOST: usize = 12;
/// Largest number of methods.
pub(super) const METHODS_MOST: usize = 30;

/// A type, with the number of its fields and the number of its methods.
#[derive(Debug)]
pub(super) struct Type {
    pub(super) name: String,
    /// Path relative to the directory of the crate.
    pub(super) file: String,
    pub(super) fields: usize,
    pub(super) methods: usize,
    pub(super) is_stateful: bool,
}

/// Types of a crate above one of the bounds. The largest type comes first.
pub(super) fn large(modules: &Modules) -> Vec<Type> {
    let mut types = BTreeMap::new();
    for (id, module) in modules.0.iter().enumerate() {
        for item in &module.items {
            let (name, fields, is_open) = match item {
                Item::Struct(s) => {
                    let fields: Vec<&Field> = kept(s.fields.iter()).collect();
                    let is_open = fields.iter().all(|f| is_open(&f.vis, &s.vis));
                    (&s.ident, fields.len(), is_open)
                }
                Item::Enum(e) => {
                    let sizes = e.variants.iter().map(|v| kept(v.fields.iter()).count());
                    (&e.ident, sizes.max().unwrap_or(0), true)
                }
                _ => continue,
            };
            let found = Type {
                name: name.to_string(),
                file: module.source.path.clone(),
                fields,
                methods: 0,
                is_stateful: !is_open,
            };
            types.insert((id, name.to_string()), found);
        }
    }
    for (id, module) in modules.0.iter().enumerate() {
        for item in &module.items {
            let Item::Impl(block) = item else { continue };
            let home = modules.home_of(id, block);
            let Some(owner) = home.and_then(|home| types.get_mut(&home)) else {
                continue;
            };
            for item in &block.items {
                if let ImplItem::Fn(f) = item
                    && !is_test(&f.attrs)
                {
                    owner.methods += usize::from(block.trait_.is_none());
                    owner.is_stateful |= changes(&f.sig);
                }
            }
        }
    }
    let mut large: Vec<Type> = types.into_values().filter(is_large).collect();
    large.sort_by_key(|t| std::cmp::Reverse(t.fields.max(t.methods)));
    large
}

fn is_large(found: &Type) -> bool {
    found.fields > FIELDS_MOST || found.methods > METHODS_MOST
}

fn kept<'a>(fields: impl Iterator<Item = &'a Field>) -> impl Iterator<Item = &'a Field> {
    fields.filter(|f| !is_test(&f.attrs))
}

fn is_open(field: &Visibility, owner: &Visibility) -> bool {
    matches!(field, Visibility::Public(_)) || field == owner
}

/// Whether a method takes `&mut self`.
fn changes(signature: &syn::Signature) -> bool {
    let kind = signature.receiver().map(|r| &r.kind);
    matches!(kind, Some(ReceiverKind::Reference(_, _, Some(_))))
}
