//! One text through the library as the commands take it: check, analyze, simulate. What comes out
//! must fit together.
//!
//! What is broken panics: a trial is made in a process that somebody watches.

mod judged;
mod moved;
mod reach;

use pfaff::dynamics::MotionOptions;
use pfaff::model::Registry;
use pfaff::scene::Diagnostic;
use pfaff::{AssembledScene, Overrides, StudyError};

pub use reach::Reach;
pub(crate) use reach::T_END;
use reach::named;

/// What a trial is about to do.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stage {
    /// Read the text.
    Read,
    /// Find its start and choose rows.
    Prepare,
    /// Judge its reactions.
    Judge,
    /// Move it.
    Move,
}

impl Stage {
    /// All of them, in their order.
    pub const ALL: [Self; 4] = [Self::Read, Self::Prepare, Self::Judge, Self::Move];

    /// Its letter in the answers of a process.
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

/// Tries a text and says before each stage which one it is.
///
/// # Panics
/// If the library does, or its results do not fit together.
#[must_use]
pub fn of(text: &str, mut begin: impl FnMut(Stage)) -> Reach {
    begin(Stage::Read);
    let registry = Registry::planar();
    let read = || AssembledScene::read("scene.toml", text, &registry);
    let assembled = match read() {
        Ok(assembled) => assembled,
        Err(StudyError::Scene(problems)) => {
            places(text, &problems);
            return Reach::Refused;
        }
        Err(other) => panic!("a text is refused without a place: {other}"),
    };
    begin(Stage::Prepare);
    let mut study = match assembled.prepare(&Overrides::default()) {
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
                    Reach::Judged
                }
                Err(e) => {
                    named(&e);
                    // `check` and `analyze` warn of what `simulate` refuses, and accept the same.
                    assert!(!e.is_input(), "a start that can be judged is refused: {e}");
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
    // What `simulate` refuses at the start, `check` and `analyze` warn of.
    assert!(
        rows > 0 || warning.is_some(),
        "no motion begins, and nobody was warned"
    );
    reach
}

/// Problems are there, and lie in the text.
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
