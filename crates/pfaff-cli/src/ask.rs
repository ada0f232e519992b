//! Questions on the command line: the options of a question, the scenes to which the question
//! refers, and the form of the answer. This module contains no name of a question.

use std::ffi::OsStr;
use std::num::NonZeroUsize;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};

use clap::{Arg, ArgMatches, Args, Command, FromArgMatches, Subcommand, ValueHint, value_parser};
use pfaff::question::{self, AnyAnswer, Control, Ending, NOTHING_WRITTEN, Output, Place, Writing};
use pfaff::questions::{Facts, Questions};
use pfaff::report::{FileError, OutputDirectory};
use pfaff::words;

use crate::args::SceneOptions;
use crate::console::Console;
use crate::input::Source;
use crate::interrupt::Interrupt;
use crate::output::{Answer, Failure, Files, Outcome, beside};
use crate::progress::Progress;
use crate::provenance::provenance;
use crate::resources::Resources;
use crate::watch;

/// A question on the command line.
pub(crate) struct AskCommand {
    question: Questions,
    facts: &'static Facts,
    scenes: Vec<PathBuf>,
    place: Option<OutputOptions>,
    of: CommonOptions,
}

// The comments of the questions are help texts. The comments of these structs are not.

/// Options for the files of an answer.
#[derive(Args, Clone, Default)]
pub struct OutputOptions {
    /// Directory for the files of the answer
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// Overwrite files not created by pfaff
    #[arg(long, requires = "out")]
    pub force: bool,
}

#[derive(Args)]
struct CommonOptions {
    /// Repeat whenever a file changes, until Ctrl-C
    #[arg(long, conflicts_with = "json")]
    watch: bool,
    #[command(flatten)]
    known: SceneOptions,
    #[command(flatten)]
    resources: Resources,
    /// Print the answer as a JSON document
    #[arg(long)]
    json: bool,
    /// Print more details
    #[arg(long, conflicts_with = "json")]
    verbose: bool,
    /// Print numbers in SI units without prefixes
    #[arg(long, conflicts_with = "json")]
    si: bool,
}

/// Name of the argument with the scenes.
const SCENES: &str = "scenes";

impl Subcommand for AskCommand {
    fn augment_subcommands(command: Command) -> Command {
        let all = Questions::augment_subcommands(command);
        let complete = |all: Command, facts: &Facts| {
            all.mut_subcommand(facts.name, |own| {
                // The added options must not replace the description of the question.
                let about = own.get_about().cloned().unwrap_or_default();
                let scenes = Arg::new(SCENES)
                    .help("Scene file, or - for standard input")
                    .value_names(facts.scenes)
                    .num_args(facts.count.0..=facts.count.1)
                    .value_hint(ValueHint::FilePath)
                    .value_parser(value_parser!(PathBuf))
                    .required(facts.count.0 > 0);
                let own = own.arg(scenes);
                let own = match facts.output {
                    None => own,
                    Some(output) => OutputOptions::augment_args(own).mut_arg("out", |out| {
                        let help = format!("Output directory for {}", output.contents);
                        out.required(output.is_streamed()).help(help)
                    }),
                };
                CommonOptions::augment_args(own).about(about)
            })
        };
        Questions::FACTS.iter().fold(all, complete)
    }

    fn augment_subcommands_for_update(command: Command) -> Command {
        Self::augment_subcommands(command)
    }

    fn has_subcommand(name: &str) -> bool {
        Questions::has_subcommand(name)
    }
}

impl FromArgMatches for AskCommand {
    fn from_arg_matches(matches: &ArgMatches) -> Result<Self, clap::Error> {
        let question = Questions::from_arg_matches(matches)?;
        let asked = matches.subcommand().and_then(|(name, own)| {
            let facts = Questions::FACTS.iter().find(|facts| facts.name == name)?;
            Some((facts, own))
        });
        let (facts, own) =
            asked.expect("the parser of the command line accepts only names of questions");
        let scenes = own.get_many(SCENES).unwrap_or_default();
        let place = facts.output.map(|_| OutputOptions::from_arg_matches(own));
        Ok(Self {
            question,
            facts,
            scenes: scenes.cloned().collect(),
            place: place.transpose()?,
            of: CommonOptions::from_arg_matches(own)?,
        })
    }

    fn update_from_arg_matches(&mut self, matches: &ArgMatches) -> Result<(), clap::Error> {
        *self = Self::from_arg_matches(matches)?;
        Ok(())
    }
}

impl AskCommand {
    /// Returns the form of the answer.
    pub(crate) fn answer(&self) -> Answer {
        if self.of.json {
            Answer::Json
        } else {
            Answer::Words
        }
    }

    /// Computes the answer, writes its files, and prints it.
    pub(crate) fn run(&self, console: &Console<'_>) -> Outcome {
        let is_stdin = |path: &&PathBuf| path.as_os_str() == OsStr::new("-");
        if self.scenes.iter().filter(is_stdin).count() > 1 {
            return Err(Failure::input(
                "standard input contains one scene; give the second scene as a file".to_owned(),
            ));
        }
        self.of.resources.apply(console);
        if self.of.watch {
            return watch::run(&self.scenes, console, || {
                Ok(self.asking(Hears::Not).answered(self.asked(console))?.0)
            });
        }
        self.asking(Hears::Stops).run(console, self.asked(console))
    }

    fn asking(&self, hears: Hears) -> Asking<'_> {
        let output = self.facts.output;
        Asking {
            output: output.zip(self.place.as_ref()),
            is_json: self.of.json,
            is_verbose: self.of.verbose,
            is_si: self.of.si,
            threads: self.of.resources.threads,
            hears,
        }
    }

    /// Reads the scenes and computes the answer.
    fn asked<'a>(&'a self, console: &'a Console<'_>) -> impl FnOnce(&Control<'_>) -> Asks + 'a {
        move |control| {
            let CommonOptions {
                known, resources, ..
            } = &self.of;
            let read = |path: &PathBuf| -> Result<_, Failure> {
                let source = Source::read(path, &known.settings, console)?.known(known);
                Ok(source.start(*resources))
            };
            let scenes = self.scenes.iter().map(read);
            let scenes = scenes.collect::<Result<Vec<_>, _>>()?;
            let scenes: Vec<_> = scenes.iter().collect();
            Ok(self.question.as_question().ask(&scenes, control)?)
        }
    }
}

/// An answer, or the reason why there is no answer.
pub type Asks = Result<Box<dyn AnyAnswer>, Failure>;

/// The requested form of an answer.
pub struct Asking<'a> {
    /// Files of the answer and the destination of the files, if files are requested.
    pub output: Option<(Output, &'a OutputOptions)>,
    /// Whether the answer is requested as a document.
    pub is_json: bool,
    /// Whether details are also printed.
    pub is_verbose: bool,
    /// Whether values are printed in SI units without prefixes.
    pub is_si: bool,
    /// Number of threads.
    pub threads: Option<NonZeroUsize>,
    /// Whether requests to stop apply to this answer.
    pub hears: Hears,
}

impl Asking<'_> {
    /// Computes the answer, writes its files, and prints it.
    ///
    /// # Errors
    /// Returns an error if there is no answer, or if it is incomplete.
    pub fn run(&self, console: &Console<'_>, ask: impl FnOnce(&Control<'_>) -> Asks) -> Outcome {
        Interrupt::ends_at_once()?;
        let (text, ending) = self.answered(ask)?;
        match ending {
            Ending::Complete => console.print(&text),
            Ending::Partial { .. } | Ending::Stopped => Err(console.incomplete(&text)),
        }
    }

    /// Returns the answer as text, after its files are written.
    fn answered(
        &self,
        ask: impl FnOnce(&Control<'_>) -> Asks,
    ) -> Result<(String, Ending), Failure> {
        // An invalid directory is rejected before the computation.
        let place = self.output.and_then(|(output, place)| {
            Some(Directory::open(place.out.as_ref()?, output, place.force))
        });
        let place = place.transpose()?;
        let interrupt = match (self.hears, &place) {
            (Hears::Not, _) => None,
            (Hears::Stops, Some(place)) => Some(Interrupt::listen_with(place.last_act())?),
            (Hears::Stops, None) => Some(Interrupt::listen_with(|| NOTHING_WRITTEN.to_owned())?),
        };
        let shown = Progress::default();
        let control = Control {
            stop: &|| interrupt.as_ref().is_some_and(Interrupt::is_asked),
            progress: &|progress| match (progress, &place) {
                (question::Progress::Writing(what), Some(place)) => place.begins(what),
                (progress, _) => shown.show(progress),
            },
            wants_words: !self.is_json,
            wants_files: place.is_some(),
            directory: place.as_ref().map(|place| &place.directory),
            provenance: &provenance(),
            threads: self.threads,
            is_si: self.is_si,
        };
        let answer = ask(&control)?;
        drop(shown);
        let written = match &place {
            None => String::new(),
            Some(place) => place.write(answer.as_ref())?,
        };
        let text = if self.is_json {
            answer.json()?
        } else {
            answer.text(self.is_verbose) + &written
        };
        Ok((text, answer.ending()))
    }
}

/// Whether requests to stop apply to the answer.
#[derive(Clone, Copy)]
pub enum Hears {
    /// The first request ends the work, and the results so far are the answer.
    Stops,
    /// Requests apply to the caller, because the caller repeats the question.
    Not,
}

/// The directory for the files of an answer.
struct Directory {
    path: PathBuf,
    output: Output,
    directory: OutputDirectory,
    /// Name of the result that is being written.
    begun: Arc<Mutex<Option<String>>>,
}

impl Directory {
    fn open(path: &Path, output: Output, force: bool) -> Result<Self, Failure> {
        let is_shared = matches!(output.writing, Writing::Meanwhile { shared: true, .. });
        let directory = OutputDirectory::create(path)?;
        let directory = if is_shared {
            directory
        } else {
            directory.exclusive()?
        };
        let directory = if force { directory.forced() } else { directory };
        directory.check_ours(output.family)?;
        Ok(Self {
            path: path.to_owned(),
            output,
            directory,
            begun: Arc::default(),
        })
    }

    fn begins(&self, what: String) {
        *self.begun.lock().unwrap_or_else(PoisonError::into_inner) = Some(what);
    }

    /// Returns the last action for the case that the process must end early. This action writes
    /// files and returns a message.
    fn last_act(&self) -> impl Fn() -> String + Send + Sync + use<> {
        let (directory, begun) = (self.directory.clone(), Arc::clone(&self.begun));
        let writing = self.output.writing;
        move || match writing {
            Writing::AtEnd => NOTHING_WRITTEN.to_owned(),
            Writing::Meanwhile { cut, .. } => {
                let begun = begun.lock().unwrap_or_else(PoisonError::into_inner).clone();
                cut(&directory, begun.as_deref())
            }
        }
    }

    /// Writes the files that have not been written yet, and returns a text with the location of the
    /// files.
    fn write(&self, answer: &dyn AnyAnswer) -> Result<String, Failure> {
        let (path, family) = (self.path.display().to_string(), self.output.family);
        if self.output.is_streamed() {
            let beside = beside(&self.directory, family);
            return Ok(format!("{}\n{beside}", answer.written(&path)));
        }
        let mut files = NamedFiles {
            files: Files::of(&self.directory, family)?,
            names: Vec::new(),
        };
        answer.files(&mut files)?;
        let NamedFiles { files, names } = files;
        let beside = files.finish()?;
        let said = format!("written to {path}: {}", names.join(", "));
        Ok(format!("\n{}{beside}", words::wrapped("", &said)))
    }
}

/// The files of an answer with their names.
struct NamedFiles {
    files: Files,
    names: Vec<String>,
}

impl Place for NamedFiles {
    fn put(&mut self, name: &str, content: &[u8]) -> Result<(), FileError> {
        self.names.push(name.to_owned());
        self.files.put(name, content)
    }
}
