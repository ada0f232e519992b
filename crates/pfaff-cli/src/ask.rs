//! Questions on the command line: the options of a question, the scenes that it is asked about, and
//! the ways in which its answer is wanted. No question is known by name here.

use std::ffi::OsStr;
use std::path::PathBuf;

use clap::{Arg, ArgMatches, Args, Command, FromArgMatches, Subcommand, ValueHint, value_parser};
use pfaff::question::{Control, Ending, Place};
use pfaff::questions::{Facts, Questions};
use pfaff::report::FileError;
use pfaff::words;

use crate::args::Known;
use crate::console::Console;
use crate::input::Source;
use crate::interrupt::{Interrupt, NOTHING_WRITTEN};
use crate::output::{Answer, Failure, Files, Outcome, directory};
use crate::progress::Progress;
use crate::resources::Resources;
use crate::watch;
use crate::work_precision::provenance;

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
                        out.help(format!("Directory for {}", output.contents))
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
                Ok(self.asked(console, &|| false)?.0)
            });
        }
        let interrupt = Interrupt::listen_with(|| NOTHING_WRITTEN.to_owned())?;
        let (text, ending) = self.asked(console, &|| interrupt.is_asked())?;
        match ending {
            Ending::Complete => console.print(&text),
            Ending::Partial { .. } | Ending::Stopped => Err(console.incomplete(&text)),
        }
    }

    /// The answer as text, after its files are written.
    fn asked(
        &self,
        console: &Console<'_>,
        stop: &(dyn Fn() -> bool + Sync),
    ) -> Result<(String, Ending), Failure> {
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
        let out = self.place.as_ref().and_then(|place| {
            let path = place.out.as_ref()?;
            Some((path, self.facts.output?.family, place.force))
        });
        // A place that is none is refused before anything is computed.
        let place = out.map(|(path, family, force)| {
            Ok::<_, Failure>((path, family, directory(path, family, force)?))
        });
        let place = place.transpose()?;
        let shown = Progress::default();
        let control = Control {
            stop,
            progress: &|progress| shown.show(progress),
            wants_words: matches!(self.answer(), Answer::Words),
            wants_files: place.is_some(),
            provenance: &provenance(),
            threads: resources.threads,
        };
        let scenes: Vec<_> = scenes.iter().collect();
        let answer = self.question.as_question().ask(&scenes, &control)?;
        drop(shown);
        let written = match place {
            None => String::new(),
            Some((path, family, directory)) => {
                let mut files = NamedFiles {
                    files: Files::of(&directory, family)?,
                    names: Vec::new(),
                };
                answer.files(&mut files)?;
                let NamedFiles { files, names } = files;
                let beside = files.finish()?;
                let said = format!("written to {}: {}", path.display(), names.join(", "));
                format!("\n{}{beside}", words::wrapped("", &said))
            }
        };
        let text = match self.answer() {
            Answer::Json => answer.json()?,
            Answer::Words => words::text(&answer.words()) + &written,
        };
        Ok((text, answer.ending()))
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
