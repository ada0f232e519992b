//! `active`: joints, drives, forces and groups that are read and checked, but take no part.

use crate::dimension::Dimension;
use crate::key::{Key, Takes};
use crate::table::Table;

/// The key of joints, drives, forces and groups.
pub(crate) const ACTIVE: Key = Key::optional("active", "true or false", Takes::Switch)
    .doc("Whether it is there; what is not is read and checked only. A number or an expression is false where it is zero")
    .or(|| true.into());

/// Whether the item of a table takes part. What cannot be read is reported, and does.
/// Its key is not marked as known: it is the last one of its table.
pub(crate) fn read(table: &Table) -> bool {
    let Some(field) = table.field(ACTIVE.name) else {
        return true;
    };
    let value = match field.value.get_ref().as_bool() {
        Some(value) => Some(value),
        None if field.may_be_number() => {
            let number = field.number(Dimension::NONE);
            number.map(|number| number != 0.0)
        }
        None => field.boolean(),
    };
    value.unwrap_or(true)
}

/// Help for a reference to something that takes no part.
pub(crate) const HELP: &str = "remove `active = false` there, or leave the name out here";
