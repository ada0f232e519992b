//! Counts of verdicts: the number of cases, the number of undecided ones, and every wrong verdict
//! with its name.

use std::collections::BTreeMap;

use solvability::{Judgement, Verdict};

/// Number of cases with wrong verdicts that are printed.
const SHOWN: usize = 5;

/// Of the cases that should be decided, fewer than one in this number may be undecided.
const UNDECIDED: usize = 1000;

/// The number of cases that the environment variable `PFAFF_CASES` states, or the default.
pub(crate) fn cases(default: usize) -> usize {
    std::env::var("PFAFF_CASES")
        .ok()
        .and_then(|cases| cases.parse().ok())
        .unwrap_or(default)
}

/// Cases of one kind.
#[derive(Clone, Copy, Default)]
struct Count {
    cases: usize,
    undecided: usize,
    /// Number of wrong verdicts.
    wrong: usize,
}

/// Verdicts of a suite, case by case.
#[derive(Default)]
pub(crate) struct Tally {
    kinds: BTreeMap<&'static str, Count>,
    kind: &'static str,
    case_is_undecided: bool,
    case_is_wrong: bool,
    verdicts: usize,
    examples: Vec<String>,
    doubts: Vec<String>,
}

impl Tally {
    /// Begins a case.
    pub(crate) fn case(&mut self, kind: &'static str) {
        self.kind = kind;
        self.case_is_undecided = false;
        self.case_is_wrong = false;
        self.count().cases += 1;
    }

    /// Records that a result of the case is undecided.
    pub(crate) fn undecided(&mut self, what: impl FnOnce() -> String) {
        if std::mem::replace(&mut self.case_is_undecided, true) {
            return;
        }
        self.count().undecided += 1;
        if self.doubts.len() < SHOWN {
            self.doubts.push(format!("{}: {}", self.kind, what()));
        }
    }

    /// Compares a count.
    pub(crate) fn number(&mut self, found: usize, expected: usize, what: impl FnOnce() -> String) {
        self.verdict(found == expected, || {
            format!("{} is {found}, not {expected}", what())
        });
    }

    /// Compares a judgement.
    pub(crate) fn judgement(
        &mut self,
        found: &Judgement,
        unique: bool,
        what: impl FnOnce() -> String,
    ) {
        let right = match found.verdict {
            Verdict::Unique => unique,
            Verdict::NotUnique => !unique,
            _ => return self.undecided(|| format!("{}: {found:?}", what())),
        };
        self.verdict(right, || {
            format!("{}: {found:?}, but unique is {unique}", what())
        });
    }

    fn verdict(&mut self, right: bool, what: impl FnOnce() -> String) {
        self.verdicts += 1;
        if right {
            return;
        }
        self.count().wrong += 1;
        let first = !std::mem::replace(&mut self.case_is_wrong, true);
        if first && self.examples.len() < SHOWN {
            self.examples.push(format!("{}: {}", self.kind, what()));
        }
    }

    fn count(&mut self) -> &mut Count {
        self.kinds.entry(self.kind).or_default()
    }

    /// Cases of the given kinds.
    fn of(&self, kinds: impl IntoIterator<Item = &'static str>) -> Count {
        let counts = kinds.into_iter().filter_map(|kind| self.kinds.get(kind));
        counts.fold(Count::default(), |sum, c| Count {
            cases: sum.cases + c.cases,
            undecided: sum.undecided + c.undecided,
            wrong: sum.wrong + c.wrong,
        })
    }

    /// Prints the counts; fails if a verdict is wrong, or if too many cases of these kinds are
    /// undecided.
    #[expect(
        clippy::print_stdout,
        reason = "the count and the seed are part of the result"
    )]
    pub(crate) fn conclude(
        &self,
        what: &str,
        seed: u64,
        decided: impl IntoIterator<Item = &'static str>,
    ) {
        let all = self.of(self.kinds.keys().copied());
        println!(
            "{} {what}, seed {seed}: {} verdicts, {} wrong, {} cases undecided",
            all.cases, self.verdicts, all.wrong, all.undecided
        );
        for (kind, count) in &self.kinds {
            println!(
                "{:8} {kind}: {} wrong, {} undecided",
                count.cases, count.wrong, count.undecided
            );
        }
        assert_eq!(all.wrong, 0, "for example\n{}", self.examples.join("\n"));
        let planted = self.of(decided);
        assert!(
            planted.undecided * UNDECIDED < planted.cases,
            "{} of {} undecided, for example\n{}",
            planted.undecided,
            planted.cases,
            self.doubts.join("\n")
        );
    }
}
