//! The definition language: what may be written, as a tree. Meaning comes later, in `elaborate`.
//!
//! ```text
//! plane Name(slot, …) {
//!     /// What it does.
//!     params { /// What it is for.
//!              name: Kind, … }         Point in slot · Direction in slot · GroundLine · a unit ·
//!                                      [unit, …] · Function<unit> · [Function<unit>, …]; `= expr` makes a
//!                                      number optional
//!     points apart;                    the place in a scene is one point for each Point, not a common one
//!     let name = expr;
//!     initial { name: Kind = expr, … } kept from the assembled start
//!     require "words": condition;      must hold at the assembled start
//!     rows: [name, …];
//!     phi: expr;                       or   psi: expr;   (constraints)
//!     measure name: expr;              what a drive may prescribe
//!     place: expr;                     where the reaction is reported
//!     component name: expr;            a named direction of the reaction
//!     note "words";                    what a reader of the reaction must know
//!     force: law on coordinate;        (forces) Q = Σ law · ∂coordinate/∂x
//!     scene "type";                    another scene type than the name
//!     variant key = "value", default;  one of several definitions of a scene type
//! }
//! ```

mod item;
mod kind;
mod limits;
#[cfg(test)]
mod tests;

use proc_macro2::TokenStream;
use syn::parse::{ParseStream, Parser};
use syn::{Expr, Ident, LitStr};

pub use kind::UNITS;

/// What a definition defines.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// `joint!`
    Constraint,
    /// `force!`
    Force,
}

/// One definition, as written.
pub struct Definition {
    /// Its name.
    pub name: Ident,
    /// Names of its body slots.
    pub slots: Vec<Ident>,
    /// Its doc comment, one string for each line.
    pub doc: Vec<String>,
    /// Its parameters.
    pub params: Vec<Param>,
    /// Whether its place in a scene is one point for each point parameter.
    pub points_apart: bool,
    /// `let` and `initial`, in the order written.
    pub bindings: Vec<Binding>,
    /// Conditions on the assembled start.
    pub requirements: Vec<(LitStr, Expr)>,
    /// Names of the rows.
    pub rows: Vec<Ident>,
    /// Position level constraint.
    pub phi: Option<Expr>,
    /// Velocity level constraint.
    pub psi: Option<Expr>,
    /// What drives may prescribe.
    pub measures: Vec<(Ident, Expr)>,
    /// Where the reaction is reported.
    pub place: Option<Expr>,
    /// A named direction of the reaction.
    pub component: Option<(Ident, Expr)>,
    /// What a reader of the reaction must know.
    pub note: Option<LitStr>,
    /// Laws and their coordinates.
    pub forces: Vec<(Expr, Expr)>,
    /// Scene type, if it is not the name.
    pub scene: Option<LitStr>,
    /// Key, value and whether it is the default.
    pub variant: Option<(Ident, LitStr, bool)>,
}

/// One parameter.
pub struct Param {
    /// Its name.
    pub name: Ident,
    /// Its doc comment.
    pub doc: Vec<String>,
    /// What it takes.
    pub kind: ParamKind,
    /// Value at the assembled start where none is given.
    pub default: Option<Expr>,
}

/// What a parameter takes.
pub enum ParamKind {
    /// A point of the body in a slot.
    Point(Ident),
    /// A direction in the frame of the body in a slot.
    Direction(Ident),
    /// A line of the ground.
    GroundLine,
    /// One number with its unit.
    Number(Ident),
    /// Several numbers.
    Numbers(Vec<Ident>),
    /// One function of time.
    Function(Ident),
    /// Several functions of time.
    Functions(Vec<Ident>),
}

/// `let` or one entry of `initial`.
pub struct Binding {
    /// Its name.
    pub name: Ident,
    /// Its value.
    pub value: Expr,
    /// What is kept, for `initial`; nothing for `let`.
    pub kept: Option<Kept>,
}

/// What an `initial` value is.
#[derive(Clone, PartialEq, Eq)]
pub enum Kept {
    /// One number with its unit.
    Number(Ident),
    /// Two components in the frame of the body in a slot.
    Vector(Ident),
}

/// Parses the body of a `joint!` or `force!`.
///
/// # Errors
/// At the token that does not fit.
pub fn definition(kind: Kind, body: TokenStream) -> syn::Result<Definition> {
    limits::check(&body)?;
    (|input: ParseStream<'_>| item::definition(kind, input)).parse2(body)
}

/// A name that becomes a name of generated code, too.
fn name(input: ParseStream<'_>) -> syn::Result<Ident> {
    let name: Ident = input.parse()?;
    match name.to_string().strip_prefix("r#") {
        Some(word) => Err(syn::Error::new_spanned(
            &name,
            format!("`{word}` is a keyword of Rust: choose another name"),
        )),
        None => Ok(name),
    }
}
