//! Records the singular configurations that the steps of a run have passed. The record contains
//! their times, the loss of rank, and whether the motion is unique at each configuration.

use integrators::Step;
use model::System;
use solvability::{KERNEL_MAX, PassageKind, State, singular_passages};

use super::equations::RunEquations;
use crate::limits::{BESIDE, JUDGED_MOST, MOST_PASSAGES, PASSAGE_STATES};
use crate::watch::{SearchResult, Singular, SingularitySearch};

/// Searches an accepted step for singular configurations if the step may contain one.
pub(super) fn note(step: &mut Step<'_, RunEquations<'_>>) {
    if !step.ode().motion.watch.is_suspect {
        return;
    }
    for singular in found(step) {
        if step.ode().wanted.uniqueness {
            note_uniqueness(step, singular.dependent);
        }
        let search = SingularitySearch::new(&step.ode().motion.equations);
        let words = step.ode().record.uniqueness_of(singular.dependent);
        let event = search.event(singular, words);
        step.ode().record.events.push(event);
    }
}

/// Records whether the motion is unique at a singular configuration with this loss of rank, within
/// the step. Singular configurations with the same loss of rank have the same result.
fn note_uniqueness(step: &mut Step<'_, RunEquations<'_>>, dependent: usize) {
    if step.ode().record.uniqueness_of(dependent).is_some() {
        return;
    }
    // The second-order test is skipped if it is not applicable, or if it takes longer than the run.
    let motion = &step.ode().motion;
    let layout = motion.mechanism().layout();
    let mobility = layout.n_v - motion.equations.velocity.kept.len();
    let (kernel, rows) = (mobility + dependent, layout.rows());
    let words = if kernel <= KERNEL_MAX && rows <= JUDGED_MOST {
        judge(step)
    } else {
        None
    };
    let words =
        words.unwrap_or_else(|| "whether it is unique at this configuration is undecided".into());
    step.ode().record.uniqueness.push((dependent, words));
}

/// Returns the singular configurations within a step, in order. After a configuration is found, a
/// side of it on which the pivots fall again is searched as well.
fn found(step: &mut Step<'_, RunEquations<'_>>) -> Vec<Singular> {
    let noise = step.ode().motion.watch.nearest();
    let mut search = SingularitySearch::new(&step.ode().motion.equations);
    let mut y = step.y0().to_vec();
    let whole = [step.t0(), step.t1()];
    let mut state = |t: f64, q: &mut [f64]| {
        if step.interpolate_accurately(t, &mut y).is_ok() {
            let n = q.len();
            q.copy_from_slice(&y[..n]);
        }
    };
    let beside = BESIDE * (whole[1] - whole[0]);
    let mut intervals = vec![whole];
    let mut found: Vec<Singular> = Vec::new();
    while let Some([from, to]) = intervals.pop() {
        if to - from < beside || found.len() == MOST_PASSAGES {
            continue;
        }
        if let Some(SearchResult {
            singular,
            falls_again: [before, after],
        }) = search.find([from, to], noise, &mut state)
        {
            intervals.extend(before.then_some([from, singular.t - beside]));
            intervals.extend(after.then_some([singular.t + beside, to]));
            let dependent = search.rank_lost(singular, &mut state);
            if dependent > 0 {
                found.push(Singular {
                    dependent,
                    ..singular
                });
            }
        }
    }
    found.sort_by(|a, b| a.t.total_cmp(&b.t));
    found
}

/// Returns the result of the second-order test of a singular configuration within a step.
fn judge(step: &mut Step<'_, RunEquations<'_>>) -> Option<String> {
    let mechanism = step.ode().motion.mechanism();
    let (n_q, n_v) = (mechanism.layout().n_q, mechanism.layout().n_v);
    let (t0, t1) = (step.t0(), step.t1());
    let times: Vec<f64> = (0..=PASSAGE_STATES)
        .map(|k| t0 + (t1 - t0) * (k as f64 / PASSAGE_STATES as f64))
        .collect();
    let mut y = step.y0().to_vec();
    let passages = singular_passages(
        mechanism,
        |t| {
            // The test evaluates only times within the step.
            let _ = step.interpolate_accurately(t, &mut y);
            State {
                q: y[..n_q].to_vec(),
                v: y[n_q..n_q + n_v].to_vec(),
            }
        },
        &times,
    )
    .ok()?;
    passages.iter().find_map(|p| match &p.kind {
        PassageKind::RankDrops { continuation, .. } => Some(continuation.to_string()),
        _ => None,
    })
}
