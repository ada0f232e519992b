//! Errors of computations that give no results or only partial results.

use crate::contact_fault::ContactFault;
use crate::documents::RunDocument;
use dynamics::equilibrium::EquilibriumError;
use dynamics::linearise::LineariseError;
use dynamics::{MotionError, MotionFault};
use model::BuildError;
use model::codes::Code;
use model::words::listed;
use rank::DeletionError;
use report::{FileError, TableError};
use scene::{CombinationError, Diagnostic};
use solvability::{
    AlongError, AnalysisError, ChoiceError, Contradiction, EliminationError, ExplanationError,
    RequestError, StateError,
};

/// Code of a run that ended because its one-sided joints opened.
pub(crate) const OPENING: Code = Code::new(429);

/// Reason why there are no results, or only partial results.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum StudyError {
    /// The scene is invalid. The list contains all errors with their positions.
    #[error("{} problem(s) in the scene, the first: {}", .0.len(), .0.first().map_or(String::new(), ToString::to_string))]
    Scene(Vec<Diagnostic>),
    /// A description made by a program is invalid. The list contains all errors.
    #[error("{} problem(s) in the description, the first: {}", .0.len(), .0.first().map_or(String::new(), ToString::to_string))]
    Build(Vec<BuildError>),
    /// The start is a singular configuration, and no motion with the velocities of the start is
    /// possible. [`AssembledScene::analyse`](crate::AssembledScene::analyse) can still analyse the
    /// start.
    #[error("{contradiction}")]
    SingularStart {
        /// The contradiction that prevents the motion.
        contradiction: Contradiction,
        /// Position of the contradiction in the text of the scene, if it has one.
        place: Option<Box<Diagnostic>>,
    },
    /// Neither the scene nor the caller states the end of the run.
    #[error("the scene has no `[simulate]` with `t_end`, and no end time was given")]
    NoEnd,
    /// Choices or bounds are requested, but the run writes no reactions.
    #[error(
        "choices and bounds need reactions, but `[output] reactions` of the scene is false: write reactions, or omit --choose and --bounds"
    )]
    NoReactions,
    /// The bounds that the scene requests do not match the mechanism.
    #[error("[output] bounds: {0}")]
    Bounds(String),
    /// A plot that the scene requests has a column that does not exist, or columns of different
    /// units.
    #[error("[output] plots: {0}")]
    Plots(String),
    /// All loads on a body are requested, but the model does not determine some of them.
    #[error(
        "[output] bodies: the loads of {} on `{body}` are not determined: choose one of the possible solutions with --choose, or make them unique",
        listed(joints)
    )]
    OpenLoads {
        /// Name of the body.
        body: String,
        /// Joints and drives whose reactions are not unique.
        joints: Vec<String>,
    },
    /// A joint or force has the name of another load in a table of the loads on a body.
    #[error(
        "the table of the loads on `{body}` already has columns `{name}.Fx` …: rename the joint or force `{name}`, or remove the body from [output] bodies"
    )]
    LoadName {
        /// Name of the body.
        body: String,
        /// The name.
        name: String,
    },
    /// A combination cannot be parsed.
    #[error("`{text}`: {error}")]
    Combination {
        /// The combination.
        text: String,
        /// Cause of the error.
        error: CombinationError,
    },
    /// A joint or drive does not exist.
    #[error("there is no joint or drive `{name}`{}", suggestion(.nearest.as_deref()))]
    UnknownReaction {
        /// The name.
        name: String,
        /// The most similar name, if there is one.
        nearest: Option<String>,
    },
    /// A joint or drive exists in the scene, but is not active.
    #[error("`{name}` is not active in this scene, so there is no reaction")]
    InactiveReaction {
        /// The name.
        name: String,
    },
    /// A row does not exist.
    #[error("there is no row {}; rows are 1 to {rows}", row + 1)]
    UnknownRow {
        /// The row, counted from 0.
        row: usize,
        /// Number of rows.
        rows: usize,
    },
    /// Redundant rows require different motions.
    #[error(transparent)]
    Contradiction(#[from] Contradiction),
    /// A group cannot be analysed.
    #[error(transparent)]
    Request(#[from] RequestError),
    /// A motion could not begin or continue.
    #[error(transparent)]
    Motion(#[from] MotionError),
    /// A run stopped before its end. The results up to that time have been written.
    #[error("{error}; {}", run.kept())]
    Stopped {
        /// Cause of the stop.
        error: MotionError,
        /// Summary of the run.
        run: Box<RunDocument>,
    },
    /// A stop was requested before there was any result.
    #[error("interrupted before the first row; nothing was written")]
    Interrupted,
    /// A motion could not be linearised.
    #[error(transparent)]
    Linearise(#[from] LineariseError),
    /// No equilibrium was found.
    #[error(transparent)]
    Equilibrium(#[from] EquilibriumError),
    /// Contacts do not all stay closed and hold where the answer needs them closed.
    #[error("at {place} {fault}")]
    Contacts {
        /// The configuration.
        place: String,
        /// The contacts.
        fault: ContactFault,
    },
    /// A configuration could not be analysed.
    #[error(transparent)]
    Analysis(#[from] AnalysisError),
    /// A state of the motion is invalid.
    #[error(transparent)]
    State(#[from] StateError),
    /// A verdict could not be explained.
    #[error(transparent)]
    Explanation(#[from] ExplanationError),
    /// Deletions could not be determined.
    #[error(transparent)]
    Deletion(#[from] EliminationError),
    /// The choice among the solutions is not possible.
    #[error(transparent)]
    Choice(#[from] ChoiceError),
    /// A motion could not be analysed.
    #[error(transparent)]
    Along(#[from] AlongError),
    /// A file could not be written.
    #[error(transparent)]
    File(#[from] FileError),
    /// A table could not be written.
    #[error(transparent)]
    Table(#[from] TableError),
}

impl StudyError {
    /// Returns whether a run ended because its one-sided joints opened.
    pub(crate) fn is_opening(&self) -> bool {
        self.code() == OPENING
    }

    /// Returns the code of the error; see [`model::codes`].
    #[must_use]
    pub fn code(&self) -> Code {
        match self {
            Self::Scene(diagnostics) => diagnostics
                .first()
                .map_or(const { Code::new(107) }, |d| d.code),
            Self::Build(errors) => errors
                .first()
                .map_or(const { Code::new(120) }, BuildError::code),
            Self::SingularStart { .. } => const { Code::new(211) },
            Self::NoEnd => const { Code::new(214) },
            Self::NoReactions => const { Code::new(312) },
            Self::Bounds(_) | Self::Plots(_) => const { Code::new(1) },
            Self::OpenLoads { .. } => const { Code::new(318) },
            Self::LoadName { .. } => const { Code::new(319) },
            Self::Combination { .. } => const { Code::new(311) },
            Self::UnknownReaction { .. } | Self::UnknownRow { .. } => const { Code::new(310) },
            Self::InactiveReaction { .. } => const { Code::new(317) },
            Self::Contradiction(_) => const { Code::new(210) },
            Self::Request(e) => e.code(),
            Self::Motion(e) => e.code(),
            Self::Stopped { error, .. } => error.code(),
            Self::Interrupted => const { Code::new(8) },
            Self::Linearise(e) => e.code(),
            Self::Equilibrium(e) => e.code(),
            Self::Contacts { .. } => OPENING,
            Self::Analysis(e) => e.code(),
            Self::State(e) => e.code(),
            Self::Explanation(e) => e.code(),
            Self::Deletion(e) => e.code(),
            Self::Choice(e) => e.code(),
            Self::Along(e) => e.code(),
            Self::File(e) => e.code(),
            Self::Table(e) => e.code(),
        }
    }
}

/// Whether a motion cannot begin because of this input.
fn is_input(e: &MotionError) -> bool {
    match e {
        MotionError::Component { source, .. } => is_input(source),
        MotionError::Start(_)
        | MotionError::Contradiction(_)
        | MotionError::Rows(_)
        | MotionError::NoFiniteReaction(_)
        | MotionError::Option { .. }
        | MotionError::Combination { .. }
        | MotionError::Fault(MotionFault::NoDerivatives { .. }) => true,
        _ => false,
    }
}

fn suggestion(nearest: Option<&str>) -> String {
    nearest.map_or_else(String::new, |near| format!("; did you mean `{near}`?"))
}

impl StudyError {
    /// Returns the reason why a scene cannot be simulated although
    /// [`AssembledScene::analyse`](crate::AssembledScene::analyse) can analyse the start. Returns
    /// `None` if the start is invalid, or if nothing prevents a motion.
    #[must_use]
    pub fn only_motion(&self) -> Option<String> {
        match self {
            Self::Motion(e @ (MotionError::RankUndecided(_) | MotionError::Inseparable { .. })) => {
                Some(format!("this start cannot be simulated: {e}"))
            }
            Self::SingularStart { contradiction, .. } => Some(format!(
                "no motion has these initial velocities: {contradiction}"
            )),
            _ => None,
        }
    }

    /// Whether the input is invalid. Otherwise, the error occurred during the computation.
    #[must_use]
    pub fn is_input(&self) -> bool {
        match self {
            Self::Scene(_)
            | Self::Build(_)
            | Self::SingularStart { .. }
            | Self::NoEnd
            | Self::NoReactions
            | Self::Bounds(_)
            | Self::Plots(_)
            | Self::OpenLoads { .. }
            | Self::LoadName { .. }
            | Self::Combination { .. }
            | Self::UnknownReaction { .. }
            | Self::InactiveReaction { .. }
            | Self::UnknownRow { .. }
            | Self::Contradiction(_)
            | Self::Request(_) => true,
            Self::Motion(e) => is_input(e),
            Self::Linearise(e) => e.is_input(),
            Self::Equilibrium(e) => e.is_input(),
            Self::Analysis(e) => matches!(e, AnalysisError::Rows { .. }),
            Self::Deletion(e) => matches!(
                e,
                EliminationError::Deletion(DeletionError::RowOutOfRange { .. })
                    | EliminationError::Request(_)
            ),
            Self::Choice(e) => !matches!(e, ChoiceError::Undecided(_) | ChoiceError::Saddle(_)),
            Self::Along(e) => matches!(e, AlongError::Times { .. }),
            Self::File(e) => e.is_place(),
            Self::State(_)
            | Self::Stopped { .. }
            | Self::Interrupted
            | Self::Contacts { .. }
            | Self::Explanation(_)
            | Self::Table(_) => false,
        }
    }
}
