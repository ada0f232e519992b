//! Numbers and lists in messages, short enough to be read.

/// Names of a list that is written out; a longer one is its first names and a count.
pub const LISTED: usize = 12;

/// Names that stand for a longer list.
const FIRST: usize = 3;

/// Names separated by commas; of more than [`LISTED`] the first three and the number of the others.
///
/// ```
/// let names = |n: usize| (1..=n).map(|k| format!("W{k}")).collect::<Vec<_>>();
/// assert_eq!(model::words::listed(&names(2)), "W1, W2");
/// assert_eq!(model::words::listed(&names(40)), "W1, W2, W3 and 37 more");
/// ```
#[must_use]
pub fn listed<S: AsRef<str>>(names: &[S]) -> String {
    let shown = if names.len() > LISTED {
        FIRST
    } else {
        names.len()
    };
    let first: Vec<&str> = names[..shown].iter().map(AsRef::as_ref).collect();
    match names.len() - shown {
        0 => first.join(", "),
        more => format!("{} and {more} more", first.join(", ")),
    }
}

/// A number with six significant digits.
///
/// ```
/// assert_eq!(model::words::rounded(0.500_000_000_001), "0.5");
/// assert_eq!(model::words::rounded(1234.5678), "1234.57");
/// assert_eq!(model::words::rounded(1.234_567_8e-9), "1.23457e-9");
/// ```
#[must_use]
pub fn rounded(x: f64) -> String {
    let short: f64 = format!("{x:.5e}").parse().unwrap_or(x);
    match short.abs() {
        size if size != 0.0 && !(1e-4..1e7).contains(&size) => format!("{short:e}"),
        _ => short.to_string(),
    }
}
