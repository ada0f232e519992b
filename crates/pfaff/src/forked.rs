//! Parallel work in a process that was forked.
//!
//! A forked process inherits the pool of its parent but not the threads of the pool: work that is
//! given to them waits for ever. Programs that fork (`multiprocessing` of Python does) do parallel
//! work through [`on_own_threads`] or [`on_this_thread`], before the fork and after it.

use std::sync::atomic::{AtomicU32, Ordering};
use std::sync::{Arc, Mutex, PoisonError};

use rayon::ThreadPool;

use crate::workers::{Workers, alone};

/// The process that first did parallel work; 0 before.
static FIRST: AtomicU32 = AtomicU32::new(0);

/// The pool of a forked process, with its process.
static POOL: Mutex<Option<(u32, Arc<ThreadPool>)>> = Mutex::new(None);

/// Whether this process was forked from one that had done parallel work.
fn is_forked() -> bool {
    let own = std::process::id();
    let first = FIRST.compare_exchange(0, own, Ordering::Relaxed, Ordering::Relaxed);
    first.is_err_and(|first| first != own)
}

/// The pool of this process, if it was forked.
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
    // The end of a pool waits for its threads, and those of the parent do not exist here.
    std::mem::forget(kept.replace((own, Arc::clone(&pool))));
    Some(pool)
}

/// Does work whose parallel parts run on threads of this process. In a forked process the whole
/// work runs on another thread.
pub fn on_own_threads<T: Send>(work: impl FnOnce() -> T + Send) -> T {
    match own_pool() {
        Some(pool) => pool.install(work),
        None => work(),
    }
}

/// The same on the thread that calls; in a forked process the parallel parts run on it, too.
///
/// ```
/// assert_eq!(pfaff::forked::on_this_thread(|| pfaff::both(|| 1, || 2)), (1, 2));
/// assert_eq!(pfaff::forked::on_own_threads(|| pfaff::both(|| 1, || 2)), (1, 2));
/// ```
pub fn on_this_thread<T>(work: impl FnOnce() -> T) -> T {
    if is_forked() && rayon::current_thread_index().is_none() {
        // The thread keeps its pool of one until it ends.
        std::mem::forget(alone().build());
    }
    work()
}
