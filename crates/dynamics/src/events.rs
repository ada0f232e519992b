//! What happened during a run that the reader should know.

/// One event.
#[derive(Clone, Debug, PartialEq)]
pub struct Event {
    /// When (s).
    pub time: f64,
    /// What.
    pub kind: EventKind,
    /// Degree of redundancy before.
    pub redundancy_before: usize,
    /// Degree of redundancy after.
    pub redundancy_after: usize,
    /// Rows dropped from now on, from 0.
    pub dropped: Vec<usize>,
    /// In words.
    pub text: String,
}

impl Event {
    /// An event at which the degree of redundancy stays, with the rows dropped from then on.
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
    /// A rate jumped, and velocities with it.
    Impulse,
    /// Generated code was not sure: the equations are interpreted from here on.
    CodeLeft,
    /// Generated code is used again.
    CodeUsed,
}

impl EventKind {
    /// Its name in results.
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
