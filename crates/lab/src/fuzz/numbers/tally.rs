//! Examines many mechanisms, on the threads of the pool.

use std::any::Any;
use std::collections::BTreeMap;
use std::fmt::Write;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;
use std::{fs, io};

use rayon::prelude::*;

use super::examine::examine;
use super::findings::{Count, Findings, Kind};
use super::scenes::{Scene, scene};
use suite::numbers::Numbers;

/// Number of mechanisms that are listed for each kind of disagreement.
const LISTED: usize = 12;

/// Of this number of components, one may be reported as not determined although no solutions
/// differ.
const UNEXPLAINED: usize = 1000;

/// Returns the findings for scene `number` of a seed.
#[must_use]
pub fn outcome(seed: u64, number: u64) -> (Scene, Findings) {
    let scene = scene(seed, number);
    let mut numbers = Numbers::new(seed ^ Numbers::new(!number).bits());
    let examined = catch_unwind(AssertUnwindSafe(|| examine(&scene.text, &mut numbers)));
    let findings = examined.unwrap_or_else(|panic| {
        let mut findings = Findings::default();
        findings.note(Kind::Failed, words(&*panic));
        findings
    });
    (scene, findings)
}

fn words(panic: &(dyn Any + Send)) -> String {
    let text = panic.downcast_ref::<String>().map(String::as_str);
    let text = text.or_else(|| panic.downcast_ref::<&str>().copied());
    format!("panic: {}", text.unwrap_or("without words"))
}

/// Mechanisms with a kind of disagreement.
#[derive(Clone, Debug, Default)]
pub struct Disagreeing {
    /// Number of disagreements.
    pub count: usize,
    /// The mechanisms, with the first words of each disagreement.
    pub mechanisms: BTreeMap<u64, String>,
}

/// The results for many mechanisms.
#[derive(Clone, Debug, Default)]
pub struct Tally {
    /// Mechanisms by family.
    pub families: BTreeMap<String, usize>,
    /// Counted quantities.
    pub counts: BTreeMap<Count, usize>,
    /// Disagreements by kind.
    pub disagreeing: BTreeMap<Kind, Disagreeing>,
}

impl Tally {
    /// Examines mechanisms `from..from + scenes` of a seed; `done` is called after each mechanism.
    #[must_use]
    pub fn of(seed: u64, from: u64, scenes: u64, done: impl Fn() + Sync) -> Self {
        let one = |number: u64| {
            let (scene, findings) = outcome(seed, number);
            let mut tally = Self::default();
            // The first part is the name of the submechanism and its carrier.
            let family = scene.family.split(',').next().unwrap_or_default();
            tally.families.insert(family.to_owned(), 1);
            tally.counts = findings.counts;
            for finding in findings.all {
                let own = tally.disagreeing.entry(finding.kind).or_default();
                own.count += 1;
                own.mechanisms.entry(number).or_insert(finding.text);
            }
            done();
            tally
        };
        (from..from + scenes)
            .into_par_iter()
            .map(one)
            .reduce(Self::default, Self::joined)
    }

    fn joined(mut self, other: Self) -> Self {
        for (family, count) in other.families {
            *self.families.entry(family).or_default() += count;
        }
        for (what, count) in other.counts {
            *self.counts.entry(what).or_default() += count;
        }
        for (kind, found) in other.disagreeing {
            let own = self.disagreeing.entry(kind).or_default();
            own.count += found.count;
            own.mechanisms.extend(found.mechanisms);
        }
        self
    }

    /// Returns the value of a count.
    #[must_use]
    pub fn count(&self, what: Count) -> usize {
        self.counts.get(&what).copied().unwrap_or(0)
    }

    /// Returns the number of disagreements of a kind.
    #[must_use]
    pub fn of_kind(&self, kind: Kind) -> usize {
        self.disagreeing.get(&kind).map_or(0, |d| d.count)
    }

    /// Whether three conditions are satisfied: no finding means a wrong result, at most one of a
    /// thousand components is unexplained, and at least half of the ill-determined components
    /// change with a datum.
    #[must_use]
    pub fn passes(&self) -> bool {
        let wrong = self.disagreeing.keys().any(|kind| kind.is_wrong());
        let unexplained = self.of_kind(Kind::Unexplained);
        let fragile = [Count::FragileChanges, Count::Fragile].map(|c| self.count(c));
        !wrong
            && UNEXPLAINED * unexplained <= self.count(Count::NotDetermined)
            && 2 * fragile[0] >= fragile[1]
    }

    /// Returns the counts, then the disagreements with the indices of the mechanisms.
    #[must_use]
    pub fn describe(&self) -> String {
        let mut text = String::new();
        // Writing into a string does not fail.
        for (family, count) in &self.families {
            let _ = writeln!(text, "{count:>8} {family}");
        }
        text.push('\n');
        for (what, count) in &self.counts {
            let _ = writeln!(text, "{count:>8} {}", what.name());
        }
        for (kind, found) in &self.disagreeing {
            let _ = writeln!(
                text,
                "\n{}: {} in {} mechanisms",
                kind.name(),
                found.count,
                found.mechanisms.len()
            );
            for (number, words) in found.mechanisms.iter().take(LISTED) {
                let _ = writeln!(text, "  {number}: {words}");
            }
        }
        let wrong = self.disagreeing.iter().filter(|(kind, _)| kind.is_wrong());
        let wrong: usize = wrong.map(|(_, found)| found.count).sum();
        let _ = writeln!(
            text,
            "\ndisagreements {wrong}, unexplained {} of {}",
            self.of_kind(Kind::Unexplained),
            self.count(Count::NotDetermined)
        );
        text
    }

    /// Writes the mechanisms with disagreements into a folder. The folder contains one file for
    /// each kind and each mechanism, with the disagreement at the start of the file.
    ///
    /// # Errors
    /// Returns an error if a file cannot be written.
    pub fn keep(&self, seed: u64, folder: &Path) -> io::Result<()> {
        fs::create_dir_all(folder)?;
        for (kind, found) in &self.disagreeing {
            for (number, words) in found.mechanisms.iter().take(LISTED) {
                let scene = scene(seed, *number);
                let head = format!("# {}: {words}\n# {}\n", kind.name(), scene.family);
                let name = format!("{kind:?}-{seed}-{number}.toml").to_lowercase();
                fs::write(folder.join(name), head + &scene.text)?;
            }
        }
        Ok(())
    }
}
