//! Analyses a motion part by part. Each set of joints on common cycles has its own motion and its
//! own singular configurations.

use model::{Mechanism, System};

use super::data::{AlongError, GenericRank, MotionAnalysis, Passage, PassageKind, Stretch};
use super::{judged_as_one, words};
use crate::limits::ROWS_MAX;
use crate::parts::{Extent, Partition};
use crate::second_order::Continuation;
use crate::state::State;
use crate::stretches::Stretches;

/// Analyses a motion of parts at these times, which include the break times. If a simulation
/// computed the motion, the verdicts of the simulation are given.
pub(super) fn judged_by_parts(
    mechanism: &Mechanism,
    motion: impl Fn(f64, &Extent) -> State + Sync,
    times: &[f64],
    partition: &Partition,
    of_run: Option<&Stretches>,
) -> Result<MotionAnalysis, AlongError> {
    let parts = partition.map(mechanism, |part, extent| {
        let rows = part.layout().rows();
        if rows > ROWS_MAX {
            return Err(AlongError::Large {
                joints: extent.name(mechanism),
                rows,
                most: ROWS_MAX,
            });
        }
        let own = of_run.map(|all| all.of_part(&extent, part.layout().groups.len()));
        judged_as_one(part, |t| motion(t, &extent), times, own).map(|along| (extent, along))
    })?;
    let extent = [times[0], times[times.len() - 1]];
    let mut verdicts = match of_run {
        Some(all) => all.clone(),
        None => Stretches::unique(mechanism, extent, &[]),
    };
    let mut generic = GenericRank {
        time: times[0],
        rank: 0,
        redundancy: 0,
    };
    let mut stretches: Vec<(usize, Stretch)> = Vec::new();
    let mut passages: Vec<(usize, Passage)> = Vec::new();
    for (extent, along) in parts {
        let usual = along.generic.redundancy;
        generic.rank += along.generic.rank;
        generic.redundancy += usual;
        stretches.extend(along.stretches.into_iter().map(|s| (usual, s)));
        for mut passage in along.passages {
            whole_branches(&mut passage, &extent, &motion);
            passages.push((usual, passage));
        }
        let own = 0..along.verdicts.reactions.len();
        let places: Vec<usize> = own.map(|own| extent.group(own)).collect();
        verdicts.take(&along.verdicts, &places, &[]);
    }
    let is_usual = |t: f64| {
        let mut inside = stretches.iter().map(|(_, s)| [s.from, s.to]);
        let mut near = passages.iter().map(|(_, p)| p.nearly_singular);
        let holds = |[from, to]: [f64; 2]| from <= t && t <= to;
        !inside.any(holds) && !near.any(holds)
    };
    let usual = times.iter().copied().find(|&t| is_usual(t));
    generic.time = usual.unwrap_or(times[0]);
    let redundancy = generic.redundancy;
    let mut stretches = together(stretches, redundancy);
    for stretch in &mut stretches {
        stretch.text = words::stretch(stretch, redundancy);
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
            passage.text = words::passage(&passage, redundancy);
            passage
        })
        .collect();
    passages.sort_by(|a, b| a.time.total_cmp(&b.time));
    Ok(MotionAnalysis {
        verdicts,
        generic,
        stretches,
        passages,
    })
}

/// Extends the velocities on other branches of a part to the whole mechanism. Bodies outside the
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

/// Merges the time intervals of all parts in chronological order. `redundancy` is the redundancy of
/// the whole mechanism. The number with each interval is the usual redundancy of its part.
fn together(mut found: Vec<(usize, Stretch)>, redundancy: usize) -> Vec<Stretch> {
    found.sort_by(|(_, a), (_, b)| a.from.total_cmp(&b.from).then(a.to.total_cmp(&b.to)));
    let mut all: Vec<Stretch> = Vec::new();
    for (usual, stretch) in found {
        match all.last_mut() {
            Some(last) if last.from == stretch.from && last.to == stretch.to => {
                last.redundancy = last.redundancy + stretch.redundancy - usual;
            }
            _ => all.push(Stretch {
                redundancy: redundancy + stretch.redundancy - usual,
                ..stretch
            }),
        }
    }
    all
}
