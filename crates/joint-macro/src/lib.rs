#![doc = include_str!("../README.md")]

use codegen::{Invocation, Kind, expand, in_modules};
use proc_macro::TokenStream;

/// Defines a constraint: its type, its specification and its kernels, as an implementation of
/// `joints::Constraint`.
///
/// The crate `codegen` describes the language; the description of the present crate contains an
/// example.
#[proc_macro]
pub fn joint(call: TokenStream) -> TokenStream {
    items(Kind::Constraint, call)
}

/// Defines a force: its type, its specification and its kernels, as an implementation of
/// `joints::Force`.
///
/// The crate `codegen` describes the language.
#[proc_macro]
pub fn force(call: TokenStream) -> TokenStream {
    items(Kind::Force, call)
}

fn items(kind: Kind, call: TokenStream) -> TokenStream {
    Invocation::parse(kind, call.into())
        .and_then(|call| expand(kind, call.body, &call.runtime, &call.text))
        .map_or_else(|error| error.into_compile_error(), |e| in_modules(&e))
        .into()
}
