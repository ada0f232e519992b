//! Limits of a command: threads and memory. A command that needs more memory than is available is
//! rejected before it starts. The error contains the number of bytes.

use std::num::NonZeroUsize;
use std::sync::atomic::{AtomicBool, Ordering};

use clap::Args;
use pfaff::memory::{Budget, Bytes};

use crate::console::Console;
use crate::output::Failure;

#[derive(Args, Clone, Copy, Default)]
pub(crate) struct Resources {
    /// Maximum number of threads [default: number of cores]
    #[arg(long, value_name = "K")]
    pub(crate) threads: Option<NonZeroUsize>,
    #[command(flatten)]
    pub(crate) memory: Memory,
}

#[derive(Args, Clone, Copy, Default)]
pub(crate) struct Memory {
    /// Reject computations that need more memory, e.g. 500MB or 4GiB [default: available memory]
    #[arg(long, value_name = "SIZE")]
    pub(crate) max_memory: Option<Bytes>,
}

/// Starts the threads of all parallel computations. If the system does not allow the threads, the
/// command prints one message.
pub(crate) fn start_threads(threads: Option<NonZeroUsize>, console: &Console<'_>) {
    static TOLD: AtomicBool = AtomicBool::new(false);
    if !pfaff::start_threads(threads) && !TOLD.swap(true, Ordering::Relaxed) {
        console.note(
            "the system could not start the requested threads: one thread computes everything",
        );
    }
}

impl Resources {
    /// Sets the number of threads for all parallel computations.
    pub(crate) fn apply(self, console: &Console<'_>) {
        start_threads(self.threads, console);
    }
}

impl Memory {
    /// Rejects a computation that needs more memory than is allowed.
    pub(crate) fn allow(self, bytes: usize, what: &str) -> Result<(), Failure> {
        Ok(self.budget().allow(bytes, what)?)
    }

    pub(crate) fn budget(self) -> Budget {
        Budget {
            limit: self.max_memory,
            option: "--max-memory",
        }
    }
}
