//! The methods that return and replace the data of a constraint, and the specification of the data.

use proc_macro2::TokenStream;
use quote::{format_ident, quote};

use super::parts::{self, index};
use symbolic::{Expr, Scalar, Symbol};

use crate::data::{Datum, Shape, read_by, slopes};
use crate::defined::Along;
use crate::derive::ConstraintKernels;
use crate::elaborate::Model;
use crate::kernel::kernel;
use crate::parse::Definition;

/// Returns the list of data.
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

/// The stored values of a constraint that its rows read, and the derivatives of these values with
/// respect to the data.
pub(super) struct Stored {
    pub(super) symbols: Vec<Symbol>,
    slopes: Vec<(usize, usize, Expr)>,
}

impl Stored {
    pub(super) fn of(model: &mut Model, kernels: &ConstraintKernels, data: &[Along]) -> Self {
        let symbols = read_by(model, kernels.rows());
        let slopes = slopes(model, &symbols, data);
        Self { symbols, slopes }
    }

    /// Returns the number of derivatives at the beginning of the list that belong to consecutive
    /// stored values, each of which is itself a datum.
    fn run_of_numbers(model: &Model, slopes: &[(usize, usize, Expr)]) -> usize {
        let [(first, by, _), ..] = slopes else {
            return 0;
        };
        let numbers = slopes
            .iter()
            .enumerate()
            .take_while(|(k, (place, number, value))| {
                (*place, *number) == (first + k, by + k) && model.g.as_number(*value) == Some(1.0)
            });
        numbers.count()
    }

    /// Returns the statements that read the stored values. Components of one array are read
    /// together.
    fn reads(&self, model: &Model) -> Vec<TokenStream> {
        let mut runs: Vec<(String, usize)> = Vec::new();
        for &symbol in &self.symbols {
            let (access, _) = model.inputs.source(symbol).access();
            let access = access.to_string();
            match runs.last_mut() {
                Some((array, n)) if access == format!("{array} [{n}]") => *n += 1,
                _ => match access.strip_suffix(" [0]") {
                    Some(array) => runs.push((array.to_owned(), 1)),
                    None => runs.push((access, 0)),
                },
            }
        }
        let reads = runs.iter().map(|(access, n)| {
            let access: TokenStream = access.parse().expect("written by this crate");
            let count = index(*n);
            match n {
                0 => quote!(out.push(#access);),
                _ => quote!(out.extend_from_slice(&#access[..#count]);),
            }
        });
        reads.collect()
    }

    /// Returns the methods `programs`, `stored` and `d_stored_dp`.
    pub(super) fn methods(&self, model: &Model) -> TokenStream {
        let reads = self.reads(model);
        let values: Vec<Expr> = self.slopes.iter().map(|(.., value)| *value).collect();
        let kernel = kernel(model, &values, Scalar::F64);
        let statements = &kernel.statements;
        let mut entries = Vec::new();
        let mut rest = &self.slopes[..];
        while let [(place, number, _), ..] = rest {
            let (first, by) = (index(*place), index(*number));
            let run = Self::run_of_numbers(model, rest);
            let count = index(run);
            let value = &kernel.outputs[self.slopes.len() - rest.len()];
            entries.push(match run {
                0 | 1 => quote!(entry(#first, #by, #value);),
                _ => {
                    let (place, number) = (shifted(*place), shifted(*number));
                    quote!((0..#count).for_each(|k| entry(#place, #number, 1.0));)
                }
            });
            rest = &rest[run.max(1)..];
        }
        let count = index(self.symbols.len());
        quote! {
            fn programs(&self) -> &Programs {
                static PROGRAMS: OnceLock<Programs> = OnceLock::new();
                PROGRAMS.get_or_init(|| Programs::record(self, #count))
            }
            fn stored(&self, out: &mut Vec<f64>) {
                #(#reads)*
            }
            fn d_stored_dp(&self, entry: &mut dyn FnMut(usize, usize, f64)) {
                #(#statements)*
                #(#entries)*
            }
        }
    }
}

/// Returns the tokens of the sum of `k` and this number.
fn shifted(first: usize) -> TokenStream {
    let first_index = index(first);
    match first {
        0 => quote!(k),
        _ => quote!(#first_index + k),
    }
}

/// Returns the methods `data` and `set_data`.
pub(super) fn methods(model: &Model, data: &[Datum]) -> TokenStream {
    // For axes, and for angles stored by cosine and sine, the data are only changes. At first the
    // changes are zero.
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
        // Before `initialise`, the field that the kernels read does not contain a value that the
        // user gave.
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
            // A value that the user gave is retained when initial values are computed again.
            let given = datum.overridden_by.as_ref();
            let given = given.map(|p| quote!(self.#p = self.#p.map(|_| #x);));
            quote!(#given self.#field = #x;)
        }
        (_, pair) => quote!(self.#field = [#(#pair),*];),
    }
}
