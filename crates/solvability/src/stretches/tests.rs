//! Time intervals, derived from given instants.

use super::recorder::VerdictRecorder;
use super::*;

const U: Verdict = Verdict::Unique;
const N: Verdict = Verdict::NotUnique;

fn undecided() -> Verdict {
    Verdict::Undecided {
        reason: "near".into(),
    }
}

/// Returns the result for one number that is examined at these instants during a simulation with
/// these interval boundaries.
fn track(extent: [f64; 2], cuts: &[f64], seen: &[(f64, Verdict)]) -> VerdictTrack {
    let mut recorder = VerdictRecorder::new(1);
    cuts.iter().for_each(|&t| recorder.cut(t));
    for (t, verdict) in seen {
        recorder.see(*t, InstantOrder::Next, vec![Some(verdict.clone())]);
    }
    recorder.finish(extent).remove(0)
}

fn words(track: &VerdictTrack) -> Vec<(f64, f64, &'static str)> {
    let each = track.stretches().iter();
    each.map(|s| (s.from, s.to, s.verdict.word())).collect()
}

fn special(track: &VerdictTrack) -> Vec<(f64, &'static str)> {
    let each = track.special().iter();
    each.map(|s| (s.time, s.verdict.word())).collect()
}

/// Three cranks that start upright. The reactions are unique only at the start, which does not
/// affect the verdict.
#[test]
fn the_start_is_a_special_instant() {
    let found = track([0.0, 2.0], &[], &[(0.0, U), (1.0, N), (2.0, N)]);
    assert_eq!(words(&found), [(0.0, 2.0, "not_unique")]);
    assert_eq!(special(&found), [(0.0, "unique")]);
    assert_eq!(*found.of_run(), N);
    assert!(found.determined().is_empty());
}

/// The opposite case. At a start, an end and an event, more verdicts are undecided or not unique
/// than in between.
#[test]
fn instants_on_cuts_decide_nothing() {
    let seen = [(0.0, N), (0.5, U), (1.0, N), (1.5, U), (2.0, N)];
    let found = track([0.0, 2.0], &[1.0], &seen);
    assert_eq!(words(&found), [(0.0, 2.0, "unique")]);
    let expected = [
        (0.0, "not_unique"),
        (1.0, "not_unique"),
        (2.0, "not_unique"),
    ];
    assert_eq!(special(&found), expected);
}

/// A steered wheel that is kept straight up to 1 s. The verdicts before and after this time differ,
/// and the row at the boundary belongs to the later interval.
#[test]
fn a_cut_divides_the_run() {
    let seen = [(0.0, U), (0.5, U), (1.0, U), (1.5, N), (2.0, N)];
    let found = track([0.0, 2.0], &[1.0], &seen);
    assert_eq!(
        words(&found),
        [(0.0, 1.0, "unique"), (1.0, 2.0, "not_unique")]
    );
    assert_eq!((found.at(0.99), found.at(1.0), found.at(2.0)), (&U, &N, &N));
    assert_eq!(found.determined(), [[0.0, 1.0]]);
    assert_eq!(special(&found), [(1.0, "unique")]);
}

#[test]
fn one_instant_that_is_not_unique_decides_and_an_undecided_one_leaves_open() {
    let found = track([0.0, 3.0], &[], &[(1.0, U), (2.0, undecided())]);
    assert_eq!(words(&found), [(0.0, 3.0, "undecided")]);
    assert_eq!(special(&found), []);
    let found = track([0.0, 3.0], &[], &[(1.0, undecided()), (2.0, N)]);
    assert_eq!(words(&found), [(0.0, 3.0, "not_unique")]);
    assert_eq!(special(&found), [(1.0, "undecided")]);
}

/// An interval without examined instants is undecided.
#[test]
fn a_stretch_without_an_instant_is_undecided() {
    let found = track([0.0, 3.0], &[1.0, 2.0], &[(0.5, U), (1.0, U), (2.5, U)]);
    let expected = [
        (0.0, 1.0, "unique"),
        (1.0, 2.0, "undecided"),
        (2.0, 3.0, "unique"),
    ];
    assert_eq!(words(&found), expected);
    // An instant at which the rank drops gives no verdict on its interval.
    let mut recorder = VerdictRecorder::new(1);
    recorder.see(1.0, InstantOrder::Next, vec![None]);
    let found = recorder.finish([0.0, 2.0]).remove(0);
    assert_eq!(words(&found), [(0.0, 2.0, "undecided")]);
}

#[test]
fn a_run_of_one_instant_has_its_verdict() {
    assert_eq!(
        words(&track([0.0, 0.0], &[], &[(0.0, N)])),
        [(0.0, 0.0, "not_unique")]
    );
}

/// The end of a step is available before the rows inside the step.
#[test]
fn instants_ahead_take_their_place_in_time() {
    let mut recorder = VerdictRecorder::new(1);
    let mut see = |t, looked, verdict: Verdict| recorder.see(t, looked, vec![Some(verdict)]);
    see(0.0, InstantOrder::Next, U);
    see(0.5, InstantOrder::Ahead, N);
    see(1.0, InstantOrder::Ahead, U);
    see(0.7, InstantOrder::Next, U);
    // The row at the end of the step is the end itself.
    see(1.0, InstantOrder::Next, N);
    see(1.5, InstantOrder::Ahead, U);
    let found = recorder.finish([0.0, 2.0]).remove(0);
    assert_eq!(words(&found), [(0.0, 2.0, "not_unique")]);
    assert_eq!(
        special(&found),
        [
            (0.0, "unique"),
            (0.7, "unique"),
            (1.0, "unique"),
            (1.5, "unique")
        ]
    );
}

#[test]
fn together_the_worst_counts_at_each_time() {
    let a = track([0.0, 2.0], &[1.0], &[(0.5, U), (1.0, N), (1.5, N)]);
    let b = track([0.0, 2.0], &[], &[(0.0, N), (0.5, U), (1.5, U)]);
    let both = VerdictTrack::together(&[&a, &b]);
    assert_eq!(
        words(&both),
        [(0.0, 1.0, "unique"), (1.0, 2.0, "not_unique")]
    );
    assert_eq!(special(&both), [(0.0, "not_unique")]);
}
