//! All questions. Each question has a folder with its options, computation, answer and text.

pub mod analyze;
pub mod cases;
pub mod check;
pub mod diff;
pub mod equilibrium;
pub mod linearise;
pub mod plan;
pub mod simulate;
pub mod sweep;
pub mod tolerance;
pub mod work_precision;

use report::read_json;
use scene::nearest;
use serde::Deserialize;

pub use analyze::Analyze;
pub use cases::Cases;
pub use check::Check;
pub use diff::Diff;
pub use equilibrium::Equilibrium;
pub use linearise::Linearise;
pub use plan::Plan;
pub use simulate::Simulate;
pub use sweep::Sweep;
pub use tolerance::Tolerance;
pub use work_precision::WorkPrecision;

use crate::question::{AnyQuestion, Output, Question, Subject};
use crate::refusal::Refusal;
use crate::run_options::without_place;

/// Static properties of a question.
#[derive(Clone, Copy, Debug)]
pub struct Facts {
    /// Name of the subcommand and of the Python method.
    pub name: &'static str,
    /// JSON schema of the answer.
    pub schema: &'static str,
    /// The files of an answer.
    pub output: Option<Output>,
    /// Names of the scenes that are the subject of the question.
    pub scenes: &'static [&'static str],
    /// Smallest and largest number of scenes.
    pub count: (usize, usize),
}

impl Facts {
    const fn of<Q: Question>() -> Self {
        Self {
            name: Q::NAME,
            schema: Q::SCHEMA,
            output: Q::OUTPUT,
            scenes: <Q::Subject<'static> as Subject>::SCENES,
            count: <Q::Subject<'static> as Subject>::COUNT,
        }
    }
}

/// Defines the list of all questions.
macro_rules! questions {
    ($($question:ident),+ $(,)?) => {
        /// A question with its options.
        #[derive(Clone, Debug, Deserialize)]
        #[serde(rename_all = "kebab-case")]
        #[cfg_attr(feature = "command", derive(clap::Subcommand))]
        pub enum Questions {
            $(
                #[allow(missing_docs)]
                $question($question),
            )+
        }

        impl Questions {
            /// Static properties of all questions, in the order of the list.
            pub const FACTS: &'static [Facts] = &[$(Facts::of::<$question>()),+];

            /// Returns the JSON schemas of each question and of its answer.
            #[cfg(feature = "schema")]
            #[must_use]
            pub fn schemas() -> Vec<crate::schema::QuestionSchema> {
                vec![$(crate::schema::QuestionSchema::of::<$question>()),+]
            }

            /// Returns the static properties of this question.
            #[must_use]
            pub fn facts(&self) -> Facts {
                match self {
                    $(Self::$question(_) => Facts::of::<$question>(),)+
                }
            }

            /// Returns the question as a trait object.
            #[must_use]
            pub fn as_question(&self) -> &dyn AnyQuestion {
                match self {
                    $(Self::$question(question) => question,)+
                }
            }
        }
    };
}

questions!(
    Analyze,
    Simulate,
    Cases,
    Plan,
    Check,
    Equilibrium,
    Linearise,
    Tolerance,
    Diff,
    Sweep,
    WorkPrecision
);

impl Questions {
    /// Reads the question of this name, with its options as a JSON object.
    ///
    /// ```
    /// use pfaff::questions::Questions;
    ///
    /// assert!(Questions::read("equilibrium", r#"{ "stable": true }"#).is_ok());
    /// let refused = Questions::read("equilibrum", "{}").unwrap_err();
    /// assert!(refused.document().error.contains("did you mean `equilibrium`?"));
    /// ```
    ///
    /// # Errors
    /// Returns an error if there is no question with this name, or if the question does not have
    /// these options.
    pub fn read(name: &str, options: &str) -> Result<Self, Refusal> {
        let known = || Self::FACTS.iter().map(|facts| facts.name);
        if !known().any(|known| known == name) {
            let near = nearest(name, known());
            let near = near.map_or_else(String::new, |near| format!("; did you mean `{near}`?"));
            return Err(Refusal::input(format!(
                "there is no question `{name}`{near}"
            )));
        }
        read_json(&format!("{{\"{name}\": {options}}}"))
            .map_err(|e| Refusal::input(format!("the options of `{name}`: {}", without_place(&e))))
    }
}
