//! Instants at which a reaction is unique that is generically not unique, while the rank stays the
//! same: its margin falls to zero and rises again.

use std::collections::HashMap;
use std::collections::hash_map::Entry;

use super::compare::{differences, verdicts};
use super::data::{AlongError, Passage, PassageKind, Stretch};
use super::passages::local_minima;
use super::path::{Path, Sample};
use super::{search, words};
use crate::analysis::Analysis;
use crate::limits::FINER;
use crate::state::State;
use crate::verdict::Verdict;

/// Margins of all verdicts at the times that have been asked for: searches for several reactions
/// often ask for the same ones.
#[derive(Default)]
struct Margins {
    /// By the bits of the time.
    at: HashMap<u64, Vec<f64>>,
}

impl Margins {
    /// The margin of a verdict; all analyses have the same number of them.
    fn of<F: FnMut(f64) -> State>(
        &mut self,
        path: &mut Path<'_, F>,
        t: f64,
        verdict: usize,
    ) -> Result<f64, AlongError> {
        let known = match self.at.entry(t.to_bits()) {
            Entry::Occupied(known) => known.into_mut(),
            Entry::Vacant(free) => {
                let analysis = path.analysis(t)?;
                free.insert(verdicts(&analysis).map(|v| v.judgement.margin).collect())
            }
        };
        Ok(known.get(verdict).copied().unwrap_or(f64::NAN))
    }
}

/// Finds isolated instants outside the stretches that have verdicts of their own, and outside
/// nearly singular intervals.
pub(super) fn instants<F: FnMut(f64) -> State>(
    path: &mut Path<'_, F>,
    generic: &Analysis,
    stretches: &[Stretch],
    passages: &[Passage],
) -> Result<Vec<Passage>, AlongError> {
    let mechanism = path.mechanism;
    let is_special = |t: f64| {
        let mut stretches = stretches.iter().map(|e| [e.from, e.to]);
        let mut intervals = passages.iter().filter_map(|p| p.nearly_singular);
        let contains = |[from, to]: [f64; 2]| from <= t && t <= to;
        stretches.any(contains) || intervals.any(contains)
    };
    // Margins of the reactions that are generically not unique, sample by sample; `None` at samples
    // at which another verdict is already known to hold.
    let is_known = |s: &Sample| s.regular && !is_special(s.t);
    let of_all_parts = |s: &Sample| -> Option<Vec<f64>> {
        let margins = || verdicts(&s.analysis).map(|v| v.judgement.margin).collect();
        is_known(s).then(margins)
    };
    let times: Vec<f64> = path.samples.iter().map(|s| s.t).collect();
    let known: Vec<Option<Vec<f64>>> = path.samples.iter().map(of_all_parts).collect();
    let not_unique: Vec<usize> = verdicts(generic)
        .enumerate()
        .filter(|(_, v)| v.judgement.verdict == Verdict::NotUnique)
        .map(|(k, _)| k)
        .collect();
    let mut margins_at = Margins::default();
    let mut found: Vec<(f64, Analysis)> = Vec::new();
    for part in not_unique {
        let margins: Vec<Option<f64>> = known
            .iter()
            .map(|margins| margins.as_ref().map(|of_parts| of_parts[part]))
            .collect();
        let mut brackets = Vec::new();
        for coarse in local_minima(&times, &margins) {
            // Two instants may share what looks like one minimum: search between neighbouring
            // samples on each side.
            let neighbour = |t: f64, side: isize| -> Option<f64> {
                let at = times.binary_search_by(|x| x.total_cmp(&t)).ok()?;
                let next = at.checked_add_signed(side)?;
                margins.get(next)?.map(|_| times[next])
            };
            let from = neighbour(coarse[0], -1).unwrap_or(coarse[0]);
            let to = neighbour(coarse[1], 1).unwrap_or(coarse[1]);
            let near = times
                .iter()
                .zip(&margins)
                .filter(|(t, _)| (from..=to).contains(*t));
            let (least, largest) = near
                .filter_map(|(_, margin)| *margin)
                .fold((f64::INFINITY, 0.0_f64), |(a, b), x| (a.min(x), b.max(x)));
            if !search::may_reach(0.0, least, largest) {
                continue;
            }
            let step = (to - from) / f64::from(FINER);
            let finer: Vec<f64> = (0..=FINER).map(|k| from + f64::from(k) * step).collect();
            let values = finer
                .iter()
                .map(|&t| Ok(Some(margins_at.of(path, t, part)?)));
            let values = values.collect::<Result<Vec<_>, AlongError>>()?;
            brackets.extend(local_minima(&finer, &values));
        }
        for bracket in brackets {
            let is_unique = |a: &Analysis| {
                let of_part = verdicts(a).nth(part);
                of_part.is_some_and(|v| v.judgement.verdict.is_unique() && !v.is_zero)
            };
            let inside = |t: f64| bracket[0] <= t && t <= bracket[1];
            if found.iter().any(|(t, a)| inside(*t) && is_unique(a)) {
                continue;
            }
            // Near a flat minimum the margin is only rounding, so a sample time given by the caller
            // is preferred to any other time in that range.
            let mut given = path.samples.iter().filter(|s| inside(s.t) && is_known(s));
            let (t, there) = match given.find(|s| is_unique(&s.analysis)) {
                Some(sample) => (sample.t, sample.analysis.clone()),
                None => {
                    let least =
                        search::minimum(bracket, 0.0, 0.0, |t| margins_at.of(path, t, part))?;
                    let Some((t, _)) = least else {
                        continue;
                    };
                    (t, path.analysis(t)?)
                }
            };
            if is_unique(&there) && !is_special(t) {
                found.push((t, there));
            }
        }
    }
    Ok(found
        .into_iter()
        .map(|(time, analysis)| {
            let mut passage = Passage {
                time,
                kind: PassageKind::Verdicts,
                nearly_singular: None,
                differences: differences(mechanism, generic, &analysis),
                text: String::new(),
            };
            passage.text = words::passage(&passage, generic);
            passage
        })
        .collect())
}
