//! Connects long work with Python: Ctrl-C, and callbacks that raise exceptions or request the end.
//!
//! Python delivers Ctrl-C only to the calling thread. A separate thread therefore does the work,
//! while the calling thread checks for signals. The thread then waits for the work of further
//! calls, because starting a thread takes as long as the analysis of a small mechanism.

use std::any::Any;
use std::io;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::mpsc::{RecvTimeoutError, SendError, Sender, channel};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::thread::{self, ThreadId};
use std::time::{Duration, Instant};

use pfaff::forked::on_own_threads;
use pfaff::refusal::Refusal;
use pfaff::words::in_units_of_scenes;
use pyo3::prelude::*;

use crate::fault::{Fault, guarded, raised_by};

/// Time between two checks for signals.
pub(crate) const BETWEEN: Duration = Duration::from_millis(20);

/// Time within which work has to end after Ctrl-C. Work that calls the check often needs less time,
/// and closes its files before it ends. Other work is abandoned: its thread ends when the work or
/// the process ends.
const PATIENCE: Duration = Duration::from_millis(500);

/// Stack size (bytes) of a thread for work, equal to the stack size of the main thread on Linux.
/// Only the used part of the stack needs memory.
pub(crate) const STACK: usize = 8 << 20;

/// Does work on a separate thread, without the interpreter, so that other Python threads run. The
/// calling thread checks for signals until the work is done, because Python receives signals only
/// on this thread. A Python exception takes precedence over the result. A panic becomes an
/// exception.
pub(crate) fn heard<T: Send + 'static>(
    py: Python<'_>,
    work: impl FnOnce(&Arc<Hearing>) -> Result<T, Fault> + Send + 'static,
) -> PyResult<T> {
    type Ended<T> = Result<Result<T, Fault>, Box<dyn Any + Send>>;
    let hearing = Arc::new(Hearing::new());
    let (done, waits) = channel::<Ended<T>>();
    let own = Arc::clone(&hearing);
    let job = move |wait: &dyn Fn()| {
        let outcome = catch_unwind(AssertUnwindSafe(|| {
            on_own_threads(|| in_units_of_scenes(|| work(&own)))
        }));
        // The next call of this thread uses the same worker.
        wait();
        // After Ctrl-C the calling thread may no longer wait for the result.
        let _ = done.send(outcome);
    };
    let listening = Arc::clone(&hearing);
    let ended = py.detach(move || -> Result<Ended<T>, Fault> {
        start(Box::new(job))
            .map_err(|e| Refusal::stopped(format!("cannot start a thread: {e}")))?;
        let mut until: Option<Instant> = None;
        loop {
            match waits.recv_timeout(BETWEEN) {
                Ok(ended) => return Ok(ended),
                Err(RecvTimeoutError::Disconnected) => {
                    return Err(Refusal::stopped("its thread has ended".to_owned()).into());
                }
                Err(RecvTimeoutError::Timeout) => {}
            }
            if listening.ends() {
                let until = *until.get_or_insert_with(|| Instant::now() + PATIENCE);
                if Instant::now() >= until {
                    let left = || Refusal::stopped("the work was left".to_owned()).into();
                    return Err(listening.raised().map_or_else(left, Fault::from));
                }
            }
        }
    });
    if let Some(raised) = hearing.raised() {
        return Err(raised);
    }
    match ended {
        Ok(Ok(Ok(result))) => Ok(result),
        Ok(Ok(Err(fault))) | Err(fault) => Err(fault.raised(py)),
        Ok(Err(panic)) => Err(raised_by(py, panic.as_ref())),
    }
}

/// Work for a thread. The work calls its argument when the thread can accept further work.
type Job = Box<dyn FnOnce(&dyn Fn()) + Send>;

/// Threads that wait for work, with the process that started them: a forked process does not have
/// the threads of its parent.
static WAITING: Mutex<Vec<(u32, Sender<Job>)>> = Mutex::new(Vec::new());

fn waiting() -> MutexGuard<'static, Vec<(u32, Sender<Job>)>> {
    WAITING.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Does work on a thread that waits for work, or on a new thread.
fn start(mut job: Job) -> io::Result<()> {
    let process = std::process::id();
    while let Some((owner, worker)) = { waiting().pop() } {
        if owner != process {
            // The other end belongs to a thread that does not exist.
            std::mem::forget(worker);
            continue;
        }
        match worker.send(job) {
            Ok(()) => return Ok(()),
            Err(SendError(refused)) => job = refused,
        }
    }
    let (worker, jobs) = channel::<Job>();
    let wait = move || waiting().push((process, worker.clone()));
    let work = move || {
        job(&wait);
        jobs.iter().for_each(|job| job(&wait));
    };
    thread::Builder::new().stack_size(STACK).spawn(work)?;
    Ok(())
}

/// Does work that calls Python functions, on the calling thread. The work must call `ends` often. A
/// Python exception takes precedence over the result.
pub(crate) fn heard_here<T: Send>(
    py: Python<'_>,
    work: impl FnOnce(&Arc<Hearing>) -> Result<T, Fault> + Send,
) -> PyResult<T> {
    guarded(py, || {
        let hearing = Arc::new(Hearing::new());
        let done = in_units_of_scenes(|| work(&hearing));
        hearing.raised().map_or(done, |raised| Err(raised.into()))
    })
}

/// Receives signals and exceptions during one run.
pub(crate) struct Hearing {
    /// The calling thread: other threads cannot receive signals, and must not reset the time of the
    /// next check.
    caller: ThreadId,
    begun: Instant,
    /// Time of the next check for signals (ms).
    next: AtomicU64,
    ends: AtomicBool,
    raised: Mutex<Option<PyErr>>,
}

impl Hearing {
    pub(crate) fn new() -> Self {
        Self {
            caller: thread::current().id(),
            begun: Instant::now(),
            next: AtomicU64::new(BETWEEN.as_millis() as u64),
            ends: AtomicBool::new(false),
            raised: Mutex::new(None),
        }
    }

    /// Whether the run has to end. Most calls only read a clock.
    pub(crate) fn ends(&self) -> bool {
        if self.has_ended() {
            return true;
        }
        let now = self.begun.elapsed().as_millis() as u64;
        if now < self.next.load(Ordering::Relaxed) || thread::current().id() != self.caller {
            return false;
        }
        self.next
            .store(now + BETWEEN.as_millis() as u64, Ordering::Relaxed);
        // Python receives signals only on its main thread; on other threads this has no effect.
        if let Err(raised) = Python::attach(|py| py.check_signals()) {
            self.end(Some(raised));
        }
        self.has_ended()
    }

    /// Whether the run has to end according to a check on any thread.
    pub(crate) fn has_ended(&self) -> bool {
        self.ends.load(Ordering::Relaxed)
    }

    /// Calls a callback. An exception or the return value `True` ends the run.
    pub(crate) fn call(&self, call: impl FnOnce(Python<'_>) -> PyResult<Py<PyAny>>) {
        let asked = Python::attach(|py| call(py)?.bind(py).is_truthy());
        match asked {
            Ok(false) => {}
            Ok(true) => self.end(None),
            Err(raised) => self.end(Some(raised)),
        }
    }

    /// Whether an exception has ended the run.
    pub(crate) fn has_raised(&self) -> bool {
        let raised = self.raised.lock().unwrap_or_else(PoisonError::into_inner);
        raised.is_some()
    }

    /// Ends the run and stores the first exception.
    pub(crate) fn end(&self, raised: Option<PyErr>) {
        let mut first = self.raised.lock().unwrap_or_else(PoisonError::into_inner);
        if first.is_none() {
            *first = raised;
        }
        self.ends.store(true, Ordering::Relaxed);
    }

    /// Returns the exception that ended the run.
    pub(crate) fn raised(&self) -> Option<PyErr> {
        let mut raised = self.raised.lock().unwrap_or_else(PoisonError::into_inner);
        raised.take()
    }
}
