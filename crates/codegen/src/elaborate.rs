//! Translates expressions of the language into scalars of the expression graph. This module checks
//! shapes and resolves names; the result contains only mathematical expressions.

mod body;
mod check;
mod condition;
mod expression;
mod function;
mod inputs;
mod model;
mod names;
mod scope;
#[cfg(test)]
mod tests;
mod value;

use proc_macro2::Ident;
use symbolic::{Expr, Graph};

use crate::parse::{Definition, Kept, Param, ParamKind};
use crate::space::Space;
use expression::{as_scalar, wrong};
pub(crate) use inputs::{Inputs, Source};
pub(crate) use model::{
    Body, Comparison, Condition, ConstraintBody, Counted, KeptValue, Measure, Model,
};
use names::Names;
use scope::Scope;
use value::Value;

/// Names of fields, local variables and patterns in the generated code. Parameters cannot have
/// these names.
const RESERVED: [&str; 7] = [
    "motion",
    "motion_cos",
    "motion_sin",
    "measure_0",
    "reader",
    "arguments",
    "None",
];

/// Names of types and traits in the generated module. Definitions cannot have these names.
const RESERVED_TYPES: [&str; 40] = [
    "Argument",
    "ArgumentError",
    "Axes",
    "Constraint",
    "ConstraintSpec",
    "Datum",
    "DatumShape",
    "Definition",
    "Derivatives",
    "Direction",
    "Element",
    "Entry",
    "Err",
    "Force",
    "ForceElement",
    "ForceSpec",
    "GroundPlane",
    "Line",
    "Measure",
    "None",
    "Ok",
    "Option",
    "Parameter",
    "Pose",
    "Positions",
    "Reader",
    "Real",
    "Result",
    "Ring",
    "Role",
    "Row",
    "Shape",
    "Some",
    "Space3",
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
/// Returns an error that marks the wrong token.
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
        counted: Vec::new(),
        requirements: Vec::new(),
        body: Body::Force(Vec::new()),
    };
    let mut scope = Scope {
        definition: d,
        model,
        names: Names::default(),
    };
    scope.declare_params()?;
    scope.bind()?;
    scope.require()?;
    scope.model.body = if d.forces.is_empty() {
        Body::Constraint(scope.constraint()?)
    } else {
        Body::Force(scope.forces()?)
    };
    scope.names.check_use(d)?;
    scope.model.expand_printed();
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
            self.names.declare(self.definition, &p.name, value)?;
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
                let local = self.model.inputs.values(&name).to_vec();
                let arm = arm_name(self.definition, p, slot);
                self.model.name_rotated(slot, local.clone(), &arm);
                Value::Point { slot, local }
            }
            ParamKind::Direction(slot) => {
                let slot = self.slot(slot)?;
                let local = self.model.inputs.values(&name).to_vec();
                self.model.name_rotated(slot, local.clone(), &name);
                Value::Direction { slot, local }
            }
            ParamKind::Axes { slot: at, like, .. } => {
                only_in(self.definition, Space::Space3, &p.name, "`Axes`")?;
                let slot = self.slot(at)?;
                if let Some(like) = like {
                    check_like(self.definition, like, p)?;
                }
                let axes = self.model.inputs.axes(&name);
                for (local, letter) in axes.iter().zip(["u", "v", "w"]) {
                    let name = format!("{name}_{letter}");
                    self.model.name_rotated(slot, local.clone(), &name);
                }
                Value::Axes { slot, axes }
            }
            ParamKind::GroundLine => {
                only_in(self.definition, Space::Plane, &p.name, "`GroundLine`")?;
                let (start, along) = self.model.inputs.line(&name);
                Value::Line { start, along }
            }
            ParamKind::GroundPlane => {
                only_in(self.definition, Space::Space3, &p.name, "`GroundPlane`")?;
                let values = self.model.inputs.values(&name);
                Value::Plane {
                    start: values[..3].to_vec(),
                    normal: values[3..6].to_vec(),
                    along: values[6..].to_vec(),
                }
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

    fn bind(&mut self) -> syn::Result<()> {
        let definition = self.definition;
        for b in &definition.bindings {
            let value = self.value(&b.value)?;
            let Some(kept) = &b.kept else {
                self.model.name_value(&b.name.to_string(), &value);
                self.names.declare(self.definition, &b.name, value)?;
                continue;
            };
            let values = match kept {
                Kept::Turn => {
                    only_in(definition, Space::Space3, &b.name, "`turns`")?;
                    match value {
                        Value::Angle { sin, cos } => vec![cos, sin],
                        other => return Err(wrong(&b.value, "an angle in space", &other)),
                    }
                }
                Kept::Number(_) => vec![as_scalar(value, &b.value)?],
                Kept::Vector(slot) => {
                    let slot = self.slot(slot)?;
                    self.local_in(slot, value, &b.value)?
                }
            };
            self.refuse_all(&b.value, check::START)?;
            let value = self.keep(&b.name, kept.clone(), values, None)?;
            self.names.declare(self.definition, &b.name, value)?;
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
        // The optional parameter has its own name. The value that is used is stored in another
        // field. The same applies to an angle: its name denotes the angle since the start.
        let field = match (&overridden_by, &kind) {
            (None, Kept::Number(_) | Kept::Vector(_)) => name.to_string(),
            (Some(_), _) | (None, Kept::Turn) => format!("{name}_0"),
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
        let value = match &kind {
            Kept::Vector(slot) => Value::Local {
                slot: self.slot(slot)?,
                local: symbols.clone(),
            },
            Kept::Number(_) => Value::Scalar(symbols[0]),
            Kept::Turn => Value::Scalar(self.model.counted_angle(name, &values, &symbols)),
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

/// Returns `arm_i` for the only point in slot i. If the slot has several points, it returns `arm_s`
/// for a point `s`.
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

/// Rejects an item that exists only in the other space.
fn only_in(d: &Definition, space: Space, at: &Ident, what: &str) -> syn::Result<()> {
    if d.space == space {
        return Ok(());
    }
    Err(syn::Error::new_spanned(
        at,
        format!("{what} is a kind of a `{}` definition", space.word()),
    ))
}

/// Checks that the parameter after `like` consists of axes and is declared before the parameter
/// `own`.
fn check_like(d: &Definition, like: &Ident, own: &Param) -> syn::Result<()> {
    let mut before = d.params.iter().take_while(|p| p.name != own.name);
    let is_axes = |p: &Param| matches!(p.kind, ParamKind::Axes { .. });
    if before.any(|p| p.name == *like && is_axes(p)) {
        return Ok(());
    }
    Err(syn::Error::new_spanned(
        like,
        format!("`{like}` is no `Axes` parameter before `{}`", own.name),
    ))
}
