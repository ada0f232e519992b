//! A definition in mathematical form, after names are resolved.

use proc_macro2::{Ident, TokenStream};
use symbolic::{Expr, Graph};

use super::inputs::{self, Inputs, Source};
use super::value::Value;
use crate::defined::Along;
use crate::parse::Kept;
use crate::space::AXES;
use crate::vector::{Components, Frame, Turn, Vector};

/// A definition in mathematical form.
pub(crate) struct Model {
    pub(crate) g: Graph,
    pub(crate) inputs: Inputs,
    /// The total time derivative without the acceleration terms.
    pub(crate) time: Along,
    pub(crate) turns: Vec<Turn>,
    /// The sub-expressions that have a name.
    pub(crate) names: Vec<(Expr, String)>,
    /// The values stored at the assembled start, in order.
    pub(crate) kept: Vec<KeptValue>,
    /// The unwrapped angles, in order.
    pub(crate) counted: Vec<Counted>,
    pub(crate) requirements: Vec<Condition>,
    pub(crate) body: Body,
}

/// A value stored at the assembled start.
pub(crate) struct KeptValue {
    /// Name of the field.
    pub(crate) field: String,
    pub(crate) kind: Kept,
    /// The kernel inputs that represent the value.
    pub(crate) symbols: Vec<Expr>,
    /// The values of the symbols at the start.
    pub(crate) values: Vec<Expr>,
    /// The optional parameter that overrides the value.
    pub(crate) overridden_by: Option<Ident>,
    /// Whether the value depends on the configuration.
    pub(crate) of_start: bool,
}

/// An angle in space, measured from the start. The expressions determine the angle up to full
/// revolutions. The expressions also determine the rate of the angle.
#[derive(Clone, Copy)]
pub(crate) struct Counted {
    pub(crate) cos: Expr,
    pub(crate) sin: Expr,
    pub(crate) rate: Expr,
}

impl Counted {
    pub(crate) fn all(self) -> [Expr; 3] {
        [self.cos, self.sin, self.rate]
    }
}

/// The content of a definition: a constraint or a force.
pub(crate) enum Body {
    Constraint(ConstraintBody),
    /// Force laws and their coordinates.
    Force(Vec<(Expr, Expr)>),
}

/// A constraint in mathematical form.
pub(crate) struct ConstraintBody {
    /// Number of holonomic rows.
    pub(crate) holonomic: usize,
    /// The holonomic rows Φ, then the nonholonomic rows Ψ·q̇ + ψ.
    pub(crate) rows: Vec<Expr>,
    /// Vectors whose ground components are rows, with the index of the first row.
    pub(crate) vectors: Vec<(usize, Vector)>,
    /// The source text of each row, for the positions of errors.
    pub(crate) at: Vec<TokenStream>,
    pub(crate) place: Vector,
    pub(crate) component: Option<(Ident, Vector)>,
    pub(crate) measures: Vec<(Ident, Measure)>,
}

/// The quantity that a drive prescribes.
#[derive(Clone, Copy)]
pub(crate) enum Measure {
    /// The drive prescribes an expression. The row of the drive is coordinate − initial value −
    /// motion.
    Of(Expr),
    /// The drive prescribes a value stored at the start. The motion of the drive is added to this
    /// value in the rows of the joint, and the resulting rows replace the rows of the joint.
    Kept(Expr),
    /// The drive prescribes an angle θ in space. The row of the drive is sin(θ − initial angle −
    /// motion). This row is a polynomial in the sines and cosines, so that revolutions need not be
    /// counted.
    Angle { sin: Expr, cos: Expr },
}

/// A condition on the start.
pub(crate) enum Condition {
    Compare(Comparison, Expr, Expr),
    And(Box<Condition>, Box<Condition>),
    Or(Box<Condition>, Box<Condition>),
}

impl Condition {
    fn visit(&mut self, f: &mut impl FnMut(&mut Expr)) {
        match self {
            Self::Compare(_, a, b) => {
                f(a);
                f(b);
            }
            Self::And(a, b) | Self::Or(a, b) => {
                a.visit(f);
                b.visit(f);
            }
        }
    }
}

/// A comparison of two scalars.
#[derive(Clone, Copy)]
pub(crate) enum Comparison {
    Equal,
    NotEqual,
    Greater,
    Less,
}

impl Model {
    /// Returns whether an expression depends on inputs for whose source `origin` returns `true`.
    pub(crate) fn depends_on(&self, e: Expr, origin: impl Fn(&Source) -> bool) -> bool {
        let inputs = self.inputs.defined.inputs(&self.g, e);
        inputs.into_iter().any(|s| origin(self.inputs.source(s)))
    }

    /// Returns the expression in which every symbol for a rotated vector or a product is replaced
    /// by its definition.
    pub(crate) fn expand(&mut self, e: Expr) -> Expr {
        self.inputs.defined.expand(&mut self.g, e)
    }

    /// Returns the angle with this cosine and sine, measured from the angle with the cosine and
    /// sine in `start`.
    pub(crate) fn angle_since(&mut self, [cos, sin]: [Expr; 2], start: [Expr; 2]) -> Counted {
        let [cos_0, sin_0] = start;
        let g = &mut self.g;
        let mut product = |a, b| g.mul(a, b);
        let (a, b) = (product(sin, cos_0), product(cos, sin_0));
        let (c, d) = (product(cos, cos_0), product(sin, sin_0));
        let (sin, cos) = (g.sub(a, b), g.add(c, d));
        let [d_sin, d_cos] = [sin, cos].map(|e| self.time.apply(&mut self.g, e));
        let g = &mut self.g;
        let (a, b) = (g.mul(cos, d_sin), g.mul(sin, d_cos));
        let rate = g.sub(a, b);
        Counted { cos, sin, rate }
    }

    /// Returns the angle since the start, with its full revolutions. The angle is the sum of the
    /// given value and a correction for the remaining difference ε, `sin ε·(4 − cos ε)/3 = ε +
    /// O(ε⁵)`. If the given value is accurate to rounding, the result is the angle. The result is a
    /// polynomial, and its first four derivatives are exact at this value. Γ and its derivatives
    /// need three of them.
    pub(super) fn counted_angle(&mut self, name: &Ident, angle: &[Expr], start: &[Expr]) -> Expr {
        let Self {
            g, inputs, counted, ..
        } = self;
        let [known, known_cos, known_sin] = inputs.counted(g, &name.to_string(), counted.len());
        let since = self.angle_since([angle[0], angle[1]], [start[0], start[1]]);
        self.counted.push(since);
        let g = &mut self.g;
        let (a, b) = (g.mul(since.sin, known_cos), g.mul(since.cos, known_sin));
        let (c, d) = (g.mul(since.cos, known_cos), g.mul(since.sin, known_sin));
        let (sin, cos) = (g.sub(a, b), g.add(c, d));
        let third = g.number(1.0 / 3.0);
        let product = g.mul(sin, cos);
        let left = g.sum(&[(4.0, sin), (-1.0, product)]);
        let left = g.mul(third, left);
        g.add(known, left)
    }

    /// Replaces these symbols in all expressions that are printed without further derivatives.
    pub(super) fn expand_printed(&mut self) {
        let Self {
            g,
            inputs,
            names,
            kept,
            counted,
            requirements,
            ..
        } = self;
        let mut expand = |e: &mut Expr| *e = inputs.defined.expand(g, *e);
        names.iter_mut().for_each(|(e, _)| expand(e));
        kept.iter_mut()
            .flat_map(|k| &mut k.values)
            .for_each(&mut expand);
        for of_angle in counted {
            expand(&mut of_angle.cos);
            expand(&mut of_angle.sin);
            expand(&mut of_angle.rate);
        }
        requirements.iter_mut().for_each(|c| c.visit(&mut expand));
    }

    /// Returns whether a stored value is computed only from other values, so that it changes with
    /// the other values.
    pub(crate) fn is_computed(&self, kept: &KeptValue) -> bool {
        let reads_poses = |&e: &Expr| self.depends_on(e, |s| matches!(s, Source::Pose { .. }));
        kept.overridden_by.is_none() && !kept.values.iter().any(reads_poses)
    }

    /// Returns whether a value depends on the configuration, directly or through stored values.
    pub(crate) fn depends_on_start(&self, e: Expr) -> bool {
        self.depends_on(e, |s| match s {
            Source::Pose { .. } => true,
            Source::Kept { field, .. } => self.kept.iter().any(|k| k.field == *field && k.of_start),
            _ => false,
        })
    }

    /// Names the ground components of a vector that is fixed in a body.
    pub(super) fn name_rotated(&mut self, slot: usize, local: Components, name: &str) {
        let Model {
            g, turns, names, ..
        } = self;
        let vector = Vector::new(Frame::Body(slot), local);
        for (_, components) in vector.rotated_parts(g, turns) {
            let components = components.into_iter().zip(AXES);
            names.extend(components.map(|(e, axis)| (e, format!("{name}_{axis}"))));
        }
    }

    /// Gives names to the scalars of a value.
    pub(super) fn name_value(&mut self, name: &str, value: &Value) {
        let pieces: Vec<(Expr, String)> = match value {
            Value::Scalar(e) => vec![(*e, name.to_owned())],
            Value::Local { local, .. } => {
                let entries = local.iter().enumerate();
                entries.map(|(k, e)| (*e, format!("{name}_{k}"))).collect()
            }
            Value::Vector(v) => {
                let components = v.to_ground(&mut self.g, &self.turns).into_iter();
                let components = components.zip(AXES);
                components
                    .map(|(e, axis)| (e, format!("{name}_{axis}")))
                    .collect()
            }
            _ => Vec::new(),
        };
        // A local variable with this name would hide an argument.
        let free = |name: &String| !inputs::ARGUMENTS.contains(&name.as_str()) && name != "None";
        self.names
            .extend(pieces.into_iter().filter(|(_, name)| free(name)));
    }
}
