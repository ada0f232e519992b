//! The syntax of the definition language, as a tree. The module `elaborate` determines the meaning
//! of this tree later.
//!
//! ```text
//! plane Name(slot, …) {               or   space Name(slot, …) {
//!     /// What it does.
//!     params { /// What it is for.
//!              name: Kind, … }         Point in slot · Direction in slot · Axes in slot [like name]
//!                                      [optional] · GroundLine · a unit ·
//!                                      [unit, …] · Function<unit> · [Function<unit>, …]; `= expr` makes a
//!                                      number optional
//!     points apart;                    the place in a scene is one point for each Point, not a common one
//!     bearings;                        the first two bodies turn on the third about axes of joints that a scene names
//!     let name = expr;
//!     initial { name: Kind = expr, … } kept from the assembled start
//!     turns name: angle(a, b);         an angle in space since the assembled start, with its full turns
//!     require "words": condition;      must hold at the assembled start
//!     rows: [name, …];                 `gap name` for the first one: `phi` is the gap of a contact, ≥ 0 if it opens
//!     phi: expr;                       rows of position level (constraints); one of both may be missing
//!     psi: expr;                       rows of velocity level, whose names follow those of `phi`
//!     measure name: expr;              what a drive may prescribe
//!     place: expr;                     where the reaction is reported
//!     component name: expr;            a named direction of the reaction
//!     note "words";                    what a reader of the reaction must know
//!     force: law on coordinate;        (forces) Q = Σ law · ∂coordinate/∂x
//!     scene "type";                    another scene type than the name
//!     variant name {                   forms of the definition, in which `name` differs; the
//!         /// What it does.            key `name` of a scene selects one, by default the first
//!         "value": expr, … }
//! }
//! ```

mod bearings;
mod item;
mod kind;
mod limits;
#[cfg(test)]
mod tests;
mod tree;
mod variant;

use proc_macro2::TokenStream;
use syn::parse::{ParseStream, Parser};

pub use kind::UNITS;
pub use tree::{Binding, Definition, Kept, Kind, Param, ParamKind, Variant};

/// Parses the body of a `joint!` or `force!`. Returns a definition for each form of the body.
///
/// # Errors
/// Returns an error at the first token that does not fit the syntax.
pub fn definition(kind: Kind, body: TokenStream) -> syn::Result<Vec<Definition>> {
    limits::check(&body)?;
    (|input: ParseStream<'_>| item::definition(kind, input)).parse2(body)
}
