//! What tests count, to prove that work that a plan leaves out is not done. Costs nothing
//! elsewhere.

/// Work that is noted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Counted {
    /// Storage for linear systems of implicit methods is made.
    LinearSystems,
    /// Multipliers are solved for at a row of output.
    Multipliers,
    /// A dropped row is compared with its limit.
    Monitors,
    /// Coefficients of dropped rows are solved for, to see whether others should be kept.
    Coefficients,
    /// Accelerations are solved for on kept rows.
    Accelerations,
}

/// Notes one piece of work.
#[inline]
pub(crate) fn note(work: Counted) {
    #[cfg(test)]
    COUNTS.with_borrow_mut(|counts| counts[work as usize] += 1);
    let _ = work;
}

#[cfg(test)]
thread_local! {
    /// How often each kind of work was done on this thread.
    static COUNTS: std::cell::RefCell<[usize; 5]> = const { std::cell::RefCell::new([0; 5]) };
}

/// Pieces of work that `run` does on this thread, by kind.
#[cfg(test)]
pub(crate) fn counted(run: impl FnOnce()) -> impl Fn(Counted) -> usize {
    let before = COUNTS.with_borrow(|counts| *counts);
    run();
    let after = COUNTS.with_borrow(|counts| *counts);
    move |work| after[work as usize] - before[work as usize]
}
