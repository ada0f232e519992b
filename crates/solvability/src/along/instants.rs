//! Finds instants at which a component is unique although it is not unique on its time interval,
//! while the rank stays the same. The margin of the component decreases to zero at this instant and
//! then increases again.

use std::collections::HashMap;
use std::collections::hash_map::Entry;

use super::data::{AlongError, Passage, Stretch};
use super::passages::local_minima;
use super::path::{Path, Sample};
use super::search;
use crate::limits::FINER;
use crate::state::State;
use crate::stretches::{Stretches, VerdictTrack};
use crate::verdict::{Judgement, Verdict};

/// Cache of the margins of all components at the requested times. Searches for several components
/// often request the same times.
#[derive(Default)]
struct Margins {
    /// Margins by the bits of the time.
    at: HashMap<u64, Vec<f64>>,
}

impl Margins {
    /// Returns the margin of a component, given its index among all components.
    fn of<F: FnMut(f64) -> State>(
        &mut self,
        path: &mut Path<'_, F>,
        t: f64,
        component: usize,
    ) -> Result<f64, AlongError> {
        let known = match self.at.entry(t.to_bits()) {
            Entry::Occupied(known) => known.into_mut(),
            Entry::Vacant(free) => {
                let judged = path.judged_at(t)?;
                free.insert(judged.iter().map(|j| j.margin).collect())
            }
        };
        Ok(known.get(component).copied().unwrap_or(f64::NAN))
    }
}

/// An instant, and the verdicts on all components at this instant.
pub(super) type JudgedInstant = (f64, Vec<Judgement>);

/// Finds isolated instants. Stretches with another rank and nearly singular intervals are excluded.
pub(super) fn instants<F: FnMut(f64) -> State>(
    path: &mut Path<'_, F>,
    verdicts: &Stretches,
    stretches: &[Stretch],
    passages: &[Passage],
) -> Result<Vec<JudgedInstant>, AlongError> {
    let is_singular = |t: f64| {
        let mut stretches = stretches.iter().map(|e| [e.from, e.to]);
        let mut intervals = passages.iter().map(|p| p.nearly_singular);
        let contains = |[from, to]: [f64; 2]| from <= t && t <= to;
        stretches.any(contains) || intervals.any(contains)
    };
    let is_known = |s: &Sample| s.regular && !is_singular(s.t);
    let times: Vec<f64> = path.samples.iter().map(|s| s.t).collect();
    let known: Vec<bool> = path.samples.iter().map(is_known).collect();
    let mut margins_at = Margins::default();
    let mut found: Vec<JudgedInstant> = Vec::new();
    for (component, track) in verdicts.components().enumerate() {
        // Margins at samples; `None` if the verdict of the surrounding interval is not `NotUnique`.
        let samples = path.samples.iter().zip(&known);
        let margins: Vec<Option<f64>> = samples
            .map(|(s, known)| {
                let is_open = *known && *track.at(s.t) == Verdict::NotUnique;
                is_open.then(|| s.judged[component].margin)
            })
            .collect();
        let brackets = brackets(path, &mut margins_at, component, (&times, &margins))?;
        for bracket in brackets {
            let inside = |t: f64| bracket[0] <= t && t <= bracket[1];
            let is_unique = |judged: &[Judgement]| judged[component].verdict.is_unique();
            // The samples are already analysed.
            let samples = path.samples.iter().zip(&known);
            let mut given = samples.filter(|(s, known)| inside(s.t) && **known);
            let is_listed = track.special().iter().any(|s| inside(s.time));
            let is_found = found.iter().any(|(t, j)| inside(*t) && is_unique(j));
            if is_listed || is_found || given.any(|(s, _)| is_unique(&s.judged)) {
                continue;
            }
            let least = search::minimum(bracket, 0.0, 0.0, |t| margins_at.of(path, t, component))?;
            let Some((t, _)) = least else {
                continue;
            };
            let judged = path.judged_at(t)?;
            let is_instant = is_unique(&judged) && !is_singular(t) && is_open(track, t);
            if is_instant && !is_of_sample(path, &known, (t, component))? {
                found.push((t, judged));
            }
        }
    }
    Ok(found)
}

/// Returns whether a component is also unique at a sample next to an instant and at times between
/// the two. In this case, the instant is that of the sample, and rounding has displaced it.
fn is_of_sample<F: FnMut(f64) -> State>(
    path: &mut Path<'_, F>,
    known: &[bool],
    (t, component): (f64, usize),
) -> Result<bool, AlongError> {
    let next = path.samples.partition_point(|s| s.t <= t);
    for place in next.saturating_sub(1)..path.samples.len().min(next + 1) {
        let sample = &path.samples[place];
        if known[place] && sample.judged[component].verdict.is_unique() {
            let between = 0.5 * (t + sample.t);
            let judged = path.judged_at(between)?;
            if judged[component].verdict != Verdict::NotUnique {
                return Ok(true);
            }
        }
    }
    Ok(false)
}

fn is_open(track: &VerdictTrack, t: f64) -> bool {
    *track.at(t) == Verdict::NotUnique
}

/// Returns intervals around minima of the margin of a component. The minima are found from the
/// known margins of the component at samples and at finer times.
fn brackets<F: FnMut(f64) -> State>(
    path: &mut Path<'_, F>,
    margins_at: &mut Margins,
    component: usize,
    (times, margins): (&[f64], &[Option<f64>]),
) -> Result<Vec<[f64; 2]>, AlongError> {
    let mut brackets = Vec::new();
    for coarse in local_minima(times, margins) {
        // Two instants may appear as one minimum, so the search continues between neighbouring
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
            .zip(margins)
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
            .map(|&t| Ok(Some(margins_at.of(path, t, component)?)));
        let values = values.collect::<Result<Vec<_>, AlongError>>()?;
        brackets.extend(local_minima(&finer, &values));
    }
    Ok(brackets)
}
