//! Numeric constants, which may include limits and thresholds.

use proc_macro2::Span;
use syn::spanned::Spanned;
use syn::visit::{self, Visit};
use syn::{Attribute, Meta};

use super::source::{Crate, Kind, Source};

/// Crates whose constants are listed.
pub(super) const CRATES: [&str; 5] = ["dynamics", "linalg", "rank", "rotation", "solvability"];

const NUMBERS: [&str; 14] = [
    "f64", "f32", "usize", "u128", "u64", "u32", "u16", "u8", "isize", "i128", "i64", "i32", "i16",
    "i8",
];

/// `const NAME: TYPE = VALUE;` with a number, or a range of numbers.
#[derive(PartialEq, Debug)]
pub(super) struct Constant {
    /// Path relative to the directory of the crate, with the line.
    pub(super) place: String,
    pub(super) name: String,
    pub(super) value: String,
    /// The text of its comment after `Unit:` and `Test:`.
    pub(super) unit: String,
    pub(super) test: String,
}

/// All numeric constants of a crate outside of tests, in modules, types and functions.
pub(super) fn constants(home: &Crate) -> Vec<Constant> {
    let mut found = Vec::new();
    for source in home.files.iter().filter(|f| f.kind == Kind::Code) {
        let mut search = Search {
            source,
            found: Vec::new(),
        };
        if let Some(file) = &source.items {
            search.visit_file(file);
        }
        found.append(&mut search.found);
    }
    found
}

struct Search<'a> {
    source: &'a Source,
    found: Vec<Constant>,
}

impl Search<'_> {
    fn add(&mut self, attrs: &[Attribute], name: &syn::Ident, ty: &syn::Type, value: Span) {
        let ty = ty.span().source_text().unwrap_or_default();
        let bare = ty.rsplit_once("Range").map_or(ty.as_str(), |(_, rest)| {
            rest.split_once('<')
                .map_or(rest, |(_, inner)| inner.trim_end_matches('>'))
        });
        if NUMBERS.contains(&bare) && !self.source.is_test(name.span()) {
            let value = value.source_text().unwrap_or_default();
            self.found.push(Constant {
                place: format!("{}:{}", self.source.path, name.span().start().line),
                name: name.to_string(),
                value: value.split_whitespace().collect::<Vec<_>>().join(" "),
                unit: said(attrs, "Unit: "),
                test: said(attrs, "Test: ").replace('`', ""),
            });
        }
    }
}

/// Returns the rest of the sentence that starts with this word in a comment, without the full stop.
fn said(attrs: &[Attribute], word: &str) -> String {
    let lines = attrs.iter().filter_map(|a| match &a.meta {
        Meta::NameValue(doc) if doc.path.is_ident("doc") => doc.value.span().source_text(),
        _ => None,
    });
    let text: String = lines
        .map(|l| format!("{} ", l.trim_matches(['/', '"']).trim()))
        .collect();
    let rest = text.split_once(word).map_or("", |(_, rest)| rest);
    let end = rest.find(". ").unwrap_or(rest.len());
    rest[..end].trim().to_owned()
}

impl<'a> Visit<'a> for Search<'_> {
    fn visit_item_const(&mut self, item: &'a syn::ItemConst) {
        self.add(&item.attrs, &item.ident, &item.ty, item.expr.span());
        visit::visit_item_const(self, item);
    }

    fn visit_impl_item_const(&mut self, item: &'a syn::ImplItemConst) {
        self.add(&item.attrs, &item.ident, &item.ty, item.expr.span());
        visit::visit_impl_item_const(self, item);
    }
}
