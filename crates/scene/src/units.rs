//! Explains numbers with units in values for which the format does not permit units. The advice
//! contains the value in the units of the format. The author can copy this value.

use linalg::Dd;

use crate::dimension::Dimension;
use crate::expression::{evaluate, in_units_here};
use crate::language::Language;

/// A number with a unit, such as `300 mm`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WithUnit<'a> {
    /// The number.
    pub number: f64,
    /// The unit in the form given in the text.
    pub unit: &'a str,
    /// The dimension of the number. The product of `number` and [`Self::factor`] is the value in SI
    /// units.
    dimension: Dimension,
    factor: Dd,
}

impl<'a> WithUnit<'a> {
    /// Reads a number with one of the units of expressions. Returns `None` for other texts.
    ///
    /// ```
    /// let length = pfaff_scene::WithUnit::read("300mm").unwrap();
    /// assert_eq!((length.number, length.unit, length.in_si(0.5)), (300.0, "mm", 0.0005));
    /// assert!(pfaff_scene::WithUnit::read("300").is_none() && pfaff_scene::WithUnit::read("3 furlongs").is_none());
    /// ```
    #[must_use]
    pub fn read(text: &'a str) -> Option<Self> {
        let (number, _, unit) = split(text.trim())?;
        let of = evaluate(&format!("1*({unit})"), &Language::PLAIN).ok()?;
        Some(Self {
            number: number
                .replace('_', "")
                .parse()
                .ok()
                .filter(|x: &f64| x.is_finite())?,
            unit,
            dimension: of.dimension?,
            factor: of.value,
        })
    }

    /// Converts another number in this unit to SI.
    #[must_use]
    pub fn in_si(&self, number: f64) -> f64 {
        (Dd::from(number) * self.factor).to_f64()
    }

    /// Returns whether both units have the same dimension.
    #[must_use]
    pub fn is_like(&self, other: &Self) -> bool {
        self.dimension == other.dimension
    }
}

/// Returns advice for a text that starts with a number and a unit; the advice contains the
/// converted number. Returns `None` for other texts.
pub(crate) fn advice(text: &str) -> Option<String> {
    let (number, between, unit) = split(text)?;
    const RULE: &str =
        "numbers are in SI units and radians, or in quotes with `format = 2` in `[scene]`";
    let of = in_units_here(unit).unwrap_or(unit);
    let Ok(value) = evaluate(&format!("{number}*({of})"), &Language::PLAIN) else {
        return Some(RULE.to_owned());
    };
    let value = value.to_f64();
    let written = if number.parse() == Ok(value) {
        number.to_owned()
    } else {
        value.to_string()
    };
    Some(format!(
        "{RULE}: write `{written}` instead of `{number}{between}{unit}`"
    ))
}

/// Returns the number with its unit at the start of a text.
pub(crate) fn with_unit(text: &str) -> Option<&str> {
    let (number, between, unit) = split(text)?;
    text.get(..number.len() + between.len() + unit.len())
}

/// Splits a text into a number, spaces, and the unit after them.
fn split(text: &str) -> Option<(&str, &str, &str)> {
    // The longest initial part that is a number; for example, the `e` of `2 e` or `2eggs` is not an
    // exponent.
    let sign = |c: char| c.is_ascii_digit() || "+-.eE_".contains(c);
    let most = text.find(|c| !sign(c)).unwrap_or(text.len());
    let ends = (1..=most).rev();
    let number = ends.map(|end| &text[..end]).find(|n| is_number(n))?;
    let rest = &text[number.len()..];
    let behind = rest.trim_start();
    let between = &rest[..rest.len() - behind.len()];
    let is_unit = behind.starts_with(|c: char| c.is_alphabetic() || "°%µ".contains(c))
        || behind.starts_with("1/");
    let end = behind.find([',', ']', '}', '#', ';', '"', '\'']);
    let unit = behind[..end.unwrap_or(behind.len())].trim_end();
    is_unit.then_some((number, between, unit))
}

/// Whether a text is a number of the format.
pub(crate) fn is_number(text: &str) -> bool {
    let digits = |c: char| c.is_ascii_digit();
    text.ends_with(digits) && text.contains(digits) && text.replace('_', "").parse::<f64>().is_ok()
}

/// Returns the value in SI of a text that contains a finite number in SI, or a number with a unit
/// of the same dimension.
///
/// ```
/// use pfaff_scene::in_si;
///
/// assert_eq!((in_si("0.2", "1 m"), in_si("200 mm", "1 m")), (Some(0.2), Some(0.2)));
/// assert_eq!((in_si("2 kg", "1 m"), in_si("inf", "1 m")), (None, None));
/// ```
#[must_use]
pub fn in_si(text: &str, like: &str) -> Option<f64> {
    let text = text.trim();
    let number = match text.parse() {
        Ok(number) => number,
        Err(_) => {
            let with_unit = WithUnit::read(text)?;
            let is_like = WithUnit::read(like).is_some_and(|unit| unit.is_like(&with_unit));
            with_unit.in_si(is_like.then_some(with_unit.number)?)
        }
    };
    Some(number).filter(|x: &f64| x.is_finite())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_meant_is_told_in_units_of_the_format() {
        for (text, expected) in [
            ("2.0 kg", "write `2.0` instead of `2.0 kg`"),
            ("30°", "write `0.5235987755982989` instead of `30°`"),
            ("500 mm, 0.0]", "write `0.5` instead of `500 mm`"),
            ("2000g # light", "write `2` instead of `2000g`"),
            (
                "1500 rpm",
                "write `157.07963267948966` instead of `1500 rpm`",
            ),
            ("-2.5e3 N", "write `-2.5e3` instead of `-2.5e3 N`"),
            ("1e5 e", "`format = 2` in `[scene]`"),
            ("6 1/s", "write `6` instead of `6 1/s`"),
        ] {
            let said = advice(text).unwrap_or_default();
            assert!(said.ends_with(expected), "{text}: {said}");
        }
        // For an unknown unit, the advice contains only the rule, because the factor of the unit is
        // not known.
        let rule =
            "numbers are in SI units and radians, or in quotes with `format = 2` in `[scene]`";
        assert_eq!(advice("3 furlongs").as_deref(), Some(rule));
        for silent in [
            "", "kg", "2.0", "2,5", "1/2", "ü", "e", "2 # kg", "-", "1e5", "1e5 #e",
        ] {
            assert_eq!(advice(silent), None, "{silent}");
        }
    }
}
