//! A definition as mathematics, after names are resolved.

use proc_macro2::{Ident, TokenStream};
use symbolic::{Derivation, Expr, Graph};

use super::inputs::{self, Inputs, Source};
use super::value::Value;
use crate::parse::Kept;
use crate::vector::{Frame, Turn, Vector};

/// A definition as mathematics.
pub(crate) struct Model {
    pub(crate) g: Graph,
    pub(crate) inputs: Inputs,
    /// Total time derivative without the terms in the accelerations.
    pub(crate) time: Derivation,
    pub(crate) turns: Vec<Turn>,
    /// Sub-expressions that have a name.
    pub(crate) names: Vec<(Expr, String)>,
    /// The values kept from the assembled start, in order.
    pub(crate) kept: Vec<KeptValue>,
    pub(crate) requirements: Vec<Condition>,
    pub(crate) body: Body,
}

/// A value kept from the assembled start.
pub(crate) struct KeptValue {
    /// Name of its field.
    pub(crate) field: String,
    pub(crate) kind: Kept,
    /// The kernel inputs that represent it.
    pub(crate) symbols: Vec<Expr>,
    /// Its value at the start.
    pub(crate) values: Vec<Expr>,
    /// The optional parameter that overrides it.
    pub(crate) overridden_by: Option<Ident>,
    /// Whether the value depends on the configuration.
    pub(crate) of_start: bool,
}

/// The content of a definition: a constraint or a force.
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
    /// The source text of each row, for the positions of errors.
    pub(crate) at: Vec<TokenStream>,
    pub(crate) place: Vector,
    pub(crate) component: Option<(Ident, Vector)>,
    pub(crate) measures: Vec<(Ident, Measure)>,
}

/// What a drive prescribes.
#[derive(Clone, Copy)]
pub(crate) enum Measure {
    /// An expression: its row is measure − initial measure − motion.
    Of(Expr),
    /// A value kept from the start: the motion is added to it in the rows of the joint, and these
    /// rows take the place of the joint's.
    Kept(Expr),
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

impl Model {
    /// Whether an expression depends on inputs of some origin.
    pub(crate) fn depends_on(&self, e: Expr, origin: impl Fn(&Source) -> bool) -> bool {
        self.g
            .inputs(e)
            .into_iter()
            .any(|s| origin(self.inputs.source(s)))
    }

    /// Whether a kept value is computed only from other numbers, so that it changes with them.
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

    /// Names the ground components of a vector that is fixed in a body.
    pub(super) fn name_rotated(&mut self, slot: usize, pair: [Expr; 2], name: &str) {
        let Model {
            g, turns, names, ..
        } = self;
        let vector = Vector::new(Frame::Body(slot), pair);
        for (_, [x, y]) in vector.rotated_parts(g, turns) {
            names.push((x, format!("{name}_x")));
            names.push((y, format!("{name}_y")));
        }
    }

    /// Gives names to the scalars of a value.
    pub(super) fn name_value(&mut self, name: &str, value: &Value) {
        let pieces: Vec<(Expr, String)> = match value {
            Value::Scalar(e) => vec![(*e, name.to_owned())],
            Value::Pair { pair: [a, b], .. } => {
                vec![(*a, format!("{name}_0")), (*b, format!("{name}_1"))]
            }
            Value::Vector(v) => {
                let [x, y] = v.to_ground(&mut self.g, &self.turns);
                vec![(x, format!("{name}_x")), (y, format!("{name}_y"))]
            }
            _ => Vec::new(),
        };
        // A local variable of this name would hide an argument.
        let free = |name: &String| !inputs::ARGUMENTS.contains(&name.as_str()) && name != "None";
        self.names
            .extend(pieces.into_iter().filter(|(_, name)| free(name)));
    }
}
