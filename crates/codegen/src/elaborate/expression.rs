//! Elaboration of one expression of the language: names, functions, shapes.

use symbolic::{Expr, Graph, Node};
use syn::{BinOp, Lit, UnOp};

use super::check::Refusal;
use super::model::Model;
use super::scope::Scope;
use super::value::Value;
use crate::parse::Definition;
use crate::vector::{Components, Frame, Vector};

/// Allowed magnitudes of literals. With these magnitudes, products of a few literals and of their
/// derivatives do not overflow.
const NUMBERS: std::ops::RangeInclusive<f64> = 1e-60..=1e60;

/// Highest allowed power; no joint needs more.
const POWER: u32 = 32;

impl<'a> Scope<'a> {
    /// Returns the value of an expression.
    pub(super) fn value(&mut self, e: &'a syn::Expr) -> syn::Result<Value> {
        let value = self.unbounded(e)?;
        match out_of_bounds(&self.model.g, &value) {
            Some(what) => Err(syn::Error::new_spanned(e, what)),
            None => Ok(value),
        }
    }

    fn unbounded(&mut self, e: &'a syn::Expr) -> syn::Result<Value> {
        match e {
            syn::Expr::Paren(inner) => self.value(&inner.expr),
            syn::Expr::Group(inner) => self.value(&inner.expr),
            syn::Expr::Lit(literal) => number(&mut self.model.g, &literal.lit),
            syn::Expr::Path(path) => match path.path.get_ident() {
                Some(name) => self.names.value(self.definition, name),
                None => Err(syn::Error::new_spanned(path, "expected a name")),
            },
            syn::Expr::Unary(unary) => {
                let UnOp::Neg(_) = unary.op else {
                    return Err(syn::Error::new_spanned(
                        unary.op,
                        "unknown operator: there are + - * /",
                    ));
                };
                let minus_one = self.model.g.number(-1.0);
                match self.value(&unary.expr)? {
                    Value::Scalar(a) => Ok(Value::Scalar(self.model.g.neg(a))),
                    Value::Vector(v) => Ok(Value::Vector(v.scale(&mut self.model.g, minus_one))),
                    other => Err(wrong(&unary.expr, "a scalar or a vector", &other)),
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
                "expected an expression of numbers, names, functions and + - * /",
            )),
        }
    }

    pub(super) fn scalar(&mut self, e: &'a syn::Expr) -> syn::Result<Expr> {
        let value = self.value(e)?;
        as_scalar(value, e)
    }

    pub(super) fn vector(&mut self, e: &'a syn::Expr) -> syn::Result<Vector> {
        match self.value(e)? {
            Value::Vector(v) => Ok(v),
            other => Err(no_vector(e, &other)),
        }
    }

    /// Returns a vector, or the vector with these components in the frame of a body. The result is
    /// used for products and lengths, which do not depend on a point.
    pub(super) fn free_vector(&mut self, e: &'a syn::Expr) -> syn::Result<Vector> {
        match self.value(e)? {
            Value::Vector(v) => Ok(v),
            Value::Local { slot, local } => Ok(Vector::new(Frame::Body(slot), local)),
            other => Err(no_vector(e, &other)),
        }
    }

    /// Returns the scalars of a value. For a vector, these are its global components.
    pub(super) fn components(&mut self, value: Value, at: &syn::Expr) -> syn::Result<Vec<Expr>> {
        match value {
            Value::Scalar(e) => Ok(vec![e]),
            Value::Vector(v) => Ok(v.to_ground(&mut self.model.g, &self.model.turns)),
            Value::List(values) => {
                let mut rows = Vec::new();
                for v in values {
                    rows.extend(self.components(v, at)?);
                }
                Ok(rows)
            }
            other => Err(wrong(at, "scalars and vectors", &other)),
        }
    }

    /// Returns the components in the frame of the body in a slot.
    pub(super) fn local_in(
        &self,
        slot: usize,
        value: Value,
        at: &syn::Expr,
    ) -> syn::Result<Components> {
        match value {
            Value::Local { slot: own, local } if own == slot => Ok(local),
            Value::Local { slot: own, .. } => Err(self.wrong_frame(at, own, slot)),
            other => Err(wrong(
                at,
                &format!(
                    "components in a frame, `local({}, …)`",
                    self.definition.slots[slot]
                ),
                &other,
            )),
        }
    }

    pub(super) fn wrong_frame(&self, at: &syn::Expr, own: usize, used: usize) -> syn::Error {
        let slots = &self.definition.slots;
        syn::Error::new_spanned(
            at,
            format!(
                "this is given in the frame of body `{}`, and used in the frame of body `{}`",
                slots[own], slots[used]
            ),
        )
    }

    fn binary(&mut self, b: &'a syn::ExprBinary) -> syn::Result<Value> {
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
            (BinOp::Div(_), Value::Vector(_), Value::Scalar(y)) if g.is_zero(y) => {
                Err(syn::Error::new_spanned(&b.right, "division by zero"))
            }
            (BinOp::Div(_), Value::Vector(v), Value::Scalar(y)) => {
                let one = g.number(1.0);
                let inverse = g.div(one, y);
                Ok(Value::Vector(v.scale(g, inverse)))
            }
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
            (op, left, right) => Err(no_operator(b, &op, &left, &right)),
        }
    }

    fn index(&mut self, e: &'a syn::ExprIndex) -> syn::Result<Value> {
        let at = match &*e.index {
            syn::Expr::Lit(syn::ExprLit {
                lit: Lit::Int(i), ..
            }) => i.base10_parse::<usize>()?,
            other => return Err(syn::Error::new_spanned(other, "expected an index: 0, 1, …")),
        };
        let list = match self.value(&e.expr)? {
            Value::List(list) => list,
            Value::Local { local, .. } => local.into_iter().map(Value::Scalar).collect(),
            Value::Axes { slot, axes } => axes
                .into_iter()
                .map(|local| Value::Direction { slot, local })
                .collect(),
            Value::Vector(v) => {
                let components = v.to_ground(&mut self.model.g, &self.model.turns);
                components.into_iter().map(Value::Scalar).collect()
            }
            other => {
                return Err(wrong(
                    &e.expr,
                    "a list, a vector or components in a frame",
                    &other,
                ));
            }
        };
        let n = list.len();
        list.into_iter().nth(at).ok_or_else(|| {
            syn::Error::new_spanned(&e.index, format!("there are {n} entries, counted from 0"))
        })
    }

    /// Applies refusals to the value of `e`.
    pub(super) fn refuse_all(&mut self, e: &'a syn::Expr, refusals: &[Refusal]) -> syn::Result<()> {
        let value = self.value(e)?;
        self.refuse(e, &value, refusals)
    }

    /// Applies refusals to `value`, which is the value of `e`.
    pub(super) fn refuse(
        &mut self,
        e: &'a syn::Expr,
        value: &Value,
        refusals: &[Refusal],
    ) -> syn::Result<()> {
        let bad = |r: &&Refusal| is_bad(&mut self.model, value, r);
        match refusals.iter().find(bad) {
            Some(r) => Err(syn::Error::new_spanned(self.culprit(e, r), r.why)),
            None => Ok(()),
        }
    }

    /// Returns the smallest part of `e` to which the refusal applies.
    fn culprit(&mut self, e: &'a syn::Expr, r: &Refusal) -> &'a syn::Expr {
        let parts = parts(self.definition, e);
        let bad = |part: &&'a syn::Expr| {
            let value = self.value(part);
            value.is_ok_and(|value| is_bad(&mut self.model, &value, r))
        };
        match parts.into_iter().find(bad) {
            Some(part) => self.culprit(part, r),
            None => e,
        }
    }
}

/// Returns whether the refusal applies to one of the scalars of a value.
fn is_bad(model: &mut Model, value: &Value, r: &Refusal) -> bool {
    value.scalars().into_iter().any(|s| (r.bad)(model, s))
}

/// Returns the value of a literal.
fn number(g: &mut Graph, literal: &Lit) -> syn::Result<Value> {
    let (x, suffix) = match literal {
        Lit::Float(f) => (f.base10_parse::<f64>()?, f.suffix()),
        Lit::Int(i) => (i.base10_parse::<f64>()?, i.suffix()),
        other => return Err(syn::Error::new_spanned(other, "expected a number")),
    };
    if !suffix.is_empty() {
        return Err(syn::Error::new_spanned(
            literal,
            format!("numbers have no suffix: leave `{suffix}` out"),
        ));
    }
    Ok(Value::Scalar(g.number(x)))
}

/// Returns the reason if the coefficients or the powers of a value are not accepted.
fn out_of_bounds(g: &Graph, value: &Value) -> Option<String> {
    let scalars = match value {
        Value::Scalar(e) => vec![*e],
        Value::Vector(v) => v.components().collect(),
        _ => return None,
    };
    scalars.into_iter().find_map(|e| {
        let (numbers, power) = match g.node(e) {
            Node::Number(x) => (vec![*x], 0),
            Node::Product(x, factors) => {
                let power = factors.iter().map(|f| f.1.unsigned_abs()).max();
                (vec![*x], power.unwrap_or(0))
            }
            Node::Sum(terms) => (terms.iter().map(|t| t.0).collect(), 0),
            Node::Symbol(_) | Node::Call(..) => return None,
        };
        let bad = |x: &f64| *x != 0.0 && !NUMBERS.contains(&x.abs());
        match numbers.into_iter().find(bad) {
            Some(x) => Some(format!(
                "the number {x:e} is out of bounds: magnitudes are 0 or from {:e} to {:e}",
                NUMBERS.start(),
                NUMBERS.end()
            )),
            None if power > POWER => Some(format!(
                "the power {power} is too high: up to {POWER} are accepted"
            )),
            None => None,
        }
    })
}

/// Returns the direct parts of an expression. For the name of a `let`, these are the parts of its
/// value.
fn parts<'a>(definition: &'a Definition, e: &'a syn::Expr) -> Vec<&'a syn::Expr> {
    match e {
        syn::Expr::Paren(inner) => vec![&inner.expr],
        syn::Expr::Group(inner) => vec![&inner.expr],
        syn::Expr::Unary(unary) => vec![&unary.expr],
        syn::Expr::Binary(binary) => vec![&binary.left, &binary.right],
        syn::Expr::Call(call) => call.args.iter().collect(),
        syn::Expr::Index(index) => vec![&index.expr],
        syn::Expr::Array(array) => array.elems.iter().collect(),
        syn::Expr::Path(path) => {
            let lets = definition.bindings.iter();
            lets.filter(|b| b.kept.is_none() && path.path.is_ident(&b.name))
                .map(|b| &b.value)
                .collect()
        }
        _ => Vec::new(),
    }
}

pub(super) fn as_scalar(value: Value, at: &syn::Expr) -> syn::Result<Expr> {
    match value {
        Value::Scalar(e) => Ok(e),
        other => Err(wrong(at, "a scalar", &other)),
    }
}

pub(super) fn wrong(at: &syn::Expr, expected: &str, found: &Value) -> syn::Error {
    syn::Error::new_spanned(at, format!("expected {expected}, found {}", found.shape()))
}

fn no_vector(at: &syn::Expr, found: &Value) -> syn::Error {
    let mut message = format!("expected a vector, found {}", found.shape());
    if let Some(hint) = found.as_vector() {
        message = format!("{message}: {hint}");
    }
    syn::Error::new_spanned(at, message)
}

fn no_operator(b: &syn::ExprBinary, op: &BinOp, left: &Value, right: &Value) -> syn::Error {
    let refused = format!(
        "`{}` does not apply to {} and {}",
        quote::quote!(#op),
        left.shape(),
        right.shape()
    );
    for (value, at) in [(left, &b.left), (right, &b.right)] {
        if let Some(hint) = value.as_vector() {
            return syn::Error::new_spanned(at, format!("{refused}: {hint}"));
        }
    }
    match (op, left, right) {
        (BinOp::Mul(_), Value::Vector(_), Value::Vector(_)) => syn::Error::new_spanned(
            b,
            format!("{refused}: the product of two vectors is `dot(a, b)`"),
        ),
        _ => syn::Error::new_spanned(b, refused),
    }
}
