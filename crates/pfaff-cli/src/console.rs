//! The streams for answers, and the registry of joints and forces. A closed output ends the command
//! without a message.

use std::cell::RefCell;
use std::io::{self, IsTerminal, Write};
use std::process::ExitCode;

use clap::error::ErrorKind;
use pfaff::model::Registry;
use pfaff::model::codes::Code;
use serde::Serialize;

use crate::interrupt::note_answer;
use crate::output::{Answer, Failure, Outcome, Refusal, json, visible};

/// An output stream, and whether it can show colours.
pub struct Stream<'w> {
    writer: &'w mut dyn Write,
    is_terminal: bool,
}

impl<'w> Stream<'w> {
    /// Wraps a file or a buffer, without colours.
    pub fn plain(writer: &'w mut dyn Write) -> Self {
        Self {
            writer,
            is_terminal: false,
        }
    }

    /// Wraps a stream of the process. If the stream is a terminal, it shows colours.
    pub fn terminal(writer: &'w mut (impl Write + IsTerminal)) -> Self {
        Self {
            is_terminal: writer.is_terminal(),
            writer,
        }
    }

    fn write(&mut self, text: &[u8]) -> io::Result<()> {
        self.writer.write_all(text)?;
        self.writer.flush()
    }
}

/// The streams and the registry that a command needs in addition to its arguments.
pub struct Console<'c> {
    /// The joints and forces that scenes can use.
    pub registry: &'c Registry,
    out: RefCell<Stream<'c>>,
    err: RefCell<Stream<'c>>,
}

impl<'c> Console<'c> {
    /// Creates a console with these streams.
    pub fn new(registry: &'c Registry, out: Stream<'c>, err: Stream<'c>) -> Self {
        Self {
            registry,
            out: RefCell::new(out),
            err: RefCell::new(err),
        }
    }

    /// Writes an answer.
    ///
    /// # Errors
    /// Returns [`Failure::Closed`] if the reader has closed the output, and [`Refusal::Stopped`] if
    /// the output cannot be written.
    pub fn print(&self, text: &str) -> Outcome {
        self.write(|out| out.write_all(visible(text).as_bytes()))
    }

    /// Writes an answer as a document.
    ///
    /// # Errors
    /// Returns the errors of [`Console::print`].
    pub fn document(&self, document: &impl Serialize) -> Outcome {
        self.print(&json(document)?)
    }

    /// Writes an answer piece by piece.
    ///
    /// # Errors
    /// Returns the errors of [`Console::print`].
    pub fn write(&self, write: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> Outcome {
        let out = &mut self.out.borrow_mut();
        note_answer();
        let written = write(&mut *out.writer).and_then(|()| out.writer.flush());
        written.map_err(|e| match e.kind() {
            io::ErrorKind::BrokenPipe => Failure::Closed,
            _ => unprintable(&e),
        })
    }

    /// Writes the results of an incomplete computation. Returns the same failure even if the output
    /// cannot be written.
    pub fn incomplete(&self, text: &str) -> Failure {
        match self.print(text) {
            Ok(()) | Err(Failure::Closed) => Failure::Incomplete,
            Err(unsaid) => unsaid,
        }
    }

    /// Writes a remark to standard error.
    pub fn note(&self, text: &str) {
        // If the remark cannot be written, it is discarded.
        let _ = self
            .err
            .borrow_mut()
            .write(format!("note: {text}\n").as_bytes());
    }

    /// Whether answers are shown on a terminal.
    pub fn is_terminal(&self) -> bool {
        self.out.borrow().is_terminal
    }

    /// Whether answers are shown in colours.
    pub fn is_coloured(&self) -> bool {
        is_coloured(&self.out.borrow())
    }

    /// Reports the reason why a command did not finish, and returns the exit code. The report is a
    /// text, or a document that replaces the answer.
    pub fn report(&self, failure: Failure, answer: Answer) -> ExitCode {
        let code = match failure {
            Failure::Closed => return ExitCode::SUCCESS,
            Failure::Incomplete => return ExitCode::from(1),
            Failure::Refused(Refusal::Scene { .. } | Refusal::Input(..)) => 2,
            Failure::Refused(Refusal::Stopped(..)) => 1,
        };
        let unsaid = match answer {
            Answer::Json => failure.document().and_then(|text| self.print(&text)).err(),
            Answer::Words => Some(failure),
        };
        if let Some(failure) = unsaid {
            let mut err = self.err.borrow_mut();
            let words = failure.words(is_coloured(&err));
            // A write error on standard error cannot be reported.
            let _ = err.write(words.as_bytes());
        }
        ExitCode::from(code)
    }

    /// Prints the requested help, or reports the error in the command line.
    pub fn usage(&self, message: &clap::Error, answer: Answer) -> ExitCode {
        if message.use_stderr() {
            return self.misused(message, answer);
        }
        let mut stream = self.out.borrow_mut();
        let text = rendered(message, &stream);
        let written = stream.write(text.as_bytes());
        drop(stream);
        match written {
            Err(e) if e.kind() != io::ErrorKind::BrokenPipe => {
                self.report(unprintable(&e), Answer::Words)
            }
            _ => ExitCode::SUCCESS,
        }
    }

    fn misused(&self, message: &clap::Error, answer: Answer) -> ExitCode {
        let failure = Failure::input(in_one_line(message));
        if let Answer::Json = answer {
            return self.report(failure, answer);
        }
        let mut stream = self.err.borrow_mut();
        let text = rendered(message, &stream);
        let text = match message.kind() {
            NO_COMMAND => format!("{}\n{text}", failure.words(is_coloured(&stream))),
            _ => text.replacen(": ", &format!("[{}]: ", const { Code::new(1) }), 1),
        };
        // A write error on standard error cannot be reported.
        let _ = stream.write(text.as_bytes());
        ExitCode::from(2)
    }
}

/// The error kind whose text contains only the help.
const NO_COMMAND: ErrorKind = ErrorKind::DisplayHelpOnMissingArgumentOrSubcommand;

fn rendered(message: &clap::Error, stream: &Stream<'_>) -> String {
    let text = message.render();
    if is_coloured(stream) {
        text.ansi().to_string()
    } else {
        text.to_string()
    }
}

/// Returns the message of an error in the command line without the paragraphs about usage.
fn in_one_line(message: &clap::Error) -> String {
    if message.kind() == NO_COMMAND {
        return "the command line contains no command; `--help` lists all".to_owned();
    }
    let text = message.render().to_string();
    let text = text.strip_prefix("error: ").unwrap_or(&text);
    let said = text.split("\n\n").filter(|paragraph| {
        let usage = ["Usage:", "For more information"];
        !usage.iter().any(|begin| paragraph.starts_with(begin))
    });
    let lines = said.map(|paragraph| {
        let words: Vec<&str> = paragraph.split_whitespace().collect();
        words.join(" ")
    });
    lines.collect::<Vec<_>>().join("; ")
}

fn unprintable(e: &io::Error) -> Failure {
    Failure::stopped(format!("cannot write to standard output: {e}")).coded(const { Code::new(6) })
}

/// Whether the stream shows colours and the user permits colours. An empty `NO_COLOR` counts as not
/// set (no-color.org). A dumb terminal counts as a terminal without colours, because it would print
/// the colour codes.
fn is_coloured(stream: &Stream<'_>) -> bool {
    let refused = std::env::var_os("NO_COLOR").is_some_and(|value| !value.is_empty());
    let is_dumb = std::env::var_os("TERM").is_some_and(|value| value == "dumb");
    stream.is_terminal && !refused && !is_dumb
}
