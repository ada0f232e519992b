//! The kinds of mistakes in the text of a scene, each with its code. Errors of the described
//! mechanism, of its initial state and of its runs have the codes of their own error types.

use joints::ArgumentError;
use model::codes::Code;

use crate::combination::CombinationProblem;
use crate::expression::Problem;

/// A kind of mistake in the text of a scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Mistake {
    /// The text is not valid TOML.
    NotToml,
    /// A table does not have a key with this name.
    UnknownKey,
    /// A key is missing in a table, or a table is missing in the scene.
    Missing,
    /// A name or a key is given twice.
    Twice,
    /// The value has another type than its key requires.
    Type,
    /// A text is not an expression.
    Syntax,
    /// The list does not contain all problems.
    More,
    /// A name that is not permitted for any item.
    UnfitName,
    /// A name that already has another meaning.
    ReservedName,
    /// A number outside of its range.
    OutOfRange,
    /// A number that is not finite.
    NotFinite,
    /// A direction of length zero.
    NoDirection,
    /// A text that is too large to be read.
    TooLarge,
    /// A text that is not an allowed value of its key.
    UnknownChoice,
    /// Keys of one table that must not be given together.
    Exclusive,
    /// An unknown type of a joint, force, function or measure.
    UnknownType,
    /// The times of a table do not cover the whole run.
    Uncovered,
    /// The number of bodies is wrong.
    BodyCount,
    /// A body that does not exist.
    UnknownBody,
    /// A marker that does not exist.
    UnknownMarker,
    /// A joint or drive that does not exist.
    UnknownJoint,
    /// A joint does not have this joint coordinate.
    UnknownMeasure,
    /// A force along an angle, or a torque along a length.
    OtherLoad,
    /// A reference to an item that is not active.
    Inactive,
    /// A marker that belongs to a wrong body.
    ForeignMarker,
    /// The joints listed as `bearings` do not connect two wheels to the same carrier.
    Bearings,
    /// An output with too many rows.
    TooManyRows,
    /// An entry that needs `format = 2`.
    NeedsFormat,
    /// Parameters that depend on each other in a cycle.
    Circle,
    /// An unknown name in an expression.
    UnknownInExpression,
    /// Units that do not agree.
    Units,
    /// An expression without a finite value.
    NoValue,
    /// Registered definitions of joints that do not satisfy the requirements of the reader.
    Registry,
    /// A list without entries.
    EmptyList,
    /// A list with the wrong number of values.
    Count,
    /// A coordinate that does not exist.
    UnknownCoordinate,
    /// A row that does not exist.
    UnknownRow,
    /// A combination of reactions that cannot be read.
    Combination,
}

impl Mistake {
    /// Error code; see [`model::codes`].
    pub(crate) fn code(self) -> Code {
        match self {
            Self::NotToml => const { Code::new(101) },
            Self::UnknownKey => const { Code::new(102) },
            Self::Missing => const { Code::new(103) },
            Self::Twice => const { Code::new(104) },
            Self::Type => const { Code::new(105) },
            Self::Syntax => const { Code::new(106) },
            Self::More => const { Code::new(107) },
            Self::UnfitName => const { Code::new(108) },
            Self::ReservedName => const { Code::new(109) },
            Self::OutOfRange => const { Code::new(110) },
            Self::NotFinite => const { Code::new(111) },
            Self::NoDirection => const { Code::new(112) },
            Self::TooLarge => const { Code::new(113) },
            Self::UnknownChoice => const { Code::new(114) },
            Self::Exclusive => const { Code::new(115) },
            Self::UnknownType => const { Code::new(116) },
            Self::Uncovered => const { Code::new(119) },
            Self::BodyCount => const { Code::new(126) },
            Self::UnknownBody => const { Code::new(127) },
            Self::UnknownMarker => const { Code::new(135) },
            Self::UnknownJoint => const { Code::new(137) },
            Self::UnknownMeasure => const { Code::new(138) },
            Self::OtherLoad => const { Code::new(139) },
            Self::Inactive => const { Code::new(140) },
            Self::ForeignMarker => const { Code::new(141) },
            Self::TooManyRows => const { Code::new(142) },
            Self::NeedsFormat => const { Code::new(144) },
            Self::Circle => const { Code::new(145) },
            Self::UnknownInExpression => const { Code::new(146) },
            Self::Units => const { Code::new(147) },
            Self::NoValue => const { Code::new(148) },
            Self::Registry => const { Code::new(149) },
            Self::EmptyList => const { Code::new(150) },
            Self::Count => const { Code::new(151) },
            Self::Bearings => const { Code::new(154) },
            Self::UnknownCoordinate => const { Code::new(205) },
            Self::UnknownRow => const { Code::new(310) },
            Self::Combination => const { Code::new(311) },
        }
    }
}

impl From<Mistake> for Code {
    fn from(mistake: Mistake) -> Self {
        mistake.code()
    }
}

impl From<&ArgumentError> for Mistake {
    fn from(error: &ArgumentError) -> Self {
        match error {
            ArgumentError::Count { .. } | ArgumentError::Missing { .. } => Self::Registry,
            ArgumentError::Shape { .. } => Self::Type,
            ArgumentError::NotFinite { .. } => Self::NotFinite,
            ArgumentError::Negative { .. } => Self::OutOfRange,
            ArgumentError::NoDirection { .. } => Self::NoDirection,
            // Other errors that definitions may report concern a value.
            _ => Self::OutOfRange,
        }
    }
}

impl From<&Problem> for Mistake {
    fn from(problem: &Problem) -> Self {
        match problem {
            Problem::Empty
            | Problem::Long { .. }
            | Problem::Sign { .. }
            | Problem::NoOperand { .. }
            | Problem::NoOperator { .. }
            | Problem::Comma
            | Problem::Open
            | Problem::Closed
            | Problem::Deep { .. }
            | Problem::NoBrackets { .. }
            | Problem::Count { .. } => Self::Syntax,
            Problem::UnknownName { .. } | Problem::UnknownFunction { .. } => {
                Self::UnknownInExpression
            }
            Problem::Twice { .. } => Self::ReservedName,
            Problem::Dimension { .. }
            | Problem::Mixed { .. }
            | Problem::Exponent { .. }
            | Problem::PowerOfUnit { .. }
            | Problem::Root { .. }
            | Problem::Pi => Self::Units,
            Problem::DivisionByZero
            | Problem::Undefined { .. }
            | Problem::OnlyInLaw { .. }
            | Problem::Overflow => Self::NoValue,
        }
    }
}

impl From<&CombinationProblem> for Mistake {
    fn from(problem: &CombinationProblem) -> Self {
        match problem {
            CombinationProblem::UnknownReaction { .. } => Self::UnknownJoint,
            CombinationProblem::Inactive { .. } => Self::Inactive,
            CombinationProblem::NoTerm
            | CombinationProblem::NoSign { .. }
            | CombinationProblem::Mixed { .. }
            | CombinationProblem::NoTimes { .. }
            | CombinationProblem::UnknownComponent { .. }
            | CombinationProblem::NotFinite { .. } => Self::Combination,
        }
    }
}
