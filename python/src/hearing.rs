//! What long work hears of Python on its way: Ctrl-C, and callbacks that raise or ask it to end.

use std::panic::resume_unwind;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::sync::{Mutex, PoisonError};
use std::thread::{self, ThreadId};
use std::time::{Duration, Instant};

use pfaff::refusal::Refusal;
use pyo3::prelude::*;

use crate::fault::Fault;

/// Time (ms) between two looks for signals.
const BETWEEN: u64 = 20;

/// Does work that asks `ends` often and is not asked for anything by Python: it goes on a thread of
/// its own, and this one, on which alone Python hears signals, listens until it is done. An
/// exception goes before its result.
pub(crate) fn heard<T: Send>(
    work: impl FnOnce(&(dyn Fn() -> bool + Sync)) -> Result<T, Fault> + Send,
) -> Result<T, Fault> {
    let hearing = Hearing::new();
    let asked = || hearing.ends.load(Ordering::Relaxed);
    let (ended, waits) = channel::<()>();
    let done = thread::scope(|scope| {
        let worker = thread::Builder::new().spawn_scoped(scope, || {
            // Dropped at the end, also by a panic.
            let _ended = ended;
            work(&asked)
        });
        let worker = worker.map_err(|e| Refusal::stopped(format!("cannot start a thread: {e}")))?;
        let between = Duration::from_millis(BETWEEN);
        while waits.recv_timeout(between) == Err(RecvTimeoutError::Timeout) {
            hearing.ends();
        }
        worker.join().unwrap_or_else(|panic| resume_unwind(panic))
    });
    match hearing.raised() {
        Some(raised) => Err(raised.into()),
        None => done,
    }
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
        if self.ends.load(Ordering::Relaxed) {
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
        self.ends.load(Ordering::Relaxed)
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
