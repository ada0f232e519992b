//! The key `active`: joints, drives, forces and groups with `active = false` are read and checked,
//! but they are not part of the mechanism.

use crate::dimension::Dimension;
use crate::key::{Key, Takes};
use crate::table::Table;

/// The key `active` of joints, drives, forces and groups.
pub(crate) const ACTIVE: Key = Key::optional("active", "true or false", Takes::Switch)
    .doc("Whether the element is active; inactive elements are read and checked, but not used. A number or an expression is false if it is zero")
    .or(|| true.into());

/// Returns whether the item of a table is part of the mechanism. An unreadable value is reported
/// and counts as `true`. This function does not mark the key as known, because the key is the last
/// one of its table.
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

/// Advice for a reference to an inactive item.
pub(crate) const HELP: &str = "remove `active = false` there, or leave the name out here";
