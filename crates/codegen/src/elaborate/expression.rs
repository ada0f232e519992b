//! One expression of the language: names, functions, shapes.

use proc_macro2::{Ident, Span};
use symbolic::{Expr, Function};
use syn::spanned::Spanned;
use syn::{BinOp, Lit, UnOp};

use super::Scope;
use crate::vector::{Frame, Vector};

/// The value of an expression, with its shape.
#[derive(Clone, Debug)]
pub(crate) enum Value {
    Scalar(Expr),
    Vector(Vector),
    /// Two components without a frame.
    Pair([Expr; 2]),
    /// A point parameter.
    Point {
        slot: usize,
        pair: [Expr; 2],
    },
    /// A direction parameter.
    Direction {
        slot: usize,
        pair: [Expr; 2],
    },
    /// A line of the ground.
    Line {
        start: [Expr; 2],
        along: [Expr; 2],
    },
    List(Vec<Value>),
}

impl Value {
    pub(crate) fn shape(&self) -> &'static str {
        match self {
            Self::Scalar(_) => "a scalar",
            Self::Vector(_) => "a vector",
            Self::Pair(_) => "a pair of components",
            Self::Point { .. } => "a point parameter",
            Self::Direction { .. } => "a direction parameter",
            Self::Line { .. } => "a line",
            Self::List(_) => "a list",
        }
    }
}

/// A condition on the start.
pub(crate) enum Condition {
    Compare(Comparison, Expr, Expr),
    And(Box<Condition>, Box<Condition>),
    Or(Box<Condition>, Box<Condition>),
}

/// How two scalars are compared.
#[derive(Clone, Copy)]
pub(crate) enum Comparison {
    Equal,
    NotEqual,
    Greater,
    Less,
}

/// Functions of the language: name, what it takes, and what it gives.
const FUNCTIONS: [(&str, usize); 13] = [
    ("point", 2),
    ("direction", 2),
    ("vector", 2),
    ("local", 2),
    ("origin", 1),
    ("angle", 1),
    ("start", 1),
    ("along", 1),
    ("velocity", 1),
    ("rate", 1),
    ("perp", 1),
    ("norm", 1),
    ("dot", 2),
];

impl Scope<'_> {
    pub(super) fn value(&mut self, e: &syn::Expr) -> syn::Result<Value> {
        match e {
            syn::Expr::Paren(inner) => self.value(&inner.expr),
            syn::Expr::Group(inner) => self.value(&inner.expr),
            syn::Expr::Lit(literal) => self.number(&literal.lit),
            syn::Expr::Path(path) => match path.path.get_ident() {
                Some(name) => self.named(name),
                None => Err(syn::Error::new_spanned(path, "expected a name")),
            },
            syn::Expr::Unary(unary) => {
                let UnOp::Neg(_) = unary.op else {
                    return Err(syn::Error::new_spanned(unary.op, "unknown operator"));
                };
                let minus_one = self.model.g.number(-1.0);
                match self.value(&unary.expr)? {
                    Value::Scalar(a) => Ok(Value::Scalar(self.model.g.neg(a))),
                    Value::Vector(v) => Ok(Value::Vector(v.scale(&mut self.model.g, minus_one))),
                    other => Err(wrong(unary.expr.span(), "a scalar or a vector", &other)),
                }
            }
            syn::Expr::Binary(binary) => self.binary(binary),
            syn::Expr::Call(call) => self.call(call),
            syn::Expr::Index(index) => self.index(index),
            syn::Expr::Array(array) => {
                let values: syn::Result<Vec<_>> =
                    array.elems.iter().map(|e| self.value(e)).collect();
                Ok(Value::List(values?))
            }
            other => Err(syn::Error::new_spanned(
                other,
                "expected numbers, names, functions and + - * /",
            )),
        }
    }

    pub(super) fn scalar(&mut self, e: &syn::Expr) -> syn::Result<Expr> {
        let value = self.value(e)?;
        self.as_scalar(value, e.span())
    }

    pub(super) fn as_scalar(&self, value: Value, at: Span) -> syn::Result<Expr> {
        match value {
            Value::Scalar(e) => Ok(e),
            other => Err(wrong(at, "a scalar", &other)),
        }
    }

    pub(super) fn vector(&mut self, e: &syn::Expr) -> syn::Result<Vector> {
        match self.value(e)? {
            Value::Vector(v) => Ok(v),
            other => Err(wrong(e.span(), "a vector", &other)),
        }
    }

    /// Scalars of a list of scalars and vectors, vectors as their global components.
    pub(super) fn rows(&mut self, value: Value, at: Span) -> syn::Result<Vec<Expr>> {
        match value {
            Value::Scalar(e) => Ok(vec![e]),
            Value::Vector(v) => Ok(v.to_ground(&mut self.model.g, &self.model.turns).to_vec()),
            Value::List(values) => {
                let mut rows = Vec::new();
                for v in values {
                    rows.extend(self.rows(v, at)?);
                }
                Ok(rows)
            }
            other => Err(wrong(at, "scalars and vectors", &other)),
        }
    }

    pub(super) fn condition(&mut self, e: &syn::Expr) -> syn::Result<Condition> {
        let expected = || {
            syn::Error::new_spanned(
                e,
                "expected a comparison: `==`, `!=`, `>`, `<`, joined by `&&`, `||`",
            )
        };
        match e {
            syn::Expr::Paren(inner) => self.condition(&inner.expr),
            syn::Expr::Binary(b) => {
                let comparison = match b.op {
                    BinOp::And(_) => {
                        let (l, r) = (self.condition(&b.left)?, self.condition(&b.right)?);
                        return Ok(Condition::And(Box::new(l), Box::new(r)));
                    }
                    BinOp::Or(_) => {
                        let (l, r) = (self.condition(&b.left)?, self.condition(&b.right)?);
                        return Ok(Condition::Or(Box::new(l), Box::new(r)));
                    }
                    BinOp::Eq(_) => Comparison::Equal,
                    BinOp::Ne(_) => Comparison::NotEqual,
                    BinOp::Gt(_) => Comparison::Greater,
                    BinOp::Lt(_) => Comparison::Less,
                    _ => return Err(expected()),
                };
                Ok(Condition::Compare(
                    comparison,
                    self.scalar(&b.left)?,
                    self.scalar(&b.right)?,
                ))
            }
            _ => Err(expected()),
        }
    }

    fn number(&mut self, literal: &Lit) -> syn::Result<Value> {
        let x = match literal {
            Lit::Float(f) => f.base10_parse::<f64>()?,
            Lit::Int(i) => i.base10_parse::<f64>()?,
            other => return Err(syn::Error::new_spanned(other, "expected a number")),
        };
        Ok(Value::Scalar(self.model.g.number(x)))
    }

    fn named(&mut self, name: &Ident) -> syn::Result<Value> {
        let key = name.to_string();
        if let Some(value) = self.values.get(&key) {
            self.used.insert(key);
            return Ok(value.clone());
        }
        let known: Vec<&str> = self.values.keys().map(String::as_str).collect();
        Err(unknown(name, "name", &known))
    }

    fn binary(&mut self, b: &syn::ExprBinary) -> syn::Result<Value> {
        let (left, right) = (self.value(&b.left)?, self.value(&b.right)?);
        let g = &mut self.model.g;
        match (b.op, left, right) {
            (BinOp::Add(_), Value::Scalar(x), Value::Scalar(y)) => Ok(Value::Scalar(g.add(x, y))),
            (BinOp::Sub(_), Value::Scalar(x), Value::Scalar(y)) => Ok(Value::Scalar(g.sub(x, y))),
            (BinOp::Mul(_), Value::Scalar(x), Value::Scalar(y)) => Ok(Value::Scalar(g.mul(x, y))),
            (BinOp::Div(_), Value::Scalar(_), Value::Scalar(y)) if g.is_zero(y) => {
                Err(syn::Error::new_spanned(&b.right, "division by zero"))
            }
            (BinOp::Div(_), Value::Scalar(x), Value::Scalar(y)) => Ok(Value::Scalar(g.div(x, y))),
            (BinOp::Add(_), Value::Vector(x), Value::Vector(y)) => {
                Ok(Value::Vector(x.combine(g, 1.0, &y, 1.0)))
            }
            (BinOp::Sub(_), Value::Vector(x), Value::Vector(y)) => {
                Ok(Value::Vector(x.combine(g, 1.0, &y, -1.0)))
            }
            (BinOp::Mul(_), Value::Scalar(x), Value::Vector(v))
            | (BinOp::Mul(_), Value::Vector(v), Value::Scalar(x)) => {
                Ok(Value::Vector(v.scale(g, x)))
            }
            (op, left, right) => Err(syn::Error::new_spanned(
                b,
                format!(
                    "`{}` does not apply to {} and {}",
                    quote::quote!(#op),
                    left.shape(),
                    right.shape()
                ),
            )),
        }
    }

    fn index(&mut self, e: &syn::ExprIndex) -> syn::Result<Value> {
        let at = match &*e.index {
            syn::Expr::Lit(syn::ExprLit {
                lit: Lit::Int(i), ..
            }) => i.base10_parse::<usize>()?,
            other => return Err(syn::Error::new_spanned(other, "expected 0, 1, …")),
        };
        let list = match self.value(&e.expr)? {
            Value::List(list) => list,
            Value::Pair(pair) => pair.map(Value::Scalar).to_vec(),
            Value::Vector(v) => v
                .to_ground(&mut self.model.g, &self.model.turns)
                .map(Value::Scalar)
                .to_vec(),
            other => return Err(wrong(e.expr.span(), "a list, a vector or a pair", &other)),
        };
        let n = list.len();
        list.into_iter().nth(at).ok_or_else(|| {
            syn::Error::new_spanned(&e.index, format!("there are {n} entries, counted from 0"))
        })
    }

    fn call(&mut self, call: &syn::ExprCall) -> syn::Result<Value> {
        let name = match &*call.func {
            syn::Expr::Path(p) if p.path.get_ident().is_some() => p.path.get_ident().cloned(),
            _ => None,
        };
        let Some(name) = name else {
            return Err(syn::Error::new_spanned(
                &call.func,
                "expected the name of a function",
            ));
        };
        let Some(&(function, arity)) = FUNCTIONS.iter().find(|(f, _)| name == f) else {
            let known: Vec<&str> = FUNCTIONS.iter().map(|f| f.0).collect();
            return Err(unknown(&name, "function", &known));
        };
        let args: Vec<&syn::Expr> = call.args.iter().collect();
        if args.len() != arity {
            return Err(syn::Error::new_spanned(
                call,
                format!(
                    "`{function}` takes {arity} argument(s), found {}",
                    args.len()
                ),
            ));
        }
        match function {
            "point" | "direction" | "vector" => self.placed(function, args[0], args[1]),
            "local" => {
                let slot = self.slot_argument(args[0])?;
                let v = self.vector(args[1])?;
                let Self { model, .. } = self;
                Ok(Value::Pair(v.in_body(&mut model.g, slot, &model.turns)))
            }
            "origin" => {
                let slot = self.slot_argument(args[0])?;
                Ok(Value::Vector(self.origin(slot)))
            }
            "angle" => {
                let slot = self.slot_argument(args[0])?;
                Ok(Value::Scalar(self.model.inputs.slots[slot].pose[2]))
            }
            "start" | "along" => match self.value(args[0])? {
                Value::Line { start, along } => {
                    let pair = if function == "start" { start } else { along };
                    Ok(Value::Vector(Vector::new(Frame::Ground, pair)))
                }
                other => Err(wrong(args[0].span(), "a line", &other)),
            },
            "perp" => {
                let v = self.vector(args[0])?;
                Ok(Value::Vector(v.perp(&mut self.model.g)))
            }
            "dot" => {
                let (a, b) = (self.vector(args[0])?, self.vector(args[1])?);
                let model = &mut self.model;
                Ok(Value::Scalar(a.dot(&mut model.g, &b, &model.turns)))
            }
            "norm" => {
                let v = self.vector(args[0])?;
                let model = &mut self.model;
                let square = v.dot(&mut model.g, &v, &model.turns);
                Ok(Value::Scalar(model.g.call(Function::Sqrt, square)))
            }
            // "velocity" | "rate"
            _ => {
                let value = self.value(args[0])?;
                let model = &mut self.model;
                match value {
                    Value::Vector(v) => Ok(Value::Vector(v.rate(
                        &mut model.g,
                        &model.turns,
                        &model.time,
                    ))),
                    Value::Scalar(e) if function == "rate" => {
                        Ok(Value::Scalar(model.time.apply(&mut model.g, e)))
                    }
                    other => Err(wrong(args[0].span(), "a vector", &other)),
                }
            }
        }
    }

    /// `r_i`, or `r_i + R_i·s`, or `R_i·s`.
    fn placed(&mut self, function: &str, slot: &syn::Expr, what: &syn::Expr) -> syn::Result<Value> {
        let at = self.slot_argument(slot)?;
        let pair = match (function, self.value(what)?) {
            ("point", Value::Point { slot: own, pair })
            | ("direction", Value::Direction { slot: own, pair }) => {
                if own != at {
                    return Err(syn::Error::new_spanned(
                        slot,
                        format!(
                            "declared in the frame of `{}`, used in the frame of `{}`",
                            self.definition.slots[own], self.definition.slots[at]
                        ),
                    ));
                }
                pair
            }
            ("vector", Value::Pair(pair)) => pair,
            ("vector", Value::List(list)) => match list.as_slice() {
                [Value::Scalar(x), Value::Scalar(y)] => [*x, *y],
                _ => return Err(wrong(what.span(), "two components", &Value::List(list))),
            },
            ("point", other) => return Err(wrong(what.span(), "a `Point` parameter", &other)),
            ("direction", other) => {
                return Err(wrong(what.span(), "a `Direction` parameter", &other));
            }
            (_, other) => return Err(wrong(what.span(), "two components", &other)),
        };
        let turned = Vector::new(Frame::Body(at), pair);
        Ok(Value::Vector(match function {
            "point" => self
                .origin(at)
                .combine(&mut self.model.g, 1.0, &turned, 1.0),
            _ => turned,
        }))
    }

    fn origin(&self, slot: usize) -> Vector {
        let [x, y, ..] = self.model.inputs.slots[slot].pose;
        Vector::new(Frame::Ground, [x, y])
    }

    fn slot_argument(&self, e: &syn::Expr) -> syn::Result<usize> {
        match e {
            syn::Expr::Path(p) => match p.path.get_ident() {
                Some(name) => self.slot(name),
                None => Err(syn::Error::new_spanned(e, "expected a body slot")),
            },
            _ => Err(syn::Error::new_spanned(e, "expected a body slot")),
        }
    }
}

fn wrong(at: Span, expected: &str, found: &Value) -> syn::Error {
    syn::Error::new(at, format!("expected {expected}, found {}", found.shape()))
}

fn unknown(name: &Ident, what: &str, known: &[&str]) -> syn::Error {
    let text = name.to_string();
    let nearest = known
        .iter()
        .map(|k| (distance(&text, k), *k))
        .min()
        .filter(|(d, _)| *d <= 2);
    let hint = match nearest {
        Some((_, k)) => format!("; did you mean `{k}`?"),
        None if known.is_empty() => String::new(),
        None => format!("; known are {}", known.join(", ")),
    };
    syn::Error::new_spanned(name, format!("unknown {what} `{text}`{hint}"))
}

/// Levenshtein distance.
fn distance(a: &str, b: &str) -> usize {
    let b: Vec<char> = b.chars().collect();
    let mut row: Vec<usize> = (0..=b.len()).collect();
    for (i, x) in a.chars().enumerate() {
        let mut diagonal = row[0];
        row[0] = i + 1;
        for (j, y) in b.iter().enumerate() {
            let substitution = diagonal + usize::from(x != *y);
            diagonal = row[j + 1];
            row[j + 1] = substitution.min(row[j] + 1).min(diagonal + 1);
        }
    }
    row[b.len()]
}
