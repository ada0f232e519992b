//! Plots errors over the extreme quantity, with one panel for each family and each varied quantity.

use report::figures::{self, Extremes};

use super::document::{StressFamily, StressRow};

/// Returns the figure of all families with a varied quantity; the text is empty if there are no
/// such families. If all cases of a panel have the same bound, a dashed line shows this bound. A
/// case that ends with an error message has no point in the figure.
#[must_use]
pub fn extremes(families: &[StressFamily]) -> String {
    let panels: Vec<Extremes<'_>> = families.iter().flat_map(panels).collect();
    figures::extremes(&panels)
}

/// Returns the panels of a family, in the order in which the varied quantities first appear.
fn panels(family: &StressFamily) -> Vec<Extremes<'_>> {
    let varied = family.rows.iter().filter_map(|row| row.varied);
    let panel = |varied: &'static str| {
        let of_it = |row: &&StressRow| row.varied.is_some_and(|(name, _)| name == varied);
        let rows: Vec<&StressRow> = family.rows.iter().filter(of_it).collect();
        let first = rows.first().map_or(f64::NAN, |row| row.bound);
        Extremes {
            title: family.name,
            varied,
            series: series(&rows),
            bound: rows.iter().all(|row| row.bound == first).then_some(first),
        }
    };
    distinct(varied.map(|(name, _)| name))
        .into_iter()
        .map(panel)
        .collect()
}

/// Returns one curve for each formulation, or one for each method if there is only one formulation.
fn series<'r>(rows: &[&'r StressRow]) -> Vec<(&'r str, Vec<[f64; 2]>)> {
    let alike = rows
        .windows(2)
        .all(|w| w[0].formulation == w[1].formulation);
    let name = |row: &'r StressRow| {
        if alike {
            row.method.as_str()
        } else {
            row.formulation.as_str()
        }
    };
    let curve = |own: &'r str| {
        let rows = rows.iter().filter(|row| name(row) == own);
        let points = rows.map(|row| [row.varied.map_or(f64::NAN, |(_, x)| x), row.error]);
        (own, points.collect())
    };
    distinct(rows.iter().map(|row| name(row)))
        .into_iter()
        .map(curve)
        .collect()
}

/// Returns names in the order of their first occurrence.
fn distinct<'a>(names: impl Iterator<Item = &'a str>) -> Vec<&'a str> {
    let mut first: Vec<&str> = Vec::new();
    for name in names {
        if !first.contains(&name) {
            first.push(name);
        }
    }
    first
}
