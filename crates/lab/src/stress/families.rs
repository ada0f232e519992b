//! The list of families. Each family has one line here and a separate file.

mod accelerations;
mod bad_numbers;
mod contradictions;
mod drives;
mod duplicates;
mod far_away;
mod freedom;
mod in_space;
mod invariance;
mod long_runs;
mod massless;
mod near_redundancy;
mod not_finite;
mod passages;
mod rotation;
mod singular;
mod starts;
mod steering;
mod stiff;
mod trivial;

use crate::stress::case::Family;

/// Returns all families, in the order of the report.
#[must_use]
pub fn families() -> Vec<Family> {
    vec![
        trivial::FAMILY,
        passages::FAMILY,
        steering::FAMILY,
        rotation::FAMILY,
        stiff::FAMILY,
        drives::FAMILY,
        far_away::FAMILY,
        freedom::FAMILY,
        not_finite::FAMILY,
        long_runs::FAMILY,
        bad_numbers::FAMILY,
        starts::FAMILY,
        contradictions::FAMILY,
        duplicates::FAMILY,
        near_redundancy::FAMILY,
        singular::FAMILY,
        massless::FAMILY,
        invariance::FAMILY,
        accelerations::FAMILY,
        in_space::FAMILY,
    ]
}

/// Finds the family with this name.
#[must_use]
pub fn find(name: &str) -> Option<Family> {
    families().into_iter().find(|family| family.name == name)
}

/// Asserts that all outcomes of a family are correct; prints the wrong outcomes.
#[cfg(test)]
fn assert_passes(family: Family) {
    assert_passes_where(family, |_| true);
}

/// Asserts that the outcomes of selected cases are correct, for families that would take too long.
#[cfg(test)]
fn assert_passes_where(family: Family, wanted: impl Fn(&crate::stress::Case) -> bool) {
    let mut failures = String::new();
    for case in (family.cases)().into_iter().filter(wanted) {
        let outcome = (case.run)();
        let found = crate::stress::judge(&case.expected, &outcome);
        if !found.passes() {
            let (name, expected) = (&case.name, case.expected.words());
            let by = (&case.method, &case.formulation);
            failures += &format!("{name} {by:?}: {found:?}; {expected}; {outcome:?}\n");
        }
    }
    assert!(failures.is_empty(), "{failures}");
}
