#![doc = include_str!("../README.md")]

mod args;
pub mod ask;
pub mod console;
mod explain;
mod import;
pub mod input;
pub mod interrupt;
mod manual;
mod new;
pub mod output;
mod progress;
pub mod provenance;
mod resources;
mod view;
mod watch;

use std::ffi::OsString;
use std::process::ExitCode;

use clap::Parser;
use clap::error::{ContextKind, ContextValue, ErrorKind};
use pfaff::model::Registry;
use pfaff::scene::nearest;

use args::{Arguments, Command};
use console::Console;
pub use console::Stream;
use output::{Answer, Outcome};
pub use pfaff::command::named;

/// Runs one command. `arguments` begins with the name of the program. `registry` contains the
/// joints and forces that scenes can use.
///
/// Answers are written to `out`, and errors to `err`. The exit code 0 means success (also if the
/// reader has closed `out`), 1 means that the computation stopped or was interrupted, and 2 means
/// invalid input. With `--json`, `out` receives exactly one document in every case.
///
/// ```
/// use pfaff::model::Registry;
/// use pfaff_cli::{Stream, run};
/// let (mut out, mut err) = (Vec::new(), Vec::new());
/// let arguments = ["pfaff", "check", "no-such-file.toml"];
/// let code = run(&Registry::standard(), arguments, Stream::plain(&mut out), Stream::plain(&mut err));
/// assert_eq!(code, std::process::ExitCode::from(2));
/// assert!(String::from_utf8(err).unwrap().contains("no-such-file.toml"));
/// ```
pub fn run<'a, I>(
    registry: &'a Registry,
    arguments: I,
    out: Stream<'a>,
    err: Stream<'a>,
) -> ExitCode
where
    I: IntoIterator<Item: Into<OsString> + Clone>,
{
    serve::<Arguments, _>(registry, arguments, out, err)
}

/// A parsed command line.
pub trait CommandLine: Parser {
    /// Returns the form of the answer.
    fn answer(&self) -> Answer;

    /// Executes the command.
    ///
    /// # Errors
    /// Returns the reason why the command did not finish.
    fn run(&self, console: &Console<'_>) -> Outcome;
}

/// Runs one command line. This function works like [`run`], for a program with additional commands.
pub fn serve<'a, C, I>(
    registry: &'a Registry,
    arguments: I,
    out: Stream<'a>,
    err: Stream<'a>,
) -> ExitCode
where
    C: CommandLine,
    I: IntoIterator<Item: Into<OsString> + Clone>,
{
    let console = Console::new(registry, out, err);
    let words: Vec<OsString> = arguments.into_iter().map(Into::into).collect();
    let arguments = match C::try_parse_from(&words) {
        Ok(arguments) => arguments,
        Err(e) => {
            let refused = with_suggestion(e, C::command(), &words);
            return console.usage(&refused, Answer::asked_by(&words));
        }
    };
    interrupt::answer_as(arguments.answer());
    match arguments.run(&console) {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => console.report(failure, arguments.answer()),
    }
}

/// Adds a suggestion to an error about an unknown word of the command line, if clap finds no
/// similar word. The suggestion is the name of the same concept in this program.
fn with_suggestion(mut e: clap::Error, program: clap::Command, words: &[OsString]) -> clap::Error {
    let said = |kind| match e.get(kind) {
        Some(ContextValue::String(word)) => Some(word.clone()),
        _ => None,
    };
    let command = words.get(1).and_then(|word| program.find_subcommand(word));
    if let Some(word) = said(ContextKind::InvalidSubcommand)
        && e.get(ContextKind::SuggestedSubcommand).is_none()
        && let Some(near) = nearest(
            &word,
            program.get_subcommands().map(clap::Command::get_name),
        )
    {
        let near = ContextValue::Strings(vec![near.to_owned()]);
        e.insert(ContextKind::SuggestedSubcommand, near);
    } else if let Some(word) = said(ContextKind::InvalidArg)
        && e.kind() == ErrorKind::UnknownArgument
        && e.get(ContextKind::SuggestedArg).is_none()
    {
        let options = command.into_iter().flat_map(clap::Command::get_arguments);
        let options: Vec<String> = options
            .filter_map(|option| Some(format!("--{}", option.get_long()?)))
            .collect();
        if let Some(near) = nearest(&word, options.iter().map(String::as_str)) {
            let near = ContextValue::String(near.to_owned());
            e.insert(ContextKind::SuggestedArg, near);
        }
    }
    e
}

impl CommandLine for Arguments {
    fn answer(&self) -> Answer {
        self.command.answer()
    }

    fn run(&self, console: &Console<'_>) -> Outcome {
        match &self.command {
            Command::Ask(a) => a.run(console),
            Command::New(a) => new::run(a, console),
            Command::Import(a) => import::run(a, console),
            Command::View(a) => view::run(a, console),
            Command::Explain(a) => explain::run(a, console),
            Command::Schema(arguments) => manual::schema(arguments, console),
            Command::Completions(a) => manual::completions(a, console),
            Command::Man(a) => manual::page(a, console),
        }
    }
}
