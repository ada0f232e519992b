//! Requests to stop from outside: Ctrl-C, the end of the terminal, and the signal that ends
//! processes.

use std::process;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, PoisonError};

use crate::output::Failure;

/// Exit code of a program that was interrupted.
const INTERRUPTED: i32 = 1;

/// Whether a stop has been requested. The computation reacts to the first request and keeps its
/// results; a second request ends the program at once.
#[derive(Clone)]
pub struct Interrupt(Arc<AtomicBool>);

impl Interrupt {
    /// Starts listening for requests.
    ///
    /// # Errors
    /// If the system does not allow it.
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

    /// Starts listening for a command without results to keep: the first request ends it.
    ///
    /// # Errors
    /// As [`Interrupt::listen`].
    pub fn ends_at_once() -> Result<(), Failure> {
        on_request(|| process::exit(INTERRUPTED))
    }

    /// Starts listening for a command that runs until it is stopped: a request is its normal end,
    /// not a failure.
    ///
    /// # Errors
    /// As [`Interrupt::listen`].
    pub fn ends_well() -> Result<(), Failure> {
        on_request(|| process::exit(0))
    }

    /// Whether a stop has been requested.
    pub fn is_asked(&self) -> bool {
        self.0.load(Ordering::Relaxed)
    }
}

/// The effect of a request at present; a later command of the same process replaces it.
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
