//! A motion analysed part by part: each set of joints on common cycles has its own motion and its
//! own passages.

use crate::judged::Judged;
use crate::limits::ROWS_MAX;
use model::{Mechanism, System};

use super::data::{Along, AlongError, Passage, PassageKind, Stretch};
use super::{judged_as_one, words};
use crate::analysis::Analysis;
use crate::parts::{Extent, Partition};
use crate::second_order::Continuation;
use crate::state::State;

/// Analyses a motion of parts at these times, which include the break times.
pub(super) fn judged_by_parts(
    mechanism: &Mechanism,
    motion: impl Fn(f64, &Extent) -> State + Sync,
    times: &[f64],
    partition: &Partition,
    first: &State,
) -> Result<Along, AlongError> {
    let parts = partition.map(mechanism, |part, extent| {
        let rows = part.layout().rows();
        if rows > ROWS_MAX {
            return Err(AlongError::Large {
                joints: extent.name(mechanism),
                rows,
                most: ROWS_MAX,
            });
        }
        judged_as_one(part, |t| motion(t, &extent), times).map(|along| (extent, along))
    })?;
    let mut generic = Vec::with_capacity(parts.len());
    let mut stretches: Vec<(usize, Stretch)> = Vec::new();
    let mut passages: Vec<(usize, Passage)> = Vec::new();
    for (extent, along) in parts {
        let usual = along.generic.decision.redundancy;
        stretches.extend(along.stretches.into_iter().map(|s| (usual, s)));
        for mut passage in along.passages {
            whole_branches(&mut passage, &extent, &motion);
            passages.push((usual, passage));
        }
        generic.push(of_whole(along.generic, mechanism, extent));
    }
    let is_usual = |t: f64| {
        let mut inside = stretches.iter().map(|(_, s)| [s.from, s.to]);
        let mut near = passages
            .iter()
            .map(|(_, p)| p.nearly_singular.unwrap_or([p.time; 2]));
        let holds = |[from, to]: [f64; 2]| from <= t && t <= to;
        !inside.any(holds) && !near.any(holds)
    };
    let time = times
        .iter()
        .copied()
        .find(|&t| is_usual(t))
        .unwrap_or(times[0]);
    let generic = Analysis::of(mechanism, time, &first.q, generic);
    let redundancy = generic.decision.redundancy;
    let mut stretches = together(stretches, redundancy);
    for stretch in &mut stretches {
        stretch.text = words::stretch(stretch, &generic);
    }
    let mut passages: Vec<Passage> = passages
        .into_iter()
        .map(|(usual, mut passage)| {
            if let PassageKind::RankDrops {
                redundancy: own, ..
            } = &mut passage.kind
            {
                *own += redundancy - usual;
            }
            passage.text = words::passage(&passage, &generic);
            passage
        })
        .collect();
    passages.sort_by(|a, b| a.time.total_cmp(&b.time));
    Ok(Along {
        generic,
        stretches,
        passages,
    })
}

/// Converts the analysis of a part to the numbering of the whole mechanism.
fn of_whole(analysis: Analysis, whole: &Mechanism, extent: Extent) -> Judged {
    let mut parts = analysis.parts;
    let part = parts.swap_remove(0);
    Judged {
        part,
        reactions: analysis.reactions,
        dependencies: analysis.dependencies,
        warnings: analysis.warnings,
    }
    .placed(whole, extent)
}

/// Extends the velocities on other branches of a part to the whole mechanism; bodies outside the
/// part keep the velocities of the motion.
fn whole_branches(passage: &mut Passage, extent: &Extent, motion: &impl Fn(f64, &Extent) -> State) {
    if let PassageKind::RankDrops {
        continuation: Continuation::Bifurcation { branches },
        ..
    } = &mut passage.kind
    {
        let v = motion(passage.time, &Extent::Whole).v;
        for branch in branches {
            *branch = extent.put_velocities(branch, v.clone());
        }
    }
}

/// Merges the stretches of all parts, in the order of time. `redundancy` is that of the whole
/// mechanism; the number with each stretch is the usual redundancy of its part.
fn together(mut found: Vec<(usize, Stretch)>, redundancy: usize) -> Vec<Stretch> {
    found.sort_by(|(_, a), (_, b)| a.from.total_cmp(&b.from).then(a.to.total_cmp(&b.to)));
    let mut all: Vec<Stretch> = Vec::new();
    for (usual, stretch) in found {
        match all.last_mut() {
            Some(last) if last.from == stretch.from && last.to == stretch.to => {
                last.redundancy = last.redundancy + stretch.redundancy - usual;
                last.differences.extend(stretch.differences);
            }
            _ => all.push(Stretch {
                redundancy: redundancy + stretch.redundancy - usual,
                ..stretch
            }),
        }
    }
    all
}
