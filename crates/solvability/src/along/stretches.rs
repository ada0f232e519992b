//! The generic verdict of a motion, and the stretches between break times on which another verdict
//! holds.
//!
//! At constant rank a reaction that is not unique at one instant is not unique at almost all
//! instants, because a non-zero margin stays non-zero nearby. So of several analyses the one with
//! the most non-unique reactions is generic.

use super::compare::{differences, verdicts};
use super::data::Stretch;
use super::path::{Path, Sample};
use super::words;
use model::{Mechanism, System};

use crate::analysis::Analysis;
use crate::verdict::Verdict;

/// The generic analysis, and the stretches in the order of time; neighbouring stretches with the
/// same verdicts are merged.
pub(super) fn stretches<F>(path: &Path<'_, F>) -> (Analysis, Vec<Stretch>) {
    let (mechanism, samples) = (path.mechanism, &path.samples);
    let (first, last) = (samples[0].t, samples[samples.len() - 1].t);
    let ends = ends_of_pieces(mechanism, first, last);
    // A piece on which no rank is decided has no verdict of its own.
    let typical: Vec<([f64; 2], &Sample)> = ends
        .windows(2)
        .filter_map(|e| {
            let inside = samples.iter().filter(|s| e[0] < s.t && s.t < e[1]);
            Some(([e[0], e[1]], most_generic(inside)?))
        })
        .collect();
    let all = typical.iter().map(|piece| piece.1);
    let generic = most_generic(all)
        .or_else(|| most_generic(samples.iter()))
        .unwrap_or(&samples[0])
        .analysis
        .clone();
    let mut found: Vec<Stretch> = Vec::new();
    for ([from, to], sample) in typical {
        let differences = differences(mechanism, &generic, &sample.analysis);
        let redundancy = sample.decision.redundancy;
        if differences.is_empty() && redundancy == generic.decision.redundancy {
            continue;
        }
        match found.last_mut() {
            Some(last)
                if last.to == from
                    && last.differences == differences
                    && last.redundancy == redundancy =>
            {
                last.to = to;
            }
            _ => found.push(Stretch {
                from,
                to,
                redundancy,
                differences,
                text: String::new(),
            }),
        }
    }
    for stretch in &mut found {
        stretch.text = words::stretch(stretch, &generic);
    }
    (generic, found)
}

/// The sample with the largest rank; among these the one with the most verdicts "not unique" and
/// the fewest "undecided"; among these the one farthest from singular.
fn most_generic<'a>(samples: impl Iterator<Item = &'a Sample>) -> Option<&'a Sample> {
    let standing = |s: &Sample| {
        let (mut not_unique, mut undecided) = (0, 0);
        for v in verdicts(&s.analysis) {
            match v.judgement.verdict {
                Verdict::NotUnique => not_unique += 1,
                Verdict::Undecided { .. } => undecided += 1,
                Verdict::Unique => {}
            }
        }
        (s.decision.rank, not_unique, std::cmp::Reverse(undecided))
    };
    samples
        .filter(|s| s.decision.is_decided())
        .map(|s| (standing(s), s))
        .max_by(|(a, s), (b, t)| a.cmp(b).then(s.sigma.total_cmp(&t.sigma)))
        .map(|(_, s)| s)
}

/// First and last time, and the break times between them.
pub(super) fn ends_of_pieces(mechanism: &Mechanism, first: f64, last: f64) -> Vec<f64> {
    let breaks = mechanism.layout().break_times.iter().copied();
    let inside = breaks.filter(|t| first < *t && *t < last);
    [first].into_iter().chain(inside).chain([last]).collect()
}
