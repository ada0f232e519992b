//! One function for one list of expressions. The function contains the inputs that are used, shared
//! parts, outputs, and the number of operations.

use proc_macro2::{Ident, Literal, Span, TokenStream};
use quote::quote;
use symbolic::{Counts, Expr, Printer, Program, Scalar, Symbol};

use crate::elaborate::Model;

/// The body of a kernel.
pub(crate) struct Kernel {
    /// `let` statements for inputs and shared parts.
    pub(crate) statements: Vec<TokenStream>,
    /// One expression for each output.
    pub(crate) outputs: Vec<TokenStream>,
    pub(crate) counts: Counts,
}

/// Prints `outputs` for a numeric type.
pub(crate) fn kernel(model: &Model, outputs: &[Expr], scalar: Scalar) -> Kernel {
    print(model, outputs, scalar, &[])
}

/// Prints rows with the indices of the stored values that the rows read. The list `stored` contains
/// the symbols of these values.
pub(crate) fn rows(model: &Model, outputs: &[Expr], stored: &[Symbol]) -> Kernel {
    print(model, outputs, Scalar::Generic, stored)
}

fn print(model: &Model, outputs: &[Expr], scalar: Scalar, stored: &[Symbol]) -> Kernel {
    let program = Program::new(&model.g, outputs);
    let (shared, printed) = Printer::new(&model.g, &program, scalar, &model.names).print();
    let mut used: Vec<_> = outputs.iter().flat_map(|&e| model.g.inputs(e)).collect();
    used.sort_unstable();
    used.dedup();
    let inputs = used.into_iter().map(|s| {
        let name = Ident::new(model.g.name(s), Span::call_site());
        let (access, is_f64) = model.inputs.source(s).access();
        match stored.iter().position(|other| *other == s) {
            Some(place) => {
                let place = Literal::usize_unsuffixed(place);
                quote!(let #name = T::stored(#access, #place);)
            }
            None if is_f64 && scalar == Scalar::Generic => quote!(let #name = T::from(#access);),
            None => quote!(let #name = #access;),
        }
    });
    Kernel {
        statements: inputs.chain(shared).collect(),
        outputs: printed,
        counts: program.counts(),
    }
}

impl Kernel {
    /// Returns the kernel as statements that assign `out[k]`.
    pub(crate) fn into_out(self) -> TokenStream {
        let Self {
            statements,
            outputs,
            ..
        } = self;
        let assignments = outputs.iter().enumerate().map(|(k, e)| {
            let k = Literal::usize_unsuffixed(k);
            quote!(out[#k] = #e;)
        });
        quote!(#(#statements)* #(#assignments)*)
    }
}

#[cfg(test)]
mod tests;
