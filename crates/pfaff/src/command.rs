//! Values of options on a command line.

use clap::builder::{PossibleValuesParser, TypedValueParser};

/// Parses one of the names of an enum. For any other text, the error lists the names.
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
