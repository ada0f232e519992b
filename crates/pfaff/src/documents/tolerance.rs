//! Ranges of reactions, ranks and positions for data that vary within their tolerances.

use model::words::estimate;
use report::figures::RangeDocument;
use serde::Serialize;

use super::ByName;
use crate::words::grouped;

/// The document of `tolerance --json`.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct ToleranceDocument {
    /// Name of the scene.
    pub scene: String,
    /// Time of the configuration (s).
    pub time: f64,
    /// Description of the random data of the samples.
    pub drawn: DrawnDocument,
    /// Number of samples that were computed, of those that were requested.
    pub samples: u64,
    /// Whether a stop was requested before all samples were computed.
    pub partial: bool,
    /// Samples that could be assembled.
    pub assembled: u64,
    /// Reasons why the other samples could not be assembled, the most frequent reason first.
    pub failures: Vec<FailureDocument>,
    /// The described mechanism, analysed within its tolerances.
    pub described: DescribedDocument,
    /// Ranks of the samples with exact numbers at their configurations, the most frequent rank
    /// first.
    pub ranks: Vec<RankCountDocument>,
    /// Samples whose rank is undecided with exact numbers.
    pub undecided: u64,
    /// Samples in which one-sided joints open, if the scene has one-sided joints.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub openings: Option<OpeningsDocument>,
    /// Violations, in the samples, of rows that are redundant as described, the largest first.
    /// Angles are multiplied by their lever arm, the size of the mechanism.
    pub misfits: Vec<RowMisfitDocument>,
    /// Joints and drives, the largest relative range first.
    pub reactions: Vec<ReactionRangeDocument>,
    /// Distances of bodies from their described positions.
    pub bodies: ByName<MovedDocument>,
    /// Ranges of the positions of markers.
    pub markers: ByName<MarkerRangeDocument>,
    /// Ranges of joint coordinates (measures).
    pub measures: ByName<MeasureRangeDocument>,
    /// The assumptions of the bounds, if bounds were requested.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub bounds: Option<String>,
}

/// Description of the random data of samples.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct DrawnDocument {
    /// Number of requested samples.
    pub samples: u64,
    /// The seed: the same seed gives the same samples.
    pub seed: u64,
    /// The distribution of each displacement within its tolerance.
    pub distribution: &'static str,
    /// The tolerances as text, such as `± 0.1 mm`.
    pub within: String,
    /// Smallest and largest tolerance of points and lengths (m); `null` if none varies.
    pub lengths: Option<[f64; 2]>,
    /// Smallest and largest tolerance of directions, angles and ratios (rad); `null` if none
    /// varies.
    pub angles: Option<[f64; 2]>,
    /// Number of points, directions and numbers that vary.
    pub data: usize,
    /// Further numbers of the scene that vary.
    pub varied: Vec<VariedDocument>,
}

/// A number of the scene that varies.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct VariedDocument {
    /// Key of the number in the scene.
    pub key: String,
    /// The requested variation.
    pub by: String,
}

/// Samples that failed for the same reason.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct FailureDocument {
    /// Reason why the samples could not be assembled.
    pub reason: String,
    /// Number of these samples.
    pub samples: u64,
    /// Number of the first such sample, counted from 1.
    pub first: u64,
    /// Further details of the first sample.
    pub detail: String,
}

/// The described mechanism.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct DescribedDocument {
    /// Number of rows.
    pub rows: usize,
    /// Rank of the described mechanism. If the rank is undecided, this is the smaller of the two
    /// possible ranks; the samples are assembled with this rank.
    pub rank: usize,
    /// Number of rows minus the rank.
    pub redundancy: usize,
    /// Number of free motions.
    pub mobility: usize,
    /// Reason why the rank is undecided within the tolerances.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub undecided_because: Option<String>,
}

/// Samples with the same rank.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct RankCountDocument {
    /// Rank of all rows.
    pub rank: usize,
    /// Number of rows minus the rank.
    pub redundancy: usize,
    /// Number of free motions.
    pub mobility: usize,
    /// Number of samples.
    pub samples: u64,
}

/// Samples in which one-sided joints cannot all stay closed, with the described redundancy.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct OpeningsDocument {
    /// Number of these samples.
    pub samples: u64,
    /// The first of these samples, counted from 1.
    pub first: Option<u64>,
    /// The joints that open, with their numbers of samples.
    pub joints: ByName<u64>,
}

/// Violation of a row in the samples.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct RowMisfitDocument {
    /// The row, counted from 1.
    pub row: usize,
    /// Joint or drive of the row.
    pub joint: String,
    /// Name of the row in the joint.
    pub name: &'static str,
    /// `m` or `rad`.
    pub unit: &'static str,
    /// Mean absolute violation.
    pub mean: f64,
    /// Largest absolute violation.
    pub greatest: f64,
    /// The sample with the largest violation, counted from 1.
    pub sample: u64,
}

/// Results for a joint or drive in all samples.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct ReactionRangeDocument {
    /// Name of the joint or drive.
    pub name: String,
    /// Type of the joint or drive in scenes.
    #[serde(rename = "type")]
    pub kind: &'static str,
    /// Verdict for the described data, within the tolerances.
    pub verdict: &'static str,
    /// Whether the reaction is unique, but sensitive to the last digits of the data.
    pub fragile: bool,
    /// Number of samples with each verdict, with exact numbers.
    pub verdicts: VerdictCounts,
    /// The range as text.
    pub sentence: String,
    /// Width of the range of the first number, relative to the described value; `null` if there is
    /// no range, or no value for comparison.
    pub relative: Option<f64>,
    /// Numbers of the reaction; the text describes the first one.
    pub values: Vec<QuantityRangeDocument>,
}

/// Numbers of samples by verdict.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct VerdictCounts {
    /// Number of samples in which the reaction is unique.
    pub unique: u64,
    /// Number of samples in which it is not unique.
    pub not_unique: u64,
    /// Number of samples in which its verdict is undecided.
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
    /// Whether the number is unique as described.
    pub unique: bool,
    /// The verdict on the number as described; if the number is unique there, the worst verdict of
    /// all samples with the described redundancy.
    pub verdict: &'static str,
    /// `kept_rows`: the redundancy is as described, and the number is unique with it in all
    /// samples. `exact`: the number is not unique as described. With exact numbers all rows count,
    /// the bodies are rigid and the joints have no clearance; then all samples determine the
    /// number. `none`: at least one sample does not determine the number.
    pub reading: &'static str,
    /// Reason why the number has no range; absent if it has one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub reason: Option<&'static str>,
    /// Range of its values; `null` unless all samples determine the number.
    pub range: Option<RangeDocument>,
    /// Bounds of a number without range for elastic joints, if bounds were requested and every
    /// sample has bounds.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub bounds: Option<BoundsOfSamples>,
    /// The range of a number that is not unique, over the loads that one-sided joints permit and
    /// over all samples in which these joints stay closed; absent without a limit.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub permitted: Option<PermittedOfSamples>,
}

/// The range of a number over the loads that one-sided joints permit, in all samples in which these
/// joints stay closed.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct PermittedOfSamples {
    /// The smallest value (N, N·m); `null` if there is none.
    pub lowest: Option<f64>,
    /// The largest value (N, N·m); `null` if there is none.
    pub highest: Option<f64>,
}

/// The smallest and the largest bound of a number over all samples.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct BoundsOfSamples {
    /// The smallest value (N, N·m).
    pub lowest: f64,
    /// The largest value (N, N·m).
    pub highest: f64,
}

/// Displacement of a body from its described position.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct MovedDocument {
    /// Mean distance of the frame of the body (m).
    pub mean: f64,
    /// Largest distance of the frame of the body (m).
    pub greatest: f64,
    /// Largest rotation (rad).
    pub turned: f64,
}

/// Position of a marker.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct MarkerRangeDocument {
    /// Position for the described data (m).
    pub described: Vec<f64>,
    /// Smallest coordinates (m).
    pub least: Vec<f64>,
    /// Largest coordinates (m).
    pub greatest: Vec<f64>,
    /// Mean distance from the described position (m).
    pub mean: f64,
    /// Largest distance from the described position (m).
    pub farthest: f64,
}

/// Values of a joint coordinate (measure).
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct MeasureRangeDocument {
    /// Unit of the joint coordinate.
    pub unit: &'static str,
    /// Range of its values.
    pub range: RangeDocument,
}

/// A row counts as satisfied if its violation is below this fraction of the tolerances.
const FITS: f64 = 1e-6;

/// A row counts as satisfied for any tolerances if its violation is below this value (m or rad).
const CLOSED: f64 = 1e-12;

impl ToleranceDocument {
    /// Describes the samples and the results in sentences, without the ranges of single reactions.
    #[must_use]
    pub fn sentences(&self) -> Vec<String> {
        let drawn = &self.drawn;
        let angles = match (drawn.lengths, drawn.angles) {
            (Some(_), Some([_, greatest])) => format!(" or {}", estimate(greatest, "rad")),
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
                format!("{samples} of {data}, with {distribution} errors within {within}{angles}")
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
            all.push(format!("also varied: {}", model::words::listed(&varied)));
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
        all.extend(
            self.openings
                .as_ref()
                .map(|own| own.sentence(self.assembled)),
        );
        all
    }

    /// Lists reactions without a range in sentences. Reactions with the same reason share a
    /// sentence.
    #[must_use]
    pub fn without_range(&self) -> Vec<String> {
        let without = self.reactions.iter().filter_map(|reaction| {
            let reason = reaction.values.first()?.reason?;
            Some((reason, format!("`{}`", reaction.name)))
        });
        let by_reason = grouped(without);
        if self.assembled == 0 {
            return Vec::new();
        }
        let told = by_reason.into_iter();
        told.map(|(reason, names)| {
            let names = model::words::listed(&names);
            format!("no range, because {reason}: {names}")
        })
        .collect()
    }

    /// Describes the rank with which the described mechanism is analysed.
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

    /// Describes the ranks with exact numbers.
    fn exact(&self) -> Vec<String> {
        let d = &self.described;
        let mut all = Vec::new();
        for own in &self.ranks {
            if own.rank == d.rank {
                all.push(if own.samples == self.assembled {
                    "the rank without tolerance is the same in all samples".to_owned()
                } else {
                    format!(
                        "the rank without tolerance is the same in {} of {} samples",
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
                    "rows that are redundant in the described scene are independent in these samples; without play or slip {free} lost"
                )
            } else {
                "rows that are independent in the described scene are redundant in these samples"
                    .to_owned()
            };
            all.push(format!(
                "the rank without tolerance is {} (redundancy {}, mobility {}) in {} of {} samples: {meaning}",
                own.rank, own.redundancy, own.mobility, own.samples, self.assembled
            ));
        }
        if self.undecided > 0 {
            all.push(format!(
                "the rank without tolerance is undecided in {} of {} samples",
                self.undecided, self.assembled
            ));
        }
        all
    }

    /// Describes the violations of the redundant rows.
    fn fit(&self) -> Option<String> {
        let worst = self.misfits.first()?;
        let drawn = &self.drawn;
        let tolerances = drawn.lengths.into_iter().chain(drawn.angles).flatten();
        let least = tolerances.reduce(f64::min).unwrap_or(0.0);
        if worst.greatest <= (FITS * least).max(CLOSED) {
            return Some("the redundant rows are satisfied in all samples".to_owned());
        }
        let told = |x: f64| estimate(x, worst.unit);
        let others = match self.misfits.len() {
            1 => String::new(),
            n => format!(", the largest of {n}"),
        };
        Some(format!(
            "the redundant rows are violated: row {} (`{}`, {}) by up to {}, {} on average{others}; without play or elasticity \
             the parts cannot be assembled",
            worst.row,
            worst.joint,
            worst.name,
            told(worst.greatest),
            told(worst.mean)
        ))
    }
}

impl OpeningsDocument {
    /// Describes the samples in which contacts open.
    fn sentence(&self, assembled: u64) -> String {
        let Some(first) = self.first else {
            return "the one-sided joints can all stay closed in all samples".to_owned();
        };
        let joints = self.joints.0.iter();
        let joints = joints.map(|(name, samples)| format!("`{name}` in {samples}"));
        let joints = model::words::listed(&joints.collect::<Vec<_>>());
        let in_them = match self.samples {
            1 => "this sample",
            _ => "these samples",
        };
        format!(
            "one-sided joints open in {} of {assembled} samples ({joints}; the first is sample {first}): the reactions of {in_them} are \
             those of joints that also pull",
            self.samples
        )
    }
}

fn counted(n: u64, one: &str, many: &str) -> String {
    format!("{n} {}", if n == 1 { one } else { many })
}
