//! Text formatting of lists, numbers and vectors.

use model::words::vector as quantities;
use model::{ConstraintId, Layout, Mechanism, System};

/// Formats a list as "`a`, `b` and `c`" without the quotes.
pub(crate) fn list(words: &[String]) -> String {
    match words {
        [] => String::new(),
        [one] => one.clone(),
        [first @ .., last] => format!("{} and {last}", first.join(", ")),
    }
}

/// Formats a vector as "(0.25, −1, 0)" without the quotes. Numbers below a share of `size` are
/// zero.
pub(crate) fn vector(p: [f64; 3], size: f64) -> String {
    components(&p, size)
}

/// Formats the coordinates of a point (m) as "(0.25, −1) m" without the quotes, in the unit of the
/// scene.
pub(crate) fn place(p: &[f64], size: f64) -> String {
    quantities(p, size, "m")
}

/// Formats any number of components in the same way as [`vector`].
pub(crate) fn components(p: &[f64], size: f64) -> String {
    quantities(p, size, "")
}

/// Returns the names of joints and drives, in quotes.
pub(crate) fn names(layout: &Layout, ids: &[ConstraintId]) -> Vec<String> {
    let name = |id: &ConstraintId| format!("`{}`", layout.groups[id.0].name);
    ids.iter().map(name).collect()
}

/// Returns a sentence on rows whose dependencies are undecided because of a stated tolerance.
pub(crate) fn open(mechanism: &Mechanism, rows: &[usize]) -> String {
    let layout = mechanism.layout();
    let touched = |id: &ConstraintId| {
        let own = &layout.groups[id.0].rows;
        rows.iter().any(|row| own.contains(*row))
    };
    let ids: Vec<ConstraintId> = mechanism
        .layout()
        .constraint_ids()
        .filter(touched)
        .collect();
    format!(
        "within the tolerance it is undecided which rows of {} depend on each other; these dependencies are not listed",
        list(&names(layout, &ids))
    )
}
