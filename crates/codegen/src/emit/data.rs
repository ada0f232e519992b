//! The methods that return the data of a constraint and replace them, and the facts about the data.

use proc_macro2::TokenStream;
use quote::{format_ident, quote};

use super::parts::{self, index};
use crate::data::{Datum, Shape};
use crate::elaborate::Model;
use crate::parse::Definition;

/// The list of data.
pub(super) fn facts(d: &Definition, data: &[Datum]) -> TokenStream {
    let mut first = 0;
    let data = data.iter().map(|datum| {
        let (name, at) = (&datum.name, index(first));
        first += datum.symbols.len();
        let shape = match &datum.shape {
            Shape::Point(slot) => {
                let slot = parts::slot(d, slot);
                quote!(Point { slot: #slot })
            }
            Shape::Direction(slot) => {
                let slot = parts::slot(d, slot);
                quote!(Direction { slot: #slot })
            }
            Shape::Line => quote!(Line),
            Shape::Number(unit, _) => quote!(Number(Unit::#unit)),
            Shape::Kept(unit) => quote!(Kept(Unit::#unit)),
            Shape::KeptVector(slot) => {
                let slot = parts::slot(d, slot);
                quote!(KeptVector { slot: #slot })
            }
        };
        quote!(Datum::new(#name, DatumShape::#shape, #at))
    });
    quote!(&[#(#data),*])
}

/// `data` and `set_data`.
pub(super) fn methods(model: &Model, data: &[Datum]) -> TokenStream {
    let numbers = data.iter().flat_map(|d| &d.symbols).enumerate();
    let reads = numbers.map(|(k, &e)| {
        let symbol = model.g.as_symbol(e).expect("data are inputs");
        let (k, (access, _)) = (index(k), model.inputs.source(symbol).access());
        quote!(out[#k] = #access;)
    });
    let mut first = 0;
    let writes = data.iter().map(|datum| {
        let n = datum.symbols.len();
        let number: Vec<TokenStream> = (first..first + n)
            .map(|k| {
                let k = index(k);
                quote!(numbers[#k])
            })
            .collect();
        first += n;
        write(datum, &number)
    });
    let computed = model.kept.iter().filter(|k| model.is_computed(k));
    let computed = computed.map(|k| {
        let (field, value) = (format_ident!("{}", k.field), parts::kept_value(model, k));
        quote!(self.#field = #value;)
    });
    quote! {
        fn data(&self, out: &mut [f64]) { #(#reads)* }
        fn set_data(&mut self, numbers: &[f64]) { #(#writes)* #(#computed)* }
    }
}

fn write(datum: &Datum, number: &[TokenStream]) -> TokenStream {
    let field = &datum.field;
    match (&datum.shape, number) {
        (Shape::Direction(_), [x, y]) => {
            quote!(self.#field = Direction::from_data([#x, #y]);)
        }
        (Shape::Line, [x, y, along_x, along_y]) => {
            quote!(self.#field = Line::from_data([#x, #y], [#along_x, #along_y]);)
        }
        (Shape::Number(_, Some(k)), [x]) => {
            let k = index(*k);
            quote!(self.#field[#k] = #x;)
        }
        (_, [x]) => {
            // A value that the user stated is kept when initial values are computed again.
            let given = datum.overridden_by.as_ref();
            let given = given.map(|p| quote!(self.#p = self.#p.map(|_| #x);));
            quote!(#given self.#field = #x;)
        }
        (_, pair) => quote!(self.#field = [#(#pair),*];),
    }
}
