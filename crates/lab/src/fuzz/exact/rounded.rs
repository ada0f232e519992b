//! Sets of scenes with a tolerance: degenerate drawings whose numbers are rounded to 3 … 16
//! significant digits, and drawings of full rank that are near a lower one.

use std::collections::BTreeMap;
use std::panic::{self, AssertUnwindSafe};

use crate::fuzz::space;
use rayon::prelude::*;
use suite::numbers::Numbers;

use super::answer;
use super::doubles::{Doubles, extent};
use super::examine::examine;
use super::families::Family;
use super::families::slender::Slender;
use super::findings::Kind;
use super::pose::{Posed, Writing};
use super::ratio::Ratio;
use super::text::{Precision, text_within};
use super::within::{BEYOND_DOUBT, Judged, Meant};

/// Numbers of significant digits. With the last one no tolerance is stated.
pub const DIGITS: [usize; 14] = [3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16];

/// Tolerances for drawings near a lower rank, as fractions of τ*/3.
pub const PARTS: [f64; 6] = [0.99, 0.5, 0.1, 1e-2, 1e-4, 1e-7];

/// Gravity (m/s²), not parallel to an axis.
const GRAVITY: [f64; 2] = [3.0, -9.0];

/// Number of scenes that are listed for each kind of finding.
const LISTED: usize = 8;

/// Fewer than one scene out of this number may be undecided if a lower rank is far away.
const UNDECIDED: usize = 100;

/// The same with sixteen digits and no tolerance.
const UNDECIDED_WITHOUT: usize = 1000;

/// A set of scenes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, clap::ValueEnum)]
pub enum Suite {
    /// Degenerate drawings with few digits.
    #[default]
    #[value(name = "plane")]
    Rounded,
    /// Mechanisms in space with few digits.
    Space,
    /// Drawings of full rank near a lower one.
    #[value(skip)]
    FullRank,
}

impl Suite {
    /// Number of scenes for each drawing.
    #[must_use]
    pub fn ways(self) -> u64 {
        match self {
            Self::Rounded | Self::Space => DIGITS.len() as u64,
            Self::FullRank => PARTS.len() as u64,
        }
    }
}

/// The result for one scene.
pub struct Outcome {
    /// Its family.
    pub family: &'static str,
    /// Its number of digits, or the index of its tolerance.
    pub way: usize,
    /// The text.
    pub text: String,
    /// The correct answer, in words.
    pub truth: String,
    /// The findings.
    pub judged: Judged,
    /// Whether a lower rank is so far away that everything must be decided.
    pub is_far: bool,
    /// Whether it is redundant.
    pub is_redundant: bool,
}

impl Outcome {
    /// The worst finding.
    #[must_use]
    pub fn worst(&self) -> Option<Kind> {
        self.judged.findings.0.iter().map(|f| f.kind).max()
    }

    /// The scene with the correct answer and that of the program in comments at its beginning.
    #[must_use]
    pub fn page(&self) -> String {
        let mut page = format!("# {}, {}\n", self.family, self.way);
        let findings = self.judged.findings.0.iter();
        let findings = findings.map(|f| format!("{}: {}", f.kind.name(), f.text));
        let other = self.judged.other_rank.iter().map(|x| (*x).to_owned());
        for line in self
            .truth
            .lines()
            .map(str::to_owned)
            .chain(findings)
            .chain(other)
        {
            page.push_str(&format!("# {}\n", line.replace('\n', "\n#   ")));
        }
        page + &self.text
    }
}

/// A drawing in the plane, moved by up to its size and turned.
fn posed(suite: Suite, seed: u64, drawn: u64) -> (&'static str, Posed) {
    let mut numbers = Numbers::new(seed ^ Numbers::new(drawn).bits());
    let (name, drawing) = match suite {
        Suite::Rounded | Suite::Space => {
            let family = Family::ALL[(drawn % Family::ALL.len() as u64) as usize];
            (family.name(), family.draw(&mut numbers))
        }
        Suite::FullRank => {
            let kind = Slender::ALL[(drawn % Slender::ALL.len() as u64) as usize];
            (kind.name(), kind.draw(&mut numbers))
        }
    };
    let mut posed = Posed::new(&drawing, Writing::Moved, &mut numbers);
    posed.shift = [Ratio::ZERO; 2];
    let size = extent(&posed);
    let tenths = (7.0 * size).floor() as i32;
    posed.shift = [0; 2].map(|_| Ratio::new(numbers.between(-tenths, tenths).into(), 10));
    (name, posed)
}

/// Returns the results for all scenes of one drawing, or `None` if a near drawing happens to be
/// redundant.
#[must_use]
pub fn outcomes(suite: Suite, seed: u64, drawn: u64) -> Vec<Outcome> {
    if suite == Suite::Space {
        return space::within::outcomes(seed, drawn);
    }
    let (family, posed) = posed(suite, seed, drawn);
    let gravity = match suite {
        Suite::Rounded | Suite::Space => GRAVITY,
        Suite::FullRank => [0.0; 2],
    };
    let meant = Meant::of(&posed, seed, gravity);
    if suite == Suite::FullRank && meant.right.redundancy > 0 {
        return Vec::new();
    }
    let largest = largest_coordinate(&posed);
    let one = |way: usize| {
        let precision = match suite {
            Suite::Rounded | Suite::Space => {
                let digits = DIGITS[way];
                let tolerance = 2.0 * 10_f64.powi(1 - digits as i32) * largest;
                Precision {
                    digits: Some(digits),
                    tolerance: (digits < 16).then_some(tolerance),
                    gravity,
                }
            }
            Suite::FullRank => Precision {
                tolerance: Some(PARTS[way] * meant.from.low / BEYOND_DOUBT),
                ..Precision::default()
            },
        };
        outcome(suite, family, way, (&posed, &meant), &precision)
    };
    (0..suite.ways() as usize).map(one).collect()
}

fn outcome(
    suite: Suite,
    family: &'static str,
    way: usize,
    (posed, meant): (&Posed, &Meant<'_>),
    precision: &Precision,
) -> Outcome {
    let text = text_within(posed, precision);
    let mut judged = Judged::default();
    match panic::catch_unwind(AssertUnwindSafe(|| answer::answer(&text))) {
        Ok(Ok(document)) => match precision.tolerance {
            Some(tolerance) => {
                judged = meant.judge(&document, tolerance);
                if suite == Suite::FullRank && judged.other_rank.is_some() {
                    judged.other_rank = None;
                }
            }
            None => judged.findings = examine(&meant.truth, &meant.right, &document),
        },
        Ok(Err(refusal)) => judged.findings.note(Kind::Refused, refusal),
        Err(_) => judged
            .findings
            .note(Kind::Panic, "the analysis panicked".to_owned()),
    }
    let tolerance = precision.tolerance.unwrap_or(0.0);
    Outcome {
        family,
        way,
        truth: format!(
            "{}\nτ* from {:.3e} m to {:.3e} m, tolerance {tolerance:.3e} m, size {:.3e} m, {}",
            meant.right.describe(),
            meant.from.low,
            meant.from.high,
            meant.size,
            if meant.is_permanent {
                "permanent"
            } else {
                "singular pose"
            },
        ),
        text,
        judged,
        is_far: suite == Suite::FullRank || meant.is_far(tolerance),
        is_redundant: meant.right.redundancy > 0,
    }
}

/// The largest coordinate in the text (m).
fn largest_coordinate(posed: &Posed) -> f64 {
    let doubles = Doubles::of(posed);
    let lengths = doubles.blocks.iter().filter(|b| b.count == 2);
    let local = lengths.flat_map(|b| &doubles.data[b.first..b.first + 2]);
    let bodies = doubles.q.chunks_exact(3).flat_map(|q| &q[..2]);
    let world = posed.links.iter().flat_map(|p| p.link.tie.points());
    let world = world.flat_map(|p| posed.point(p).map(|x| x.rounded(posed.stretch)));
    let largest = local.chain(bodies).copied().chain(world);
    largest.fold(0.0, |a: f64, x| a.max(x.abs())).max(1.0)
}

/// Counts for one kind of scenes.
#[derive(Clone, Debug, Default)]
pub struct Count {
    /// Number of scenes.
    pub scenes: usize,
    /// Redundant ones.
    pub redundant: usize,
    /// Scenes that are far from a lower rank.
    pub far: usize,
    /// Scenes without findings.
    pub right: usize,
    /// Scenes for which another rank is correct, by reason.
    pub other: BTreeMap<&'static str, usize>,
    /// Scenes with findings, by the worst one and whether they are far: their number, and the first
    /// of them.
    pub not: BTreeMap<(Kind, bool), (usize, Vec<u64>)>,
}

impl Count {
    fn add(&mut self, other: Self) {
        self.scenes += other.scenes;
        self.redundant += other.redundant;
        self.far += other.far;
        self.right += other.right;
        for (why, count) in other.other {
            *self.other.entry(why).or_default() += count;
        }
        for (kind, (count, first)) in other.not {
            let own = self.not.entry(kind).or_default();
            own.0 += count;
            own.1.extend(first);
            own.1.sort_unstable();
            own.1.truncate(LISTED);
        }
    }

    fn of(&self, wanted: impl Fn(Kind, bool) -> bool) -> usize {
        let counts = self
            .not
            .iter()
            .filter(|((kind, far), _)| wanted(*kind, *far));
        counts.map(|(_, (count, _))| count).sum()
    }
}

/// The results for many scenes.
#[derive(Clone, Debug)]
pub struct Tally {
    /// The set of scenes.
    pub suite: Suite,
    /// By the index of digits or tolerance.
    pub by_way: BTreeMap<usize, Count>,
    /// By family.
    pub by_family: BTreeMap<&'static str, Count>,
}

impl Tally {
    fn new(suite: Suite) -> Self {
        Self {
            suite,
            by_way: BTreeMap::new(),
            by_family: BTreeMap::new(),
        }
    }

    /// Tests the scenes of some drawings of a seed; `done` is called after each of them.
    #[must_use]
    pub fn of(suite: Suite, seed: u64, from: u64, drawings: u64, done: impl Fn() + Sync) -> Self {
        let of_drawing = |drawn: u64| {
            let mut tally = Self::new(suite);
            for outcome in outcomes(suite, seed, drawn) {
                tally.note(drawn * suite.ways() + outcome.way as u64, &outcome);
                done();
            }
            tally
        };
        let drawn: Vec<u64> = (from..from + drawings).collect();
        let tallies = drawn.into_par_iter().map(of_drawing);
        tallies.reduce(|| Self::new(suite), Self::joined)
    }

    fn note(&mut self, number: u64, outcome: &Outcome) {
        let mut count = Count {
            scenes: 1,
            redundant: usize::from(outcome.is_redundant),
            far: usize::from(outcome.is_far),
            ..Count::default()
        };
        match (outcome.worst(), outcome.judged.other_rank) {
            (Some(worst), _) => {
                count.not.insert((worst, outcome.is_far), (1, vec![number]));
            }
            (None, Some(why)) => {
                count.other.insert(why, 1);
            }
            (None, None) => count.right = 1,
        }
        self.by_way
            .entry(outcome.way)
            .or_default()
            .add(count.clone());
        self.by_family.entry(outcome.family).or_default().add(count);
    }

    fn joined(mut self, other: Self) -> Self {
        for (key, count) in other.by_way {
            self.by_way.entry(key).or_default().add(count);
        }
        for (key, count) in other.by_family {
            self.by_family.entry(key).or_default().add(count);
        }
        self
    }

    /// Number of scenes with a wrong answer.
    #[must_use]
    pub fn wrong(&self) -> usize {
        let counts = self.by_way.values();
        counts.map(|c| c.of(|kind, _| kind.is_wrong())).sum()
    }

    /// Whether no answer is wrong, and few are undecided that should be decided.
    #[must_use]
    pub fn passes(&self) -> bool {
        let is_open = |kind: Kind, far: bool| far && !kind.is_wrong();
        let last = DIGITS.len() - 1;
        let is_last = |way: usize| self.suite != Suite::FullRank && way == last;
        let (mut far, mut open) = (0, 0);
        for (&way, count) in &self.by_way {
            if is_last(way) {
                if UNDECIDED_WITHOUT * count.of(is_open) > count.scenes {
                    return false;
                }
                continue;
            }
            far += count.far;
            open += count.of(is_open);
        }
        self.wrong() == 0 && UNDECIDED * open <= far
    }

    /// The results in words.
    #[must_use]
    pub fn describe(&self) -> String {
        let mut text = String::new();
        let mut total = Count::default();
        for (&way, count) in &self.by_way {
            total.add(count.clone());
            let name = match self.suite {
                Suite::Rounded | Suite::Space => format!("{} digits", DIGITS[way]),
                Suite::FullRank => format!("{} τ*/3", PARTS[way]),
            };
            text.push_str(&line(&name, count));
        }
        for (family, count) in &self.by_family {
            text.push_str(&line(family, count));
        }
        text.push_str(&line("all", &total));
        text.push_str(&format!(
            "{} wrong; {} undecided or refused of {} that have to be decided\n",
            self.wrong(),
            total.of(|kind, far| far && !kind.is_wrong()),
            total.far
        ));
        text
    }
}

fn line(name: &str, count: &Count) -> String {
    let mut text = format!(
        "{name:26} {:6} scenes, {:6} redundant, {:6} far, {:6} right",
        count.scenes, count.redundant, count.far, count.right
    );
    for (why, n) in &count.other {
        text.push_str(&format!(", {n} {why}"));
    }
    for ((kind, far), (n, first)) in &count.not {
        let far = if *far { " far" } else { "" };
        text.push_str(&format!(", {n} {}{far} {first:?}", kind.name()));
    }
    text + "\n"
}
