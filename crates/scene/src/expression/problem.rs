//! The kinds of errors in an expression.

use std::ops::Range;

use joints::LARGEST;
use model::words::rounded;

use super::unit::{TIME, in_units_here, names_of};
use crate::dimension::Dimension;

/// An error, and its position in the text.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Fault {
    pub(crate) span: Range<usize>,
    pub(crate) problem: Problem,
}

/// A kind of error.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub(crate) enum Problem {
    #[error("the text is empty")]
    Empty,
    #[error("the text is longer than {most} bytes")]
    Long { most: usize },
    #[error("`{sign}` has no meaning in an expression")]
    Sign { sign: char },
    #[error("a number, a name or `(` is missing{}", before(.found))]
    NoOperand { found: String },
    #[error("an operator is missing before `{found}`")]
    NoOperator { found: String },
    #[error("`,` is outside of the arguments of a function")]
    Comma,
    #[error("a bracket is never closed")]
    Open,
    #[error("`)` closes no bracket")]
    Closed,
    #[error("brackets, powers and signs are nested deeper than {most}")]
    Deep { most: usize },
    #[error("there is no parameter `{name}`")]
    UnknownName { name: String },
    #[error("`{name}` is a parameter and {}", variable(name))]
    Twice { name: &'static str },
    #[error("there is no function `{name}`")]
    UnknownFunction { name: String },
    #[error("`{name}` is a function")]
    NoBrackets { name: &'static str },
    #[error("`{name}` takes {expected}, found {found}")]
    Count {
        name: &'static str,
        expected: &'static str,
        found: usize,
    },
    #[error("found {}, need {}", .found.words(), .expected.words())]
    Dimension {
        found: Dimension,
        expected: Dimension,
    },
    #[error("{} and {} have no sum, difference or order", .a.words(), .b.words())]
    Mixed { a: Dimension, b: Dimension },
    #[error("an exponent is {}", .found.words())]
    Exponent { found: Dimension },
    #[error("{} has whole powers up to 64 only", .of.words())]
    PowerOfUnit { of: Dimension },
    #[error("{} has no square root", .of.words())]
    Root { of: Dimension },
    #[error("a number with `pi` is an angle here, but angles without a unit are not in radians")]
    Pi,
    #[error("division by zero")]
    DivisionByZero,
    #[error("{name} is not defined for {}", rounded(*.value))]
    Undefined { name: &'static str, value: f64 },
    #[error("`{name}` needs a law of a drive: it has a state")]
    OnlyInLaw { name: &'static str },
    #[error("the result is not a number up to {LARGEST:e}")]
    Overflow,
}

/// Describes a variable of force laws and functions of time.
fn variable(name: &str) -> String {
    match name {
        TIME => "the time".to_owned(),
        name => format!("the {name} of a drive"),
    }
}

fn before(found: &str) -> String {
    match found {
        "" => " at the end".to_owned(),
        found => format!(" before `{found}`"),
    }
}

impl Problem {
    /// The text of the mark at the error.
    pub(crate) fn label(&self) -> &'static str {
        match self {
            Self::Empty | Self::NoOperand { .. } => "something is missing here",
            Self::Long { .. } => "too long",
            Self::Sign { .. } => "no sign of expressions",
            Self::NoOperator { .. } => "write an operator before this",
            Self::Comma => "not here",
            Self::Open => "opens here",
            Self::Closed => "closes nothing",
            Self::Deep { .. } => "too deep",
            Self::UnknownName { .. } => "no such parameter",
            Self::UnknownFunction { .. } => "no such function",
            Self::Twice { .. } => "two meanings",
            Self::NoBrackets { .. } => "needs brackets",
            Self::Count { .. } => "not so many values",
            Self::Dimension { .. } => "another unit is needed",
            Self::Mixed { .. } => "units that do not fit",
            Self::Exponent { .. } => "must be a number without a unit",
            Self::PowerOfUnit { .. } | Self::Root { .. } => "has no such unit",
            Self::Pi => "needs its unit",
            Self::DivisionByZero => "is zero",
            Self::Undefined { .. } => "not a number",
            Self::OnlyInLaw { .. } => "not here",
            Self::Overflow => "not a usable number",
        }
    }

    /// Advice, if the expression alone is sufficient to determine it.
    pub(crate) fn help(&self) -> Option<String> {
        Some(match self {
            Self::Empty => "write a number, or an expression as \"2*L\" or \"25 mm\"".to_owned(),
            Self::Sign { .. } => {
                "expressions have numbers, names, units, `+ - * / ^` and `( )`".to_owned()
            }
            Self::NoOperand { found } if found == "*" => "powers are written with `^`".to_owned(),
            Self::NoOperator { found } => match in_units_here(found) {
                Some(here) => format!("`{found}` is `{here}` here"),
                None => format!("to multiply, write `*{found}`"),
            },
            Self::UnknownName { name } => format!("`{name}` is `{}` here", in_units_here(name)?),
            Self::Comma => "decimals follow a point, as `2.5`".to_owned(),
            Self::Open => "write `)` where its content ends".to_owned(),
            Self::Deep { .. } | Self::Long { .. } => {
                "give parts of it names in `[parameters]`".to_owned()
            }
            Self::Twice { .. } => "give the parameter another name".to_owned(),
            Self::NoBrackets { name } => format!("write `{name}(…)`"),
            Self::Dimension { found, expected } if *expected == Dimension::NONE => {
                format!("divide it by its unit, as `/(1 {found})`")
            }
            Self::Dimension { expected, .. } => suffixes(*expected),
            Self::Mixed { .. } => "write both with units of one kind".to_owned(),
            Self::Pi => {
                "write `*rad` behind it, or write the angle in the unit that `units` states"
                    .to_owned()
            }
            Self::Exponent { .. } => "divide it by its unit".to_owned(),
            Self::PowerOfUnit { .. } => "divide it by its unit, or use `sqrt`".to_owned(),
            _ => return None,
        })
    }
}

/// Units for a value of this dimension, as a text for messages.
fn suffixes(of: Dimension) -> String {
    match &names_of(of)[..] {
        [] => format!("write its unit, as `2 {of}`"),
        names => format!(
            "its units are {}",
            crate::nearest::list(names.iter().copied())
        ),
    }
}
