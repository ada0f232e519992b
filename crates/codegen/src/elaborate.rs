//! Expressions of the language become scalars of the expression graph. Shapes are checked here, and
//! here names are resolved; after this step only mathematics is left.

mod body;
mod check;
mod condition;
mod expression;
mod function;
mod inputs;
#[cfg(test)]
mod tests;

use std::collections::{BTreeMap, BTreeSet};

use proc_macro2::{Ident, TokenStream};
use symbolic::{Derivation, Expr, Graph};

use crate::parse::{Definition, Kept, Param, ParamKind};
use crate::vector::{Frame, Turn, Vector};
pub(crate) use check::not_polynomial;
pub(crate) use condition::{Comparison, Condition};
use expression::Value;
pub(crate) use inputs::{Inputs, Source};

/// A definition as mathematics.
pub(crate) struct Model {
    pub(crate) g: Graph,
    pub(crate) inputs: Inputs,
    /// Total time derivative with the accelerations left out.
    pub(crate) time: Derivation,
    pub(crate) turns: Vec<Turn>,
    /// Sub-expressions that have a name.
    pub(crate) names: Vec<(Expr, String)>,
    /// What is kept from the assembled start, in order.
    pub(crate) kept: Vec<KeptValue>,
    pub(crate) requirements: Vec<Condition>,
    pub(crate) body: Body,
}

/// A value kept from the assembled start.
pub(crate) struct KeptValue {
    /// Name of its field.
    pub(crate) field: String,
    pub(crate) kind: Kept,
    /// The inputs of kernels that stand for it.
    pub(crate) symbols: Vec<Expr>,
    /// Its value at the start.
    pub(crate) values: Vec<Expr>,
    /// The optional parameter that overrides it.
    pub(crate) overridden_by: Option<Ident>,
    /// Whether the value depends on the configuration.
    pub(crate) of_start: bool,
}

/// What the definition defines.
pub(crate) enum Body {
    Constraint(ConstraintBody),
    /// Laws and their coordinates.
    Force(Vec<(Expr, Expr)>),
}

/// A constraint as mathematics.
pub(crate) struct ConstraintBody {
    /// Whether `rows` are Φ; otherwise they are Ψ·q̇ + ψ.
    pub(crate) holonomic: bool,
    pub(crate) rows: Vec<Expr>,
    /// The text of each row, where errors point.
    pub(crate) at: Vec<TokenStream>,
    pub(crate) place: Vector,
    pub(crate) component: Option<(Ident, Vector)>,
    pub(crate) measures: Vec<(Ident, Expr)>,
}

/// Names of fields, locals and patterns of the generated type: no parameter can have them.
const RESERVED: [&str; 5] = ["motion", "measure_0", "reader", "arguments", "None"];

/// Names of types and traits in the generated module: no definition can have them.
const RESERVED_TYPES: [&str; 33] = [
    "Argument",
    "ArgumentError",
    "Constraint",
    "ConstraintSpec",
    "Datum",
    "DatumShape",
    "Direction",
    "Entry",
    "Err",
    "Force",
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

/// Names in scope, and which of them were used.
struct Scope<'a> {
    definition: &'a Definition,
    model: Model,
    values: BTreeMap<String, Value>,
    used: BTreeSet<String>,
}

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
    scope.model.body = match d.forces.is_empty() {
        true => Body::Constraint(scope.constraint()?),
        false => Body::Force(scope.forces()?),
    };
    scope.check_use()?;
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
                self.name_rotated(slot, pair, &self.arm_name(p, slot));
                Value::Point { slot, pair }
            }
            ParamKind::Direction(slot) => {
                let slot = self.slot(slot)?;
                let pair = self.model.inputs.pair(&name);
                self.name_rotated(slot, pair, &name);
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

    /// `arm_i` for the only point in slot i, `arm_s` for one of several.
    fn arm_name(&self, p: &Param, slot: usize) -> String {
        let here = |q: &&Param| match &q.kind {
            ParamKind::Point(s) => *s == self.definition.slots[slot],
            _ => false,
        };
        match self.definition.params.iter().filter(here).count() {
            1 => format!("arm_{}", self.definition.slots[slot]),
            _ => format!("arm_{}", p.name),
        }
    }

    fn name_rotated(&mut self, slot: usize, pair: [Expr; 2], name: &str) {
        let Model {
            g, turns, names, ..
        } = &mut self.model;
        let vector = Vector::new(Frame::Body(slot), pair);
        for (_, [x, y]) in vector.rotated_parts(g, turns) {
            names.push((x, format!("{name}_x")));
            names.push((y, format!("{name}_y")));
        }
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
                self.name_value(&b.name.to_string(), &value);
                self.declare(&b.name, value)?;
                continue;
            };
            let values = match kept {
                Kept::Number(_) => vec![self.as_scalar(value, &b.value)?],
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

    fn name_value(&mut self, name: &str, value: &Value) {
        let pieces: Vec<(Expr, String)> = match value {
            Value::Scalar(e) => vec![(*e, name.to_owned())],
            Value::Pair { pair: [a, b], .. } => {
                vec![(*a, format!("{name}_0")), (*b, format!("{name}_1"))]
            }
            Value::Vector(v) => {
                let [x, y] = v.to_ground(&mut self.model.g, &self.model.turns);
                vec![(x, format!("{name}_x")), (y, format!("{name}_y"))]
            }
            _ => Vec::new(),
        };
        // A local of this name would hide an argument.
        let free = |name: &String| !inputs::ARGUMENTS.contains(&name.as_str()) && name != "None";
        self.model
            .names
            .extend(pieces.into_iter().filter(|(_, name)| free(name)));
    }

    fn keep(
        &mut self,
        name: &Ident,
        kind: Kept,
        values: Vec<Expr>,
        overridden_by: Option<Ident>,
    ) -> syn::Result<Value> {
        // The optional parameter keeps its own name; what it resolves to is another field.
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

    fn check_use(&self) -> syn::Result<()> {
        let params = self.definition.params.iter().map(|p| &p.name);
        let bindings = self.definition.bindings.iter().map(|b| &b.name);
        match params
            .chain(bindings)
            .find(|name| !self.used.contains(&name.to_string()))
        {
            Some(name) => Err(syn::Error::new_spanned(
                name,
                format!("`{name}` is never used: use it or leave it out"),
            )),
            None => Ok(()),
        }
    }
}

impl Model {
    /// Whether an expression depends on inputs of some origin.
    pub(crate) fn depends_on(&self, e: Expr, origin: impl Fn(&Source) -> bool) -> bool {
        self.g
            .inputs(e)
            .into_iter()
            .any(|s| origin(self.inputs.source(s)))
    }

    /// Whether a kept value is computed from other numbers alone, so that it changes with them.
    pub(crate) fn is_computed(&self, kept: &KeptValue) -> bool {
        let reads_poses = |&e: &Expr| self.depends_on(e, |s| matches!(s, Source::Pose { .. }));
        kept.overridden_by.is_none() && !kept.values.iter().any(reads_poses)
    }

    /// Whether a value depends on the configuration, directly or through kept values.
    pub(crate) fn depends_on_start(&self, e: Expr) -> bool {
        self.depends_on(e, |s| match s {
            Source::Pose { .. } => true,
            Source::Kept { field, .. } => self.kept.iter().any(|k| k.field == *field && k.of_start),
            _ => false,
        })
    }
}
