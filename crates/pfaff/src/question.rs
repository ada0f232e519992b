//! The definition of a question about scenes. A question has options and a subject. The answer is a
//! document, a text and files. Each question is one folder of [`crate::questions`]. The callers
//! (the command and Python) do not contain names of questions.

use std::num::NonZeroUsize;
use std::sync::LazyLock;

use crate::page::Origin;
use model::codes::Code;
use model::words::{in_units, in_units_of_scenes, units};
use report::{Family, FileError, OutputDirectory, Provenance};
use serde::{Deserialize, Serialize};

use crate::refusal::{Refusal, json};
use crate::start::Start;
use crate::words::{self, Block, UnitSystem, count};

/// A question. Its fields are the options. The comments of the fields are also the help of the
/// command.
pub trait Question: for<'d> Deserialize<'d> + Default {
    /// Name of the subcommand and of the Python method.
    const NAME: &'static str;
    /// JSON schema of the answer, written by `cargo xtask questions`.
    const SCHEMA: &'static str;
    /// The files of an answer. `None` if the answer has no files.
    const OUTPUT: Option<Output> = None;
    /// Subject of the question.
    type Subject<'s>: Subject<'s>;
    /// Type of the answer.
    type Answer: Answer;

    /// Computes the answer.
    ///
    /// # Errors
    /// Returns the reason why there is no answer.
    fn answer<'s>(
        &self,
        of: Self::Subject<'s>,
        control: &Control<'_>,
    ) -> Result<Self::Answer, Refusal>;
}

/// The subject of a question: one scene or several scenes.
pub trait Subject<'s>: Sized {
    /// Names of the scenes in help texts. The last name may represent several scenes.
    const SCENES: &'static [&'static str];
    /// Smallest and largest number of scenes.
    const COUNT: (usize, usize) = (Self::SCENES.len(), Self::SCENES.len());

    /// Builds the subject from these scenes. Returns `None` if the number of scenes is wrong.
    fn of(scenes: &[&'s Start<'s>]) -> Option<Self>;
}

impl<'s> Subject<'s> for &'s Start<'s> {
    const SCENES: &'static [&'static str] = &["SCENE"];

    fn of(scenes: &[&'s Start<'s>]) -> Option<Self> {
        let [scene] = scenes else { return None };
        Some(scene)
    }
}

impl<'s> Subject<'s> for [&'s Start<'s>; 2] {
    const SCENES: &'static [&'static str] = &["A", "B"];

    fn of(scenes: &[&'s Start<'s>]) -> Option<Self> {
        scenes.try_into().ok()
    }
}

impl<'s> Subject<'s> for Option<&'s Start<'s>> {
    const SCENES: &'static [&'static str] = &["SCENE"];
    const COUNT: (usize, usize) = (0, 1);

    fn of(scenes: &[&'s Start<'s>]) -> Option<Self> {
        match scenes {
            [] => Some(None),
            [scene] => Some(Some(scene)),
            _ => None,
        }
    }
}

impl<'s> Subject<'s> for Vec<&'s Start<'s>> {
    const SCENES: &'static [&'static str] = &["SCENE"];
    const COUNT: (usize, usize) = (1, usize::MAX);

    fn of(scenes: &[&'s Start<'s>]) -> Option<Self> {
        (!scenes.is_empty()).then(|| scenes.to_vec())
    }
}

/// An answer. It owns all data of its text and files, so that the answer can outlive the thread and
/// the scene. The fields of an answer are the keys of its JSON document, in the same order.
pub trait Answer: Serialize + Send + 'static {
    /// Returns the answer as text.
    fn words(&self) -> Vec<Block>;

    /// Returns whether the answer is complete.
    fn ending(&self) -> Ending {
        Ending::Complete
    }

    /// Writes the files of the answer, if it has any.
    ///
    /// # Errors
    /// Returns an error if a file cannot be written.
    fn files(&self, _place: &mut dyn Place) -> Result<(), Refusal> {
        Ok(())
    }

    /// Describes the location of the files that were written during the computation.
    fn written(&self, place: &str) -> String {
        format!("written to {place}")
    }
}

/// Whether an answer is complete.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Ending {
    /// The answer is complete.
    Complete,
    /// The answer is incomplete, for this reason.
    Partial {
        /// Code of the reason.
        code: Code,
        /// Text of the reason.
        error: String,
    },
    /// The answer is incomplete, and its document contains the reason.
    Stopped,
}

/// Code of a computation that was interrupted on request.
pub const INTERRUPTED: Code = Code::new(8);

/// Message for a computation that a request has ended before there were results.
pub const NOTHING_WRITTEN: &str = "interrupted; nothing was written";

impl Ending {
    /// Returns a partial answer because a stop was requested.
    #[must_use]
    pub fn interrupted(error: String) -> Self {
        let code = INTERRUPTED;
        Self::Partial { code, error }
    }

    /// Returns a document as text; in a partial document `code` and `error` come first.
    ///
    /// # Errors
    /// Returns an error if the document cannot be written.
    pub fn json(&self, document: &impl Serialize) -> Result<String, Refusal> {
        #[derive(Serialize)]
        struct Partial<'d, D> {
            code: Code,
            error: &'d str,
            #[serde(flatten)]
            document: &'d D,
        }
        match self {
            Self::Complete | Self::Stopped => json(document),
            Self::Partial { code, error } => json(&Partial {
                code: *code,
                error,
                document,
            }),
        }
    }
}

/// The files of an answer.
#[derive(Clone, Copy, Debug)]
pub struct Output {
    /// Names of the files.
    pub family: Family,
    /// Contents of the files, as a phrase after "Output directory for".
    pub contents: &'static str,
    /// The time at which the files are written.
    pub writing: Writing,
}

impl Output {
    /// Whether files are written while the answer is computed. In this case, the caller must give a
    /// directory.
    #[must_use]
    pub fn is_streamed(&self) -> bool {
        matches!(self.writing, Writing::Meanwhile { .. })
    }
}

/// The time at which the files of an answer are written.
#[derive(Clone, Copy, Debug)]
pub enum Writing {
    /// All files are written together after the computation.
    AtEnd,
    /// Files are written during the computation.
    Meanwhile {
        /// Whether several processes write into the directory at the same time.
        shared: bool,
        /// Callback for the case that the process must end immediately. It returns a text about the
        /// saved results. The second argument is the name that [`Progress::Writing`] announced.
        cut: fn(&OutputDirectory, Option<&str>) -> String,
    },
}

/// The destination of the files of an answer: a directory, or memory.
pub trait Place {
    /// Writes a whole file to the destination.
    ///
    /// # Errors
    /// Returns an error if the file cannot be written.
    fn put(&mut self, name: &str, content: &[u8]) -> Result<(), FileError>;
}

/// Settings and callbacks of a caller for the work on an answer.
#[derive(Clone, Copy)]
pub struct Control<'c> {
    /// Returns whether the work should end early. The computation calls it often.
    pub stop: &'c (dyn Fn() -> bool + Sync),
    /// Receives the current progress.
    pub progress: &'c (dyn Fn(Progress) + Sync),
    /// Whether the caller needs the answer as text.
    pub wants_words: bool,
    /// Whether the caller also needs the files of the answer.
    pub wants_files: bool,
    /// Directory for files that are written during the computation.
    pub directory: Option<&'c OutputDirectory>,
    /// Name, version and time of the caller. Pages print this information.
    pub provenance: &'c Provenance,
    /// Number of threads. `None` means one thread for each core.
    pub threads: Option<NonZeroUsize>,
    /// Whether texts contain SI units without prefixes. Otherwise, they contain the units of the
    /// scene.
    pub is_si: bool,
}

/// Provenance of callers that do not state one.
static UNNAMED: LazyLock<Provenance> = LazyLock::new(|| {
    let Origin { command, versions } = Origin::default();
    Provenance {
        machine: String::new(),
        versions,
        date: String::new(),
        command,
    }
});

impl Control<'static> {
    /// Returns settings without stop, progress and files.
    #[must_use]
    pub fn quiet() -> Self {
        Self {
            stop: &|| false,
            progress: &|_| (),
            wants_words: false,
            wants_files: false,
            directory: None,
            provenance: &UNNAMED,
            threads: None,
            is_si: false,
        }
    }
}

/// Current progress of the work.
#[derive(Clone, Debug, PartialEq)]
pub enum Progress {
    /// The stage, as text, and the size of its input (bytes).
    Stage(&'static str, usize),
    /// The counted items, the number that is done, and the total.
    Count(&'static str, usize, usize),
    /// The number of runs that are done, the total, and a remark.
    Runs(u64, u64, String),
    /// The work along a motion, the time that it has reached, and the last time (s).
    Motion(&'static str, f64, f64),
    /// The results that are written from now on belong to the scene with this name.
    Writing(String),
}

/// A question whose type is selected at run time.
pub trait AnyQuestion {
    /// Computes the answer for these scenes.
    ///
    /// # Errors
    /// Returns the reason why there is no answer.
    fn ask<'s>(
        &self,
        scenes: &[&'s Start<'s>],
        control: &Control<'_>,
    ) -> Result<Box<dyn AnyAnswer>, Refusal>;
}

impl<Q: Question> AnyQuestion for Q {
    fn ask<'s>(
        &self,
        scenes: &[&'s Start<'s>],
        control: &Control<'_>,
    ) -> Result<Box<dyn AnyAnswer>, Refusal> {
        let n = scenes.len();
        let subject = Q::Subject::of(scenes).ok_or_else(|| {
            let (name, (least, _)) = (Q::NAME, Q::Subject::COUNT);
            let expected = count(least, "scene", "scenes");
            Refusal::input(format!("`{name}` needs {expected}, not {n}"))
        })?;
        control.answered(|| self.answer(subject, control))
    }
}

impl Control<'_> {
    /// Computes an answer whose texts have the requested units.
    ///
    /// # Errors
    /// Returns the errors of the computation.
    pub fn answered<A: Answer>(
        &self,
        compute: impl FnOnce() -> Result<A, Refusal>,
    ) -> Result<Box<dyn AnyAnswer>, Refusal> {
        let compute = || (compute(), units());
        let (answer, units) = if self.is_si {
            in_units(UnitSystem::Si, compute)
        } else {
            in_units_of_scenes(compute)
        };
        let answer = answer?;
        Ok(Box::new(AnswerInUnits { answer, units }))
    }
}

/// An answer of any type.
pub trait AnyAnswer: Send {
    /// Returns the answer as text, with details if they are requested.
    fn text(&self, is_verbose: bool) -> String;

    /// See [`Answer::ending`].
    fn ending(&self) -> Ending;

    /// Returns the document as text. In a partial document, `code` and `error` come first.
    ///
    /// # Errors
    /// Returns an error if the document cannot be written.
    fn json(&self) -> Result<String, Refusal>;

    /// See [`Answer::files`].
    ///
    /// # Errors
    /// Returns an error if a file cannot be written.
    fn files(&self, place: &mut dyn Place) -> Result<(), Refusal>;

    /// See [`Answer::written`].
    fn written(&self, place: &str) -> String;
}

/// An answer with the units of its texts.
struct AnswerInUnits<A> {
    answer: A,
    units: UnitSystem,
}

impl<A: Answer> AnyAnswer for AnswerInUnits<A> {
    fn text(&self, is_verbose: bool) -> String {
        in_units(self.units, || words::text(&self.answer.words(), is_verbose))
    }

    fn ending(&self) -> Ending {
        in_units(self.units, || self.answer.ending())
    }

    fn json(&self) -> Result<String, Refusal> {
        in_units(self.units, || self.answer.ending().json(&self.answer))
    }

    fn files(&self, place: &mut dyn Place) -> Result<(), Refusal> {
        in_units(self.units, || self.answer.files(place))
    }

    fn written(&self, place: &str) -> String {
        self.answer.written(place)
    }
}
