//! Threads for parallel computations. If the system starts no threads, the calling thread computes
//! everything.

use std::io::{self, ErrorKind};
use std::num::NonZeroUsize;
use std::sync::OnceLock;
use std::sync::mpsc::{Sender, channel};
use std::thread;

use rayon::{ThreadBuilder, ThreadPool, ThreadPoolBuilder};

/// Largest number of threads for parallel computations.
pub const MOST_THREADS: usize = 256;

/// Starts the threads of all parallel computations of this program. The number of threads is the
/// given number, but at most [`MOST_THREADS`]. If no number is given, there is one thread for each
/// core. If the system does not allow this number, the calling thread computes everything, and the
/// function returns `false`. A second call has no effect and returns the result of the first call.
/// Runs with several components have a separate option, [`dynamics::MotionOptions::threads`].
pub fn start_threads(threads: Option<NonZeroUsize>) -> bool {
    static STARTED: OnceLock<bool> = OnceLock::new();
    *STARTED.get_or_init(|| {
        let waiting = waiting(most(threads));
        let started = waiting.is_ok();
        // The call fails if the program has started a thread pool itself.
        let _ = match waiting {
            Ok(waiting) => {
                let pool = ThreadPoolBuilder::new().num_threads(waiting.len());
                pool.spawn_handler(to_these(waiting)).build_global()
            }
            Err(_) => alone().build_global(),
        };
        started
    })
}

/// Creates a pool that consists of the calling thread.
pub(crate) fn alone() -> ThreadPoolBuilder {
    ThreadPoolBuilder::new().num_threads(1).use_current_thread()
}

/// Returns the number of threads of parallel computations.
#[must_use]
pub fn threads() -> usize {
    rayon::current_num_threads()
}

/// The threads that a part of a program uses.
pub(crate) enum Workers {
    /// A separate pool.
    Own(ThreadPool),
    /// The calling thread.
    Caller,
}

impl Workers {
    /// See [`start_threads`].
    pub(crate) fn start(threads: Option<NonZeroUsize>) -> Self {
        let waiting = waiting(most(threads)).ok();
        let own = waiting.and_then(|waiting| {
            let pool = ThreadPoolBuilder::new().num_threads(waiting.len());
            pool.spawn_handler(to_these(waiting)).build().ok()
        });
        own.map_or_else(
            || {
                // Parallel computations need a thread pool.
                start_threads(None);
                Self::Caller
            },
            Self::Own,
        )
    }

    pub(crate) fn number(&self) -> usize {
        match self {
            Self::Own(pool) => pool.current_num_threads().max(1),
            Self::Caller => 1,
        }
    }

    /// Returns the result of a computation on these threads.
    pub(crate) fn install<R: Send>(&self, compute: impl FnOnce() -> R + Send) -> R {
        match self {
            Self::Own(pool) => pool.install(compute),
            Self::Caller => compute(),
        }
    }

    /// Returns the results of the same computation on each of these threads.
    pub(crate) fn broadcast<R: Send>(&self, compute: impl Fn() -> R + Sync) -> Vec<R> {
        match self {
            Self::Own(pool) => pool.broadcast(|_| compute()),
            Self::Caller => vec![compute()],
        }
    }
}

fn most(threads: Option<NonZeroUsize>) -> usize {
    let cores = thread::available_parallelism().map_or(1, NonZeroUsize::get);
    threads.map_or(cores, NonZeroUsize::get).min(MOST_THREADS)
}

/// Starts threads that wait for their work, so that either all threads of a pool exist or no thread
/// of the pool exists. An incomplete pool cannot be started again. The threads end if they receive
/// no work.
fn waiting(number: usize) -> io::Result<Vec<Sender<ThreadBuilder>>> {
    let mut threads = Vec::with_capacity(number);
    for _ in 0..number {
        let (sender, receiver) = channel::<ThreadBuilder>();
        let work = move || {
            if let Ok(work) = receiver.recv() {
                work.run();
            }
        };
        match thread::Builder::new().spawn(work) {
            Ok(handle) => threads.push((sender, handle)),
            Err(e) => {
                // The memory of the threads that end must be free for later computations.
                for (sender, handle) in threads {
                    drop(sender);
                    let _ = handle.join();
                }
                return Err(e);
            }
        }
    }
    Ok(threads.into_iter().map(|(sender, _)| sender).collect())
}

/// Passes the work of a pool to threads that wait for this work.
fn to_these(
    mut waiting: Vec<Sender<ThreadBuilder>>,
) -> impl FnMut(ThreadBuilder) -> io::Result<()> {
    move |work| {
        let thread = waiting.pop().ok_or(ErrorKind::NotFound)?;
        thread.send(work).map_err(|_| ErrorKind::BrokenPipe.into())
    }
}
