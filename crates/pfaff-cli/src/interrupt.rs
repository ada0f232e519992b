//! Requests to stop from outside: Ctrl-C, the end of the terminal, and the signal that ends
//! processes.

use std::process;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, PoisonError};

use crate::output::Failure;

/// Exit code of a program that was interrupted.
const INTERRUPTED: i32 = 1;

/// Whether somebody asked to stop. The first request is for the computation, which keeps what it
/// has; a second one ends the program at once, wherever it is.
#[derive(Clone)]
pub struct Interrupt(Arc<AtomicBool>);

impl Interrupt {
    /// Listens from now on.
    ///
    /// # Errors
    /// The system does not let it.
    pub fn listen() -> Result<Self, Failure> {
        let asked = Arc::new(AtomicBool::new(false));
        let flag = Arc::clone(&asked);
        on_request(move || {
            if flag.swap(true, Ordering::Relaxed) {
                process::exit(INTERRUPTED);
            }
        })?;
        Ok(Self(asked))
    }

    /// Listens for a command that has nothing to keep: the first request ends it.
    ///
    /// # Errors
    /// As [`Interrupt::listen`].
    pub fn ends_at_once() -> Result<(), Failure> {
        on_request(|| process::exit(INTERRUPTED))
    }

    /// Listens for a command that goes on until it is told to stop: that is its end, not its
    /// failure.
    ///
    /// # Errors
    /// As [`Interrupt::listen`].
    pub fn ends_well() -> Result<(), Failure> {
        on_request(|| process::exit(0))
    }

    /// Whether somebody asked.
    pub fn is_asked(&self) -> bool {
        self.0.load(Ordering::Relaxed)
    }
}

/// What a request does at present: a later command of the same process takes it over.
static ACTION: Mutex<Option<Action>> = Mutex::new(None);

type Action = Box<dyn FnMut() + Send>;

fn on_request(action: impl FnMut() + Send + 'static) -> Result<(), Failure> {
    let mut present = ACTION.lock().unwrap_or_else(PoisonError::into_inner);
    let is_first = present.replace(Box::new(action)).is_none();
    drop(present);
    if !is_first {
        return Ok(());
    }
    let asked = || {
        let mut present = ACTION.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(action) = present.as_mut() {
            action();
        }
    };
    ctrlc::set_handler(asked)
        .map_err(|e| Failure::stopped(format!("cannot listen for interrupts: {e}")))
}
