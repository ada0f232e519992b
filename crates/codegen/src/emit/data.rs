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
        let count = index(datum.count());
        first += datum.count();
        let shape = match &datum.shape {
            Shape::Point(slot) => {
                let slot = parts::slot(d, slot);
                quote!(Point { slot: #slot })
            }
            Shape::Direction(slot) => {
                let slot = parts::slot(d, slot);
                quote!(Direction { slot: #slot })
            }
            Shape::Axes(slot) => {
                let slot = parts::slot(d, slot);
                quote!(Axes { slot: #slot })
            }
            Shape::Turn => quote!(Kept(Unit::Angle)),
            Shape::Line => quote!(Line),
            Shape::Plane => quote!(Plane),
            Shape::Number(unit, _) => quote!(Number(Unit::#unit)),
            Shape::Kept(unit) => quote!(Kept(Unit::#unit)),
            Shape::KeptVector(slot) => {
                let slot = parts::slot(d, slot);
                quote!(KeptVector { slot: #slot })
            }
        };
        quote!(Datum::new(#name, DatumShape::#shape, #at, #count))
    });
    quote!(&[#(#data),*])
}

/// `data` and `set_data`.
pub(super) fn methods(model: &Model, data: &[Datum]) -> TokenStream {
    // Axes and angles by cosine and sine have changes only: none yet.
    let numbers = data.iter().flat_map(|d| {
        let changes = d.count() < d.symbols.len();
        let symbols = d.symbols.iter().take(d.count());
        symbols.map(move |&e| (d, (!changes).then_some(e)))
    });
    let reads = numbers.enumerate().map(|(k, (datum, e))| {
        let k = index(k);
        let Some(e) = e else {
            return quote!(out[#k] = 0.0;);
        };
        let symbol = model.g.as_symbol(e).expect("data are inputs");
        let (access, _) = model.inputs.source(symbol).access();
        // Before `initialise` a value that the user stated is not yet where the kernels read it.
        match &datum.overridden_by {
            Some(given) => quote!(out[#k] = self.#given.unwrap_or(#access);),
            None => quote!(out[#k] = #access;),
        }
    });
    let mut first = 0;
    let writes = data.iter().map(|datum| {
        let n = datum.count();
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
        (Shape::Direction(_), components) => {
            quote!(self.#field = Direction::from_data([#(#components),*]);)
        }
        (Shape::Axes(_), turn) => quote!(self.#field = self.#field.turned([#(#turn),*]);),
        (Shape::Turn, [angle]) => quote! {
            let (sin, cos) = f64::sin_cos(#angle);
            let [c, s] = self.#field;
            self.#field = [c * cos - s * sin, s * cos + c * sin];
        },
        (Shape::Line, [x, y, along_x, along_y]) => {
            quote!(self.#field = Line::from_data([#x, #y], [#along_x, #along_y]);)
        }
        (Shape::Plane, [x, y, z, normal @ ..]) => {
            quote!(self.#field = self.#field.with_data([#x, #y, #z], [#(#normal),*]);)
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
