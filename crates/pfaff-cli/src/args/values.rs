//! Values of options: names of which one is chosen, and names that are no longer part of runs.

use std::ffi::OsStr;

use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use clap::error::ErrorKind;
use pfaff::dynamics::options::moved;

/// Reads one of the names of an enum; for another text the error lists the names.
pub fn named<T: Copy + Send + Sync + 'static>(
    all: &'static [T],
    name: fn(T) -> &'static str,
) -> impl TypedValueParser<Value = T> {
    let names = all.iter().map(|value| name(*value));
    PossibleValuesParser::new(names).try_map(move |text| {
        let found = all.iter().find(|value| name(**value) == text);
        found.copied().ok_or("no such name")
    })
}

/// Reads one of the names of an option of a run; for the name of a method that is no longer part of
/// runs, the error says what to use instead.
pub(super) fn chosen<T: Copy + Send + Sync + 'static>(
    key: &'static str,
    all: &'static [T],
    name: fn(T) -> &'static str,
) -> impl TypedValueParser<Value = T> {
    Moved {
        key,
        then: named(all, name),
    }
}

/// A parser that first refuses names that are no longer part of runs.
#[derive(Clone)]
struct Moved<P> {
    key: &'static str,
    then: P,
}

impl<P: TypedValueParser> TypedValueParser for Moved<P> {
    type Value = P::Value;

    fn parse_ref(
        &self,
        command: &clap::Command,
        argument: Option<&clap::Arg>,
        value: &OsStr,
    ) -> Result<Self::Value, clap::Error> {
        match value.to_str().and_then(|text| moved(self.key, text)) {
            Some(words) => Err(
                clap::Error::raw(ErrorKind::InvalidValue, format!("{words}\n")).with_cmd(command),
            ),
            None => self.then.parse_ref(command, argument, value),
        }
    }

    fn possible_values(&self) -> Option<Box<dyn Iterator<Item = PossibleValue> + '_>> {
        self.then.possible_values()
    }
}

/// Refuses every formulation; the error says what to use instead.
pub(super) fn no_formulation(text: &str) -> Result<String, String> {
    let words = moved("formulation", text);
    Err(words.unwrap_or_else(|| "a run has one formulation".to_owned()))
}

/// A joint and a value of its coordinate.
pub(super) fn joint_value(text: &str) -> Result<(String, f64), String> {
    let (name, value) = text.rsplit_once('=').ok_or("expected JOINT=VALUE")?;
    let number = value.trim().parse().ok().filter(|x: &f64| x.is_finite());
    let number = number.ok_or_else(|| format!("`{value}` is not a finite number"))?;
    Ok((name.trim().to_owned(), number))
}
