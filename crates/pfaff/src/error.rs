//! Why there are no results, or only a part of them.

use dynamics::MotionError;
use model::BuildError;
use rank::DeletionError;
use report::{FileError, TableError};
use scene::{CombinationError, Diagnostic};
use solvability::{
    AlongError, AnalysisError, ChoiceError, Contradiction, EliminationError, ExplanationError,
    RequestError, StateError, UnitError,
};

/// Why there are no results, or only a part of them.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum StudyError {
    /// The scene is wrong, with all places.
    #[error("{} problem(s) in the scene, the first: {}", .0.len(), .0.first().map_or(String::new(), ToString::to_string))]
    Scene(Vec<Diagnostic>),
    /// The description that a program has made is wrong, with all faults.
    #[error("{} problem(s) in the description, the first: {}", .0.len(), .0.first().map_or(String::new(), ToString::to_string))]
    Build(Vec<BuildError>),
    /// The start is a singular configuration that cannot be left with its velocities. It can be
    /// judged all the same, by [`AssembledScene::analyse`](crate::AssembledScene::analyse).
    #[error("{contradiction}")]
    SingularStart {
        /// What stands against it.
        contradiction: Contradiction,
        /// Where in the text of the scene, if it has one.
        place: Option<Box<Diagnostic>>,
    },
    /// Nobody says how long the run takes.
    #[error("the scene has no `[simulate]` with `t_end`, and no last time was given")]
    NoEnd,
    /// A combination that cannot be read.
    #[error("`{text}`: {error}")]
    Combination {
        /// The combination.
        text: String,
        /// What is wrong.
        error: CombinationError,
    },
    /// A joint or drive that the mechanism does not have.
    #[error("there is no joint or drive `{name}`{}", suggestion(.nearest.as_deref()))]
    UnknownReaction {
        /// The name.
        name: String,
        /// The nearest one, if one is near.
        nearest: Option<String>,
    },
    /// A row that the mechanism does not have.
    #[error("there is no row {}; rows are 1 to {rows}", row + 1)]
    UnknownRow {
        /// The row, from 0.
        row: usize,
        /// How many there are.
        rows: usize,
    },
    /// Redundant rows ask for different motions.
    #[error(transparent)]
    Contradiction(#[from] Contradiction),
    /// A group cannot be judged.
    #[error(transparent)]
    Request(#[from] RequestError),
    /// A motion could not begin or go on.
    #[error(transparent)]
    Motion(#[from] MotionError),
    /// A configuration could not be judged.
    #[error(transparent)]
    Analysis(#[from] AnalysisError),
    /// A state of the motion is none.
    #[error(transparent)]
    State(#[from] StateError),
    /// A verdict could not be explained.
    #[error(transparent)]
    Explanation(#[from] ExplanationError),
    /// Deletions could not be told.
    #[error(transparent)]
    Deletion(#[from] EliminationError),
    /// There is no such choice among the solutions.
    #[error(transparent)]
    Choice(#[from] ChoiceError),
    /// Facts and choices could not be told apart.
    #[error(transparent)]
    Units(#[from] UnitError),
    /// A motion could not be judged.
    #[error(transparent)]
    Along(#[from] AlongError),
    /// A file could not be written.
    #[error(transparent)]
    File(#[from] FileError),
    /// A table could not be written.
    #[error(transparent)]
    Table(#[from] TableError),
}

fn suggestion(nearest: Option<&str>) -> String {
    nearest.map_or_else(String::new, |near| format!("; did you mean `{near}`?"))
}

impl StudyError {
    /// Why a scene cannot be moved although its start can be judged, by
    /// [`AssembledScene::analyse`](crate::AssembledScene::analyse); nothing where the start is no
    /// start, or nothing keeps the scene from moving.
    #[must_use]
    pub fn only_motion(&self) -> Option<String> {
        match self {
            Self::Motion(e @ (MotionError::RankUndecided(_) | MotionError::Inseparable { .. })) => {
                Some(format!("this mechanism cannot be moved: {e}"))
            }
            Self::SingularStart { contradiction, .. } => Some(format!(
                "no motion begins with these velocities: {contradiction}"
            )),
            _ => None,
        }
    }

    /// Whether the input is wrong; otherwise the computation stopped.
    #[must_use]
    pub fn is_input(&self) -> bool {
        match self {
            Self::Scene(_)
            | Self::Build(_)
            | Self::SingularStart { .. }
            | Self::NoEnd
            | Self::Combination { .. }
            | Self::UnknownReaction { .. }
            | Self::UnknownRow { .. }
            | Self::Contradiction(_)
            | Self::Request(_) => true,
            Self::Motion(e) => matches!(
                e,
                MotionError::Start(_)
                    | MotionError::Contradiction(_)
                    | MotionError::Rows(_)
                    | MotionError::Option { .. }
                    | MotionError::Combination { .. }
            ),
            Self::Analysis(e) => matches!(e, AnalysisError::Rows { .. }),
            Self::Deletion(e) => matches!(
                e,
                EliminationError::Deletion(DeletionError::RowOutOfRange { .. })
                    | EliminationError::Request(_)
            ),
            Self::Choice(e) | Self::Units(UnitError::Choice(e)) => {
                !matches!(e, ChoiceError::Undecided(_) | ChoiceError::Saddle(_))
            }
            Self::Along(e) => matches!(e, AlongError::Times { .. }),
            Self::State(_)
            | Self::Explanation(_)
            | Self::Units(_)
            | Self::File(_)
            | Self::Table(_) => false,
        }
    }
}
