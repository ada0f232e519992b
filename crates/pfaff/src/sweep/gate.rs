//! Runs that may end their process are performed while the process performs no other run of any
//! sweep, so that the end of the process has a unique cause.

use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{PoisonError, RwLock, RwLockReadGuard, RwLockWriteGuard, TryLockError};
use std::thread::sleep;
use std::time::Duration;

/// Runs that may execute at the same time share this lock.
static GATE: RwLock<()> = RwLock::new(());

/// Number of threads that wait to run alone. These threads take precedence.
static WAITING: AtomicUsize = AtomicUsize::new(0);

/// Time between two attempts to lock.
const PAUSE: Duration = Duration::from_millis(1);

/// Waits until no thread runs alone. Returns `None` if the wait was interrupted. A thread may hold
/// only one lock at a time.
pub(super) fn beside_others(
    interrupted: &dyn Fn() -> bool,
) -> Option<RwLockReadGuard<'static, ()>> {
    loop {
        if WAITING.load(Ordering::Relaxed) == 0 {
            match GATE.try_read() {
                Ok(guard) => return Some(guard),
                Err(TryLockError::Poisoned(e)) => return Some(e.into_inner()),
                Err(TryLockError::WouldBlock) => {}
            }
        }
        if interrupted() {
            return None;
        }
        sleep(PAUSE);
    }
}

/// Waits until no other run is in progress, and prevents other runs from beginning. Returns `None`
/// if the wait was interrupted.
pub(super) fn alone(interrupted: &dyn Fn() -> bool) -> Option<RwLockWriteGuard<'static, ()>> {
    let _waits = Waits::new();
    loop {
        match GATE.try_write() {
            Ok(guard) => return Some(guard),
            Err(TryLockError::Poisoned(e)) => return Some(PoisonError::into_inner(e)),
            Err(TryLockError::WouldBlock) if interrupted() => return None,
            Err(TryLockError::WouldBlock) => sleep(PAUSE),
        }
    }
}

struct Waits;

impl Waits {
    fn new() -> Self {
        WAITING.fetch_add(1, Ordering::Relaxed);
        Self
    }
}

impl Drop for Waits {
    fn drop(&mut self) {
        WAITING.fetch_sub(1, Ordering::Relaxed);
    }
}

#[cfg(test)]
mod tests {
    use std::sync::atomic::{AtomicI32, Ordering};

    use super::{alone, beside_others};

    #[test]
    fn who_is_alone_is_alone_and_gets_his_turn() {
        let within = AtomicI32::new(0);
        let never = || false;
        std::thread::scope(|scope| {
            for _ in 0..3 {
                scope.spawn(|| {
                    for _ in 0..200 {
                        let _guard = beside_others(&never).expect("not interrupted");
                        assert!(within.fetch_add(1, Ordering::SeqCst) >= 0);
                        std::thread::sleep(std::time::Duration::from_micros(50));
                        within.fetch_sub(1, Ordering::SeqCst);
                    }
                });
            }
            scope.spawn(|| {
                for _ in 0..20 {
                    let _guard = alone(&never).expect("not interrupted");
                    assert_eq!(within.swap(-100, Ordering::SeqCst), 0);
                    within.store(0, Ordering::SeqCst);
                }
            });
        });
        let guard = alone(&never).expect("free");
        assert!(beside_others(&|| true).is_none());
        drop(guard);
        let guard = beside_others(&|| true);
        assert!(guard.is_some() && alone(&|| true).is_none());
    }
}
