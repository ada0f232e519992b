//! Definitions for tests, and values for their expressions.

use proc_macro2::TokenStream;
use symbolic::Expr;

use crate::Kind;
use crate::derive::{self, Component, ConstraintKernels, ForceKernels};
use crate::elaborate::{Body, ConstraintBody, Model, Source, elaborate};
use crate::parse::{self, Definition};

pub(crate) const REVOLUTE: &str = "plane Revolute(i, j) {
    /// Two points coincide.
    params { s_i: Point in i, s_j: Point in j }
    rows: [x, y];
    phi: point(i, s_i) - point(j, s_j);
    place: point(i, s_i);
}";

pub(crate) const KNIFE_EDGE: &str = "plane KnifeEdge(i) {
    /// No velocity along a direction.
    params { s: Point in i, normal: Direction in i }
    rows: [normal];
    psi: dot(direction(i, normal), velocity(point(i, s)));
    component N: direction(i, normal);
    place: point(i, s);
}";

pub(crate) const VELOCITY: &str = "plane Velocity(i) {
    /// The velocity along a direction is a function of time.
    params { s: Point in i, normal: Direction in i, rate: Function<Velocity> }
    rows: [along];
    psi: dot(direction(i, normal), velocity(point(i, s))) - rate;
    place: point(i, s);
}";

/// Returns a definition with one form.
fn definition(kind: Kind, tokens: TokenStream) -> syn::Result<Definition> {
    let mut forms = parse::definition(kind, tokens)?;
    Ok(forms.remove(0))
}

/// Returns the definition in mathematical form.
pub(crate) fn model(kind: Kind, text: &str) -> syn::Result<Model> {
    elaborate(&definition(kind, text.parse()?)?)
}

/// Returns the error message for a wrong definition.
pub(crate) fn error(kind: Kind, text: &str) -> String {
    match model(kind, text) {
        Ok(_) => "(no error)".to_owned(),
        Err(e) => e.to_string(),
    }
}

/// Returns a correct constraint and its kernels.
pub(crate) fn constraint(text: &str) -> (Model, ConstraintBody, ConstraintKernels) {
    let tokens = text.parse().unwrap_or_else(|e| panic!("{e}"));
    let definition = definition(Kind::Constraint, tokens).unwrap_or_else(|e| panic!("{e}"));
    let mut model = elaborate(&definition).unwrap_or_else(|e| panic!("{e}"));
    let Body::Constraint(body) = std::mem::replace(&mut model.body, Body::Force(Vec::new())) else {
        unreachable!("elaborated as a constraint")
    };
    let component = match body.component {
        Some(_) => Component::Along,
        None => Component::None,
    };
    let kernels = derive::constraint(&mut model, &body, &component)
        .unwrap_or_else(|row| panic!("row {row} restricts nothing"));
    (model, body, kernels)
}

/// Returns a correct force and its kernels.
pub(crate) fn force(text: &str) -> (Model, ForceKernels) {
    let mut model = model(Kind::Force, text).unwrap_or_else(|e| panic!("{e}"));
    let Body::Force(terms) = std::mem::replace(&mut model.body, Body::Force(Vec::new())) else {
        unreachable!("elaborated as a force")
    };
    let kernels = derive::force(&mut model, &terms);
    (model, kernels)
}

/// Values for the inputs of kernels.
pub(crate) struct State {
    /// The coordinates x and y and the angle of each slot.
    pub(crate) pose: Vec<[f64; 3]>,
    pub(crate) twist: Vec<[f64; 3]>,
    /// Values of parameters. Each value has the name of its field, without `self.`.
    pub(crate) parameters: Vec<(&'static str, f64)>,
    pub(crate) f: Vec<[f64; 3]>,
}

impl State {
    /// Returns the value of an expression, by direct evaluation of the graph.
    pub(crate) fn value(&self, model: &Model, e: Expr) -> f64 {
        let dof = |field: &str| ["x", "y", "omega"].iter().position(|f| *f == field);
        model.g.evaluate(e, &|s| match model.inputs.source(s) {
            Source::Pose { slot, field } => {
                let [x, y, angle] = self.pose[*slot];
                match *field {
                    "x" => x,
                    "y" => y,
                    "angle" => angle,
                    "cos" => angle.cos(),
                    _ => angle.sin(),
                }
            }
            Source::Twist { slot, field } => {
                self.twist[*slot][dof(field).expect("a field of a twist")]
            }
            Source::Function { index, order } => self.f[*index][*order],
            Source::Parameter { access } | Source::Kept { access, .. } => {
                let found = self
                    .parameters
                    .iter()
                    .find(|(name, _)| access.strip_prefix("self.") == Some(name));
                found.unwrap_or_else(|| panic!("no value for {access}")).1
            }
            other => panic!("no value for {other:?}"),
        })
    }

    pub(crate) fn values(&self, model: &Model, expressions: &[Expr]) -> Vec<f64> {
        expressions.iter().map(|&e| self.value(model, e)).collect()
    }
}

/// The rounding error of a few dozen operations with values of order one to ten.
pub(crate) const ROUNDING: f64 = 1e-13;

/// Asserts that two lists are equal up to rounding.
pub(crate) fn assert_close(found: &[f64], expected: &[f64]) {
    assert_eq!(found.len(), expected.len(), "{found:?} {expected:?}");
    for (a, b) in found.iter().zip(expected) {
        assert!((a - b).abs() <= ROUNDING, "{found:?} {expected:?}");
    }
}
