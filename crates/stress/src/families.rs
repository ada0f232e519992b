//! The list of families: one line each, and a file of its own for each.

mod accelerations;
mod trivial;

use crate::case::Family;

/// All families, in the order of the report.
#[must_use]
pub fn families() -> Vec<Family> {
    vec![trivial::FAMILY, accelerations::FAMILY]
}

/// The family of this name.
#[must_use]
pub fn find(name: &str) -> Option<Family> {
    families().into_iter().find(|family| family.name == name)
}

/// Rows of a family made on one thread, for tests.
#[cfg(test)]
fn rows(family: Family) -> Vec<report::stress::StressRow> {
    crate::run(&[family], std::num::NonZeroUsize::MIN, &|| false, |_| {})
}

/// Asserts that everything in a family is right; prints what is not.
#[cfg(test)]
fn assert_passes(family: Family) {
    for row in rows(family) {
        assert!(row.judgement.passes(), "{row:#?}");
    }
}
