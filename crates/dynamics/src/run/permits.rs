//! Limits the number of threads that compute at the same time. Other threads wait until a computing
//! thread pauses.

use std::num::NonZeroUsize;
use std::sync::{Condvar, Mutex, MutexGuard, PoisonError};

/// A set of permits to compute.
pub(super) struct Permits {
    free: Mutex<usize>,
    returned: Condvar,
}

impl Permits {
    /// Creates a given number of permits, or unlimited permits.
    pub(super) fn new(n: Option<NonZeroUsize>) -> Self {
        Self {
            free: Mutex::new(n.map_or(usize::MAX / 2, NonZeroUsize::get)),
            returned: Condvar::new(),
        }
    }

    /// Waits for a permit.
    pub(super) fn take(&self) -> Permit<'_> {
        let mut permit = Permit {
            all: self,
            is_held: false,
        };
        permit.regain();
        permit
    }

    /// The count remains valid even if a thread has panicked.
    fn free(&self) -> MutexGuard<'_, usize> {
        self.free.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// A permit. Dropping the permit returns it.
pub(super) struct Permit<'p> {
    all: &'p Permits,
    is_held: bool,
}

impl Permit<'_> {
    /// Runs `wait`, which may wait for other threads, without the permit.
    pub(super) fn leave_for<T>(&mut self, wait: impl FnOnce() -> T) -> T {
        self.give_back();
        let found = wait();
        self.regain();
        found
    }

    fn regain(&mut self) {
        let free = self.all.free();
        let waited = self.all.returned.wait_while(free, |free| *free == 0);
        *waited.unwrap_or_else(PoisonError::into_inner) -= 1;
        self.is_held = true;
    }

    fn give_back(&mut self) {
        if std::mem::take(&mut self.is_held) {
            *self.all.free() += 1;
            self.all.returned.notify_one();
        }
    }
}

impl Drop for Permit<'_> {
    fn drop(&mut self) {
        self.give_back();
    }
}

#[cfg(test)]
mod tests {
    use std::sync::atomic::{AtomicUsize, Ordering};
    use std::thread;

    use super::*;

    #[test]
    fn no_more_compute_than_may() {
        let permits = Permits::new(NonZeroUsize::new(2));
        let (computing, most) = (AtomicUsize::new(0), AtomicUsize::new(0));
        thread::scope(|scope| {
            for _ in 0..8 {
                scope.spawn(|| {
                    let mut permit = permits.take();
                    for _ in 0..50 {
                        let now = computing.fetch_add(1, Ordering::SeqCst) + 1;
                        most.fetch_max(now, Ordering::SeqCst);
                        thread::yield_now();
                        computing.fetch_sub(1, Ordering::SeqCst);
                        permit.leave_for(thread::yield_now);
                    }
                });
            }
        });
        assert_eq!(most.into_inner(), 2);
        assert_eq!(*permits.free(), 2);
    }
}
