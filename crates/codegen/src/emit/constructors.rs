//! Constructors of the generated types. The constructors take the parameters, without the values
//! stored at the start.

use proc_macro2::{Ident, TokenStream};
use quote::{format_ident, quote};

use super::parts::{Driven, field_type, index, measure_0};
use crate::elaborate::Model;
use crate::parse::{Definition, Kept};

/// Returns `new` with the parameters that have no default, and a method for each parameter with a
/// default. The function `initialise` sets the values stored at the start, so a user cannot give
/// these values.
pub(super) fn constructors(
    d: &Definition,
    model: &Model,
    name: &Ident,
    driven: Option<Driven>,
) -> TokenStream {
    let stored = || {
        d.params
            .iter()
            .filter_map(|p| Some((p, field_type(d.space, p)?)))
    };
    let (optional, required): (Vec<_>, Vec<_>) = stored().partition(|(p, _)| p.default.is_some());
    let arguments = required.iter().map(|(p, ty)| {
        let name = &p.name;
        quote!(#name: #ty)
    });
    let fields = stored().map(|(p, _)| {
        let name = &p.name;
        match p.default {
            Some(_) => quote!(#name: None),
            None => quote!(#name),
        }
    });
    let kept = model.kept.iter().map(|k| {
        let name = format_ident!("{}", k.field);
        match k.kind {
            Kept::Number(_) => quote!(#name: 0.0),
            Kept::Vector(_) => {
                let dim = index(d.space.dim());
                quote!(#name: [0.0; #dim])
            }
            Kept::Turn => quote!(#name: [1.0, 0.0]),
        }
    });
    let fields = fields.chain(kept).chain(driven.and_then(measure_0));
    // The number of parameters causes the lints, and the definition determines this number.
    let lints = match required.len() {
        0 => Some(quote!(#[allow(clippy::new_without_default)])),
        8.. => Some(quote!(#[allow(clippy::too_many_arguments)])),
        _ => None,
    };
    let doc = match (required.is_empty(), optional.is_empty()) {
        (true, _) => " It has no parameters that must be given.",
        (false, true) => " From its parameters, in the order of its fields.",
        (false, false) => " From the parameters that have no default, in the order of its fields.",
    };
    let with = optional.iter().map(|(p, _)| {
        let (field, doc) = (&p.name, format!(" The same, with `{}`.", p.name));
        let method = format_ident!("with_{}", field);
        quote! {
            #[doc = #doc]
            #[must_use]
            #[allow(dead_code)]
            pub const fn #method(mut self, #field: f64) -> Self {
                self.#field = Some(#field);
                self
            }
        }
    });
    quote! {
        impl #name {
            #[doc = #doc]
            #[must_use]
            #lints
            pub const fn new(#(#arguments),*) -> Self {
                Self { #(#fields),* }
            }
            #(#with)*
        }
    }
}
