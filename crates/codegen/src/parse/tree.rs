//! A definition as written by its author.

use syn::parse::ParseStream;
use syn::{Expr, Ident, LitStr};

use crate::space::Space;

/// The kind of a definition.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// A definition of `joint!`.
    Constraint,
    /// A definition of `force!`.
    Force,
}

/// One definition, as written by its author.
#[derive(Clone)]
pub struct Definition {
    /// The space of its bodies.
    pub space: Space,
    /// Name of the definition.
    pub name: Ident,
    /// Names of the body slots. The body slots are the arguments of the definition that denote
    /// bodies.
    pub slots: Vec<Ident>,
    /// Doc comment, one string for each line.
    pub doc: Vec<String>,
    /// Parameters of the definition.
    pub params: Vec<Param>,
    /// Whether a scene gives one point for each point parameter, instead of one common reference
    /// point.
    pub points_apart: bool,
    /// Whether the bodies, the axes and all points except the last are taken from two joints. These
    /// joints support the first two bodies on the third body.
    pub bearings: bool,
    /// The bindings `let`, `initial` and `turns`, in the order of the text.
    pub bindings: Vec<Binding>,
    /// Conditions on the assembled start.
    pub requirements: Vec<(LitStr, Expr)>,
    /// Names of the rows: first of the rows of `phi`, then of the rows of `psi`.
    pub rows: Vec<Ident>,
    /// Whether the only row of position level is the gap of a contact. The gap is positive where
    /// the contact is open.
    pub has_gap: bool,
    /// The rows of position level. The names of these rows come first in `rows`.
    pub phi: Option<Expr>,
    /// The rows of velocity level.
    pub psi: Option<Expr>,
    /// The joint coordinates that drives may prescribe. The expression is `None` for a value stored
    /// at the start, which a drive moves in the rows of the joint.
    pub measures: Vec<(Ident, Option<Expr>)>,
    /// The reference point of the reaction.
    pub place: Option<Expr>,
    /// A named direction of the reaction.
    pub component: Option<(Ident, Expr)>,
    /// A note for readers of the reaction.
    pub note: Option<LitStr>,
    /// Force laws and their coordinates.
    pub forces: Vec<(Expr, Expr)>,
    /// Scene type, if it differs from the name.
    pub scene: Option<LitStr>,
    /// The form of this definition, if the definition has several forms.
    pub variant: Option<Variant>,
}

/// One of several forms of a definition. All forms have the same scene type.
#[derive(Clone)]
pub struct Variant {
    /// Key that selects the form in a scene.
    pub key: Ident,
    /// Value of the key for this form.
    pub value: LitStr,
    /// Whether this form is selected if the key is not given.
    pub default: bool,
}

/// One parameter.
#[derive(Clone)]
pub struct Param {
    /// Name of the parameter.
    pub name: Ident,
    /// Doc comment of the parameter.
    pub doc: Vec<String>,
    /// Kind of the value.
    pub kind: ParamKind,
    /// Value at the assembled start that is used if the parameter is not given.
    pub default: Option<Expr>,
}

/// The kind of a parameter.
#[derive(Clone)]
pub enum ParamKind {
    /// A point of the body in a slot.
    Point(Ident),
    /// A direction in the frame of the body in a slot.
    Direction(Ident),
    /// An axis in the frame of the body in a slot, with directions across the axis. If the
    /// directions are not given, the axes of another parameter are used, or the axes of the frame
    /// if `optional`.
    Axes {
        /// The slot.
        slot: Ident,
        /// The parameter whose axes are used if none are given.
        like: Option<Ident>,
        /// Whether the axes of the frame are used if none are given.
        optional: bool,
    },
    /// A line of the ground.
    GroundLine,
    /// A plane of the ground; the default is z = 0.
    GroundPlane,
    /// A scalar value with its unit.
    Number(Ident),
    /// Several scalar values.
    Numbers(Vec<Ident>),
    /// One function of time.
    Function(Ident),
    /// Several functions of time.
    Functions(Vec<Ident>),
}

/// A binding `let` or `turns`, or one entry of `initial`.
#[derive(Clone)]
pub struct Binding {
    /// Name of the binding.
    pub name: Ident,
    /// Value of the binding.
    pub value: Expr,
    /// The kind of the stored value for `initial` and `turns`; `None` for `let`.
    pub kept: Option<Kept>,
}

/// The kind of a value stored at the start.
#[derive(Clone, PartialEq, Eq)]
pub enum Kept {
    /// A scalar value with its unit.
    Number(Ident),
    /// Components in the frame of the body in a slot.
    Vector(Ident),
    /// An angle in space, stored by its cosine and sine. The name denotes the angle since the
    /// start, with its full revolutions.
    Turn,
}

/// Parses a name that is also used as a name in the generated code.
pub(super) fn name(input: ParseStream<'_>) -> syn::Result<Ident> {
    let name: Ident = input.parse()?;
    match name.to_string().strip_prefix("r#") {
        Some(word) => Err(syn::Error::new_spanned(
            &name,
            format!("`{word}` is a keyword of Rust: choose another name"),
        )),
        None => Ok(name),
    }
}
