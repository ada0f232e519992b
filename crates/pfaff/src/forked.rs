//! Parallel work in a process that was created by a fork.
//!
//! A forked process inherits the thread pool of its parent, but not the threads of the pool. Work
//! for this pool would wait forever. Programs that fork (for example with `multiprocessing` of
//! Python) must do parallel work through [`on_own_threads`] or [`on_this_thread`], before the fork
//! and after it.

use std::sync::atomic::{AtomicU32, Ordering};
use std::sync::{Arc, Mutex, PoisonError};

use rayon::ThreadPool;

use crate::workers::{Workers, alone};

/// Identifier of the process that first did parallel work. The value is 0 before any parallel work.
static FIRST: AtomicU32 = AtomicU32::new(0);

/// The thread pool of a forked process, with the identifier of the process.
static POOL: Mutex<Option<(u32, Arc<ThreadPool>)>> = Mutex::new(None);

/// Whether this process was forked from a process that had done parallel work.
fn is_forked() -> bool {
    let own = std::process::id();
    let first = FIRST.compare_exchange(0, own, Ordering::Relaxed, Ordering::Relaxed);
    first.is_err_and(|first| first != own)
}

/// Returns the thread pool of this process, if it was forked.
fn own_pool() -> Option<Arc<ThreadPool>> {
    if !is_forked() {
        return None;
    }
    let own = std::process::id();
    let mut kept = POOL.lock().unwrap_or_else(PoisonError::into_inner);
    if let Some((process, pool)) = kept.as_ref()
        && *process == own
    {
        return Some(Arc::clone(pool));
    }
    let Workers::Own(pool) = Workers::start(None) else {
        return None;
    };
    let pool = Arc::new(pool);
    // Dropping a pool would wait for its threads, and the threads of the parent do not exist in
    // this process.
    std::mem::forget(kept.replace((own, Arc::clone(&pool))));
    Some(pool)
}

/// Does work whose parallel parts run on threads of this process. In a forked process, a new pool
/// runs the whole work.
pub fn on_own_threads<T: Send>(work: impl FnOnce() -> T + Send) -> T {
    match own_pool() {
        Some(pool) => pool.install(work),
        None => work(),
    }
}

/// Does the work on the calling thread. In a forked process, the parallel parts also run on this
/// thread.
///
/// ```
/// assert_eq!(pfaff::forked::on_this_thread(|| pfaff::both(|| 1, || 2)), (1, 2));
/// assert_eq!(pfaff::forked::on_own_threads(|| pfaff::both(|| 1, || 2)), (1, 2));
/// ```
pub fn on_this_thread<T>(work: impl FnOnce() -> T) -> T {
    if is_forked() && rayon::current_thread_index().is_none() {
        // The thread keeps its pool of one thread until it ends.
        std::mem::forget(alone().build());
    }
    work()
}
