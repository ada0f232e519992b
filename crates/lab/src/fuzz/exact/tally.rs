//! Tests many scenes, on the threads of the pool.

use std::collections::BTreeMap;
use std::fs;
use std::io;
use std::ops::Range;
use std::path::Path;

use rayon::prelude::*;

use super::examine::examine;
use super::findings::Kind;
use super::outcome::{JudgedStart, Outcome, judged};
use super::pose::Writing;
use super::{answer, precisions, rounded, scene, text};
use crate::fuzz::space;

/// Number of scenes that are listed for each kind of finding.
const LISTED: usize = 8;

/// Number of scenes of each family, variant and kind that are stored as files.
const KEPT: usize = 2;

/// Limit for scenes without a tolerance in which all results must be decided. The share of
/// undecided scenes must be less than one divided by this number.
const UNDECIDED: usize = 1000;

/// Limit for scenes with a tolerance in which all results must be decided. The share of undecided
/// scenes must be at most one divided by this number.
const UNDECIDED_WITHIN: usize = 100;

/// The scenes of a campaign.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, clap::ValueEnum)]
pub enum Suite {
    /// Degenerate scenes in the plane.
    #[default]
    Plane,
    /// Mechanisms in space with planted redundancy.
    Space,
    /// Scenes of the plane, converted to space.
    Lifted,
    /// Degenerate drawings in the plane, with numbers rounded to 3 … 16 significant digits.
    #[value(skip)]
    RoundedInPlane,
    /// Mechanisms in space, with numbers rounded to 3 … 16 significant digits.
    #[value(skip)]
    RoundedInSpace,
    /// Drawings in the plane that have full rank. A small change of the data lowers their rank.
    #[value(skip)]
    FullRank,
}

impl Suite {
    /// Returns the number n of variants of a drawing. Scenes `n·k` to `n·k + n − 1` contain the
    /// same drawing.
    #[must_use]
    pub fn ways(self) -> usize {
        match self {
            Self::Plane | Self::Space | Self::Lifted => Writing::ALL.len(),
            Self::RoundedInPlane | Self::RoundedInSpace => precisions::DIGITS.len(),
            Self::FullRank => precisions::PARTS.len(),
        }
    }

    /// Returns the name of a variant.
    #[must_use]
    pub fn way(self, way: usize) -> String {
        match self {
            Self::Plane | Self::Space | Self::Lifted => Writing::ALL[way].name().to_owned(),
            Self::RoundedInPlane | Self::RoundedInSpace => {
                format!("{} digits", precisions::DIGITS[way])
            }
            Self::FullRank => format!("{} τ*/3", precisions::PARTS[way]),
        }
    }

    /// Whether scenes in this variant state a tolerance.
    fn has_tolerance(self, way: usize) -> bool {
        match self {
            Self::Plane | Self::Space | Self::Lifted => false,
            Self::RoundedInPlane | Self::RoundedInSpace => way + 1 < precisions::DIGITS.len(),
            Self::FullRank => true,
        }
    }

    /// Tests some scenes of one drawing of a seed, given by their numbers.
    #[must_use]
    pub fn outcomes(self, seed: u64, numbers: Range<u64>) -> Vec<Outcome> {
        let one = match self {
            Self::Plane => in_plane,
            Self::Space => space::examine::outcome,
            Self::Lifted => space::lifted::outcome,
            _ => {
                let ways = self.ways() as u64;
                let drawn = numbers.start / ways;
                let is_wanted = |o: &Outcome| numbers.contains(&(ways * drawn + o.way as u64));
                let all = rounded::outcomes(self, seed, drawn).into_iter();
                return all.filter(is_wanted).collect();
            }
        };
        numbers.map(|number| one(seed, number)).collect()
    }

    /// Returns the page of one scene; empty if the scene does not exist.
    #[must_use]
    pub fn page(self, seed: u64, number: u64) -> String {
        let mut outcomes = self.outcomes(seed, number..number + 1);
        let outcome = outcomes.pop();
        outcome.map_or_else(String::new, |o| o.page(&self.way(o.way)))
    }
}

fn in_plane(seed: u64, number: u64) -> Outcome {
    let scene = scene(seed, number);
    let (truth, right) = scene.posed.right();
    let text = text::text(&scene.posed);
    let judged = judged(
        || answer::answer(&text),
        |document| JudgedStart::with_rank(examine(&truth, &right, document), document),
    );
    Outcome {
        family: scene.family.name(),
        way: scene.writing as usize,
        text,
        judged,
        truth: right.describe(),
        is_redundant: right.redundancy > 0,
        must_be_decided: scene.writing != Writing::Far,
    }
}

/// Counts for one kind of scenes.
#[derive(Clone, Debug, Default)]
pub struct Count {
    /// Number of scenes.
    pub scenes: usize,
    /// Scenes that are redundant by exact arithmetic.
    pub redundant: usize,
    /// Scenes in which all results must be decided.
    pub to_decide: usize,
    /// Scenes without findings.
    pub right: usize,
    /// Numbers of scenes for which another rank is also correct, by reason.
    pub other: BTreeMap<&'static str, usize>,
    /// Scenes with findings, by the worst finding and by whether all results must be decided. The
    /// value is the number of these scenes, and the numbers of the first scenes.
    pub not: BTreeMap<(Kind, bool), (usize, Vec<u64>)>,
}

impl Count {
    fn add(&mut self, other: &Self) {
        self.scenes += other.scenes;
        self.redundant += other.redundant;
        self.to_decide += other.to_decide;
        self.right += other.right;
        for (why, count) in &other.other {
            *self.other.entry(why).or_default() += count;
        }
        for (kind, (count, first)) in &other.not {
            let own = self.not.entry(*kind).or_default();
            own.0 += count;
            own.1.extend(first);
            own.1.sort_unstable();
            own.1.truncate(LISTED);
        }
    }

    fn of(&self, wanted: impl Fn(Kind, bool) -> bool) -> usize {
        let counts = self.not.iter();
        let counts = counts.filter(|((kind, decide), _)| wanted(*kind, *decide));
        counts.map(|(_, (count, _))| count).sum()
    }

    /// Returns the number of scenes with a wrong answer.
    #[must_use]
    pub fn wrong(&self) -> usize {
        self.of(|kind, _| kind.is_wrong())
    }

    /// Returns how many of the scenes that must be decided are undecided or rejected.
    #[must_use]
    pub fn undecided(&self) -> usize {
        self.of(|kind, must_be_decided| must_be_decided && !kind.is_wrong())
    }

    fn line(&self, name: &str) -> String {
        let mut text = format!(
            "{name:26} {:6} scenes, {:6} redundant, {:6} to decide, {:6} right",
            self.scenes, self.redundant, self.to_decide, self.right
        );
        for (why, n) in &self.other {
            text.push_str(&format!(", {n} {why}"));
        }
        for ((kind, must_be_decided), (n, first)) in &self.not {
            let may = if *must_be_decided {
                ""
            } else {
                " (where it may be)"
            };
            text.push_str(&format!(", {n} {}{may} {first:?}", kind.name()));
        }
        text + "\n"
    }
}

/// The results for many scenes.
#[derive(Clone, Debug, Default)]
pub struct Tally {
    /// The scenes.
    pub suite: Suite,
    /// Counts by family and variant.
    pub counts: BTreeMap<(&'static str, usize), Count>,
    /// Drawings with different ranks in two variants.
    pub contradicting: Vec<u64>,
}

impl Tally {
    /// Tests scenes `from..from + scenes` of a seed; `done` is called after each scene.
    #[must_use]
    pub fn of(suite: Suite, seed: u64, from: u64, scenes: u64, done: impl Fn() + Sync) -> Self {
        let ways = suite.ways() as u64;
        let empty = || Self {
            suite,
            ..Self::default()
        };
        let drawings: Vec<u64> = (from / ways..(from + scenes).div_ceil(ways)).collect();
        let of_drawing = |&drawing: &u64| {
            let first = ways * drawing;
            let numbers = first.max(from)..(first + ways).min(from + scenes);
            let mut tally = empty();
            let mut ranks = Vec::new();
            for outcome in suite.outcomes(seed, numbers) {
                ranks.extend(outcome.judged.rank);
                tally.note(first + outcome.way as u64, &outcome);
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
        let count = self.counts.entry((outcome.family, outcome.way));
        let count = count.or_default();
        count.scenes += 1;
        count.redundant += usize::from(outcome.is_redundant);
        count.to_decide += usize::from(outcome.must_be_decided);
        match (outcome.worst(), outcome.judged.other_rank) {
            (Some(worst), _) => {
                let kind = (worst, outcome.must_be_decided);
                let own = count.not.entry(kind).or_default();
                own.0 += 1;
                own.1.push(number);
            }
            (None, Some(why)) => *count.other.entry(why).or_default() += 1,
            (None, None) => count.right += 1,
        }
    }

    fn joined(mut self, other: Self) -> Self {
        for (key, count) in &other.counts {
            self.counts.entry(*key).or_default().add(count);
        }
        self.contradicting.extend(other.contradicting);
        self
    }

    /// Returns the sum of the counts of some families and variants.
    #[must_use]
    pub fn sum(&self, wanted: impl Fn(&str, usize) -> bool) -> Count {
        let mut sum = Count::default();
        for ((family, way), count) in &self.counts {
            if wanted(family, *way) {
                sum.add(count);
            }
        }
        sum
    }

    /// Returns the number of scenes with a wrong answer.
    #[must_use]
    pub fn wrong(&self) -> usize {
        self.sum(|_, _| true).wrong()
    }

    /// Whether no answer is wrong, and only few answers are undecided although they should be
    /// decided.
    #[must_use]
    pub fn passes(&self) -> bool {
        let [all_digits, within] =
            [false, true].map(|has| self.sum(|_, way| self.suite.has_tolerance(way) == has));
        let open = all_digits.undecided();
        let few = open == 0 || UNDECIDED * open < all_digits.to_decide;
        self.wrong() == 0 && few && UNDECIDED_WITHIN * within.undecided() <= within.to_decide
    }

    /// Writes the listed scenes with the answers into a directory. For each family, variant and
    /// kind, the shortest of the listed scenes are written.
    ///
    /// # Errors
    /// Returns an error if the files cannot be written.
    pub fn keep(&self, seed: u64, folder: &Path) -> io::Result<()> {
        fs::create_dir_all(folder)?;
        for ((family, way), count) in &self.counts {
            for ((kind, _), (_, first)) in &count.not {
                let pages = first.iter().map(|&n| (n, self.suite.page(seed, n)));
                let mut pages: Vec<(u64, String)> = pages.collect();
                pages.sort_by_key(|(_, page)| page.len());
                for (number, page) in pages.into_iter().take(KEPT) {
                    let (kind, way) = (kind.name(), self.suite.way(*way));
                    let name = format!("{family}--{kind}--{way}--{seed}-{number}.toml");
                    fs::write(folder.join(name.replace([' ', '/', '*'], "-")), page)?;
                }
            }
        }
        Ok(())
    }

    /// Describes the results as text.
    #[must_use]
    pub fn describe(&self) -> String {
        let mut text = String::new();
        for way in 0..self.suite.ways() {
            let own = self.sum(|_, other| other == way);
            text.push_str(&own.line(&self.suite.way(way)));
        }
        let mut families: Vec<&str> = self.counts.keys().map(|(family, _)| *family).collect();
        families.dedup();
        for family in families {
            text.push_str(&self.sum(|other, _| other == family).line(family));
        }
        let all = self.sum(|_, _| true);
        text.push_str(&all.line("all"));
        text.push_str(&format!(
            "{} wrong; {} undecided or rejected of {} that must be decided\n\
             {} drawings with ranks that contradict each other\n",
            all.wrong(),
            all.undecided(),
            all.to_decide,
            self.contradicting.len()
        ));
        text
    }
}
