//! What a question about scenes is: options, a subject, and an answer that is a document, words and
//! files. Each question is one folder of [`crate::questions`]; whoever asks (the command, Python)
//! knows none by name.

use std::num::NonZeroUsize;
use std::sync::LazyLock;

use crate::page::Origin;
use model::codes::Code;
use report::{Family, FileError, OutputDirectory, Provenance};
use serde::{Deserialize, Serialize};

use crate::refusal::{Refusal, json};
use crate::start::Start;
use crate::words::{Block, count};

/// A question; its fields are the options. Their comments are the help of the command, too.
pub trait Question: for<'d> Deserialize<'d> + Default {
    /// Subcommand and method of Python.
    const NAME: &'static str;
    /// JSON schema of the answer, written by `cargo xtask questions`.
    const SCHEMA: &'static str;
    /// The files of an answer; `None` if it has none.
    const OUTPUT: Option<Output> = None;
    /// What it is asked about.
    type Subject<'s>: Subject<'s>;
    /// What comes back.
    type Answer: Answer;

    /// Answers it.
    ///
    /// # Errors
    /// Why there is no answer.
    fn answer<'s>(
        &self,
        of: Self::Subject<'s>,
        control: &Control<'_>,
    ) -> Result<Self::Answer, Refusal>;
}

/// What a question is asked about: one scene or several.
pub trait Subject<'s>: Sized {
    /// Names of the scenes in help texts; the last one may stand for several.
    const SCENES: &'static [&'static str];
    /// The least and the greatest number of them.
    const COUNT: (usize, usize) = (Self::SCENES.len(), Self::SCENES.len());

    /// The subject that consists of these scenes; `None` if it has another number of them.
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

/// An answer. It owns all that its words and files need, so that it can leave the thread and the
/// scene. As a document its fields are the keys, in their order.
pub trait Answer: Serialize + Send + 'static {
    /// The answer for people.
    fn words(&self) -> Vec<Block>;

    /// Whether it is whole.
    fn ending(&self) -> Ending {
        Ending::Complete
    }

    /// Writes its files, if it has any.
    ///
    /// # Errors
    /// If one of them cannot be written.
    fn files(&self, _place: &mut dyn Place) -> Result<(), Refusal> {
        Ok(())
    }

    /// Where files are that were written while it was computed.
    fn written(&self, place: &str) -> String {
        format!("written to {place}")
    }
}

/// Whether an answer is whole.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Ending {
    /// It is.
    Complete,
    /// It is a part: why.
    Partial {
        /// The code of the reason.
        code: Code,
        /// The reason.
        error: String,
    },
    /// It is a part, and says itself why.
    Stopped,
}

/// Code of what was ended by a request.
pub const INTERRUPTED: Code = Code::new(8);

/// What is said where a request has ended what has no results yet.
pub const NOTHING_WRITTEN: &str = "interrupted; nothing was written";

impl Ending {
    /// A part, since a stop was requested.
    #[must_use]
    pub fn interrupted(error: String) -> Self {
        let code = INTERRUPTED;
        Self::Partial { code, error }
    }

    /// A document as text; `code` and `error` come first in one that is not whole.
    ///
    /// # Errors
    /// If it cannot be written.
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
    /// Their names.
    pub family: Family,
    /// What they contain, after "Directory for".
    pub contents: &'static str,
    /// When they are written.
    pub writing: Writing,
}

impl Output {
    /// Whether files are written while the answer is computed: then a directory has to be given.
    #[must_use]
    pub fn is_streamed(&self) -> bool {
        matches!(self.writing, Writing::Meanwhile { .. })
    }
}

/// When the files of an answer are written.
#[derive(Clone, Copy, Debug)]
pub enum Writing {
    /// Together, once the answer is there.
    AtEnd,
    /// While the answer is computed.
    Meanwhile {
        /// Whether several processes write into the directory at the same time.
        shared: bool,
        /// What is done if the process has to end at once; returns what was kept, in words. It is
        /// called with the name that was announced by [`Progress::Writing`].
        cut: fn(&OutputDirectory, Option<&str>) -> String,
    },
}

/// Where the files of an answer are put: a directory, or memory.
pub trait Place {
    /// Puts a whole file there.
    ///
    /// # Errors
    /// If it cannot be written.
    fn put(&mut self, name: &str, content: &[u8]) -> Result<(), FileError>;
}

/// How whoever asks accompanies the work on an answer.
#[derive(Clone, Copy)]
pub struct Control<'c> {
    /// Whether the work should end before it is done. It is asked often.
    pub stop: &'c (dyn Fn() -> bool + Sync),
    /// Hears what is done at present.
    pub progress: &'c (dyn Fn(Progress) + Sync),
    /// Whether the answer is wanted in words.
    pub wants_words: bool,
    /// Whether the files of the answer are wanted, too.
    pub wants_files: bool,
    /// Where files are written while the answer is computed.
    pub directory: Option<&'c OutputDirectory>,
    /// Who asks, with what, when: named on pages.
    pub provenance: &'c Provenance,
    /// Number of threads; `None` means one for each core.
    pub threads: Option<NonZeroUsize>,
}

/// Whoever does not say.
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
    /// Nobody stops the work, hears of it, or wants files.
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
        }
    }
}

/// What is done at present.
#[derive(Clone, Debug, PartialEq)]
pub enum Progress {
    /// Work on a text of so many bytes, in words.
    Stage(&'static str, usize),
    /// What is counted, how much of it is done, and all of it.
    Count(&'static str, usize, usize),
    /// Runs that are done, all of them, and what else there is to say.
    Runs(u64, u64, String),
    /// What is done along a motion, the time that it has reached, and the last time (s).
    Motion(&'static str, f64, f64),
    /// Results of the scene with this name are written from now on.
    Writing(String),
}

/// A question whose type is known when it is asked.
pub trait AnyQuestion {
    /// Answers it about these scenes.
    ///
    /// # Errors
    /// Why there is no answer.
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
            Refusal::input(format!("`{name}` asks about {expected}, not {n}"))
        })?;
        Ok(Box::new(self.answer(subject, control)?))
    }
}

/// An answer of any type.
pub trait AnyAnswer: Send {
    /// As [`Answer::words`].
    fn words(&self) -> Vec<Block>;

    /// As [`Answer::ending`].
    fn ending(&self) -> Ending;

    /// The document as text; `code` and `error` come first in one that is not whole.
    ///
    /// # Errors
    /// If it cannot be written.
    fn json(&self) -> Result<String, Refusal>;

    /// As [`Answer::files`].
    ///
    /// # Errors
    /// If one of them cannot be written.
    fn files(&self, place: &mut dyn Place) -> Result<(), Refusal>;

    /// As [`Answer::written`].
    fn written(&self, place: &str) -> String;
}

impl<A: Answer> AnyAnswer for A {
    fn words(&self) -> Vec<Block> {
        Answer::words(self)
    }

    fn ending(&self) -> Ending {
        Answer::ending(self)
    }

    fn json(&self) -> Result<String, Refusal> {
        Answer::ending(self).json(self)
    }

    fn files(&self, place: &mut dyn Place) -> Result<(), Refusal> {
        Answer::files(self, place)
    }

    fn written(&self, place: &str) -> String {
        Answer::written(self, place)
    }
}
