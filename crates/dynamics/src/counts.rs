//! Counters of work. Tests use the counters to prove that a run does not do the work that its plan
//! omits. The counters exist only in tests.

/// Kinds of work that are counted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum WorkKind {
    /// Allocating storage for the linear systems of implicit methods.
    LinearSystems,
    /// Solving for multipliers at a row of output.
    Multipliers,
    /// Comparing a redundant row with its limit.
    Monitors,
    /// Solving for the coefficients of redundant rows, to decide whether other independent rows
    /// should be chosen.
    Coefficients,
    /// Solving for accelerations with the independent rows.
    Accelerations,
}

/// Adds one to the counter of this kind of work.
#[inline]
pub(crate) fn note(work: WorkKind) {
    #[cfg(test)]
    COUNTS.with_borrow_mut(|counts| counts[work as usize] += 1);
    let _ = work;
}

#[cfg(test)]
thread_local! {
    /// Number of times each kind of work was done on this thread.
    static COUNTS: std::cell::RefCell<[usize; 5]> = const { std::cell::RefCell::new([0; 5]) };
}

/// Counts the work that `run` does on this thread, by kind of work.
#[cfg(test)]
pub(crate) fn counted(run: impl FnOnce()) -> impl Fn(WorkKind) -> usize {
    let before = COUNTS.with_borrow(|counts| *counts);
    run();
    let after = COUNTS.with_borrow(|counts| *counts);
    move |work| after[work as usize] - before[work as usize]
}
