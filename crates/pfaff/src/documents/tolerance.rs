//! What reactions, ranks and places do while data vary within their tolerances.

use report::figures::RangeDocument;
use serde::Serialize;

use super::ByName;

/// The document of `tolerance --json`.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct ToleranceDocument {
    /// Name of the scene.
    pub scene: String,
    /// Time of the configuration (s).
    pub time: f64,
    /// What the samples are drawn from.
    pub drawn: DrawnDocument,
    /// Samples that were made, of those that were asked for.
    pub samples: u64,
    /// Whether a stop was requested before all were made.
    pub partial: bool,
    /// Samples that could be assembled.
    pub assembled: u64,
    /// Why others could not, the most frequent reason first.
    pub failures: Vec<FailureDocument>,
    /// The described mechanism, as it is read within its tolerances.
    pub described: DescribedDocument,
    /// Ranks of the samples with exact numbers at their poses, the most frequent one first.
    pub ranks: Vec<RankCountDocument>,
    /// Samples whose rank is undecided with exact numbers.
    pub undecided: u64,
    /// What rows that are redundant as described miss in the samples, the largest first: angles
    /// count by their arm, the size of the mechanism.
    pub misfits: Vec<RowMisfitDocument>,
    /// Joints and drives, the largest relative range first.
    pub reactions: Vec<ReactionRangeDocument>,
    /// How far bodies are from where they are described.
    pub bodies: ByName<MovedDocument>,
    /// Where markers are.
    pub markers: ByName<MarkerRangeDocument>,
    /// Values of measures.
    pub measures: ByName<MeasureRangeDocument>,
}

/// What samples are drawn from.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct DrawnDocument {
    /// Samples that were asked for.
    pub samples: u64,
    /// The seed: the same one gives the same samples.
    pub seed: u64,
    /// The distribution of each displacement within its tolerance.
    pub distribution: &'static str,
    /// The tolerances in words, as `± 0.1 mm`.
    pub within: String,
    /// Least and greatest tolerance of points and lengths (m); `null` if none varies.
    pub lengths: Option<[f64; 2]>,
    /// Least and greatest tolerance of directions, angles and ratios (rad); `null` if none varies.
    pub angles: Option<[f64; 2]>,
    /// Number of points, directions and numbers that vary.
    pub data: usize,
    /// Numbers of the scene that vary besides.
    pub varied: Vec<VariedDocument>,
}

/// A number of the scene that varies.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct VariedDocument {
    /// Its key.
    pub key: String,
    /// By how much, as it was asked for.
    pub by: String,
}

/// Samples with the same reason.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct FailureDocument {
    /// Why they could not be assembled.
    pub reason: String,
    /// Their number.
    pub samples: u64,
    /// The first of them, from 1.
    pub first: u64,
    /// What is special to it.
    pub detail: String,
}

/// The described mechanism.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct DescribedDocument {
    /// Number of rows.
    pub rows: usize,
    /// Rank; if it is undecided, the lower one, at which samples are assembled.
    pub rank: usize,
    /// Rows beyond the rank.
    pub redundancy: usize,
    /// Free motions.
    pub mobility: usize,
    /// Why the rank is undecided within the tolerances.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub undecided_because: Option<String>,
}

/// Samples of one rank.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct RankCountDocument {
    /// Rank of all rows.
    pub rank: usize,
    /// Rows beyond the rank.
    pub redundancy: usize,
    /// Free motions.
    pub mobility: usize,
    /// Number of samples.
    pub samples: u64,
}

/// What a row misses.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct RowMisfitDocument {
    /// The row, from 1.
    pub row: usize,
    /// Its joint or drive.
    pub joint: String,
    /// Its name in the joint.
    pub name: &'static str,
    /// `m` or `rad`.
    pub unit: &'static str,
    /// Mean size.
    pub mean: f64,
    /// Largest size.
    pub greatest: f64,
    /// The sample with the largest one, from 1.
    pub sample: u64,
}

/// A joint or drive in all samples.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct ReactionRangeDocument {
    /// Its name.
    pub name: String,
    /// Its type in scenes.
    #[serde(rename = "type")]
    pub kind: &'static str,
    /// Its verdict as described, within the tolerances.
    pub verdict: &'static str,
    /// Whether it is unique, but hangs on the last digits of the data.
    pub fragile: bool,
    /// How many samples have which verdict with exact numbers.
    pub verdicts: VerdictCounts,
    /// The range in words.
    pub sentence: String,
    /// Width of the range of its first number, relative to the described one; `null` if there is
    /// no range, or nothing to relate it to.
    pub relative: Option<f64>,
    /// Its numbers; the first one is that of the sentence.
    pub values: Vec<QuantityRangeDocument>,
}

/// Numbers of samples by verdict.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct VerdictCounts {
    /// Unique.
    pub unique: u64,
    /// Not unique.
    pub not_unique: u64,
    /// Undecided.
    pub undecided: u64,
}

/// A number of a reaction in all samples.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct QuantityRangeDocument {
    /// The component, or `|F|` or `|T|`.
    pub name: &'static str,
    /// `N` or `N·m`.
    pub unit: &'static str,
    /// Whether it is unique as described.
    pub unique: bool,
    /// The verdict on it: as described, and if it is unique there, the worst of all samples with
    /// the redundancy as it is described.
    pub verdict: &'static str,
    /// `kept_rows`: the redundancy stays as it is described, and the number is unique there in all
    /// samples. `exact`: not unique as described; all rows count with exact numbers, rigid and
    /// without play, and determine it in all samples. `none`: some sample does not determine it.
    pub reading: &'static str,
    /// Why it has no range; absent if it has one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub reason: Option<&'static str>,
    /// Its values; `null` unless all samples determine it.
    pub range: Option<RangeDocument>,
}

/// How far a body is from where it is described.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct MovedDocument {
    /// Mean distance of its frame (m).
    pub mean: f64,
    /// Largest distance of its frame (m).
    pub greatest: f64,
    /// Largest angle (rad).
    pub turned: f64,
}

/// Where a marker is.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct MarkerRangeDocument {
    /// With the data as described (m).
    pub described: Vec<f64>,
    /// Least coordinates (m).
    pub least: Vec<f64>,
    /// Greatest coordinates (m).
    pub greatest: Vec<f64>,
    /// Mean distance from the described place (m).
    pub mean: f64,
    /// Largest distance from the described place (m).
    pub farthest: f64,
}

/// Values of a measure.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct MeasureRangeDocument {
    /// Its unit.
    pub unit: &'static str,
    /// Its values.
    pub range: RangeDocument,
}

/// A row that misses by less than this share of the tolerances fits.
const FITS: f64 = 1e-6;

/// A row that misses by less than this (m or rad) fits, whatever the tolerances.
const CLOSED: f64 = 1e-12;

impl ToleranceDocument {
    /// What was done and what holds, in sentences: all but the ranges of single reactions.
    #[must_use]
    pub fn sentences(&self) -> Vec<String> {
        let drawn = &self.drawn;
        let angles = match (drawn.lengths, drawn.angles) {
            (Some(_), Some([_, greatest])) => format!(" or {greatest:.1e} rad"),
            _ => String::new(),
        };
        let samples = counted(drawn.samples, "sample", "samples");
        let (distribution, within) = (drawn.distribution, &drawn.within);
        let what = match drawn.data as u64 {
            0 => format!("{samples}, {distribution} within {within}"),
            n => {
                let data = counted(
                    n,
                    "point, direction or number",
                    "points, directions and numbers",
                );
                format!("{samples} of {data}, each {distribution} within {within}{angles}")
            }
        };
        let mut all = vec![format!(
            "{} at t = {} s: {what} (seed {})",
            self.scene, self.time, drawn.seed
        )];
        if !drawn.varied.is_empty() {
            let varied = drawn
                .varied
                .iter()
                .map(|own| format!("`{}` {}", own.key, own.by));
            let varied: Vec<String> = varied.collect();
            all.push(format!("varied besides: {}", model::words::listed(&varied)));
        }
        if self.partial {
            all.push(format!(
                "interrupted: {} of {} samples were made",
                self.samples, drawn.samples
            ));
        }
        for failure in &self.failures {
            all.push(format!(
                "{} could not be assembled: {} (sample {}: {})",
                counted(failure.samples, "sample", "samples"),
                failure.reason,
                failure.first,
                failure.detail
            ));
        }
        all.push(self.reading());
        all.extend(self.exact());
        all.extend(self.fit());
        all
    }

    /// Reactions without a range, in sentences: those with the same reason together.
    #[must_use]
    pub fn without_range(&self) -> Vec<String> {
        let mut by_reason: Vec<(&str, Vec<String>)> = Vec::new();
        for reaction in &self.reactions {
            let first = reaction.values.first();
            let Some(reason) = first.and_then(|value| value.reason) else {
                continue;
            };
            let name = format!("`{}`", reaction.name);
            match by_reason.iter_mut().find(|(own, _)| *own == reason) {
                Some((_, names)) => names.push(name),
                None => by_reason.push((reason, vec![name])),
            }
        }
        if self.assembled == 0 {
            return Vec::new();
        }
        let told = by_reason.into_iter();
        told.map(|(reason, names)| {
            let names = model::words::listed(&names);
            format!("{reason}, so no range: {names}")
        })
        .collect()
    }

    /// How the described mechanism is read.
    fn reading(&self) -> String {
        let d = &self.described;
        match &d.undecided_because {
            None => format!(
                "as described: rank {} of {}, redundancy {}, mobility {}",
                d.rank,
                counted(d.rows as u64, "row", "rows"),
                d.redundancy,
                d.mobility
            ),
            Some(doubt) => format!(
                "as described the rank is undecided: {doubt}; samples are assembled with rank {}",
                d.rank
            ),
        }
    }

    /// The ranks with exact numbers.
    fn exact(&self) -> Vec<String> {
        let d = &self.described;
        let mut all = Vec::new();
        for own in &self.ranks {
            if own.rank == d.rank {
                all.push(if own.samples == self.assembled {
                    "with exact numbers the rank is the same in all samples".to_owned()
                } else {
                    format!(
                        "with exact numbers the rank is the same in {} of {} samples",
                        own.samples, self.assembled
                    )
                });
                continue;
            }
            let meaning = if own.rank > d.rank {
                let free = match d.mobility - own.mobility.min(d.mobility) {
                    1 => "one free motion is".to_owned(),
                    lost => format!("{lost} free motions are"),
                };
                format!(
                    "rows that are redundant as described are independent there, and without play or slip {free} lost"
                )
            } else {
                "rows are redundant there that are independent as described".to_owned()
            };
            all.push(format!(
                "with exact numbers the rank is {} (redundancy {}, mobility {}) in {} of {} samples: {meaning}",
                own.rank, own.redundancy, own.mobility, own.samples, self.assembled
            ));
        }
        if self.undecided > 0 {
            all.push(format!(
                "with exact numbers the rank is undecided in {} of {} samples",
                self.undecided, self.assembled
            ));
        }
        all
    }

    /// What the redundant rows miss.
    fn fit(&self) -> Option<String> {
        let worst = self.misfits.first()?;
        let drawn = &self.drawn;
        let tolerances = drawn.lengths.into_iter().chain(drawn.angles).flatten();
        let least = tolerances.reduce(f64::min).unwrap_or(0.0);
        if worst.greatest <= (FITS * least).max(CLOSED) {
            return Some("the redundant rows fit in all samples".to_owned());
        }
        let told = |x: f64| match worst.unit {
            "m" => distance(x),
            unit => format!("{x:.1e} {unit}"),
        };
        let others = match self.misfits.len() {
            1 => String::new(),
            n => format!(", the largest of {n}"),
        };
        Some(format!(
            "the redundant rows do not fit exactly: row {} (`{}`, {}) misses by up to {}, {} on average{others}; play or \
             elasticity has to take it, or the parts cannot be put together",
            worst.row,
            worst.joint,
            worst.name,
            told(worst.greatest),
            told(worst.mean)
        ))
    }
}

/// A distance with at most three significant digits, in the unit that people say.
///
/// ```
/// use pfaff::documents::distance;
/// assert_eq!([0.0, 1e-4, 2.346e-3, 1e-7, 2.0].map(distance), ["0 mm", "0.1 mm", "2.35 mm", "0.1 µm", "2 m"]);
/// ```
#[must_use]
pub fn distance(metres: f64) -> String {
    let (unit, name) = match metres.abs() {
        0.0 => (1e-3, "mm"),
        x if x >= 1.0 => (1.0, "m"),
        x if x >= 1e-5 => (1e-3, "mm"),
        _ => (1e-6, "µm"),
    };
    let short: f64 = format!("{:.2e}", metres / unit)
        .parse()
        .unwrap_or(metres / unit);
    format!("{} {name}", model::words::rounded(short))
}

fn counted(n: u64, one: &str, many: &str) -> String {
    format!("{n} {}", if n == 1 { one } else { many })
}
