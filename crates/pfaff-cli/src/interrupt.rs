//! Requests to stop from outside: Ctrl-C, the end of the terminal, and the termination signal. A
//! command that has results to keep receives the first request and ends itself. If the command has
//! not ended after a short time, or if there is a second request, the process ends.

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

/// Time within which a command must end itself. The sum of this time and the time for the last
/// action is less than a second, because users press Ctrl-C again after about a second.
const GRACE: Duration = Duration::from_millis(600);

/// Time for the last action of a command that has not ended itself.
const LAST_ACT: Duration = Duration::from_millis(250);

/// Time for the last action after a second request. In this case, the process does not wait for the
/// command. A disk that is busy with files of other processes needs longer than [`LAST_ACT`] to
/// rename a file.
const LAST_ACT_AT_ONCE: Duration = GRACE.saturating_add(LAST_ACT);

/// The last action of a command that must end early. It completes the files, and returns a text
/// about the saved results.
type LastAct = Arc<dyn Fn() -> String + Send + Sync>;

/// Requests to stop for a command that keeps its results.
pub struct Interrupt(Arc<AtomicBool>);

/// The current effect of a request.
enum Action {
    /// Ends the process with this exit code. For a code other than 0, this message is printed.
    End(i32, &'static str),
    /// The command receives the request. The process ends after a time limit, or at the second
    /// request.
    Hear {
        asked: Arc<AtomicBool>,
        last_act: LastAct,
    },
}

/// The current effect of a request. A later command of the same process replaces this value.
static ACTION: Mutex<Option<Action>> = Mutex::new(None);
static AS_JSON: AtomicBool = AtomicBool::new(false);
/// Whether a thread is ending the process.
static IS_ENDING: AtomicBool = AtomicBool::new(false);
/// Whether the command has printed its answer.
static ANSWERED: AtomicBool = AtomicBool::new(false);

impl Interrupt {
    /// Starts to listen for requests.
    ///
    /// # Errors
    /// Returns an error if the system does not allow the program to listen.
    pub fn listen() -> Result<Self, Failure> {
        Self::listen_with(|| "interrupted".to_owned())
    }

    /// Starts to listen for requests. If the command must end early, `last_act` completes the files
    /// and returns a text about the saved results.
    ///
    /// # Errors
    /// Returns an error if the system does not allow the program to listen.
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

    /// Starts to listen for a command without results to keep. The first request ends the command.
    ///
    /// # Errors
    /// Returns the errors of [`Interrupt::listen`].
    pub fn ends_at_once() -> Result<(), Failure> {
        on_request(Action::End(INTERRUPTED, NOTHING_WRITTEN))
    }

    /// Starts to listen for a command that runs until it is stopped. A request is the normal end of
    /// the command, not a failure.
    ///
    /// # Errors
    /// Returns the errors of [`Interrupt::listen`].
    pub fn ends_well() -> Result<(), Failure> {
        on_request(Action::End(0, ""))
    }

    /// Whether a stop has been requested.
    pub fn is_asked(&self) -> bool {
        self.0.load(Ordering::Relaxed)
    }
}

impl Drop for Interrupt {
    /// The command has ended, so no last action is needed. If a last action has begun, this action
    /// ends the process. The last action takes the files from the command, so the command fails;
    /// the command must not end the process first.
    fn drop(&mut self) {
        let mut present = action();
        if IS_ENDING.load(Ordering::Relaxed) {
            drop(present);
            thread::sleep(LAST_ACT_AT_ONCE);
            return;
        }
        let is_own = |action: &Action| matches!(action, Action::Hear { asked, .. } if Arc::ptr_eq(asked, &self.0));
        if present.as_ref().is_some_and(is_own) {
            *present = Some(Action::End(INTERRUPTED, ""));
        }
    }
}

/// Sets the form of messages about requests for the command that begins.
pub(crate) fn answer_as(answer: Answer) {
    AS_JSON.store(matches!(answer, Answer::Json), Ordering::Relaxed);
    ANSWERED.store(false, Ordering::Relaxed);
}

/// Records that the command has printed its answer: no other document may follow.
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
    // The listener needs a thread. If no thread can be started, the system ends the process in its
    // default way.
    if thread::Builder::new().spawn(|| ()).is_err() {
        return Ok(());
    }
    ctrlc::set_handler(heard)
        .map_err(|e| Failure::stopped(format!("cannot listen for interrupts: {e}")))
}

/// Reacts to a request, on a separate thread.
fn heard() {
    let present = action();
    match present.as_ref() {
        None => process::exit(INTERRUPTED),
        Some(Action::End(code, words)) => {
            let (code, words) = (*code, *words);
            end(present, code, LAST_ACT, move || words.to_owned());
        }
        Some(Action::Hear { asked, last_act }) => {
            let (asked, last_act) = (Arc::clone(asked), Arc::clone(last_act));
            if asked.swap(true, Ordering::Relaxed) {
                end(present, INTERRUPTED, LAST_ACT_AT_ONCE, move || last_act());
            }
            drop(present);
            let late = move || {
                thread::sleep(GRACE);
                let present = action();
                let is_present = matches!(
                    present.as_ref(),
                    Some(Action::Hear { asked: present, .. }) if Arc::ptr_eq(present, &asked)
                );
                if is_present {
                    end(present, INTERRUPTED, LAST_ACT, move || last_act());
                }
            };
            if thread::Builder::new().spawn(late).is_err() {
                // In this case, only a second request ends the process.
            }
        }
    }
}

/// Ends the process after the last action and the last message. The process ends earlier if both
/// take longer than `limit`.
fn end(
    present: MutexGuard<'_, Option<Action>>,
    code: i32,
    limit: Duration,
    last_act: impl FnOnce() -> String + Send + 'static,
) -> ! {
    let is_first = !IS_ENDING.swap(true, Ordering::Relaxed);
    drop(present);
    if !is_first {
        // The thread with the first last action ends the process.
        thread::sleep(LAST_ACT_AT_ONCE);
    }
    let (done, is_done) = channel();
    let act = move || {
        say(&last_act());
        // If the action took too long, the receiver no longer exists.
        let _ = done.send(());
    };
    if thread::Builder::new().spawn(act).is_ok() {
        let _ = is_done.recv_timeout(limit);
    }
    process::exit(code)
}

/// Writes the last message to the streams of the process, because the streams of the command may be
/// blocked.
fn say(words: &str) {
    if words.is_empty() || ANSWERED.load(Ordering::Relaxed) {
        return;
    }
    let failure = Failure::stopped(words.to_owned()).coded(BY_REQUEST);
    // The process ends even if the message cannot be written.
    let _ = if AS_JSON.load(Ordering::Relaxed) {
        let document = failure.document().unwrap_or_default();
        io::stdout().write_all(document.as_bytes())
    } else {
        io::stderr().write_all(failure.words(false).as_bytes())
    };
}
