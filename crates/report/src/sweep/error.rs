//! Errors for files of a sweep that cannot be used.

use std::path::{Path, PathBuf};

use model::codes::Code;

use super::SweepPlan;
use super::line::digest;
use crate::files::FileError;

/// Reason why the files of a sweep cannot be used.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum JournalError {
    /// The operating system reported an error.
    #[error(transparent)]
    File(#[from] FileError),
    /// The file belongs to another sweep.
    #[error(
        "`{}` belongs to another sweep: {what} is {now}, and was {was}; choose another directory, or remove this one to start again",
        path.display()
    )]
    Changed {
        /// The file.
        path: PathBuf,
        /// The entry that differs.
        what: &'static str,
        /// Previous value of the entry.
        was: String,
        /// Present value of the entry.
        now: String,
    },
    /// The first line of the file is damaged, or does not describe a sweep.
    #[error("the first line of `{}` is not the header of a sweep, so its rows cannot be assigned; remove the file to start again", path.display())]
    Damaged {
        /// The file.
        path: PathBuf,
    },
    /// The directory contains no sweep.
    #[error("`{}` does not contain a sweep", directory.display())]
    Missing {
        /// The directory.
        directory: PathBuf,
    },
    /// Two rows of one run differ. Machines with equal arithmetic produce equal rows.
    #[error(transparent)]
    Differs(#[from] Box<Difference>),
}

/// Two rows of one run that differ.
#[derive(Debug, thiserror::Error)]
#[error(
    "run {run} was performed twice, with different results: `{column}` is {} in `{}` and {} in `{}`; the machines compute different results: remove one of the files and repeat its runs",
    values[0], paths[0].display(), values[1], paths[1].display()
)]
pub struct Difference {
    /// Index of the run.
    pub run: u64,
    /// The first column that differs.
    pub column: String,
    /// The two different values of this column.
    pub values: [String; 2],
    /// The files of both rows.
    pub paths: [PathBuf; 2],
}

impl JournalError {
    /// Error code; see [`model::codes`].
    #[must_use]
    pub fn code(&self) -> Code {
        match self {
            Self::File(e) => e.code(),
            Self::Changed { .. } => const { Code::new(505) },
            Self::Damaged { .. } => const { Code::new(506) },
            Self::Missing { .. } => const { Code::new(507) },
            Self::Differs(_) => const { Code::new(509) },
        }
    }

    /// Whether the content of the directory is the cause of the error. Otherwise, the system is the
    /// cause.
    #[must_use]
    pub fn is_input(&self) -> bool {
        match self {
            Self::File(e) => e.is_place(),
            _ => true,
        }
    }
}

/// The text of a plan.
pub(super) fn json(plan: &SweepPlan) -> Vec<u8> {
    // The plan contains only texts, numbers and lists of texts, so this cannot fail.
    serde_json::to_vec(plan).unwrap_or_default()
}

/// The digest that identifies the plan of a file.
pub(super) fn mark(plan: &SweepPlan) -> String {
    format!("{:016x}", digest(&json(plan)))
}

/// Returns an error that states the difference if two descriptions differ.
pub(super) fn same(path: &Path, was: &SweepPlan, now: &SweepPlan) -> Result<(), JournalError> {
    let keeps = |plan: &SweepPlan| {
        if plan.keep_rows {
            "with trajectories".to_owned()
        } else {
            "without trajectories".to_owned()
        }
    };
    let differing = [
        (
            "the text of the scene",
            was.digest.clone(),
            now.digest.clone(),
        ),
        ("the grid", was.vary.join(" "), now.vary.join(" ")),
        ("the program", was.version.clone(), now.version.clone()),
        ("it", keeps(was), keeps(now)),
    ];
    let found = differing.into_iter().find(|(_, was, now)| was != now);
    let what = match found {
        Some(difference) => difference,
        None if was == now => return Ok(()),
        None => (
            "what the rows have",
            String::from_utf8_lossy(&json(was)).into_owned(),
            String::from_utf8_lossy(&json(now)).into_owned(),
        ),
    };
    Err(JournalError::Changed {
        path: path.to_owned(),
        what: what.0,
        was: what.1,
        now: what.2,
    })
}
