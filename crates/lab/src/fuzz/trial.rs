//! Tests one text with the same calls of the library as the commands check, analyze and simulate.
//! The results must be consistent.
//!
//! A failed test panics. Each trial runs in a supervised process.

mod judged;
mod moved;
mod reach;

use pfaff::dynamics::MotionOptions;
use pfaff::model::Registry;
use pfaff::scene::Diagnostic;
use pfaff::{AssembledScene, RunOptions, StudyError};

pub use reach::Reach;
pub(crate) use reach::T_END;
use reach::named;

/// The next stage of a trial.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stage {
    /// Read the text.
    Read,
    /// Assemble the initial state and choose independent rows.
    Prepare,
    /// Compute the verdicts on the reactions.
    Judge,
    /// Run the motion.
    Move,
}

impl Stage {
    /// All stages, in their order.
    pub const ALL: [Self; 4] = [Self::Read, Self::Prepare, Self::Judge, Self::Move];

    /// Returns the letter of the stage in the answers of a process.
    #[must_use]
    pub fn letter(self) -> char {
        match self {
            Self::Read => 'R',
            Self::Prepare => 'P',
            Self::Judge => 'J',
            Self::Move => 'M',
        }
    }
}

/// Tests a text and reports each stage before it begins.
///
/// # Panics
/// Panics if the library panics, or if its results are inconsistent.
#[must_use]
pub fn of(text: &str, mut begin: impl FnMut(Stage)) -> Reach {
    begin(Stage::Read);
    let registry = Registry::standard();
    let read = || AssembledScene::read("scene.toml", text, &registry);
    let assembled = match read() {
        Ok(assembled) => assembled,
        Err(StudyError::Scene(problems)) => {
            places(text, &problems);
            return Reach::Refused;
        }
        Err(other) => panic!("an error has no position in the text: {other}"),
    };
    begin(Stage::Prepare);
    let mut study = match assembled.prepare(&RunOptions::default()) {
        Ok(study) => study,
        Err(e) => {
            named(&e);
            if let StudyError::Scene(problems) = &e {
                places(text, problems);
            }
            let can_be_judged = e.only_motion().is_some();
            let Some(mut assembled) = read().ok().filter(|_| can_be_judged) else {
                return Reach::NoStart;
            };
            begin(Stage::Judge);
            return match assembled.analyse(None) {
                Ok(configuration) => {
                    judged::check(&configuration);
                    Reach::JudgedStart
                }
                Err(e) => {
                    named(&e);
                    // All commands accept the same inputs. `check` and `analyze` only warn of an
                    // initial state that `simulate` rejects.
                    assert!(
                        !e.is_input(),
                        "a start that can be analysed is rejected: {e}"
                    );
                    Reach::NoStart
                }
            };
        }
    };
    begin(Stage::Judge);
    judged::start(&study);
    match study.analyse(0.0, None) {
        Ok(configuration) => judged::check(&configuration),
        Err(e) => {
            named(&e);
            return Reach::NoStart;
        }
    }
    let options = study
        .options
        .get_or_insert_with(|| MotionOptions::to(T_END));
    options.t_end = options.t_end.min(T_END);
    begin(Stage::Move);
    let warning = study.cannot_begin();
    let (reach, rows) = moved::check(&study);
    // `check` and `analyze` only warn of an initial state that `simulate` rejects.
    assert!(
        rows > 0 || warning.is_some(),
        "no motion exists, but the program printed no warning"
    );
    reach
}

/// Asserts that there are problems and that their positions are in the text.
fn places(text: &str, problems: &[Diagnostic]) {
    assert!(!problems.is_empty(), "refused without a reason");
    for problem in problems {
        for label in std::iter::once(&problem.primary).chain(&problem.secondary) {
            assert!(
                text.get(label.span.clone()).is_some(),
                "{problem}: outside of the text: {label:?}"
            );
        }
    }
}
