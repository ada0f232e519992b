//! Questions on the command line: the options of a question, the scenes that it is asked about, and
//! the ways in which its answer is wanted. No question is known by name here.

use std::ffi::OsStr;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};

use clap::{Arg, ArgMatches, Args, Command, FromArgMatches, Subcommand, ValueHint, value_parser};
use pfaff::question::{self, AnyAnswer, Control, Ending, Output, Place};
use pfaff::questions::{Facts, Questions};
use pfaff::report::documents::EndedDocument;
use pfaff::report::{FileError, OutputDirectory};
use pfaff::words;

use crate::args::Known;
use crate::console::Console;
use crate::input::Source;
use crate::interrupt::{BY_REQUEST, Interrupt, NOTHING_WRITTEN};
use crate::output::{Answer, Failure, Files, Outcome, beside, directory, json};
use crate::progress::Progress;
use crate::provenance::provenance;
use crate::resources::Resources;
use crate::watch;

/// A question that is asked on the command line.
pub(crate) struct Asked {
    question: Questions,
    facts: &'static Facts,
    scenes: Vec<PathBuf>,
    place: Option<OutputOptions>,
    of: CommonOptions,
}

// The comments of these structs are not help texts: those of the questions are.

#[derive(Args)]
struct OutputOptions {
    /// Directory for the files of the answer
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Also replace files there that pfaff has not written
    #[arg(long, requires = "out")]
    force: bool,
}

#[derive(Args)]
struct CommonOptions {
    /// Ask again whenever a file changes, until Ctrl-C
    #[arg(long, conflicts_with = "json")]
    watch: bool,
    #[command(flatten)]
    known: Known,
    #[command(flatten)]
    resources: Resources,
    /// The answer as one JSON document on standard output
    #[arg(long)]
    json: bool,
}

/// The name of the argument with the scenes.
const SCENES: &str = "scenes";

impl Subcommand for Asked {
    fn augment_subcommands(command: Command) -> Command {
        let all = Questions::augment_subcommands(command);
        let complete = |all: Command, facts: &Facts| {
            all.mut_subcommand(facts.name, |own| {
                // Options that are added must not say what the question is.
                let about = own.get_about().cloned().unwrap_or_default();
                let scenes = Arg::new(SCENES)
                    .help("Scene file, or - for standard input")
                    .value_names(facts.scenes)
                    .num_args(facts.scenes.len())
                    .value_hint(ValueHint::FilePath)
                    .value_parser(value_parser!(PathBuf))
                    .required(true);
                let own = own.arg(scenes);
                let own = match facts.output {
                    None => own,
                    Some(output) => OutputOptions::augment_args(own).mut_arg("out", |out| {
                        let help = format!("Directory for {}", output.contents);
                        out.required(output.streams.is_some()).help(help)
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

impl FromArgMatches for Asked {
    fn from_arg_matches(matches: &ArgMatches) -> Result<Self, clap::Error> {
        let question = Questions::from_arg_matches(matches)?;
        let asked = matches.subcommand().and_then(|(name, own)| {
            let facts = Questions::FACTS.iter().find(|facts| facts.name == name)?;
            Some((facts, own))
        });
        let (facts, own) = asked.expect("clap has found a question by its name");
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

impl Asked {
    /// The form of the answer.
    pub(crate) fn answer(&self) -> Answer {
        if self.of.json {
            Answer::Json
        } else {
            Answer::Words
        }
    }

    /// Asks, writes the files, and prints the answer.
    pub(crate) fn run(&self, console: &Console<'_>) -> Outcome {
        let is_stdin = |path: &&PathBuf| path.as_os_str() == OsStr::new("-");
        if self.scenes.iter().filter(is_stdin).count() > 1 {
            return Err(Failure::input(
                "standard input is one scene; give the other one as a file".to_owned(),
            ));
        }
        self.of.resources.apply(console);
        if self.of.watch {
            return watch::run(&self.scenes, console, || {
                Ok(self.asked(console, Hears::Not)?.0)
            });
        }
        Interrupt::ends_at_once()?;
        let (text, ending) = self.asked(console, Hears::Stops)?;
        match ending {
            Ending::Complete => console.print(&text),
            Ending::Partial { .. } | Ending::Stopped => Err(console.incomplete(&text)),
        }
    }

    /// The answer as text, after its files are written.
    fn asked(&self, console: &Console<'_>, hears: Hears) -> Result<(String, Ending), Failure> {
        let CommonOptions {
            known, resources, ..
        } = &self.of;
        let read = |path: &PathBuf| -> Result<_, Failure> {
            let source = Source::read(path, &known.settings, console)?.known(known);
            Ok(source.start(*resources))
        };
        let scenes = self
            .scenes
            .iter()
            .map(read)
            .collect::<Result<Vec<_>, _>>()?;
        // A place that is none is refused before anything is computed.
        let place = self.place.as_ref().and_then(|place| {
            let (path, output) = (place.out.as_ref()?, self.facts.output?);
            Some(Directory::open(path, output, place.force))
        });
        let place = place.transpose()?;
        let interrupt = match (hears, &place) {
            (Hears::Not, _) => None,
            (Hears::Stops, Some(place)) => Some(Interrupt::listen_with(place.last_act())?),
            (Hears::Stops, None) => Some(Interrupt::listen_with(|| NOTHING_WRITTEN.to_owned())?),
        };
        let shown = Progress::default();
        let control = Control {
            stop: &|| interrupt.as_ref().is_some_and(Interrupt::is_asked),
            progress: &|progress| match (progress, &place) {
                (question::Progress::Writing(scene), Some(place)) => place.begins(scene),
                (progress, _) => shown.show(progress),
            },
            wants_words: matches!(self.answer(), Answer::Words),
            wants_files: place.is_some(),
            directory: place.as_ref().map(|place| &place.directory),
            provenance: &provenance(),
            threads: resources.threads,
        };
        let scenes: Vec<_> = scenes.iter().collect();
        let answer = self.question.as_question().ask(&scenes, &control)?;
        drop(shown);
        let written = match &place {
            None => String::new(),
            Some(place) => place.write(answer.as_ref())?,
        };
        let text = match self.answer() {
            Answer::Json => answer.json()?,
            Answer::Words => words::text(&answer.words()) + &written,
        };
        Ok((text, answer.ending()))
    }
}

/// Whether requests to stop are for the answer.
#[derive(Clone, Copy)]
enum Hears {
    Stops,
    Not,
}

/// The directory of an answer.
struct Directory {
    path: PathBuf,
    output: Output,
    directory: OutputDirectory,
    /// The scene whose results are being written.
    scene: Arc<Mutex<Option<String>>>,
}

impl Directory {
    fn open(path: &Path, output: Output, force: bool) -> Result<Self, Failure> {
        Ok(Self {
            path: path.to_owned(),
            output,
            directory: directory(path, output.family, force)?,
            scene: Arc::default(),
        })
    }

    fn begins(&self, scene: String) {
        *self.scene.lock().unwrap_or_else(PoisonError::into_inner) = Some(scene);
    }

    /// What is done, and said, if the work has to be ended: its tables are kept, and a summary says
    /// that they are partial.
    fn last_act(&self) -> impl Fn() -> String + Send + Sync + use<> {
        let (directory, scene) = (self.directory.clone(), Arc::clone(&self.scene));
        let Output {
            family, streams, ..
        } = self.output;
        move || {
            let begun = scene.lock().unwrap_or_else(PoisonError::into_inner).clone();
            let (Some(scene), Some(summary)) = (begun, streams) else {
                return NOTHING_WRITTEN.to_owned();
            };
            let (error, kept) = ("interrupted", "kept: whole rows of the tables");
            let document = json(&EndedDocument {
                scene,
                partial: true,
                code: BY_REQUEST,
                error,
            });
            let document = document.unwrap_or_default();
            let place = directory.path().display();
            if directory.abandon_as(summary, document.as_bytes(), family) {
                format!("{error}; {kept} in `{place}`; {summary} says that they are partial")
            } else {
                format!("{error}; nothing was written into `{place}`")
            }
        }
    }

    /// Writes the files that are not written yet; says where they are.
    fn write(&self, answer: &dyn AnyAnswer) -> Result<String, Failure> {
        let (path, family) = (self.path.display(), self.output.family);
        if self.output.streams.is_some() {
            let beside = beside(&self.directory, family);
            return Ok(format!("written to {path}\n{beside}"));
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
