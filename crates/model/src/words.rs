//! Short numbers and lists in messages.

mod units;

pub use units::{
    SceneUnits, UnitSystem, in_same_units, in_units, in_units_of_scenes, read_in, units,
};

/// Largest number of names that are listed completely. A longer list consists of its first names
/// and a count.
pub const LISTED: usize = 12;

/// Advice for a vehicle whose wheels prevent every motion, as an imperative.
pub const ROLL_TOGETHER: &str = "turn the wheels so that their axles meet in one point, or let a wheel slip (in the plane, a `tyre` instead of its joint)";

/// Number of names that are printed of a longer list.
const FIRST: usize = 3;

/// Returns names separated by commas. If there are more than [`LISTED`] names, the result contains
/// the first three names and the number of the remaining names.
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

/// Returns names in grave accents.
fn in_accents<S: AsRef<str>>(names: &[S]) -> Vec<String> {
    let each = names.iter();
    each.map(|name| format!("`{}`", name.as_ref())).collect()
}

/// Formats names in grave accents, such as `` `A`, `B` ``.
#[must_use]
pub fn marked<S: AsRef<str>>(names: &[S]) -> String {
    in_accents(names).join(", ")
}

/// States what these joints or bodies do, with the verb for one name and for several names.
///
/// ```
/// use pfaff_model::words::clause;
/// assert_eq!(clause(&["A"], ["opens", "open"]), "`A` opens");
/// assert_eq!(clause(&["A", "B"], ["opens", "open"]), "`A`, `B` open");
/// ```
#[must_use]
pub fn clause<S: AsRef<str>>(names: &[S], [one, several]: [&str; 2]) -> String {
    let verb = if names.len() == 1 { one } else { several };
    format!("{} {verb}", listed(&in_accents(names)))
}

/// Returns a number with six significant digits, as a scene accepts it.
///
/// ```
/// assert_eq!(pfaff_model::words::rounded(0.500_000_000_001), "0.5");
/// assert_eq!(pfaff_model::words::rounded(1234.5678), "1234.57");
/// assert_eq!(pfaff_model::words::rounded(1.234_567_8e-9), "1.23457e-9");
/// ```
#[must_use]
pub fn rounded(x: f64) -> String {
    ascii(x, 6)
}

/// Returns a number with four significant digits and a true minus sign, for readers.
///
/// ```
/// assert_eq!(pfaff_model::words::short(-9.810_01), "−9.81");
/// assert_eq!(pfaff_model::words::short(5.4e-12), "5.4e-12");
/// ```
#[must_use]
pub fn short(x: f64) -> String {
    digits(x, 4)
}

/// Returns a whole number with its digits in groups of three.
///
/// ```
/// assert_eq!([7, 1000, 1_020_003].map(pfaff_model::words::whole), ["7", "1 000", "1 020 003"]);
/// ```
#[must_use]
pub fn whole(n: u64) -> String {
    match n / 1000 {
        0 => n.to_string(),
        thousands => format!("{} {:03}", whole(thousands), n % 1000),
    }
}

/// Returns a number with two significant digits, for errors and bounds of errors.
///
/// ```
/// assert_eq!([0.0, 1.234e-13, 0.42].map(pfaff_model::words::rough), ["0", "1.2e-13", "0.42"]);
/// ```
#[must_use]
pub fn rough(x: f64) -> String {
    digits(x, 2)
}

/// Returns a number with this number of significant digits and a true minus sign.
#[must_use]
pub fn digits(x: f64, digits: usize) -> String {
    ascii(x, digits).replacen('-', if x < 0.0 { "−" } else { "-" }, 1)
}

fn ascii(x: f64, digits: usize) -> String {
    // The sum removes the sign of a zero.
    let short = to_digits(x, digits) + 0.0;
    match short.abs() {
        size if size != 0.0 && !(1e-4..1e7).contains(&size) => format!("{short:e}"),
        _ => short.to_string(),
    }
}

/// Rounds to this number of significant digits.
fn to_digits(x: f64, digits: usize) -> f64 {
    let text = format!("{x:.*e}", digits.saturating_sub(1));
    text.parse().unwrap_or(x)
}

/// Numbers from this size on have no prefix.
const MOST: f64 = 1e10;

/// A prefix of units, such as `k` in kN.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Prefix {
    /// The symbol.
    pub symbol: &'static str,
    /// The value of the prefix.
    pub factor: f64,
}

impl Prefix {
    /// No prefix.
    pub const NONE: Self = Self {
        symbol: "",
        factor: 1.0,
    };

    /// Prefixes, each with the smallest number of units that is printed with the prefix. Hundredths
    /// of a millimetre are common, but hundredths of a metre are not. The bounds are slightly
    /// smaller because of rounding.
    pub const ALL: [(f64, Self); 6] = [
        (0.9995e6, Self::new("M", 1e6)),
        (0.9995e3, Self::new("k", 1e3)),
        (0.099, Self::NONE),
        (0.99e-5, Self::new("m", 1e-3)),
        (0.99e-7, Self::new("µ", 1e-6)),
        (0.99e-10, Self::new("n", 1e-9)),
    ];

    /// Symbols of units that may have a prefix.
    pub const UNITS: [&str; 8] = ["N", "J", "W", "m", "rad", "s", "Hz", "Pa"];

    const fn new(symbol: &'static str, factor: f64) -> Self {
        Self { symbol, factor }
    }

    /// Returns the prefix for numbers of this size in a unit.
    ///
    /// ```
    /// use pfaff_model::words::Prefix;
    /// assert_eq!(Prefix::of(3400.8, "N·m").symbol, "k");
    /// assert_eq!(Prefix::of(3400.8, "kg"), Prefix::NONE);
    /// ```
    #[must_use]
    pub fn of(size: f64, unit: &str) -> Self {
        let end = unit.find(['·', '/']).unwrap_or(unit.len());
        if !Self::UNITS.contains(&&unit[..end]) {
            return Self::NONE;
        }
        let found = Self::ALL.iter().find(|(from, _)| size >= *from);
        match found {
            Some((_, prefix)) if size < MOST => *prefix,
            _ => Self::NONE,
        }
    }
}

/// Formats a number with four significant digits and its unit: the unit of the scene (see
/// [`in_units`]), or the SI unit with the prefix for its size.
///
/// ```
/// use pfaff_model::words::quantity;
/// assert_eq!(quantity(-3400.8, "N"), "−3.401 kN");
/// assert_eq!(quantity(0.0, "N·m"), "0 N·m");
/// ```
#[must_use]
pub fn quantity(x: f64, unit: &str) -> String {
    with_unit(x, unit, 4)
}

fn with_unit(x: f64, unit: &str, significant: usize) -> String {
    let (unit, factor) = units().unit(to_digits(x, significant).abs(), unit);
    format!("{} {unit}", digits(x / factor, significant))
}

/// Formats the range between two numbers, with one unit.
///
/// ```
/// assert_eq!(pfaff_model::words::range(20.0, 1200.0, "N"), "0.02 … 1.2 kN");
/// ```
#[must_use]
pub fn range(least: f64, greatest: f64, unit: &str) -> String {
    let (unit, factor) = units().unit(least.abs().max(greatest.abs()), unit);
    format!(
        "{} … {} {unit}",
        short(least / factor),
        short(greatest / factor)
    )
}

/// A component of a vector below this share of the size of the mechanism is rounding. Too small:
/// rounding errors are printed. Too large: small numbers are not printed.
const VISIBLE: f64 = 1e-9;

/// Formats a vector of quantities in the unit of the scene, otherwise in the SI unit without
/// prefix. Components below 1e-9 of `size` are rounding errors and are printed as zero.
///
/// ```
/// assert_eq!(pfaff_model::words::vector(&[0.25, -1.0, 1e-14], 1.0, "m"), "(0.25, −1, 0) m");
/// ```
#[must_use]
pub fn vector(x: &[f64], size: f64, unit: &str) -> String {
    let (unit, factor) = units().unprefixed(unit);
    let visible = |x: &f64| if x.abs() > VISIBLE * size { *x } else { 0.0 };
    let components: Vec<String> = x.iter().map(|x| short(visible(x) / factor)).collect();
    format!("({}) {unit}", components.join(", "))
        .trim_end()
        .to_owned()
}

/// Formats a quantity with two significant digits.
///
/// ```
/// assert_eq!(pfaff_model::words::estimate(3.58e-4, "m"), "0.36 mm");
/// ```
#[must_use]
pub fn estimate(x: f64, unit: &str) -> String {
    with_unit(x, unit, 2)
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
            (3e-12, "3e-12 m"),
            (1e12, "1e12 m"),
        ] {
            assert_eq!(estimate(metres, "m"), said);
        }
    }

    #[test]
    fn rounding_errors_of_vectors_are_zero() {
        let text = |x: f64| vector(&[0.0, x], 2.0, "m");
        assert_eq!([text(1e-9), text(-4e-9)], ["(0, 0) m", "(0, −4e-9) m"]);
    }

    #[test]
    fn a_prefix_keeps_one_to_three_digits_before_the_point() {
        for (x, unit, said) in [
            (999.4, "N", "999.4 N"),
            (999.96, "N", "1 kN"),
            (-12_345.0, "N·m", "−12.35 kN·m"),
            (2.5e6, "N/m", "2.5 MN/m"),
            (0.033, "N·m", "33 mN·m"),
            (1234.0, "kg", "1234 kg"),
            (1234.0, "m²", "1234 m²"),
            (1234.0, "", "1234 "),
            (f64::NAN, "N", "NaN N"),
            (f64::INFINITY, "N", "inf N"),
        ] {
            assert_eq!(quantity(x, unit), said);
        }
        assert_eq!(digits(-1.5e-9, 2), "−1.5e-9");
        assert_eq!(digits(-0.0, 2), "0");
    }
}
