//! Requests to stop from outside: Ctrl-C, the end of the terminal, and the signal that ends
//! processes. A command that has results to keep hears the first request and ends by itself; if it
//! has not ended after a short time, or at the second request, its process ends.

use std::io::{self, Write};
use std::process;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::channel;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::thread;
use std::time::Duration;

use pfaff::question::{INTERRUPTED as BY_REQUEST, NOTHING_WRITTEN};

use crate::output::{Answer, Failure};

/// Exit code of a program that was interrupted.
const INTERRUPTED: i32 = 1;

/// Time that a command has to end by itself: with the time for its last act it is less than a
/// second, after which people press Ctrl-C again.
const GRACE: Duration = Duration::from_millis(600);

/// Time for the last act of a command that has to be ended.
const LAST_ACT: Duration = Duration::from_millis(250);

/// What is left to do for a command that is ended: it puts the files in order, and says what was
/// kept.
type LastAct = Arc<dyn Fn() -> String + Send + Sync>;

/// Requests to stop, as heard by a command that keeps its results.
pub struct Interrupt(Arc<AtomicBool>);

/// What a request does at present.
enum Action {
    /// Ends the process with this code; a code other than 0 with these words.
    End(i32, &'static str),
    /// Is heard by the command; the process ends after a time, or at the second request.
    Hear {
        asked: Arc<AtomicBool>,
        last_act: LastAct,
    },
}

/// The action, and the form of its words. A later command of the same process replaces it.
static ACTION: Mutex<Option<Action>> = Mutex::new(None);
static AS_JSON: AtomicBool = AtomicBool::new(false);
/// Whether the command has answered.
static ANSWERED: AtomicBool = AtomicBool::new(false);

impl Interrupt {
    /// Starts listening for requests.
    ///
    /// # Errors
    /// If the system does not allow it.
    pub fn listen() -> Result<Self, Failure> {
        Self::listen_with(|| "interrupted".to_owned())
    }

    /// Starts listening for requests; `last_act` puts files in order if the command has to be
    /// ended, and returns what it has kept, in words.
    ///
    /// # Errors
    /// If the system does not allow it.
    pub fn listen_with(
        last_act: impl Fn() -> String + Send + Sync + 'static,
    ) -> Result<Self, Failure> {
        let asked = Arc::new(AtomicBool::new(false));
        on_request(Action::Hear {
            asked: Arc::clone(&asked),
            last_act: Arc::new(last_act),
        })?;
        Ok(Self(asked))
    }

    /// Starts listening for a command without results to keep: the first request ends it.
    ///
    /// # Errors
    /// As [`Interrupt::listen`].
    pub fn ends_at_once() -> Result<(), Failure> {
        on_request(Action::End(INTERRUPTED, NOTHING_WRITTEN))
    }

    /// Starts listening for a command that runs until it is stopped: a request is its normal end,
    /// not a failure.
    ///
    /// # Errors
    /// As [`Interrupt::listen`].
    pub fn ends_well() -> Result<(), Failure> {
        on_request(Action::End(0, ""))
    }

    /// Whether a stop has been requested.
    pub fn is_asked(&self) -> bool {
        self.0.load(Ordering::Relaxed)
    }
}

impl Drop for Interrupt {
    /// The command is over: there is nothing to wait for.
    fn drop(&mut self) {
        let mut present = action();
        let is_own = |action: &Action| matches!(action, Action::Hear { asked, .. } if Arc::ptr_eq(asked, &self.0));
        if present.as_ref().is_some_and(is_own) {
            *present = Some(Action::End(INTERRUPTED, ""));
        }
    }
}

/// Sets the form of words about requests of the command that begins.
pub(crate) fn answer_as(answer: Answer) {
    AS_JSON.store(matches!(answer, Answer::Json), Ordering::Relaxed);
    ANSWERED.store(false, Ordering::Relaxed);
}

/// Notes that the command has answered: no other document may follow.
pub(crate) fn note_answer() {
    ANSWERED.store(true, Ordering::Relaxed);
}

fn action() -> MutexGuard<'static, Option<Action>> {
    ACTION.lock().unwrap_or_else(PoisonError::into_inner)
}

fn on_request(new: Action) -> Result<(), Failure> {
    if action().replace(new).is_some() {
        return Ok(());
    }
    // Listening needs a thread. Where there is none, the system ends the process as it always does.
    if thread::Builder::new().spawn(|| ()).is_err() {
        return Ok(());
    }
    ctrlc::set_handler(heard)
        .map_err(|e| Failure::stopped(format!("cannot listen for interrupts: {e}")))
}

/// Reacts to a request, on a thread of its own.
fn heard() {
    let present = action();
    match present.as_ref() {
        None => process::exit(INTERRUPTED),
        Some(Action::End(code, words)) => {
            let (code, words) = (*code, *words);
            drop(present);
            end(code, move || words.to_owned());
        }
        Some(Action::Hear { asked, last_act }) => {
            let (asked, last_act) = (Arc::clone(asked), Arc::clone(last_act));
            drop(present);
            if asked.swap(true, Ordering::Relaxed) {
                end(INTERRUPTED, move || last_act());
            }
            let late = move || {
                thread::sleep(GRACE);
                let is_present = matches!(
                    action().as_ref(),
                    Some(Action::Hear { asked: present, .. }) if Arc::ptr_eq(present, &asked)
                );
                if is_present {
                    end(INTERRUPTED, move || last_act());
                }
            };
            if thread::Builder::new().spawn(late).is_err() {
                // Then only a second request ends the process.
            }
        }
    }
}

/// Ends the process after its last act and its last words, as far as there is time for them.
fn end(code: i32, last_act: impl FnOnce() -> String + Send + 'static) -> ! {
    let (done, is_done) = channel();
    let act = move || {
        say(&last_act());
        // Nobody listens if it took too long.
        let _ = done.send(());
    };
    if thread::Builder::new().spawn(act).is_ok() {
        let _ = is_done.recv_timeout(LAST_ACT);
    }
    process::exit(code)
}

/// Writes the last words to the streams of the process, because those of the command may be
/// blocked.
fn say(words: &str) {
    if words.is_empty() || ANSWERED.load(Ordering::Relaxed) {
        return;
    }
    let failure = Failure::stopped(words.to_owned()).coded(BY_REQUEST);
    // The process ends, whether or not anybody hears it.
    let _ = if AS_JSON.load(Ordering::Relaxed) {
        let document = failure.document().unwrap_or_default();
        io::stdout().write_all(document.as_bytes())
    } else {
        io::stderr().write_all(failure.words(false).as_bytes())
    };
}
