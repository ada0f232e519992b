//! Names of a definition, and their meanings.

use std::collections::{BTreeMap, BTreeSet};

use super::model::Model;
use super::value::Value;
use crate::parse::Definition;

/// Names in scope, and which of them were used.
pub(super) struct Scope<'a> {
    pub(super) definition: &'a Definition,
    pub(super) model: Model,
    pub(super) values: BTreeMap<String, Value>,
    pub(super) used: BTreeSet<String>,
}
