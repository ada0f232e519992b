//! Runs several cases at the same time. Each case runs on a separate thread, so that a panic or an
//! endless loop is an outcome of this case only. For the same reason, the cases do not use the
//! thread pool of this module.
//!
//! The judgement of outcomes and the files are not part of this module.

use std::any::Any;
use std::num::NonZeroUsize;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::mpsc::{self, RecvTimeoutError};
use std::sync::{Arc, Mutex};
use std::thread;
use std::time::{Duration, Instant};

use crate::stress::{Judgement, StressRow};

use crate::stress::case::{Case, Family, Outcome};
use crate::stress::judge::judge;

/// Interval between two checks for a request to stop.
const ASK: Duration = Duration::from_millis(50);

/// Runs all cases of some families on `threads` threads and passes each row to `done` when it is
/// ready; returns all rows, in the order of the families. If `interrupted` requests a stop,
/// unfinished cases are omitted.
pub fn run(
    families: &[Family],
    threads: NonZeroUsize,
    interrupted: &(dyn Fn() -> bool + Sync),
    mut done: impl FnMut(&StressRow),
) -> Vec<StressRow> {
    let cases: Vec<(&'static str, Mutex<Option<Case>>)> = families
        .iter()
        .flat_map(|f| {
            (f.cases)()
                .into_iter()
                .map(|c| (f.name, Mutex::new(Some(c))))
        })
        .collect();
    let next = AtomicUsize::new(0);
    let mut rows: Vec<Option<StressRow>> = cases.iter().map(|_| None).collect();
    thread::scope(|scope| {
        let (sender, receiver) = mpsc::channel();
        for _ in 0..threads.get() {
            let (sender, next, cases) = (sender.clone(), &next, &cases);
            scope.spawn(move || {
                loop {
                    let k = next.fetch_add(1, Ordering::Relaxed);
                    let Some((family, case)) = cases.get(k) else {
                        return;
                    };
                    // Each case is processed only once, so its lock is neither contended nor
                    // poisoned.
                    let case = case.lock().ok().and_then(|mut place| place.take());
                    let Some(case) = case else { return };
                    let Some(row) = make(family, case, interrupted) else {
                        return;
                    };
                    if sender.send((k, row)).is_err() {
                        return;
                    }
                }
            });
        }
        drop(sender);
        for (k, row) in receiver {
            done(&row);
            rows[k] = Some(row);
        }
    });
    rows.into_iter().flatten().collect()
}

/// Runs one case; `None` if a stop was requested. If a case does not end, its thread runs until the
/// program ends.
fn make(
    family: &'static str,
    case: Case,
    interrupted: &(dyn Fn() -> bool + Sync),
) -> Option<StressRow> {
    let case = Arc::new(case);
    let begin = Instant::now();
    let (sender, receiver) = mpsc::channel();
    let own = Arc::clone(&case);
    let spawned = thread::Builder::new().spawn(move || {
        // If the case took too long, the receiver no longer exists.
        let _ = sender.send((own.run)());
    });
    let made = match spawned {
        Err(e) => Err(format!("no thread: {e}")),
        Ok(thread) => loop {
            if interrupted() {
                return None;
            }
            match receiver.recv_timeout(ASK) {
                Ok(outcome) => break Ok(outcome),
                Err(RecvTimeoutError::Timeout) if begin.elapsed() < case.limit => {}
                Err(RecvTimeoutError::Timeout) => {
                    break Err(format!("nothing after {:.1} s", case.limit.as_secs_f64()));
                }
                Err(RecvTimeoutError::Disconnected) => {
                    let payload = thread.join().err();
                    break Err(format!("panicked: {}", words(payload.as_deref())));
                }
            }
        },
    };
    Some(row(family, &case, made, begin.elapsed()))
}

/// Returns the row of a case; a missing outcome counts as silently wrong.
fn row(
    family: &'static str,
    case: &Case,
    made: Result<Outcome, String>,
    took: Duration,
) -> StressRow {
    let judgement = match &made {
        Ok(outcome) => judge(&case.expected, outcome),
        Err(_) => Judgement::SilentlyWrong,
    };
    let (error, outcome) = match made {
        Ok(Outcome::Answer { error, detail }) => (error, detail),
        Ok(Outcome::Refused { text }) | Err(text) => (f64::NAN, text),
    };
    StressRow {
        family,
        case: case.name.clone(),
        varied: case.varied,
        method: case.method.clone(),
        formulation: case.formulation.clone(),
        expected: case.expected.words(),
        bound: case.expected.bound(),
        error,
        outcome,
        judgement,
        seconds: took.as_secs_f64(),
    }
}

/// Returns the message of a panic.
fn words(payload: Option<&(dyn Any + Send)>) -> String {
    let payload = payload.unwrap_or(&());
    match (
        payload.downcast_ref::<String>(),
        payload.downcast_ref::<&str>(),
    ) {
        (Some(text), _) => text.clone(),
        (None, Some(text)) => (*text).to_owned(),
        (None, None) => "without words".to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::stress::case::Expected;

    fn exact(name: &str, run: impl Fn() -> Outcome + Send + Sync + 'static) -> Case {
        Case::new(name, "-", "-", Expected::answer(0.0, "exact"), run)
    }

    fn mixed() -> Vec<Case> {
        vec![
            exact("right", || Outcome::answer(0.0, "")),
            exact("wrong", || Outcome::answer(1.0, "")),
            exact("panics", || panic!("on purpose")),
            exact("hangs", || {
                thread::sleep(Duration::from_secs(1));
                Outcome::answer(0.0, "")
            })
            .within(Duration::from_millis(1)),
            exact("last", || Outcome::refused("no")),
        ]
    }

    const MIXED: Family = Family {
        name: "mixed",
        about: "all kinds of outcomes",
        cases: mixed,
    };

    #[test]
    fn panics_and_hangs_are_silently_wrong_and_stop_nothing_else() {
        let mut seen = 0;
        let two = NonZeroUsize::new(2).expect("not zero");
        let rows = run(&[MIXED], two, &|| false, |_| seen += 1);
        let found: Vec<_> = rows
            .iter()
            .map(|r| (r.case.as_str(), r.judgement))
            .collect();
        let expected = [
            ("right", Judgement::Right),
            ("wrong", Judgement::SilentlyWrong),
            ("panics", Judgement::SilentlyWrong),
            ("hangs", Judgement::SilentlyWrong),
            ("last", Judgement::Limit),
        ];
        assert_eq!(found, expected);
        assert_eq!(seen, expected.len());
        assert_eq!(rows[2].outcome, "panicked: on purpose");
    }

    #[test]
    fn nothing_is_made_after_an_interrupt() {
        let rows = run(&[MIXED], NonZeroUsize::MIN, &|| true, |_| {});
        assert_eq!(rows, []);
    }
}
