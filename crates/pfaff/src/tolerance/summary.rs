//! The combined results of all samples as a document, and each sample as a row of a table.

use std::cmp::Reverse;

use crate::documents::{
    BoundsOfSamples, DescribedDocument, DrawnDocument, FailureDocument, MarkerRangeDocument,
    MeasureRangeDocument, MovedDocument, OpeningsDocument, PermittedOfSamples,
    QuantityRangeDocument, RangeDocument, RankCountDocument, ReactionRangeDocument,
    RowMisfitDocument, ToleranceDocument, VariedDocument, VerdictCounts,
};
use model::words::{estimate, quantity, range as range_in, short};
use model::{ConstraintId, DataUnit, System};
use report::ByName;
use solvability::Elasticity;

use super::ToleranceOptions;
use super::nominal::{Nominal, Reading};
use super::quantity::{Quantity, worse};
use super::sample::{AssembledSample, Sample};
use super::vary::Variation;
use crate::elasticity::assumption;

/// A number below this fraction of the largest number of its kind is too small for a relative
/// range.
const NOTHING: f64 = 0.1;

/// A number below this fraction of the largest number of its kind is rounding.
const ROUNDING: f64 = 1e-12;

impl Nominal {
    pub(super) fn document(
        &self,
        options: &ToleranceOptions,
        vary: &[Variation],
        samples: &[Sample],
    ) -> ToleranceDocument {
        let good: Vec<(u64, &AssembledSample)> = (samples.iter())
            .filter_map(|s| Some((s.number, s.outcome.as_ref().ok()?)))
            .collect();
        let described = self.assembled(&self.mechanism, &self.base).ok();
        let within = self.within();
        let told = match vary {
            [_, ..] if !self.data.is_empty() => format!("{within} and the given ranges"),
            _ => within.clone(),
        };
        let mut reactions = self.reactions(&good, described.as_ref(), &told);
        let width = |r: &ReactionRangeDocument| r.relative.unwrap_or(-1.0);
        // Entries with equal widths remain in the order of the scene.
        reactions.sort_by(|a, b| width(b).total_cmp(&width(a)));
        ToleranceDocument {
            scene: self.scene.clone(),
            time: self.t,
            drawn: DrawnDocument {
                samples: options.samples as u64,
                seed: options.seed,
                distribution: "uniform",
                within,
                lengths: self.tolerances(DataUnit::Length),
                angles: self.tolerances(DataUnit::Angle),
                data: self.data.len(),
                varied: (vary.iter())
                    .map(|own| VariedDocument {
                        key: own.key().to_owned(),
                        by: own.by(),
                    })
                    .collect(),
            },
            samples: samples.len() as u64,
            partial: samples.len() < options.samples,
            assembled: good.len() as u64,
            failures: failures(samples),
            described: self.described(),
            ranks: self.ranks(&good),
            undecided: good.iter().filter(|(_, s)| s.rank.is_none()).count() as u64,
            openings: self.openings(&good),
            misfits: self.misfits(&good),
            reactions,
            bodies: self.bodies(&good),
            markers: self.markers(&good, described.as_ref()),
            measures: self.measures(&good, described.as_ref()),
            bounds: (self.bounds.as_ref()).map(|asked| self.assumption(&asked.elasticity)),
        }
    }

    /// States the assumptions of the bounds.
    fn assumption(&self, elasticity: &Elasticity) -> String {
        let groups = self.mechanism.layout().groups.iter();
        let open = groups.zip(&self.reactions);
        let open = open.filter(|(_, r)| r.verdict != "unique");
        let open: Vec<_> = open.map(|(group, _)| group).collect();
        assumption(&open, true, elasticity.within.as_ref())
    }

    /// Returns the tolerances as text.
    fn within(&self) -> String {
        let told = |range: Option<[f64; 2]>, words: &dyn Fn(f64) -> String| {
            range.map(|[least, greatest]| {
                if least == greatest {
                    format!("± {}", words(least))
                } else {
                    format!("± {} to ± {}", words(least), words(greatest))
                }
            })
        };
        let lengths = told(self.tolerances(DataUnit::Length), &|x| quantity(x, "m"));
        let angles = told(self.tolerances(DataUnit::Angle), &|x| estimate(x, "rad"));
        lengths
            .or(angles)
            .unwrap_or_else(|| "the given ranges".to_owned())
    }

    fn described(&self) -> DescribedDocument {
        let layout = self.mechanism.layout();
        DescribedDocument {
            rows: layout.rows(),
            rank: self.rank,
            redundancy: layout.rows() - self.rank,
            mobility: layout.n_v - self.rank,
            undecided_because: match &self.reading {
                Reading::Decided => None,
                Reading::Undecided(doubt) => Some(doubt.clone()),
            },
        }
    }

    fn ranks(&self, good: &[(u64, &AssembledSample)]) -> Vec<RankCountDocument> {
        let layout = self.mechanism.layout();
        let mut ranks: Vec<RankCountDocument> = Vec::new();
        for rank in good.iter().filter_map(|(_, s)| s.rank) {
            match ranks.iter_mut().find(|own| own.rank == rank) {
                Some(own) => own.samples += 1,
                None => ranks.push(RankCountDocument {
                    rank,
                    redundancy: layout.rows() - rank,
                    mobility: layout.n_v - rank,
                    samples: 1,
                }),
            }
        }
        ranks.sort_by_key(|own| Reverse((own.samples, own.rank)));
        ranks
    }

    /// Counts the samples in which one-sided joints open.
    fn openings(&self, good: &[(u64, &AssembledSample)]) -> Option<OpeningsDocument> {
        // Without finite reactions it is not known whether joints stay closed.
        self.contacts.as_ref()?;
        let layout = self.mechanism.layout();
        let sided = layout.constraint_ids();
        let sided = sided.filter(|id| layout.groups[id.0].limits.open_side.is_some());
        let of_joint = |id: ConstraintId| {
            let samples = good.iter().filter(|(_, s)| s.opened.contains(&id)).count();
            (layout.groups[id.0].name.clone(), samples as u64)
        };
        let joints: Vec<(String, u64)> = sided.map(of_joint).collect();
        let mut open = good.iter().filter(|(_, s)| !s.opened.is_empty());
        (!joints.is_empty()).then(|| OpeningsDocument {
            samples: open.clone().count() as u64,
            first: open.next().map(|(number, _)| *number),
            joints: ByName(joints.into_iter().filter(|(_, n)| *n > 0).collect()),
        })
    }

    fn misfits(&self, good: &[(u64, &AssembledSample)]) -> Vec<RowMisfitDocument> {
        let layout = self.mechanism.layout();
        let of_row = |(k, &row): (usize, &usize)| {
            let mut worst: Option<(u64, f64)> = None;
            let mut sum = 0.0;
            for (number, sample) in good {
                let miss = sample.misfits[k].abs();
                sum += miss;
                if worst.is_none_or(|(_, most)| miss > most) {
                    worst = Some((*number, miss));
                }
            }
            let (sample, greatest) = worst?;
            let label = &layout.labels[row];
            Some(RowMisfitDocument {
                row: row + 1,
                joint: label.joint.clone(),
                name: label.row,
                unit: if layout.is_angular(row) { "rad" } else { "m" },
                mean: sum / good.len() as f64,
                greatest,
                sample,
            })
        };
        let mut all: Vec<_> = self.missing.iter().enumerate().filter_map(of_row).collect();
        let size = |m: &RowMisfitDocument| match m.unit {
            "rad" => m.greatest * self.size,
            _ => m.greatest,
        };
        all.sort_by(|a, b| size(b).total_cmp(&size(a)));
        all
    }

    fn reactions(
        &self,
        good: &[(u64, &AssembledSample)],
        described: Option<&AssembledSample>,
        within: &str,
    ) -> Vec<ReactionRangeDocument> {
        let first = |id: usize| self.quantities.iter().position(|q| q.id.0 == id);
        let told = (0..self.reactions.len()).filter_map(first);
        let value = |k: usize| described.map_or(0.0, |d| d.kept[k].abs());
        // Reference values of ranges, and limits of rounding, for forces and torques.
        let largest = |unit: &str| {
            let own = told.clone().filter(|k| self.quantities[*k].unit == unit);
            own.map(value).filter(|x| x.is_finite()).fold(0.0, f64::max)
        };
        let [forces, torques] = ["N", "N·m"].map(largest);
        let scale = |unit: &str| if unit == "N" { forces } else { torques };
        let rounding = |unit: &str| match unit {
            "N" => ROUNDING * forces.max(torques / self.size),
            _ => ROUNDING * torques.max(forces * self.size),
        };
        let reactions = self.reactions.iter().enumerate();
        reactions
            .map(|(id, reaction)| {
                let mut verdicts = VerdictCounts::default();
                for (_, sample) in good {
                    match sample.verdicts[id] {
                        "unique" => verdicts.unique += 1,
                        "not_unique" => verdicts.not_unique += 1,
                        _ => verdicts.undecided += 1,
                    }
                }
                let own = self.quantities.iter().enumerate();
                let values: Vec<QuantityRangeDocument> = own
                    .filter(|(_, q)| q.id.0 == id)
                    .map(|(k, q)| self.quantity(k, q, (good, described), rounding(q.unit)))
                    .collect();
                let relative = values.first().and_then(|value| {
                    let range = value.range.as_ref()?;
                    let around = range.described.unwrap_or(range.percentiles[1]).abs();
                    let over = around.max(NOTHING * scale(value.unit));
                    (over > 0.0).then(|| range.width() / over)
                });
                let told = RangeContext {
                    name: &reaction.name,
                    verdict: reaction.verdict,
                    samples: good.len() as u64,
                    within,
                };
                ReactionRangeDocument {
                    name: reaction.name.clone(),
                    kind: reaction.kind,
                    verdict: reaction.verdict,
                    fragile: reaction.fragile,
                    verdicts,
                    sentence: told.sentence(values.first()),
                    relative,
                    values,
                }
            })
            .collect()
    }

    /// Returns the value of a number in a sample. Returns NaN if the sample does not determine the
    /// number.
    fn value(&self, k: usize, sample: &AssembledSample) -> f64 {
        if self.is_unique(k) {
            sample.kept[k]
        } else {
            sample.exact[k]
        }
    }

    /// Summarises a component or magnitude of a reaction over all samples.
    fn quantity(
        &self,
        k: usize,
        quantity: &Quantity,
        (good, described): (&[(u64, &AssembledSample)], Option<&AssembledSample>),
        rounding: f64,
    ) -> QuantityRangeDocument {
        let unique = self.is_unique(k);
        // If a sum cancels, its value is only a rounding error and is replaced by zero.
        let clean = |x: f64| if x.abs() <= rounding { 0.0 } else { x };
        let value = |s: &AssembledSample| clean(self.value(k, s));
        let told = described.filter(|_| unique || !self.is_decided());
        let told = told.map(value).filter(|x| x.is_finite());
        let values: Vec<f64> = good.iter().map(|(_, s)| value(s)).collect();
        let determined = values.iter().filter(|x| x.is_finite()).count();
        // A range over only some samples would depend on the selection of the samples.
        let is_whole = determined == values.len();
        let range = is_whole.then(|| RangeDocument::of(values, told)).flatten();
        let bounds = bounds(good, k, clean);
        let permitted = permitted(good, k, clean).filter(|_| !unique);
        let of_samples = good.iter().map(|(_, s)| s.of_kept[k]);
        let reason = match &range {
            Some(_) => None,
            None if good.is_empty() => Some(NO_SAMPLE),
            None if unique => Some(SHARED_IN_SAMPLES),
            None if determined > 0 => Some(SOME_SAMPLES),
            None if good
                .iter()
                .all(|(_, s)| s.verdicts[quantity.id.0] != "unique") =>
            {
                Some(NEVER)
            }
            None => Some(CANNOT_MOVE),
        };
        // With exact data, a number may be unique that is not unique in the described mechanism.
        let bounds = bounds.filter(|_| range.is_none() || !unique);
        QuantityRangeDocument {
            name: quantity.name,
            unit: quantity.unit,
            unique,
            verdict: match (unique, reason) {
                (true, _) => of_samples.fold("unique", worse),
                (false, _) => self.verdicts[k],
            },
            reason,
            reading: match (&range, unique) {
                (None, _) => "none",
                (Some(_), true) => "kept_rows",
                (Some(_), false) => "exact",
            },
            range,
            bounds,
            permitted,
        }
    }

    fn bodies(&self, good: &[(u64, &AssembledSample)]) -> ByName<MovedDocument> {
        let names = self.mechanism.bodies().iter().map(|b| b.name.clone());
        let of_body = |(k, name): (usize, String)| {
            let mut moved = MovedDocument {
                mean: 0.0,
                greatest: 0.0,
                turned: 0.0,
            };
            for (_, sample) in good {
                let [by, turned] = sample.moved[k];
                moved.mean += by / good.len() as f64;
                moved.greatest = moved.greatest.max(by);
                moved.turned = moved.turned.max(turned);
            }
            (name, moved)
        };
        ByName(names.enumerate().map(of_body).collect())
    }

    fn markers(
        &self,
        good: &[(u64, &AssembledSample)],
        described: Option<&AssembledSample>,
    ) -> ByName<MarkerRangeDocument> {
        let Some(described) = described.filter(|_| !good.is_empty()) else {
            return ByName(Vec::new());
        };
        let axes = self.mechanism.space().n_translations();
        let markers = self.mechanism.frames().observed().markers.iter();
        let of_marker = |(k, marker): (usize, &model::Marker)| {
            let there = described.markers[k];
            let places = || good.iter().map(|(_, s)| s.markers[k]);
            let extreme = |of: fn(f64, f64) -> f64| -> Vec<f64> {
                (0..axes)
                    .map(|axis| places().map(|p| p[axis]).fold(there[axis], of))
                    .collect()
            };
            let apart = |p: [f64; 3]| -> f64 {
                let d: Vec<f64> = p.iter().zip(there).map(|(a, b)| a - b).collect();
                linalg::kernels::norm(&d)
            };
            let range = MarkerRangeDocument {
                described: there[..axes].to_vec(),
                least: extreme(f64::min),
                greatest: extreme(f64::max),
                mean: places().map(apart).sum::<f64>() / good.len() as f64,
                farthest: places().map(apart).fold(0.0, f64::max),
            };
            (marker.name.clone(), range)
        };
        ByName(markers.enumerate().map(of_marker).collect())
    }

    fn measures(
        &self,
        good: &[(u64, &AssembledSample)],
        described: Option<&AssembledSample>,
    ) -> ByName<MeasureRangeDocument> {
        let measures = self.mechanism.frames().observed().measures.iter();
        let of_measure = |(k, measure): (usize, &model::Measure)| {
            let values = good.iter().map(|(_, s)| s.measures[k]);
            let range = RangeDocument::of(values, described.map(|d| d.measures[k]))?;
            let unit = measure.kind.unit();
            Some((measure.name.clone(), MeasureRangeDocument { unit, range }))
        };
        ByName(measures.enumerate().filter_map(of_measure).collect())
    }

    /// Returns the columns of the table of samples.
    pub(super) fn columns(&self, vary: &[Variation]) -> Vec<String> {
        let fixed = ["sample", "status", "rank", "redundancy", "mobility"];
        let mut columns: Vec<String> = fixed.map(str::to_owned).to_vec();
        columns.extend(vary.iter().map(|own| format!("varied.{}", own.key())));
        let labels = &self.mechanism.layout().labels;
        for row in &self.missing {
            let label = &labels[*row];
            columns.push(format!("misfit.{}.{}", label.joint, label.row));
        }
        for (id, reaction) in self.reactions.iter().enumerate() {
            columns.push(format!("{}.verdict", reaction.name));
            let own = self.quantities.iter().enumerate();
            for (k, quantity) in own.filter(|(_, q)| q.id.0 == id) {
                let exact = if self.is_unique(k) { "" } else { ".exact" };
                let name = quantity.name.replace('|', "");
                columns.push(format!("{}.{name}{exact}", reaction.name));
            }
        }
        let space = self.mechanism.space();
        let observed = self.mechanism.frames().observed();
        for marker in &observed.markers {
            let axes = &["x", "y", "z"][..space.n_translations()];
            columns.extend(axes.iter().map(|axis| format!("{}.{axis}", marker.name)));
        }
        columns.extend(observed.measures.iter().map(|m| m.name.clone()));
        columns
    }

    /// Returns a row of the table of samples. Missing values are NaN.
    pub(super) fn row(&self, vary: &[Variation], sample: &Sample) -> Vec<String> {
        let layout = self.mechanism.layout();
        let mut row = vec![sample.number.to_string()];
        let found = match &sample.outcome {
            Ok(found) => found,
            Err(failed) => {
                row.push(failed.reason.to_owned());
                row.resize(self.columns(vary).len(), "NaN".to_owned());
                return row;
            }
        };
        row.push("done".to_owned());
        let of_rank = |f: fn(usize, usize) -> usize, of: usize| {
            found
                .rank
                .map_or("NaN".to_owned(), |r| f(of, r).to_string())
        };
        row.push(of_rank(|_, r| r, 0));
        row.push(of_rank(|rows, r| rows - r, layout.rows()));
        row.push(of_rank(|n_v, r| n_v - r, layout.n_v));
        row.extend(sample.varied.iter().map(f64::to_string));
        row.extend(found.misfits.iter().map(f64::to_string));
        for (id, verdict) in found.verdicts.iter().enumerate() {
            row.push((*verdict).to_owned());
            let own = self.quantities.iter().enumerate();
            for (k, _) in own.filter(|(_, q)| q.id.0 == id) {
                row.push(self.value(k, found).to_string());
            }
        }
        let axes = self.mechanism.space().n_translations();
        for place in &found.markers {
            row.extend(place[..axes].iter().map(f64::to_string));
        }
        row.extend(found.measures.iter().map(f64::to_string));
        row
    }

    /// Returns the names of the markers and their positions. For each marker, the first position
    /// follows from the data given in the scene.
    pub(super) fn clouds(&self, samples: &[Sample]) -> Vec<(String, Vec<[f64; 3]>)> {
        let Ok(described) = self.assembled(&self.mechanism, &self.base) else {
            return Vec::new();
        };
        let markers = self.mechanism.frames().observed().markers.iter();
        let cloud = |(k, marker): (usize, &model::Marker)| {
            let good = samples.iter().filter_map(|s| s.outcome.as_ref().ok());
            let all = std::iter::once(&described).chain(good);
            (marker.name.clone(), all.map(|s| s.markers[k]).collect())
        };
        markers.enumerate().map(cloud).collect()
    }
}

/// Returns the smallest and the largest bound of a number over the samples. Returns `None` if a
/// sample has no bounds.
fn bounds(
    good: &[(u64, &AssembledSample)],
    k: usize,
    clean: impl Fn(f64) -> f64,
) -> Option<BoundsOfSamples> {
    let each = good.iter().map(|(_, s)| s.bounds.get(k).copied());
    let each: Option<Vec<[f64; 2]>> = each.collect();
    let each = each.filter(|each| each.iter().flatten().all(|x| x.is_finite()))?;
    let over = |end: usize, of: fn(f64, f64) -> f64| each.iter().map(|x| x[end]).reduce(of);
    Some(BoundsOfSamples {
        lowest: clean(over(0, f64::min)?),
        highest: clean(over(1, f64::max)?),
    })
}

/// Returns the range of a number over the loads that contacts permit, in all samples in which
/// one-sided joints stay closed; `None` without a limit, or if the range of a sample is not clear.
fn permitted(
    good: &[(u64, &AssembledSample)],
    k: usize,
    clean: impl Fn(f64) -> f64,
) -> Option<PermittedOfSamples> {
    let closed = good.iter().filter(|(_, s)| s.opened.is_empty());
    let each = closed.map(|(_, s)| s.permitted.get(k).copied());
    let each: Vec<[f64; 2]> = each.collect::<Option<_>>()?;
    if each.iter().flatten().any(|x| x.is_nan()) {
        return None;
    }
    let over = |end: usize, of: fn(f64, f64) -> f64| {
        let end = each.iter().map(|x| x[end]).reduce(of)?;
        end.is_finite().then(|| clean(end))
    };
    let [lowest, highest] = [over(0, f64::min), over(1, f64::max)];
    (lowest.is_some() || highest.is_some()).then_some(PermittedOfSamples { lowest, highest })
}

/// Counts the reasons of samples that could not be assembled, the most frequent one first.
fn failures(samples: &[Sample]) -> Vec<FailureDocument> {
    let mut all: Vec<FailureDocument> = Vec::new();
    for sample in samples {
        let Err(failed) = &sample.outcome else {
            continue;
        };
        match all.iter_mut().find(|own| own.reason == failed.reason) {
            Some(own) => own.samples += 1,
            None => all.push(FailureDocument {
                reason: failed.reason.to_owned(),
                samples: 1,
                first: sample.number,
                detail: failed.detail.clone(),
            }),
        }
    }
    // Entries with equal numbers remain in the order of their first samples.
    all.sort_by_key(|own| Reverse(own.samples));
    all
}

/// Reason why a number has no range.
const NO_SAMPLE: &str = "no sample was assembled";
const NEVER: &str = "not unique in any sample";
const SOME_SAMPLES: &str = "only in some samples do the exact numbers determine it";
const SHARED_IN_SAMPLES: &str =
    "unique in the described scene, but in samples it depends on how redundant rows share loads";
const CANNOT_MOVE: &str =
    "without play, slip or elasticity the mechanism could not perform this motion";

/// Data for the sentence about a reaction, in addition to the range of the reaction.
struct RangeContext<'a> {
    name: &'a str,
    verdict: &'a str,
    samples: u64,
    within: &'a str,
}

impl RangeContext<'_> {
    /// Describes the range of the reaction.
    fn sentence(&self, first: Option<&QuantityRangeDocument>) -> String {
        let (name, samples, within) = (self.name, self.samples, self.within);
        let Some(value) = first else {
            return format!("`{name}` has no reaction");
        };
        let Some(range) = &value.range else {
            let reason = value.reason.unwrap_or(NEVER);
            return format!("`{name}` ({}): {reason}, so no range", value.name);
        };
        let unit = value.unit;
        let span = if short(range.least) == short(range.greatest) {
            quantity(range.least, unit)
        } else {
            range_in(range.least, range.greatest, unit)
        };
        if value.unique {
            let verb = match unit {
                "N" => "carries",
                _ => "takes a torque of",
            };
            let told = range.described.map_or(String::new(), |x| {
                format!(" ({} as described)", quantity(x, unit))
            });
            return format!("within {within} `{name}` {verb} {span}{told}");
        }
        let [low, _, high] = range.percentiles;
        let low_to_high = range_in(low, high, unit);
        let share = match range.samples {
            n if n == samples => String::new(),
            n => format!(" in {n} of {samples} samples"),
        };
        format!(
            "`{name}` is {}; rigid and without play, data within {within} alone would decide it{share}: {span}, nine tenths \
             within {low_to_high}",
            self.verdict.replace('_', " ")
        )
    }
}
