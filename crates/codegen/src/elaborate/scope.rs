//! The context in which an expression of a definition is elaborated.

use super::model::Model;
use super::names::Names;
use crate::parse::Definition;

/// A definition, the names in scope, and the mathematical form so far.
pub(super) struct Scope<'a> {
    pub(super) definition: &'a Definition,
    pub(super) model: Model,
    pub(super) names: Names,
}
