//! Expressions of the language become scalars of the expression graph. Shapes are checked here, and here names
//! are resolved; after this step only mathematics is left.

mod expression;
mod inputs;

use std::collections::{BTreeMap, BTreeSet};

use proc_macro2::Ident;
use symbolic::{Derivation, Expr, Graph, Node};
use syn::spanned::Spanned;

use crate::parse::{Definition, Kept, Param, ParamKind};
use crate::vector::{Frame, Turn, Vector};
use expression::Value;
pub(crate) use expression::{Comparison, Condition};
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
    pub(crate) place: Vector,
    pub(crate) component: Option<(Ident, Vector)>,
    pub(crate) measures: Vec<(Ident, Expr)>,
}

/// Names that generated kernels use themselves.
const RESERVED: [&str; 11] = [
    "x",
    "v",
    "a",
    "f",
    "k",
    "out",
    "lambda",
    "motion",
    "measure_0",
    "reader",
    "arguments",
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

impl Scope<'_> {
    fn declare_params(&mut self) -> syn::Result<()> {
        for p in &self.definition.params {
            if RESERVED.iter().any(|r| p.name == r) {
                return Err(syn::Error::new_spanned(
                    &p.name,
                    format!("`{}` is a name of generated code", p.name),
                ));
            }
            let value = self.param_value(p)?;
            self.declare(&p.name, value)?;
        }
        Ok(())
    }

    fn param_value(&mut self, p: &Param) -> syn::Result<Value> {
        let name = p.name.to_string();
        if let (Some(default), false) = (&p.default, matches!(p.kind, ParamKind::Number(_))) {
            return Err(syn::Error::new(
                default.span(),
                "only a number may have a default",
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
                    .map(|k| Value::Scalar(self.model.inputs.scalar(&format!("{name}_{k}"))))
                    .collect(),
            ),
            ParamKind::Function(_) => Value::Scalar(self.model.inputs.scalar(&name)),
            ParamKind::Functions(units) => Value::List(
                (0..units.len())
                    .map(|k| Value::Scalar(self.model.inputs.scalar(&format!("{name}_{k}"))))
                    .collect(),
            ),
            ParamKind::Number(_) => match &p.default {
                None => Value::Scalar(self.model.inputs.scalar(&name)),
                Some(default) => {
                    let value = self.scalar(default)?;
                    self.keep(&name, Kept::Number, vec![value], Some(p.name.clone()))
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
        match self.values.insert(name.to_string(), value) {
            Some(_) => Err(syn::Error::new_spanned(
                name,
                format!("`{name}` is defined twice"),
            )),
            None => Ok(()),
        }
    }

    fn bind(&mut self) -> syn::Result<()> {
        for b in &self.definition.bindings {
            let value = self.value(&b.value)?;
            let value = match b.kept {
                None => {
                    self.name_value(&b.name.to_string(), &value);
                    value
                }
                Some(Kept::Number) => {
                    let value = self.as_scalar(value, b.value.span())?;
                    self.keep(&b.name.to_string(), Kept::Number, vec![value], None)
                }
                Some(Kept::Vector) => {
                    let Value::Pair(pair) = value else {
                        return Err(syn::Error::new(
                            b.value.span(),
                            format!(
                                "expected the components of a vector in a frame, `local(slot, …)`; this is {}",
                                value.shape()
                            ),
                        ));
                    };
                    self.keep(&b.name.to_string(), Kept::Vector, pair.to_vec(), None)
                }
            };
            self.declare(&b.name, value)?;
        }
        Ok(())
    }

    fn name_value(&mut self, name: &str, value: &Value) {
        let pieces: Vec<(Expr, String)> = match value {
            Value::Scalar(e) => vec![(*e, name.to_owned())],
            Value::Pair([a, b]) => vec![(*a, format!("{name}_0")), (*b, format!("{name}_1"))],
            Value::Vector(v) => {
                let [x, y] = v.to_ground(&mut self.model.g, &self.model.turns);
                vec![(x, format!("{name}_x")), (y, format!("{name}_y"))]
            }
            _ => Vec::new(),
        };
        self.model.names.extend(pieces);
    }

    fn keep(
        &mut self,
        name: &str,
        kind: Kept,
        values: Vec<Expr>,
        overridden_by: Option<Ident>,
    ) -> Value {
        // The optional parameter keeps its own name; what it resolves to is another field.
        let field = match overridden_by {
            Some(_) => format!("{name}_0"),
            None => name.to_owned(),
        };
        let symbols = self.model.inputs.kept(&mut self.model.g, &field, kind);
        let of_start = values.iter().any(|&v| self.model.depends_on_start(v));
        let value = match (kind, symbols.as_slice()) {
            (Kept::Vector, &[a, b]) => Value::Pair([a, b]),
            _ => Value::Scalar(symbols[0]),
        };
        self.model.kept.push(KeptValue {
            field,
            kind,
            values,
            overridden_by,
            of_start,
        });
        value
    }

    fn require(&mut self) -> syn::Result<()> {
        for (_, condition) in &self.definition.requirements {
            let condition = self.condition(condition)?;
            self.model.requirements.push(condition);
        }
        Ok(())
    }

    fn constraint(&mut self) -> syn::Result<ConstraintBody> {
        let d = self.definition;
        let (holonomic, expr) = match (&d.phi, &d.psi) {
            (Some(phi), _) => (true, phi),
            (None, Some(psi)) => (false, psi),
            (None, None) => unreachable!("the parser requires phi or psi"),
        };
        let value = self.value(expr)?;
        let rows = self.rows(value, expr.span())?;
        if rows.len() != d.rows.len() {
            return Err(syn::Error::new(
                expr.span(),
                format!(
                    "{} rows here, but `rows:` names {}",
                    rows.len(),
                    d.rows.len()
                ),
            ));
        }
        for &row in &rows {
            self.check_polynomial(row, expr.span())?;
            let moving = self
                .model
                .depends_on(row, |s| matches!(s, Source::Twist { .. }));
            if holonomic && moving {
                return Err(syn::Error::new(
                    expr.span(),
                    "`phi` depends on velocities: a velocity level constraint is `psi`",
                ));
            }
            if !holonomic && !moving {
                return Err(syn::Error::new(
                    expr.span(),
                    "`psi` contains no velocity: a position level constraint is `phi`",
                ));
            }
        }
        let place = d.place.as_ref().expect("the parser requires a place");
        let place_value = self.vector(place)?;
        let component = match &d.component {
            None => None,
            Some((name, e)) => Some((name.clone(), self.vector(e)?)),
        };
        let mut measures = Vec::new();
        for (name, e) in &d.measures {
            let value = self.scalar(e)?;
            self.check_polynomial(value, e.span())?;
            if self
                .model
                .depends_on(value, |s| matches!(s, Source::Twist { .. }))
            {
                return Err(syn::Error::new(
                    e.span(),
                    "a measure is a relative position or angle",
                ));
            }
            measures.push((name.clone(), value));
        }
        Ok(ConstraintBody {
            holonomic,
            rows,
            place: place_value,
            component,
            measures,
        })
    }

    fn forces(&mut self) -> syn::Result<Vec<(Expr, Expr)>> {
        let mut terms = Vec::new();
        for (law, coordinate) in &self.definition.forces {
            let (l, c) = (self.scalar(law)?, self.scalar(coordinate)?);
            if self
                .model
                .depends_on(c, |s| matches!(s, Source::Twist { .. }))
            {
                return Err(syn::Error::new(
                    coordinate.span(),
                    "a force acts on a relative position or angle, not on a velocity",
                ));
            }
            terms.push((l, c));
        }
        Ok(terms)
    }

    fn check_polynomial(&self, e: Expr, at: proc_macro2::Span) -> syn::Result<()> {
        let mut stack = vec![e];
        while let Some(e) = stack.pop() {
            let polynomial = match self.model.g.node(e) {
                Node::Call(..) => false,
                Node::Product(_, factors) => factors.iter().all(|f| f.1 > 0),
                _ => true,
            };
            if !polynomial {
                return Err(syn::Error::new(
                    at,
                    "a constraint kernel is a polynomial: no quotients and no `norm` here; put what depends on \
                     parameters and the start only into `initial`",
                ));
            }
            stack.extend(self.model.g.children(e));
        }
        Ok(())
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
                format!("`{name}` is never used"),
            )),
            None => Ok(()),
        }
    }

    fn slot(&self, name: &Ident) -> syn::Result<usize> {
        self.definition
            .slots
            .iter()
            .position(|s| s == name)
            .ok_or_else(|| {
                let slots: Vec<_> = self
                    .definition
                    .slots
                    .iter()
                    .map(|s| format!("`{s}`"))
                    .collect();
                syn::Error::new_spanned(
                    name,
                    format!(
                        "`{name}` is no body slot; the slots are {}",
                        slots.join(", ")
                    ),
                )
            })
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

    /// Whether a value depends on the configuration, directly or through kept values.
    pub(crate) fn depends_on_start(&self, e: Expr) -> bool {
        self.depends_on(e, |s| match s {
            Source::Pose { .. } => true,
            Source::Kept { field, .. } => self.kept.iter().any(|k| k.field == *field && k.of_start),
            _ => false,
        })
    }
}
