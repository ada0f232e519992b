//! Translation of expressions of the language into scalars of the expression graph. Shapes are
//! checked and names are resolved here; the result is purely mathematical.

mod body;
mod check;
mod condition;
mod expression;
mod function;
mod inputs;
mod model;
mod scope;
#[cfg(test)]
mod tests;
mod value;

use std::collections::{BTreeMap, BTreeSet};

use proc_macro2::Ident;
use symbolic::{Expr, Graph};

use crate::parse::{Definition, Kept, Param, ParamKind};
pub(crate) use check::not_polynomial;
use expression::as_scalar;
pub(crate) use inputs::{Inputs, Source};
pub(crate) use model::{Body, Comparison, Condition, ConstraintBody, KeptValue, Measure, Model};
use scope::Scope;
use value::Value;

/// Names of fields, locals and patterns of the generated type, which no parameter can have.
const RESERVED: [&str; 5] = ["motion", "measure_0", "reader", "arguments", "None"];

/// Names of types and traits in the generated module, which no definition can have.
const RESERVED_TYPES: [&str; 36] = [
    "Argument",
    "ArgumentError",
    "Constraint",
    "ConstraintSpec",
    "Datum",
    "DatumShape",
    "Definition",
    "Direction",
    "Element",
    "Entry",
    "Err",
    "Force",
    "ForceElement",
    "ForceSpec",
    "Level",
    "Line",
    "Measure",
    "None",
    "Ok",
    "Option",
    "Parameter",
    "Pose",
    "Reader",
    "Real",
    "Result",
    "Ring",
    "Role",
    "Row",
    "Shape",
    "Some",
    "Spec",
    "T",
    "Twist",
    "Unit",
    "Variant",
    "Visitor",
];

/// Elaborates a definition.
///
/// # Errors
/// At the token that is wrong.
pub(crate) fn elaborate(d: &Definition) -> syn::Result<Model> {
    if RESERVED_TYPES.iter().any(|r| d.name == r) {
        return Err(syn::Error::new_spanned(
            &d.name,
            format!(
                "`{0}` is a type that generated code uses: choose another name, for example `{0}Joint`",
                d.name
            ),
        ));
    }
    let mut g = Graph::new();
    let inputs = Inputs::new(&mut g, d);
    let time = inputs.time_derivation(&mut g);
    let turns = inputs.turns();
    let model = Model {
        g,
        inputs,
        time,
        turns,
        names: Vec::new(),
        kept: Vec::new(),
        requirements: Vec::new(),
        body: Body::Force(Vec::new()),
    };
    let mut scope = Scope {
        definition: d,
        model,
        values: BTreeMap::new(),
        used: BTreeSet::new(),
    };
    scope.declare_params()?;
    scope.bind()?;
    scope.require()?;
    scope.model.body = if d.forces.is_empty() {
        Body::Constraint(scope.constraint()?)
    } else {
        Body::Force(scope.forces()?)
    };
    check_use(&scope)?;
    Ok(scope.model)
}

impl<'a> Scope<'a> {
    fn declare_params(&mut self) -> syn::Result<()> {
        let definition = self.definition;
        for p in &definition.params {
            if RESERVED.iter().any(|r| p.name == r) {
                return Err(syn::Error::new_spanned(
                    &p.name,
                    format!(
                        "`{}` is a name that generated code uses: choose another one",
                        p.name
                    ),
                ));
            }
            let value = self.param_value(p)?;
            self.declare(&p.name, value)?;
        }
        Ok(())
    }

    fn param_value(&mut self, p: &'a Param) -> syn::Result<Value> {
        let name = p.name.to_string();
        if let (Some(default), false) = (&p.default, matches!(p.kind, ParamKind::Number(_))) {
            return Err(syn::Error::new_spanned(
                default,
                format!("`{name}` is no number: only a single number may have a default"),
            ));
        }
        Ok(match &p.kind {
            ParamKind::Point(slot) => {
                let slot = self.slot(slot)?;
                let pair = self.model.inputs.pair(&name);
                self.model
                    .name_rotated(slot, pair, &arm_name(self.definition, p, slot));
                Value::Point { slot, pair }
            }
            ParamKind::Direction(slot) => {
                let slot = self.slot(slot)?;
                let pair = self.model.inputs.pair(&name);
                self.model.name_rotated(slot, pair, &name);
                Value::Direction { slot, pair }
            }
            ParamKind::GroundLine => {
                let (start, along) = self.model.inputs.line(&name);
                Value::Line { start, along }
            }
            ParamKind::Numbers(units) => Value::List(
                (0..units.len())
                    .map(|k| Value::Scalar(self.model.inputs.values(&name)[k]))
                    .collect(),
            ),
            ParamKind::Function(_) => Value::Scalar(self.model.inputs.values(&name)[0]),
            ParamKind::Functions(units) => Value::List(
                (0..units.len())
                    .map(|k| Value::Scalar(self.model.inputs.values(&name)[k]))
                    .collect(),
            ),
            ParamKind::Number(unit) => match &p.default {
                None => Value::Scalar(self.model.inputs.values(&name)[0]),
                Some(default) => {
                    let value = self.scalar(default)?;
                    self.refuse_all(default, check::START)?;
                    let kept = Kept::Number(unit.clone());
                    self.keep(&p.name, kept, vec![value], Some(p.name.clone()))?
                }
            },
        })
    }

    fn declare(&mut self, name: &Ident, value: Value) -> syn::Result<()> {
        if self.definition.slots.contains(name) {
            return Err(syn::Error::new_spanned(
                name,
                format!("`{name}` is a body slot already: choose another name"),
            ));
        }
        match self.values.insert(name.to_string(), value) {
            Some(_) => Err(syn::Error::new_spanned(
                name,
                format!("`{name}` is defined twice"),
            )),
            None => Ok(()),
        }
    }

    fn bind(&mut self) -> syn::Result<()> {
        let definition = self.definition;
        for b in &definition.bindings {
            let value = self.value(&b.value)?;
            let Some(kept) = &b.kept else {
                self.model.name_value(&b.name.to_string(), &value);
                self.declare(&b.name, value)?;
                continue;
            };
            let values = match kept {
                Kept::Number(_) => vec![as_scalar(value, &b.value)?],
                Kept::Vector(slot) => {
                    let slot = self.slot(slot)?;
                    self.pair_in(slot, value, &b.value)?.to_vec()
                }
            };
            self.refuse_all(&b.value, check::START)?;
            let value = self.keep(&b.name, kept.clone(), values, None)?;
            self.declare(&b.name, value)?;
        }
        Ok(())
    }

    fn keep(
        &mut self,
        name: &Ident,
        kind: Kept,
        values: Vec<Expr>,
        overridden_by: Option<Ident>,
    ) -> syn::Result<Value> {
        // The optional parameter keeps its own name; the value that is used is another field.
        let field = match overridden_by {
            Some(_) => format!("{name}_0"),
            None => name.to_string(),
        };
        let params = self.definition.params.iter().map(|p| p.name.to_string());
        let kept = self.model.kept.iter().map(|k| k.field.clone());
        if RESERVED.contains(&field.as_str()) || params.chain(kept).any(|f| f == field) {
            return Err(syn::Error::new_spanned(
                name,
                format!(
                    "the value kept for `{name}` would be called `{field}`, which is taken: choose another name"
                ),
            ));
        }
        let symbols = self.model.inputs.kept(&mut self.model.g, &field, &kind);
        let of_start = values.iter().any(|&v| self.model.depends_on_start(v));
        let value = match (&kind, symbols.as_slice()) {
            (Kept::Vector(slot), &[x, y]) => Value::Pair {
                slot: self.slot(slot)?,
                pair: [x, y],
            },
            _ => Value::Scalar(symbols[0]),
        };
        self.model.kept.push(KeptValue {
            field,
            kind,
            symbols,
            values,
            overridden_by,
            of_start,
        });
        Ok(value)
    }
}

/// `arm_i` for the only point in slot i, `arm_s` for a point `s` if the slot has several.
fn arm_name(definition: &Definition, p: &Param, slot: usize) -> String {
    let here = |q: &&Param| match &q.kind {
        ParamKind::Point(s) => *s == definition.slots[slot],
        _ => false,
    };
    match definition.params.iter().filter(here).count() {
        1 => format!("arm_{}", definition.slots[slot]),
        _ => format!("arm_{}", p.name),
    }
}

/// Every name must be used.
fn check_use(scope: &Scope<'_>) -> syn::Result<()> {
    let params = scope.definition.params.iter().map(|p| &p.name);
    let bindings = scope.definition.bindings.iter().map(|b| &b.name);
    match params
        .chain(bindings)
        .find(|name| !scope.used.contains(&name.to_string()))
    {
        Some(name) => Err(syn::Error::new_spanned(
            name,
            format!("`{name}` is never used: use it or leave it out"),
        )),
        None => Ok(()),
    }
}
