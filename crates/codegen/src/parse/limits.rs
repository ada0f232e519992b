//! Bounds on what is handed to the recursive parts of the pipeline: a definition that is absurdly long or deep is
//! refused with an error, because a compiler that runs out of stack cannot say why.

use proc_macro2::{TokenStream, TokenTree};

/// Tokens of a definition; the longest that is shipped has about 250.
const TOKENS: usize = 2048;

/// Nesting of parentheses, brackets and braces.
const DEPTH: usize = 32;

/// Operators in a row, as in `- - x`.
const OPERATORS: usize = 4;

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
