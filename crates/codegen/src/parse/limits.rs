//! Bounds on the input of the recursive parts of the pipeline. A definition that is extremely long
//! or deep is rejected with an error, because a compiler that runs out of stack cannot report the
//! reason. This module also rejects paths, and keywords of Rust that are not words of this
//! language. The reason is the same: the parser of Rust would follow them to any depth.

use proc_macro2::{Ident, Spacing, TokenStream, TokenTree};

/// Maximum number of tokens of a definition; the longest definition of the library has about 250.
const TOKENS: usize = 2048;

/// Maximum nesting depth of parentheses, brackets and braces.
const DEPTH: usize = 32;

/// Maximum number of consecutive operators, as in `- - x`.
const OPERATORS: usize = 4;

/// Maximum number of forms of a definition. Each form is expanded.
pub(super) const FORMS: usize = 8;

/// The keywords of Rust that are also words of this language.
const KEYWORDS: [&str; 2] = ["let", "in"];

/// Checks all bounds.
pub(super) fn check(tokens: &TokenStream) -> syn::Result<()> {
    let mut left = TOKENS;
    walk(tokens, DEPTH, &mut left)
}

fn walk(tokens: &TokenStream, depth: usize, left: &mut usize) -> syn::Result<()> {
    let mut operators = 0;
    for token in tokens.clone() {
        let refuse = |what: String| Err(syn::Error::new_spanned(&token, what));
        match left.checked_sub(1) {
            Some(rest) => *left = rest,
            None => {
                return refuse(format!(
                    "the definition has more than {TOKENS} tokens: split it"
                ));
            }
        }
        operators = match &token {
            TokenTree::Punct(p) if !matches!(p.as_char(), ',' | ';' | ':' | '#') => operators + 1,
            _ => 0,
        };
        if operators > OPERATORS {
            return refuse(format!("more than {OPERATORS} operators in a row"));
        }
        match &token {
            TokenTree::Ident(word) if is_foreign(word) => {
                return refuse(format!("`{word}` is a word of Rust, not of this language"));
            }
            TokenTree::Punct(p) if p.as_char() == ':' && p.spacing() == Spacing::Joint => {
                return refuse("a path is no part of this language: names have no `::`".to_owned());
            }
            _ => {}
        }
        if let TokenTree::Group(group) = &token {
            match depth.checked_sub(1) {
                Some(depth) => walk(&group.stream(), depth, left)?,
                None => {
                    return refuse(format!(
                        "nested more than {DEPTH} deep: name a part of it with `let`"
                    ));
                }
            }
        }
    }
    Ok(())
}

fn is_foreign(word: &Ident) -> bool {
    let is_name = syn::parse2::<Ident>(TokenTree::Ident(word.clone()).into()).is_ok();
    !is_name && !KEYWORDS.iter().any(|k| word == k)
}
