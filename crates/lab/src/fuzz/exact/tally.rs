//! Tests many scenes, on the threads of the pool.

use std::collections::BTreeMap;
use std::fs;
use std::io;
use std::path::Path;

use rayon::prelude::*;

use super::examine::examine;
use super::findings::Kind;
use super::outcome::{Outcome, judged};
use super::pose::Writing;
use super::{answer, scene, text};
use crate::fuzz::space;

/// Number of scenes that are listed for each kind of finding.
const LISTED: usize = 6;

/// Number of scenes of each family, way of writing and kind that are stored as files.
const KEPT: usize = 2;

/// Near the origin fewer than one scene out of this number may be undecided.
const UNDECIDED: usize = 1000;

/// The scenes of a campaign.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, clap::ValueEnum)]
pub enum Suite {
    /// Degenerate scenes in the plane.
    #[default]
    Plane,
    /// Mechanisms in space with planted redundancy.
    Space,
    /// Scenes of the plane, lifted into space.
    Lifted,
}

impl Suite {
    /// Number of ways in which a drawing is written: scenes `n·k` to `n·k + n − 1` are one drawing.
    #[must_use]
    pub fn ways(self) -> u64 {
        Writing::ALL.len() as u64
    }

    /// Tests one scene of a seed.
    #[must_use]
    pub fn outcome(self, seed: u64, number: u64) -> Outcome {
        match self {
            Self::Plane => in_plane(seed, number),
            Self::Space => space::examine::outcome(seed, number),
            Self::Lifted => space::lifted::outcome(seed, number),
        }
    }
}

fn in_plane(seed: u64, number: u64) -> Outcome {
    let scene = scene(seed, number);
    let (truth, right) = scene.posed.right();
    let text = text::text(&scene.posed);
    let (findings, rank) = judged(
        || answer::answer(&text),
        |document| examine(&truth, &right, document),
    );
    Outcome {
        family: scene.family.name(),
        writing: scene.writing,
        text,
        findings,
        rank,
        truth: right.describe(),
        redundancy: right.redundancy,
    }
}

/// Counts for one family, written in one way.
#[derive(Clone, Debug, Default)]
pub struct Count {
    /// Number of scenes.
    pub scenes: usize,
    /// Scenes that are redundant by exact arithmetic.
    pub redundant: usize,
    /// Scenes without findings.
    pub right: usize,
    /// Scenes with findings, by the worst one: their number, and the first of them.
    pub not: BTreeMap<Kind, (usize, Vec<u64>)>,
}

impl Count {
    fn add(&mut self, other: Self) {
        self.scenes += other.scenes;
        self.redundant += other.redundant;
        self.right += other.right;
        for (kind, (count, first)) in other.not {
            let own = self.not.entry(kind).or_default();
            own.0 += count;
            own.1.extend(first);
            own.1.sort_unstable();
            own.1.truncate(LISTED);
        }
    }

    fn of(&self, wanted: impl Fn(Kind) -> bool) -> usize {
        let counts = self.not.iter().filter(|(kind, _)| wanted(**kind));
        counts.map(|(_, (count, _))| count).sum()
    }
}

/// The results for many scenes.
#[derive(Clone, Debug, Default)]
pub struct Tally {
    /// The scenes.
    pub suite: Suite,
    /// By family and way of writing.
    pub counts: BTreeMap<(&'static str, Writing), Count>,
    /// Drawings with different ranks for two ways of writing.
    pub contradicting: Vec<u64>,
}

impl Tally {
    /// Tests scenes `from..from + scenes` of a seed; `done` is called after each of them.
    #[must_use]
    pub fn of(suite: Suite, seed: u64, from: u64, scenes: u64, done: impl Fn() + Sync) -> Self {
        let ways = suite.ways();
        let empty = || Self {
            suite,
            ..Self::default()
        };
        let drawings: Vec<u64> = (from / ways..(from + scenes).div_ceil(ways)).collect();
        let of_drawing = |&drawing: &u64| {
            let numbers = (ways * drawing..ways * (drawing + 1))
                .filter(|n| (from..from + scenes).contains(n));
            let mut tally = empty();
            let mut ranks = Vec::new();
            for number in numbers {
                let outcome = suite.outcome(seed, number);
                ranks.extend(outcome.rank);
                tally.note(number, &outcome);
                done();
            }
            ranks.dedup();
            if ranks.len() > 1 {
                tally.contradicting.push(drawing);
            }
            tally
        };
        drawings
            .par_iter()
            .map(of_drawing)
            .reduce(empty, Self::joined)
    }

    fn note(&mut self, number: u64, outcome: &Outcome) {
        let key = (outcome.family, outcome.writing);
        let count = self.counts.entry(key).or_default();
        count.scenes += 1;
        count.redundant += usize::from(outcome.redundancy > 0);
        match outcome.worst() {
            Some(worst) => {
                let own = count.not.entry(worst).or_default();
                own.0 += 1;
                own.1.push(number);
            }
            None => count.right += 1,
        }
    }

    fn joined(mut self, other: Self) -> Self {
        for (key, count) in other.counts {
            self.counts.entry(key).or_default().add(count);
        }
        self.contradicting.extend(other.contradicting);
        self
    }

    /// The counts of scenes near the origin, or of those far away.
    #[must_use]
    pub fn sum(&self, is_far: bool) -> Count {
        let mut sum = Count::default();
        let own = self
            .counts
            .iter()
            .filter(|((_, w), _)| (*w == Writing::Far) == is_far);
        for (_, count) in own {
            sum.add(count.clone());
        }
        sum
    }

    /// Number of scenes with a wrong answer.
    #[must_use]
    pub fn wrong(&self) -> usize {
        [true, false]
            .map(|far| self.sum(far).of(Kind::is_wrong))
            .iter()
            .sum()
    }

    /// Number of scenes near the origin with an undecided answer.
    #[must_use]
    pub fn undecided_near(&self) -> usize {
        self.sum(false).of(|kind| !kind.is_wrong())
    }

    /// Whether no answer is wrong, and fewer than one scene in a thousand near the origin is
    /// undecided.
    #[must_use]
    pub fn passes(&self) -> bool {
        let near = self.sum(false);
        self.wrong() == 0 && UNDECIDED * self.undecided_near() < near.scenes
    }

    /// Writes the listed scenes with their answers into a directory, the shortest ones of each
    /// family and kind.
    ///
    /// # Errors
    /// If they cannot be written.
    pub fn keep(&self, seed: u64, folder: &Path) -> io::Result<()> {
        fs::create_dir_all(folder)?;
        for ((family, writing), count) in &self.counts {
            for (kind, (_, first)) in &count.not {
                let pages = first
                    .iter()
                    .map(|&n| (n, self.suite.outcome(seed, n).page()));
                let mut pages: Vec<(u64, String)> = pages.collect();
                pages.sort_by_key(|(_, page)| page.len());
                for (number, page) in pages.into_iter().take(KEPT) {
                    let name = format!(
                        "{family}--{}--{}--{seed}-{number}.toml",
                        kind.name(),
                        writing.name()
                    );
                    fs::write(folder.join(name.replace(' ', "-")), page)?;
                }
            }
        }
        Ok(())
    }

    /// The results in words.
    #[must_use]
    pub fn describe(&self) -> String {
        let mut text = String::new();
        for ((family, writing), count) in &self.counts {
            text.push_str(&format!(
                "{:26}{:10} {:5} scenes, {:5} redundant, {:5} right",
                family,
                writing.name(),
                count.scenes,
                count.redundant,
                count.right
            ));
            for (kind, (n, first)) in &count.not {
                text.push_str(&format!(", {n} {} {first:?}", kind.name()));
            }
            text.push('\n');
        }
        for (far, name) in [(false, "near"), (true, "far")] {
            let sum = self.sum(far);
            text.push_str(&format!(
                "{name}: {} scenes, {} right, {} undecided or refused, {} wrong\n",
                sum.scenes,
                sum.right,
                sum.of(|kind| !kind.is_wrong()),
                sum.of(Kind::is_wrong)
            ));
        }
        text.push_str(&format!(
            "{} drawings with ranks that contradict each other\n",
            self.contradicting.len()
        ));
        text
    }
}
