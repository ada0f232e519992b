//! Straight-line code as Rust tokens. A value that is used once is written at its use. A value that
//! is shared or has a name becomes a `let` statement.

use std::collections::{HashMap, HashSet};

use proc_macro2::{Ident, Literal, Span, TokenStream};
use quote::quote;

use crate::graph::{Expr, Function, Graph};
use crate::program::{Binary, Op, Program, Value};

/// The numeric type of the printed code.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scalar {
    /// The type `f64`: constants are literals.
    F64,
    /// A type parameter `T`: constants are `T::from(literal)`.
    Generic,
}

/// Prints the operations of a program.
pub struct Printer<'a> {
    graph: &'a Graph,
    program: &'a Program,
    scalar: Scalar,
    names: HashMap<Value, String>,
    uses: Vec<usize>,
}

/// Precedence of a printed expression.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Strength {
    Sum,
    Product,
    Sign,
    Atom,
}

impl<'a> Printer<'a> {
    /// Creates a printer that uses the given names for the given expressions in all computations.
    #[must_use]
    pub fn new(
        graph: &'a Graph,
        program: &'a Program,
        scalar: Scalar,
        names: &[(Expr, String)],
    ) -> Self {
        let names = names
            .iter()
            .filter_map(|(e, name)| Some((program.value_of(*e)?, name.clone())))
            .filter(|(v, _)| !matches!(program.op(*v), Op::Number(_) | Op::Input(_)))
            .collect();
        Self {
            graph,
            program,
            scalar,
            names,
            uses: program.uses(),
        }
    }

    /// Returns the `let` statements, and the expression of each output.
    ///
    /// A name is not used if it would hide an input or an earlier `let`.
    ///
    /// # Panics
    /// Panics if the name of an input or of an expression is not a Rust identifier.
    #[must_use]
    pub fn print(&self) -> (Vec<TokenStream>, Vec<TokenStream>) {
        let mut bound: HashMap<Value, Ident> = HashMap::new();
        let mut statements = Vec::new();
        let mut taken = self.input_names();
        let mut temporaries = (0..).map(|k| format!("t{k}"));
        for (k, op) in self.program.ops().iter().enumerate() {
            if matches!(op, Op::Number(_) | Op::Input(_)) {
                continue;
            }
            let v = self.program.value_at(k);
            let name = match self.names.get(&v) {
                // A named value that is used once inside another value is nevertheless easier to
                // read under its name.
                Some(name)
                    if self.uses[k] > 0 && !self.is_only_output(v) && !taken.contains(name) =>
                {
                    name.clone()
                }
                _ if self.uses[k] > 1 => temporaries
                    .find(|name| !taken.contains(name))
                    .expect("there is always another number"),
                _ => continue,
            };
            let ident = Ident::new(&name, Span::call_site());
            let (tokens, _) = self.expression(v, &bound, true);
            statements.push(quote!(let #ident = #tokens;));
            bound.insert(v, ident);
            taken.insert(name);
        }
        let outputs = self
            .program
            .outputs()
            .iter()
            .map(|&v| self.expression(v, &bound, false).0)
            .collect();
        (statements, outputs)
    }

    fn input_names(&self) -> HashSet<String> {
        let inputs = self.program.ops().iter().filter_map(|op| match op {
            Op::Input(s) => Some(self.graph.name(*s).to_owned()),
            _ => None,
        });
        inputs.collect()
    }

    /// Returns whether one output is the only use of the value.
    fn is_only_output(&self, v: Value) -> bool {
        self.uses[v.index()] == 1 && self.program.outputs().contains(&v)
    }

    fn expression(
        &self,
        v: Value,
        bound: &HashMap<Value, Ident>,
        defining: bool,
    ) -> (TokenStream, Strength) {
        if let (Some(ident), false) = (bound.get(&v), defining) {
            return (quote!(#ident), Strength::Atom);
        }
        match self.program.op(v) {
            Op::Number(bits) => self.number(f64::from_bits(bits)),
            Op::Input(s) => {
                let ident = Ident::new(self.graph.name(s), Span::call_site());
                (quote!(#ident), Strength::Atom)
            }
            Op::Neg(a) => {
                let a = self.operand(a, bound, Strength::Sign);
                (quote!(-#a), Strength::Sign)
            }
            Op::Call(f, a) => {
                let (name, order) = function_name(f);
                let name = Ident::new(name, Span::call_site());
                let order = order.map(Literal::u8_unsuffixed);
                let others = order.iter();
                // A literal without suffix has no definite type, and therefore no methods.
                let bare =
                    self.scalar == Scalar::F64 && matches!(self.program.op(a), Op::Number(_));
                let tokens = if bare {
                    let a = self.operand(a, bound, Strength::Sum);
                    quote!(f64::#name(#a #(, #others)*))
                } else {
                    let a = self.operand(a, bound, Strength::Atom);
                    quote!(#a.#name(#(#others),*))
                };
                (tokens, Strength::Atom)
            }
            Op::Binary(kind, a, b) => {
                let (left, right, strength) = match kind {
                    // A sum on the right keeps its parentheses, because a + (b + c) must be rounded
                    // in this order.
                    Binary::Add | Binary::Sub => (Strength::Sum, Strength::Product, Strength::Sum),
                    // A product or quotient on the right keeps its parentheses, for the same
                    // reason.
                    Binary::Mul | Binary::Div => {
                        (Strength::Product, Strength::Sign, Strength::Product)
                    }
                };
                let (a, b) = (self.operand(a, bound, left), self.operand(b, bound, right));
                let tokens = match kind {
                    Binary::Add => quote!(#a + #b),
                    Binary::Sub => quote!(#a - #b),
                    Binary::Mul => quote!(#a * #b),
                    Binary::Div => quote!(#a / #b),
                };
                (tokens, strength)
            }
        }
    }

    fn operand(&self, v: Value, bound: &HashMap<Value, Ident>, needed: Strength) -> TokenStream {
        let (tokens, strength) = self.expression(v, bound, false);
        if strength >= needed {
            tokens
        } else {
            quote!((#tokens))
        }
    }

    fn number(&self, x: f64) -> (TokenStream, Strength) {
        let magnitude = if x.is_nan() {
            quote!(f64::NAN)
        } else if x.is_infinite() {
            quote!(f64::INFINITY)
        } else {
            // The shortest text that is parsed to the same bits.
            let literal = Literal::f64_unsuffixed(x.abs());
            quote!(#literal)
        };
        let (signed, strength) = if x < 0.0 {
            (quote!(-#magnitude), Strength::Sign)
        } else {
            (magnitude, Strength::Atom)
        };
        match self.scalar {
            Scalar::Generic => (quote!(T::from(#signed)), Strength::Atom),
            Scalar::F64 => (signed, strength),
        }
    }
}

/// Returns the name of a function. The order of its derivative is the second argument.
fn function_name(f: Function) -> (&'static str, Option<u8>) {
    match f {
        Function::Sqrt => ("sqrt", None),
        Function::Sin => ("sin", None),
        Function::Cos => ("cos", None),
        Function::RecipOrZero => ("recip_or_zero", None),
        Function::AngleOverSine(order) => ("angle_over_sine", Some(order)),
    }
}
