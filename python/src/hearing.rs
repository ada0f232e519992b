//! What a run hears of Python on its way: Ctrl-C, and callbacks that raise or ask it to end.

use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Mutex, PoisonError};
use std::time::Instant;

use pyo3::prelude::*;

/// Time (ms) between two looks for signals.
const BETWEEN: u64 = 20;

/// Hears signals and exceptions during one run.
pub(crate) struct Hearing {
    begun: Instant,
    /// When to look for signals again (ms).
    next: AtomicU64,
    ends: AtomicBool,
    raised: Mutex<Option<PyErr>>,
}

impl Hearing {
    pub(crate) fn new() -> Self {
        Self {
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
        if now < self.next.load(Ordering::Relaxed) {
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

    fn end(&self, raised: Option<PyErr>) {
        let mut first = self.raised.lock().unwrap_or_else(PoisonError::into_inner);
        if first.is_none() {
            *first = raised;
        }
        self.ends.store(true, Ordering::Relaxed);
    }

    /// The exception that ended the run.
    pub(crate) fn raised(self) -> Option<PyErr> {
        self.raised
            .into_inner()
            .unwrap_or_else(PoisonError::into_inner)
    }
}
