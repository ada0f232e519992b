//! Processes that test texts, with limits of time and memory. A process that ends too early or does
//! not answer in time is a failure.

use std::io::{self, Read, Write};
use std::path::PathBuf;
use std::process::{Child, Command, Stdio};
use std::sync::mpsc::{Receiver, RecvTimeoutError, channel};
use std::thread;
use std::time::{Duration, Instant};

use crate::fuzz::trial::{Reach, Stage};

/// Program of a process, and its limits.
#[derive(Clone, Debug)]
pub struct Limits {
    /// Path of the program.
    pub program: PathBuf,
    /// Longest time for one text.
    pub deadline: Duration,
    /// Largest memory (MiB). The limit is enforced if a shell supports it.
    pub memory: u64,
}

/// The failure of a trial.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Fault {
    /// The process ended, for instance because of a panic, a stack overflow, or too little memory.
    Died {
        /// Location and cause: the line of the panic, or the way in which the process ended.
        place: String,
        /// Last output of the process.
        words: String,
    },
    /// The trial took too long.
    Hung {
        /// The stage that took too long.
        place: String,
    },
}

impl Fault {
    /// Returns the location, which is the same for faults with the same cause.
    #[must_use]
    pub fn place(&self) -> &str {
        match self {
            Self::Died { place, .. } | Self::Hung { place } => place,
        }
    }
}

/// Tests one text.
///
/// # Errors
/// Returns an error if the process cannot be started.
pub fn one(limits: &Limits, text: &str) -> io::Result<Result<Reach, Fault>> {
    let mut worker = Worker::begin(limits, &["try", "-"], Some(text))?;
    let answer = worker.answer(limits.deadline);
    worker.end();
    Ok(answer)
}

/// A running process. It writes a letter for each [`Stage`] that begins and for the [`Reach`] of
/// each text.
pub struct Worker {
    child: Child,
    answers: Receiver<u8>,
    words: Option<thread::JoinHandle<String>>,
}

impl Worker {
    /// Starts the process.
    ///
    /// # Errors
    /// Returns an error if there is no such program, or if no more processes are allowed.
    pub fn begin(limits: &Limits, arguments: &[&str], input: Option<&str>) -> io::Result<Self> {
        let mut command = if cfg!(unix) {
            let mut shell = Command::new("sh");
            let script = format!("ulimit -v {}; exec \"$0\" \"$@\"", 1024 * limits.memory);
            shell.args(["-c", &script]).arg(&limits.program);
            shell
        } else {
            Command::new(&limits.program)
        };
        let mut child = command
            .arg("fuzz")
            .args(arguments)
            .env("RUST_BACKTRACE", "0")
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()?;
        if let (Some(mut stdin), Some(text)) = (child.stdin.take(), input) {
            // If the process has already ended, it does not answer. The missing answer is detected
            // later.
            let _ = stdin.write_all(text.as_bytes());
        }
        let (send, answers) = channel();
        if let Some(mut stdout) = child.stdout.take() {
            thread::spawn(move || {
                let mut bytes = [0; 256];
                while let Ok(n @ 1..) = stdout.read(&mut bytes) {
                    if bytes[..n].iter().any(|b| send.send(*b).is_err()) {
                        return;
                    }
                }
            });
        }
        let words = child.stderr.take().map(|mut stderr| {
            thread::spawn(move || {
                let mut bytes = Vec::new();
                let _ = stderr.read_to_end(&mut bytes);
                String::from_utf8_lossy(&bytes).into_owned()
            })
        });
        Ok(Self {
            child,
            answers,
            words,
        })
    }

    /// Returns the answer for the next text.
    ///
    /// # Errors
    /// Returns a [`Fault`] if there is no answer.
    pub fn answer(&mut self, deadline: Duration) -> Result<Reach, Fault> {
        let (end, mut stage) = (Instant::now() + deadline, None);
        loop {
            let left = end.saturating_duration_since(Instant::now());
            match self.answers.recv_timeout(left).map(char::from) {
                Ok(letter) => match Reach::ALL.into_iter().find(|r| r.letter() == letter) {
                    Some(reach) => return Ok(reach),
                    None => stage = Stage::ALL.into_iter().find(|s| s.letter() == letter),
                },
                Err(RecvTimeoutError::Timeout) => {
                    let place = format!("hang, stage {stage:?}");
                    return Err(Fault::Hung { place });
                }
                Err(RecvTimeoutError::Disconnected) => return Err(self.died()),
            }
        }
    }

    fn died(&mut self) -> Fault {
        let status = self.child.wait();
        let words = self
            .words
            .take()
            .and_then(|thread| thread.join().ok())
            .unwrap_or_default();
        let panicked = words
            .lines()
            .find_map(|line| line.split_once("panicked at "));
        let place = match (panicked, status) {
            (Some((_, place)), _) => place.trim_end_matches(':').to_owned(),
            (None, Ok(status)) => status.to_string(),
            (None, Err(e)) => e.to_string(),
        };
        Fault::Died { place, words }
    }

    /// Ends the process immediately.
    pub fn end(mut self) {
        // This fails if the process has already ended.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}
