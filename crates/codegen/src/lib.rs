#![doc = include_str!("../README.md")]
//!
//! # Code map, in the order of the data
//!
//! | module | step |
//! | --- | --- |
//! | [`invocation`](Invocation) | tokens of a macro call → runtime path, definition, text |
//! | [`parse`] | tokens → [`parse::Definition`], one for each form |
//! | [`Space`] | sizes, and the fields of a body that kernels read |
//! | `vector` | vectors as sums of parts in frames: products of parts in the same frame need no rotation |
//! | `defined` | rotated vectors and products of vectors in space, differentiated as a whole |
//! | `elaborate` | expressions of the language → scalars of the graph, with shapes checked |
//! | `data` | the values that a constraint stores, and the derivatives with respect to them |
//! | `identity` | tests whether an expression is zero for every pose |
//! | `derive` | Φ or Ψ → C, b, Γ and the derivatives for implicit methods; force laws → Q and its derivatives |
//! | `kernel` | a list of expressions → one function with its operation count |
//! | `emit` | kernels and facts → the text of a module |
//! | `names` | conversion of type names into names of modules and scene types, and of words into type names |
//! | `nearest` | hints for misspelt names |

mod data;
mod defined;
mod derive;
mod elaborate;
mod emit;
mod identity;
mod invocation;
mod kernel;
mod names;
mod nearest;
pub mod parse;
mod space;
#[cfg(test)]
mod testing;
mod vector;

use proc_macro2::TokenStream;
use quote::quote;

pub use invocation::Invocation;
pub use names::{kebab_case, snake_case};
pub use parse::{Definition, Kind};
pub use space::Space;

/// A definition with its generated module.
pub struct Expansion {
    /// Name of the definition.
    pub name: String,
    /// Constraint or force.
    pub kind: Kind,
    /// The space of its bodies.
    pub space: Space,
    /// Items of the module: the type, its specification and its kernels.
    pub items: TokenStream,
}

/// Expands the body of one `joint!` or `force!`. Returns an expansion for each form of the
/// definition; the first expansion has the name of the definition. `runtime` is the path of the
/// crate `joints` in the expanded code. `text` is the definition as written by its author.
///
/// # Errors
/// Returns an error that marks the wrong token. Reasons are an unknown name, a wrong shape, a Ψ
/// that is not linear in velocities, a parameter that is never used, …
pub fn expand(
    kind: Kind,
    body: TokenStream,
    runtime: &TokenStream,
    text: &str,
) -> syn::Result<Vec<Expansion>> {
    let definitions = parse::definition(kind, body)?.into_iter();
    let expansions = definitions.map(|definition| {
        let model = elaborate::elaborate(&definition)?;
        let items = match kind {
            Kind::Constraint => emit::constraint(&definition, model, runtime, text)?,
            Kind::Force => emit::force(&definition, model, runtime, text)?,
        };
        Ok(Expansion {
            name: definition.name.to_string(),
            kind,
            space: definition.space,
            items,
        })
    });
    expansions.collect()
}

/// Expands a file that contains one `joint! { … }` or `force! { … }`.
///
/// # Errors
/// Returns an error if the file is not valid Rust, if it contains something else, or if its
/// definition is wrong.
pub fn expand_file(source: &str, runtime: &TokenStream) -> syn::Result<Vec<Expansion>> {
    let file = syn::parse_file(source)?;
    let [syn::Item::Macro(item)] = file.items.as_slice() else {
        return Err(syn::Error::new(
            proc_macro2::Span::call_site(),
            "a definition file holds exactly one `joint! { … }` or `force! { … }`",
        ));
    };
    let path = &item.mac.path;
    let kind = match () {
        () if path.is_ident("joint") => Kind::Constraint,
        () if path.is_ident("force") => Kind::Force,
        () => {
            return Err(syn::Error::new_spanned(
                path,
                "expected `joint!` or `force!`",
            ));
        }
    };
    expand(kind, item.mac.tokens.clone(), runtime, source.trim_end())
}

/// Returns the modules around the items of expansions in a user's crate.
#[must_use]
pub fn in_modules(expansions: &[Expansion]) -> TokenStream {
    expansions.iter().map(in_module).collect()
}

fn in_module(expansion: &Expansion) -> TokenStream {
    let module = quote::format_ident!("__{}", snake_case(&expansion.name));
    let items = &expansion.items;
    // All tokens have the position of the call, which has several lines. For this reason, Clippy
    // would report a difference in a list as two entries without a comma.
    quote! {
        #[doc(hidden)]
        #[allow(clippy::possible_missing_comma)]
        mod #module { #items }
        pub use #module::*;
    }
}
