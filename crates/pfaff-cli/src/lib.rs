#![doc = include_str!("../README.md")]

mod analyze;
mod args;
mod check;
mod console;
mod diff;
mod generate;
mod input;
mod interrupt;
mod manual;
mod new;
mod output;
mod plan;
mod resources;
mod simulate;
mod start;
mod stress;
mod sweep;
mod template;
mod view;
mod watch;
mod work_precision;

use std::ffi::OsString;
use std::process::ExitCode;

use clap::Parser;
use pfaff::model::Registry;

use args::{Arguments, Command};
use console::Console;
pub use console::Stream;

/// Runs one command: `arguments` begin with the name of the program, `registry` knows the joints
/// and forces of scenes.
///
/// Answers go to `out`, what went wrong to `err`. Exit codes: 0 done (also when nobody reads `out`
/// any more), 1 the computation stopped or was interrupted, 2 the input is wrong. With `--json`,
/// `out` gets one document, whichever it is.
///
/// ```
/// use pfaff::model::Registry;
/// use pfaff_cli::{Stream, run};
/// let (mut out, mut err) = (Vec::new(), Vec::new());
/// let arguments = ["pfaff", "check", "no-such-file.toml"];
/// let code = run(&Registry::planar(), arguments, Stream::plain(&mut out), Stream::plain(&mut err));
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
    let console = Console::new(registry, out, err);
    let arguments = match Arguments::try_parse_from(arguments) {
        Ok(arguments) => arguments,
        Err(e) => return console.usage(&e),
    };
    let outcome = match &arguments.command {
        Command::Analyze(a) => analyze::run(a, &console),
        Command::Simulate(a) => simulate::run(a, &console),
        Command::Plan(a) => plan::run(a, &console),
        Command::Sweep(a) => sweep::run(a, &console),
        Command::Stress(a) => stress::run(a, &console),
        Command::WorkPrecision(a) => work_precision::run(a, &console),
        Command::Generate(a) => generate::run(a, &console),
        Command::Check(a) => check::run(a, &console),
        Command::New(a) => new::run(a, &console),
        Command::View(a) => view::run(a, &console),
        Command::Diff(a) => diff::run(a, &console),
        Command::Schema => manual::schema(&console),
        Command::Completions(a) => manual::completions(a, &console),
        Command::Man(a) => manual::page(a, &console),
    };
    match outcome {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => console.report(failure, arguments.command.answer()),
    }
}
