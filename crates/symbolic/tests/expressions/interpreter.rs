//! Runs printed code from its text, with the precedence that `syn` assigns to it, and counts the
//! executed operations. Code that would not compile is an error here too: literals without definite
//! type as receivers of methods, unsuffixed literals in generic code, undefined names.

use std::collections::HashMap;

use pfaff_symbolic::{Counts, Scalar};
use proc_macro2::TokenStream;
use quote::quote;
use syn::{BinOp, Expr, Lit, Pat, Stmt, UnOp};

/// Values of the outputs and the executed operations.
#[derive(Debug, PartialEq)]
pub(crate) struct Run {
    pub(crate) outputs: Vec<f64>,
    pub(crate) counts: Counts,
}

/// Returns printed code as text: a function of the inputs, formatted.
pub(crate) fn text((statements, outputs): (Vec<TokenStream>, Vec<TokenStream>)) -> String {
    let file = quote! { fn f() { #(#statements)* [#(#outputs),*] } };
    prettyplease::unparse(&syn::parse2(file).expect("printed code is Rust"))
}

/// Runs a text made by [`text`].
pub(crate) fn run(text: &str, scalar: Scalar, inputs: &[(&str, f64)]) -> Result<Run, String> {
    let function: syn::ItemFn = syn::parse_str(text).map_err(|e| e.to_string())?;
    let mut machine = Machine {
        scalar,
        variables: inputs.iter().map(|(n, v)| ((*n).to_owned(), *v)).collect(),
        counts: Counts::default(),
    };
    for statement in &function.block.stmts {
        match statement {
            Stmt::Local(local) => {
                let Pat::Ident(name) = &local.pat else {
                    return Err("a pattern that is no name".to_owned());
                };
                let init = local.init.as_ref().ok_or("a let without value")?;
                let value = machine.value(&init.expr)?;
                machine.variables.insert(name.ident.to_string(), value);
            }
            Stmt::Expr(Expr::Array(array), None) => {
                let outputs: Result<_, _> = array.elems.iter().map(|e| machine.value(e)).collect();
                return outputs.map(|outputs| Run {
                    outputs,
                    counts: machine.counts,
                });
            }
            other => return Err(format!("unexpected statement {other:?}")),
        }
    }
    Err("no outputs".to_owned())
}

struct Machine {
    scalar: Scalar,
    variables: HashMap<String, f64>,
    counts: Counts,
}

impl Machine {
    fn function(&mut self, name: &str, u: f64) -> Result<f64, String> {
        self.counts.call += 1;
        match name {
            "sqrt" => Ok(u.sqrt()),
            "sin" => Ok(u.sin()),
            "cos" => Ok(u.cos()),
            "recip_or_zero" if u == 0.0 => Ok(0.0),
            "recip_or_zero" => Ok(1.0 / u),
            other => Err(format!("unexpected function {other}")),
        }
    }

    fn value(&mut self, e: &Expr) -> Result<f64, String> {
        if let Some(x) = constant(e) {
            return match self.scalar {
                Scalar::F64 => Ok(x),
                Scalar::Generic => Err(format!("bare constant {x} in generic code")),
            };
        }
        match e {
            Expr::Paren(inner) => self.value(&inner.expr),
            Expr::Path(path) => {
                let name = path.path.require_ident().map_err(|e| e.to_string())?;
                let value = self.variables.get(&name.to_string()).copied();
                value.ok_or_else(|| format!("`{name}` is not defined"))
            }
            Expr::Unary(unary) if matches!(unary.op, UnOp::Neg(_)) => {
                self.counts.neg += 1;
                Ok(-self.value(&unary.expr)?)
            }
            Expr::Binary(binary) => {
                let (a, b) = (self.value(&binary.left)?, self.value(&binary.right)?);
                let (count, value) = match binary.op {
                    BinOp::Add(_) => (&mut self.counts.add, a + b),
                    BinOp::Sub(_) => (&mut self.counts.add, a - b),
                    BinOp::Mul(_) => (&mut self.counts.mul, a * b),
                    BinOp::Div(_) => (&mut self.counts.div, a / b),
                    other => return Err(format!("unexpected operator {other:?}")),
                };
                *count += 1;
                Ok(value)
            }
            Expr::MethodCall(call) if call.args.is_empty() => {
                // The compiler reports "can't call method on ambiguous numeric type" (E0689).
                if let Some(x) = literal(&call.receiver) {
                    return Err(format!("method of the bare literal {x}"));
                }
                let u = self.value(&call.receiver)?;
                self.function(&call.method.to_string(), u)
            }
            Expr::Call(call) => {
                let arguments: Vec<_> = call.args.iter().collect();
                let (Expr::Path(f), [x]) = (&*call.func, arguments.as_slice()) else {
                    return Err("unexpected call".to_owned());
                };
                match (self.scalar, path_text(&f.path).split_once("::")) {
                    (Scalar::Generic, Some(("T", "from"))) => {
                        constant(x).ok_or_else(|| "T::from of no constant".to_owned())
                    }
                    (Scalar::F64, Some(("f64", function))) => {
                        let u = self.value(x)?;
                        self.function(function, u)
                    }
                    other => Err(format!("unexpected call {other:?}")),
                }
            }
            other => Err(format!("unexpected expression {other:?}")),
        }
    }
}

/// Returns the value of a constant: a literal, a literal with a sign, or an associated constant of
/// `f64`.
fn constant(e: &Expr) -> Option<f64> {
    match e {
        Expr::Unary(unary) if matches!(unary.op, UnOp::Neg(_)) => constant(&unary.expr).map(|x| -x),
        Expr::Path(path) => match path_text(&path.path).as_str() {
            "f64::INFINITY" => Some(f64::INFINITY),
            "f64::NAN" => Some(f64::NAN),
            _ => None,
        },
        _ => literal(e),
    }
}

/// Returns the value of a literal without suffix, with or without sign and parentheses.
fn literal(e: &Expr) -> Option<f64> {
    match e {
        Expr::Lit(lit) => match &lit.lit {
            Lit::Float(x) if x.suffix().is_empty() => x.base10_parse().ok(),
            _ => None,
        },
        Expr::Unary(unary) if matches!(unary.op, UnOp::Neg(_)) => literal(&unary.expr).map(|x| -x),
        Expr::Paren(inner) => literal(&inner.expr),
        _ => None,
    }
}

fn path_text(path: &syn::Path) -> String {
    let parts: Vec<_> = path.segments.iter().map(|s| s.ident.to_string()).collect();
    parts.join("::")
}
