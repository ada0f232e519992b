//! Short numbers and lists in messages.

/// Largest number of names that are listed completely. A longer list consists of its first names
/// and a count.
pub const LISTED: usize = 12;

/// Number of names that represent a longer list.
const FIRST: usize = 3;

/// Returns names separated by commas. If there are more than [`LISTED`], it returns the first three
/// and the number of the others.
///
/// ```
/// let names = |n: usize| (1..=n).map(|k| format!("W{k}")).collect::<Vec<_>>();
/// assert_eq!(pfaff_model::words::listed(&names(2)), "W1, W2");
/// assert_eq!(pfaff_model::words::listed(&names(40)), "W1, W2, W3 and 37 more");
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

/// Returns a number with six significant digits.
///
/// ```
/// assert_eq!(pfaff_model::words::rounded(0.500_000_000_001), "0.5");
/// assert_eq!(pfaff_model::words::rounded(1234.5678), "1234.57");
/// assert_eq!(pfaff_model::words::rounded(1.234_567_8e-9), "1.23457e-9");
/// ```
#[must_use]
pub fn rounded(x: f64) -> String {
    let short: f64 = format!("{x:.5e}").parse().unwrap_or(x);
    match short.abs() {
        size if size != 0.0 && !(1e-4..1e7).contains(&size) => format!("{short:e}"),
        _ => short.to_string(),
    }
}

/// Units of lengths (m), each with the smallest length that is printed in it. Hundredths of a
/// millimetre are common, but hundredths of a metre are not. The bounds are slightly smaller
/// because of rounding.
const UNITS: [(f64, f64, &str); 4] = [
    (1.0, 0.099, "m"),
    (1e-3, 0.99e-5, "mm"),
    (1e-6, 0.99e-7, "µm"),
    (1e-9, 0.99e-10, "nm"),
];

/// Formats a length (m) with two digits, in the common unit for its size.
///
/// ```
/// assert_eq!(pfaff_model::words::length(3.58e-4), "0.36 mm");
/// ```
#[must_use]
pub fn length(metres: f64) -> String {
    let two_digits = |x: f64| format!("{x:.1e}").parse().unwrap_or(x);
    let metres: f64 = two_digits(metres);
    let said = UNITS.into_iter().find(|(_, from, _)| metres >= *from);
    let (one, _, unit) = said.unwrap_or(UNITS[0]);
    let number: f64 = two_digits(metres / one);
    if (0.01..1e4).contains(&number) {
        format!("{number} {unit}")
    } else {
        format!("{metres:.1e} m")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lengths_have_the_unit_that_people_say() {
        for (metres, said) in [
            (1e-4, "0.1 mm"),
            (5.04e-5, "0.05 mm"),
            (4.96e-5, "0.05 mm"),
            (4.94e-5, "0.049 mm"),
            (1e-5, "0.01 mm"),
            (9.8e-6, "9.8 µm"),
            (1e-2, "10 mm"),
            (1e-3, "1 mm"),
            (0.15, "0.15 m"),
            (2.0, "2 m"),
            (1.3e-6, "1.3 µm"),
            (4e-10, "0.4 nm"),
            (3e-12, "3.0e-12 m"),
            (1e9, "1.0e9 m"),
        ] {
            assert_eq!(length(metres), said);
        }
    }
}
