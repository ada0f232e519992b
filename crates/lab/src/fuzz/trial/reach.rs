//! The stage that a text reached, and the limits of a trial.

use std::fmt;

use pfaff::StudyError;

/// Limits of a run: end time (s), number of steps, and number of rows.
pub(crate) const T_END: f64 = 0.25;
pub(crate) const STEPS: usize = 60;
pub(crate) const ROWS: usize = 60;

/// The last stage that a text reached.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Reach {
    /// The text is not a valid scene.
    Refused,
    /// The text is a scene without a consistent initial state.
    NoStart,
    /// The reactions were analysed, but no motion can begin at the initial state.
    JudgedStart,
    /// A simulation began, and stopped with an error message.
    Stopped,
    /// A simulation was ended early, because it reached the limits of a trial.
    Cut,
    /// A simulation reached its end time.
    Moved,
}

impl Reach {
    /// All stages, in ascending order.
    pub const ALL: [Self; 6] = [
        Self::Refused,
        Self::NoStart,
        Self::JudgedStart,
        Self::Stopped,
        Self::Cut,
        Self::Moved,
    ];

    /// Returns the letter of the stage in the answers of a process.
    #[must_use]
    pub fn letter(self) -> char {
        match self {
            Self::Refused => 'r',
            Self::NoStart => 'n',
            Self::JudgedStart => 'j',
            Self::Stopped => 's',
            Self::Cut => 'c',
            Self::Moved => 'm',
        }
    }
}

impl fmt::Display for Reach {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Refused => "refused",
            Self::NoStart => "without a start",
            Self::JudgedStart => "judged",
            Self::Stopped => "stopped by name",
            Self::Cut => "moved, cut off",
            Self::Moved => "moved",
        })
    }
}

/// An error must have a message.
pub(super) fn named(error: &StudyError) {
    assert!(
        !error.to_string().trim().is_empty(),
        "an error without words: {error:?}"
    );
}
