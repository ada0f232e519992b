//! Events during a run that are reported to the user.

/// One event.
#[derive(Clone, Debug, PartialEq)]
pub struct Event {
    /// Time (s).
    pub time: f64,
    /// Kind of event.
    pub kind: EventKind,
    /// Degree of redundancy before.
    pub redundancy_before: usize,
    /// Degree of redundancy after.
    pub redundancy_after: usize,
    /// Rows dropped after the event, from 0.
    pub dropped: Vec<usize>,
    /// Description.
    pub text: String,
}

impl Event {
    /// An event that does not change the degree of redundancy, with the rows dropped after it.
    pub(crate) fn at(time: f64, kind: EventKind, dropped: &[usize], text: String) -> Self {
        Self {
            time,
            kind,
            redundancy_before: dropped.len(),
            redundancy_after: dropped.len(),
            dropped: dropped.to_vec(),
            text,
        }
    }
}

/// Kinds of events.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum EventKind {
    /// Other rows are kept; the rank is the same.
    RowsExchanged,
    /// A singular configuration was passed: the rank dropped for an instant.
    SingularPassage,
    /// A rate, and with it the velocities, jumped.
    Impulse,
    /// Generated code was no longer reliable: the equations are interpreted from here on.
    CodeLeft,
    /// Generated code is used again.
    CodeUsed,
}

impl EventKind {
    /// Whether another stretch of verdicts begins with it.
    #[must_use]
    pub fn cuts(self) -> bool {
        match self {
            Self::RowsExchanged | Self::SingularPassage | Self::Impulse => true,
            Self::CodeLeft | Self::CodeUsed => false,
        }
    }

    /// Its name in output files.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::RowsExchanged => "rows-exchanged",
            Self::SingularPassage => "singular-passage",
            Self::Impulse => "impulse",
            Self::CodeLeft => "code-left",
            Self::CodeUsed => "code-used",
        }
    }
}
