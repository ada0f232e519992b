//! An attempt of this process to perform the runs of a shard, on several threads, with a journal.

use std::num::NonZeroUsize;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};

use dynamics::Stop;
use report::sweep::{Journal, Records, Runs};
use report::{SweepRow, SweepStatus};

use super::job::Keep;
use super::make::TOGETHER;
use super::varied::reason;
use super::{Sweep, SweepError, gate};
use crate::workers::Workers;

/// A run counts as the cause of a crash if its process has ended this many times while it performed
/// no other run. A single end may have another cause; for example, a user may have stopped the
/// process.
const PROOF: u64 = 2;

/// Progress of a sweep.
#[derive(Clone, Copy, Debug)]
pub enum SweepProgress<'a> {
    /// The attempt begins.
    Begin {
        /// Number of runs of this shard.
        runs: u64,
        /// Number of runs that were finished before.
        finished: u64,
    },
    /// A run is finished, and its row is in the journal.
    Finished(&'a SweepRow),
}

/// An attempt to perform the runs of a shard.
pub(super) struct Attempt<'a, P> {
    sweep: &'a Sweep<'a>,
    keep: Keep<'a>,
    interrupted: &'a Stop<'a>,
    /// Whether an error has occurred on a thread.
    fails: AtomicBool,
    ledger: Mutex<Ledger<P>>,
}

/// Data that the threads of an attempt share.
struct Ledger<P> {
    journal: Journal,
    progress: P,
    /// Whether at least one run could begin.
    has_begun: bool,
}

impl<'a, P: FnMut(SweepProgress<'_>) + Send> Attempt<'a, P> {
    pub(super) fn new(
        sweep: &'a Sweep<'a>,
        keep: Keep<'a>,
        interrupted: &'a Stop<'a>,
        journal: Journal,
        progress: P,
    ) -> Self {
        Self {
            sweep,
            keep,
            interrupted,
            fails: AtomicBool::new(false),
            ledger: Mutex::new(Ledger {
                journal,
                progress,
                has_begun: false,
            }),
        }
    }

    /// Returns the journal, after the attempt.
    pub(super) fn into_journal(self) -> Journal {
        let ledger = self.ledger.into_inner();
        ledger.unwrap_or_else(PoisonError::into_inner).journal
    }

    /// Whether one of the performed runs could begin.
    pub(super) fn has_begun(&self) -> bool {
        self.with(|ledger| ledger.has_begun)
    }

    fn with<T>(&self, act: impl FnOnce(&mut Ledger<P>) -> T) -> T {
        // A thread that panicked has written either a whole line or no line.
        act(&mut self.ledger.lock().unwrap_or_else(PoisonError::into_inner))
    }

    fn ends(&self) -> bool {
        self.fails.load(Ordering::Relaxed) || (self.interrupted)()
    }

    /// Performs the pending runs. Runs that may have ended a process are performed first, one at a
    /// time. The other runs are then performed on several threads.
    pub(super) fn make(
        &self,
        known: &Records,
        pending: &[Runs],
        threads: usize,
    ) -> Result<(), SweepError> {
        let pending = pending.iter().flat_map(|runs| runs.first()..=runs.last());
        let (suspects, others): (Vec<u64>, Vec<u64>) =
            pending.partition(|run| known.suspects.contains_key(run));
        // More threads than runs would be idle.
        let threads = NonZeroUsize::new(threads.min(others.len().max(1)));
        let workers = Workers::start(threads);
        workers.install(|| self.make_alone(known, &suspects))?;
        let n = workers.number();
        // If there are few runs, the groups are small, so that all threads end at about the same
        // time.
        let size = others.len().div_ceil(4 * n).clamp(1, TOGETHER);
        let groups: Vec<&[u64]> = others.chunks(size).collect();
        let next = AtomicUsize::new(0);
        let ended = workers.broadcast(|| {
            let ended = self.make_groups(&groups, &next);
            if ended.is_err() {
                self.fails.store(true, Ordering::Relaxed);
            }
            ended
        });
        ended.into_iter().collect()
    }

    fn make_groups(&self, groups: &[&[u64]], next: &AtomicUsize) -> Result<(), SweepError> {
        while let Some(group) = groups.get(next.fetch_add(1, Ordering::Relaxed)) {
            let Some(_passed) = gate::beside_others(&|| self.ends()) else {
                break;
            };
            if self.ends() {
                break;
            }
            self.with(|ledger| ledger.journal.begin(group))?;
            self.make_group(group)?;
        }
        Ok(())
    }

    fn make_alone(&self, known: &Records, suspects: &[u64]) -> Result<(), SweepError> {
        if suspects.is_empty() {
            return Ok(());
        }
        let Some(_passed) = gate::alone(&|| self.ends()) else {
            return Ok(());
        };
        for run in suspects {
            if known.suspects.get(run).is_some_and(|ends| *ends >= PROOF) {
                self.finished(&self.sweep.crashed(*run))?;
            } else if self.ends() {
                break;
            } else {
                self.with(|ledger| ledger.journal.begin_alone(*run))?;
                self.make_group(&[*run])?;
            }
        }
        Ok(())
    }

    fn make_group(&self, runs: &[u64]) -> Result<(), SweepError> {
        let stop = || self.ends();
        let mut sink = |row: SweepRow| self.finished(&row);
        self.sweep.make(runs, self.keep, &stop, &mut sink)
    }

    fn finished(&self, row: &SweepRow) -> Result<(), SweepError> {
        self.with(|ledger| {
            ledger.journal.append(row)?;
            ledger.has_begun |= row.status != SweepStatus::Refused;
            (ledger.progress)(SweepProgress::Finished(row));
            Ok(())
        })
    }

    /// Returns the error of a sweep in which no run can begin. The function is called if none of
    /// the performed runs could begin. Returns `None` if another run can begin, or if this is
    /// unknown because a run may end the process.
    pub(super) fn none_begins(
        &self,
        made: Runs,
        known: &Records,
    ) -> Result<Option<SweepError>, SweepError> {
        let sweep = self.sweep;
        for run in (1..=sweep.runs()).filter(|run| !made.has(*run)) {
            if known.suspects.contains_key(&run) {
                return Ok(None);
            }
            self.with(|ledger| ledger.journal.begin(&[run]))?;
            if self.ends() || sweep.begin(run).is_ok() {
                return Ok(None);
            }
        }
        Ok(sweep.begin(1).err().map(|error| SweepError::NoneBegins {
            runs: sweep.runs(),
            values: sweep.values(1),
            reason: reason(&error),
        }))
    }
}
