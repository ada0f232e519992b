//! Options of a run that replace the options of the scene.

use std::num::NonZeroUsize;

use dynamics::{Method, Stabilisation};
use report::read_json;
use scene::nearest;
use serde::de::Error;
use serde::{Deserialize, Deserializer};

use crate::refusal::Refusal;

/// Options of the caller that replace those of the scene.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(default, deny_unknown_fields)]
#[cfg_attr(feature = "command", derive(clap::Args))]
pub struct RunOptions {
    /// End time (s)
    #[cfg_attr(
        feature = "command",
        arg(long, value_name = "T", allow_hyphen_values = true)
    )]
    pub t_end: Option<f64>,
    /// Relative tolerance
    #[cfg_attr(
        feature = "command",
        arg(long, value_name = "R", allow_hyphen_values = true)
    )]
    pub rtol: Option<f64>,
    /// Absolute tolerance
    #[cfg_attr(
        feature = "command",
        arg(long, value_name = "A", allow_hyphen_values = true)
    )]
    pub atol: Option<f64>,
    /// Maximum step size (s)
    #[cfg_attr(
        feature = "command",
        arg(long, value_name = "H", allow_hyphen_values = true)
    )]
    pub max_step: Option<f64>,
    /// Maximum number of steps (accepted + rejected)
    #[cfg_attr(feature = "command", arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..)))]
    pub max_steps: Option<u64>,
    /// Integrator
    #[serde(deserialize_with = "method")]
    #[cfg_attr(feature = "schema", schemars(with = "Option<String>"))]
    #[cfg_attr(feature = "command", arg(long, value_name = "M", value_parser = crate::command::named(Method::ALL, Method::name)))]
    pub method: Option<Method>,
    /// Method against constraint drift
    #[serde(deserialize_with = "stabilisation")]
    #[cfg_attr(feature = "schema", schemars(with = "Option<String>"))]
    #[cfg_attr(feature = "command", arg(long, value_name = "S", value_parser = crate::command::named(Stabilisation::ALL, Stabilisation::name)))]
    pub stabilisation: Option<Stabilisation>,
    /// Rows to eliminate (1-based)
    // In the program they are counted from 0.
    #[serde(deserialize_with = "rows")]
    #[cfg_attr(
        feature = "schema",
        schemars(with = "Option<Vec<std::num::NonZeroUsize>>")
    )]
    #[cfg_attr(feature = "command", arg(long, value_name = "ROWS", value_delimiter = ',', value_parser = row))]
    pub drop: Option<Vec<usize>>,
    /// Number of components that are integrated at the same time.
    #[serde(skip)]
    #[cfg_attr(feature = "command", arg(skip))]
    pub threads: Option<NonZeroUsize>,
}

impl RunOptions {
    /// Reads options from a JSON object.
    ///
    /// # Errors
    /// Returns an error that names the invalid option.
    pub fn read(text: &str) -> Result<Self, Refusal> {
        read_json(text).map_err(|e| Refusal::input(without_place(&e).to_owned()))
    }
}

/// Removes the position from a JSON error, because the caller has not written the JSON text.
pub(crate) fn without_place(error: &str) -> &str {
    error
        .rsplit_once(" at line ")
        .map_or(error, |(words, _)| words)
}

pub(crate) const NO_ROW: &str = "row 0 does not exist: rows are counted from 1";

/// Converts rows given by a user (1-based) to rows counted from 0.
pub(crate) fn rows<'d, D: Deserializer<'d>>(reader: D) -> Result<Option<Vec<usize>>, D::Error> {
    let Some(rows) = Option::<Vec<usize>>::deserialize(reader)? else {
        return Ok(None);
    };
    let from_zero: Option<Vec<usize>> = rows.iter().map(|row| row.checked_sub(1)).collect();
    from_zero.map(Some).ok_or_else(|| D::Error::custom(NO_ROW))
}

/// Converts one row of a command line, counted from 1, to a row counted from 0.
///
/// # Errors
/// Returns an error if the text is not a number, or is 0.
#[cfg(feature = "command")]
pub fn row(text: &str) -> Result<usize, String> {
    let row: usize = text
        .parse()
        .map_err(|_| format!("`{text}` is not a row number"))?;
    row.checked_sub(1).ok_or_else(|| NO_ROW.to_owned())
}

fn method<'d, D: Deserializer<'d>>(reader: D) -> Result<Option<Method>, D::Error> {
    named(reader, Method::ALL, Method::name)
}

fn stabilisation<'d, D: Deserializer<'d>>(reader: D) -> Result<Option<Stabilisation>, D::Error> {
    named(reader, Stabilisation::ALL, Stabilisation::name)
}

/// Returns the value with this name, or an error that lists all names.
pub(crate) fn named<'d, D: Deserializer<'d>, T: Copy>(
    reader: D,
    all: &[T],
    name: fn(T) -> &'static str,
) -> Result<Option<T>, D::Error> {
    let Some(text) = Option::<String>::deserialize(reader)? else {
        return Ok(None);
    };
    let found = all.iter().copied().find(|value| name(*value) == text);
    found.map(Some).ok_or_else(|| {
        let names: Vec<&str> = all.iter().map(|value| name(*value)).collect();
        let near = nearest(&text, names.iter().copied());
        let near = near.map_or_else(String::new, |near| format!("; did you mean `{near}`?"));
        D::Error::custom(format!("`{text}` is not one of {}{near}", names.join(", ")))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> Result<RunOptions, String> {
        report::read_json(text)
    }

    #[test]
    fn options_are_those_of_a_user() {
        let expected = RunOptions {
            t_end: Some(2.0),
            method: Some(Method::Radau5),
            drop: Some(vec![5, 20]),
            ..RunOptions::default()
        };
        let text = r#"{ "t_end": 2, "method": "radau5", "drop": [6, 21] }"#;
        assert_eq!(read(text), Ok(expected));
        for (wrong, words) in [
            (r#"{ "method": "euler" }"#, "`euler` is not one of "),
            (r#"{ "drop": [0] }"#, NO_ROW),
            (r#"{ "t_ned": 2 }"#, "t_ned"),
        ] {
            let refused = read(wrong).expect_err(wrong);
            assert!(refused.contains(words), "{refused}");
        }
    }
}
