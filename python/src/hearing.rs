//! What long work hears of Python on its way: Ctrl-C, and callbacks that raise or ask it to end.

use std::any::Any;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread::{self, ThreadId};
use std::time::{Duration, Instant};

use pfaff::forked::on_own_threads;
use pfaff::refusal::Refusal;
use pyo3::prelude::*;

use crate::fault::{Fault, guarded, raised_by};

/// Time (ms) between two looks for signals.
const BETWEEN: u64 = 20;

/// Time that work has to end by itself after Ctrl-C: what asks often needs less, and has closed its
/// files then. What does not ask is left to itself: its thread ends with it, or with the process.
const PATIENCE: Duration = Duration::from_millis(500);

/// Stack (bytes) of a thread for work: that of a main thread of Linux. Only what is used is taken.
const STACK: usize = 8 << 20;

/// Does work on a thread of its own, without the interpreter, so that other threads of Python run.
/// This thread, on which alone Python hears signals, listens until the work is done. An exception
/// of Python goes before the result. A panic becomes an exception.
pub(crate) fn heard<T: Send + 'static>(
    py: Python<'_>,
    work: impl FnOnce(&Arc<Hearing>) -> Result<T, Fault> + Send + 'static,
) -> PyResult<T> {
    type Ended<T> = Result<Result<T, Fault>, Box<dyn Any + Send>>;
    let hearing = Arc::new(Hearing::new());
    let (done, waits) = channel::<Ended<T>>();
    let own = Arc::clone(&hearing);
    let job = move || {
        let outcome = catch_unwind(AssertUnwindSafe(|| on_own_threads(|| work(&own))));
        // After Ctrl-C no thread may wait for it.
        let _ = done.send(outcome);
    };
    let listening = Arc::clone(&hearing);
    let ended = py.detach(move || -> Result<Ended<T>, Fault> {
        let worker = thread::Builder::new().stack_size(STACK).spawn(job);
        worker.map_err(|e| Refusal::stopped(format!("cannot start a thread: {e}")))?;
        let mut until: Option<Instant> = None;
        loop {
            match waits.recv_timeout(Duration::from_millis(BETWEEN)) {
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

/// Does work that calls functions of Python, on the thread that calls, and that asks `ends` often.
/// An exception of Python goes before the result.
pub(crate) fn heard_here<T: Send>(
    py: Python<'_>,
    work: impl FnOnce(&Arc<Hearing>) -> Result<T, Fault> + Send,
) -> PyResult<T> {
    guarded(py, || {
        let hearing = Arc::new(Hearing::new());
        let done = work(&hearing);
        hearing.raised().map_or(done, |raised| Err(raised.into()))
    })
}

/// Hears signals and exceptions during one run.
pub(crate) struct Hearing {
    /// The thread that has been called: others cannot hear, and must not take its turn.
    caller: ThreadId,
    begun: Instant,
    /// When to look for signals again (ms).
    next: AtomicU64,
    ends: AtomicBool,
    raised: Mutex<Option<PyErr>>,
}

impl Hearing {
    pub(crate) fn new() -> Self {
        Self {
            caller: thread::current().id(),
            begun: Instant::now(),
            next: AtomicU64::new(BETWEEN),
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
        self.next.store(now + BETWEEN, Ordering::Relaxed);
        // Python hears signals on its main thread only; elsewhere this does nothing.
        if let Err(raised) = Python::attach(|py| py.check_signals()) {
            self.end(Some(raised));
        }
        self.has_ended()
    }

    /// Whether the run has to end, as far as that was heard on another thread.
    pub(crate) fn has_ended(&self) -> bool {
        self.ends.load(Ordering::Relaxed)
    }

    /// Calls back; an exception ends the run, and `True` as well.
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

    /// Ends the run; the first exception is kept.
    pub(crate) fn end(&self, raised: Option<PyErr>) {
        let mut first = self.raised.lock().unwrap_or_else(PoisonError::into_inner);
        if first.is_none() {
            *first = raised;
        }
        self.ends.store(true, Ordering::Relaxed);
    }

    /// The exception that ended the run.
    pub(crate) fn raised(&self) -> Option<PyErr> {
        let mut raised = self.raised.lock().unwrap_or_else(PoisonError::into_inner);
        raised.take()
    }
}
