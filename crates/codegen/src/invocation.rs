//! The tokens between the braces of `joint! { … }` or `force! { … }`: an optional path of the crate
//! `joints`, followed by the definition.

use proc_macro2::{Delimiter, TokenStream, TokenTree};
use quote::quote;

use crate::Kind;

/// The parts of a macro call.
pub struct Invocation {
    /// Path of the crate `joints` in the expanded code; it is `::joints` if the call gives no path.
    pub runtime: TokenStream,
    /// The definition.
    pub body: TokenStream,
    /// The call as written by its author. If the compiler provides the source text, it is the
    /// source text; otherwise it consists of printed tokens.
    pub text: String,
}

impl Invocation {
    /// Splits a macro call into `#![runtime = some::path]`, if present, and the rest.
    ///
    /// # Errors
    /// Returns an error if the definition starts with a different inner attribute.
    ///
    /// ```
    /// use pfaff_codegen::{Invocation, Kind};
    /// let call = "#![runtime = pfaff::joints] plane Rod(i) {}".parse().unwrap();
    /// let call = Invocation::parse(Kind::Constraint, call).unwrap();
    /// assert_eq!(call.runtime.to_string(), "pfaff :: joints");
    /// assert_eq!(call.text, "joint! { plane Rod(i) {} }");
    /// ```
    pub fn parse(kind: Kind, call: TokenStream) -> syn::Result<Self> {
        let mut tokens = call.into_iter().peekable();
        let runtime = match tokens.peek() {
            Some(TokenTree::Punct(p)) if p.as_char() == '#' => {
                let attribute: Vec<TokenTree> = tokens.by_ref().take(3).collect();
                runtime(&attribute)?
            }
            _ => quote!(::joints),
        };
        let body: TokenStream = tokens.collect();
        let text = text(kind, &body);
        Ok(Self {
            runtime,
            body,
            text,
        })
    }
}

/// Returns the path in `#![runtime = path]`. The path is not checked, so that the `$crate` of a
/// wrapping macro can be passed.
fn runtime(attribute: &[TokenTree]) -> syn::Result<TokenStream> {
    if let [_, TokenTree::Punct(not), TokenTree::Group(group)] = attribute
        && not.as_char() == '!'
        && group.delimiter() == Delimiter::Bracket
    {
        let mut inner = group.stream().into_iter();
        if let (Some(TokenTree::Ident(key)), Some(TokenTree::Punct(equals))) =
            (inner.next(), inner.next())
            && key == "runtime"
            && equals.as_char() == '='
        {
            let path: TokenStream = inner.collect();
            if !path.is_empty() {
                return Ok(path);
            }
        }
    }
    Err(syn::Error::new_spanned(
        attribute.iter().cloned().collect::<TokenStream>(),
        "expected `#![runtime = path]`, the path of the crate `joints`, or the definition",
    ))
}

/// Returns the text of `plane Name(i, j) { … }`. The text consists of four tokens, each with its
/// own source text.
fn text(kind: Kind, body: &TokenStream) -> String {
    let name = match kind {
        Kind::Constraint => "joint",
        Kind::Force => "force",
    };
    let mut text = String::new();
    for token in body.clone() {
        // The slots follow the name without a space.
        let tight =
            matches!(&token, TokenTree::Group(g) if g.delimiter() == Delimiter::Parenthesis);
        if !text.is_empty() && !tight {
            text.push(' ');
        }
        let source = token.span().source_text();
        text.push_str(&source.unwrap_or_else(|| token.to_string()));
    }
    format!("{name}! {{ {text} }}")
}
